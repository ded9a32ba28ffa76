#include "bringup/loop_priority.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>

namespace thimble::bringup {

LoopPriority::LoopPriority(bool wanted) noexcept {
  constexpr int kPriority = 80;  // as in driver::enter_real_time
  sched_param before{};
  if (!wanted || pthread_getschedparam(pthread_self(), &policy_, &before) != 0) return;
  priority_ = before.sched_priority;
  sched_param requested{};
  requested.sched_priority = kPriority;
  raised_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &requested) == 0;
}

LoopPriority::~LoopPriority() {
  if (!raised_) return;
  sched_param before{};
  before.sched_priority = priority_;
  pthread_setschedparam(pthread_self(), policy_, &before);
}

void LateTicks::count(double behind, double period) noexcept {
  ++ticks;
  if (behind > 0.5 * period) ++late;
  worst = std::max(worst, behind);
}

void LateTicks::add(const LateTicks& other) noexcept {
  ticks += other.ticks;
  late += other.late;
  worst = std::max(worst, other.worst);
}

}  // namespace thimble::bringup
