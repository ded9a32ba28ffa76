// Time, keys and threads.
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>

#include "compat/core/arm_access.h"
#include "compat/dhd/last_error.h"
#include "drdc.h"

namespace {

// Switches the terminal to single keys during its lifetime.
class SingleKeyMode {
 public:
  SingleKeyMode() noexcept {
    if (!isatty(STDIN_FILENO) || tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    keys.c_cc[VMIN] = 1;
    keys.c_cc[VTIME] = 0;
    changed_ = tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0;
  }
  ~SingleKeyMode() {
    if (changed_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  SingleKeyMode(const SingleKeyMode&) = delete;
  SingleKeyMode& operator=(const SingleKeyMode&) = delete;

 private:
  termios before_{};
  bool changed_ = false;
};

bool key_waits(int timeout_ms) noexcept {
  pollfd keyboard{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  return poll(&keyboard, 1, timeout_ms) == 1 && (keyboard.revents & POLLIN) != 0;
}

}  // namespace

extern "C" {

double dhdGetTime(void) {
  return 1e-9 * static_cast<double>(thimble::compat::arms::now_ns());
}
double drdGetTime(void) {
  return dhdGetTime();
}

void dhdSleep(double seconds) {
  if (!(seconds > 0)) return;
  constexpr double kLongest = 1e8;  // three years
  thimble::compat::arms::sleep_ns(std::llround(1e9 * std::fmin(seconds, kLongest)));
}
void drdSleep(double seconds) {
  dhdSleep(seconds);
}

bool dhdKbHit(void) {
  const SingleKeyMode keys;
  return key_waits(0);
}

char dhdKbGet(void) {
  const SingleKeyMode keys;
  char key = 0;
  ssize_t got;
  do {
    got = read(STDIN_FILENO, &key, 1);
  } while (got < 0 && errno == EINTR);
  return got == 1 ? key : '\0';
}

int dhdStartThread(void* function(void*), void* argument, int) {
  using thimble::compat::dhd::fail;
  if (!function) return fail("dhdStartThread", DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
  pthread_t thread{};
  const int made = pthread_create(&thread, &attributes, function, argument);
  pthread_attr_destroy(&attributes);
  return made == 0 ? 0 : fail("dhdStartThread", DHD_ERROR, "the thread cannot be created");
}

}  // extern "C"
