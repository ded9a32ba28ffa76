// Preloaded by faults_test.sh (LD_PRELOAD): the date jumps by a day and back every few
// milliseconds, as if it were set. The monotonic clock continues.
#include <dlfcn.h>
#include <sys/time.h>

#include <ctime>

namespace {

using Gettime = int (*)(clockid_t, timespec*);

int true_time(clockid_t clock, timespec* time) {
  static const auto next = reinterpret_cast<Gettime>(dlsym(RTLD_NEXT, "clock_gettime"));
  return next(clock, time);
}

void jump(timespec& time) {
  if (time.tv_nsec / 5'000'000 % 2 == 0) time.tv_sec += 86'400;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const int result = true_time(clock, time);
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) jump(*time);
  return result;
}

extern "C" int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  const int result = true_time(CLOCK_REALTIME, &now);
  jump(now);
  time->tv_sec = now.tv_sec;
  time->tv_usec = now.tv_nsec / 1000;
  return result;
}
