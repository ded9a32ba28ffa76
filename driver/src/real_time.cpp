#include "thimble/driver/real_time.h"

#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

namespace thimble::driver {

RealTimeGrant enter_real_time(int priority) {
  RealTimeGrant grant;
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int refused = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  grant.fifo = refused == 0;
  if (!grant.fifo) {
    grant.advice += "Real-time scheduling was refused (" + std::string(std::strerror(refused)) +
                    "). Add your user to a group with 'rtprio 80' in /etc/security/limits.d, or "
                    "run as root; until then expect more jitter. ";
  }
  // With a finite limit, locking future pages would make later allocations fail at that limit.
  rlimit limit{};
  const bool unlimited =
      geteuid() == 0 || (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
  grant.memory_locked = mlockall(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0;
  if (!grant.memory_locked) {
    grant.advice += "Locking memory was refused (" + std::string(std::strerror(errno)) +
                    "). Allow 'memlock unlimited' for your user in /etc/security/limits.d. ";
  }
  if (!grant.advice.empty()) grant.advice.pop_back();
  return grant;
}

CpuLatencyRequest::CpuLatencyRequest(const std::filesystem::path& root) {
  const std::filesystem::path path = root / "dev/cpu_dma_latency";
  file_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  const std::int32_t max_latency_us = 0;
  if (file_ >= 0 && write(file_, &max_latency_us, sizeof max_latency_us) == sizeof max_latency_us)
    return;
  const int error = errno;
  if (file_ >= 0) close(file_);
  file_ = -1;
  advice_ = path.string() + " was refused (" + std::strerror(error) +
            "), so the processors may sleep between ticks and wake late. Run `thimble doctor` for "
            "a remedy.";
}

CpuLatencyRequest::~CpuLatencyRequest() {
  if (file_ >= 0) close(file_);
}

}  // namespace thimble::driver
