// The scheduler: callbacks on a thread of the program's process, once per tick of the arm, in order
// of priority. The arm's own loop is in another process and never waits for them.
#include <HD/hd.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "compat/core/arm_access.h"
#include "compat/hd/hd_device.h"
#include "compat/hd/hd_errors.h"

namespace thimble::compat::hd {
namespace {

constexpr std::size_t kCallbacksMax = 256;  // chosen: programs have two to five
constexpr HDulong kFullRate = 1000;         // Hz, rate of our arms
constexpr int kPriority = 60;               // of the thread, below that of the arm's loop

struct Callback {
  HDSchedulerHandle handle = 0;
  HDSchedulerCallback call = nullptr;
  void* data = nullptr;
  HDushort priority = 0;
  bool running = false;
  bool leaving = false;  // another thread waits to remove it: do not run it again
};

struct Scheduler {
  std::mutex mutex;
  std::condition_variable changed;  // signals the end of a callback, or that the scheduler stops
  std::vector<Callback> callbacks;  // by priority, the highest first; equal ones in order of age
  HDSchedulerHandle next = 1;
  HDulong rate = kFullRate;
  std::thread thread;
  bool running = false;
  std::shared_ptr<std::atomic<bool>> stop;  // of the thread, which may outlive the scheduler
  std::atomic<std::int64_t> tick_began_ns{0};
};

thread_local bool on_scheduler_thread = false;
thread_local std::uint64_t own_run = 0;  // number of the run that this thread executes
thread_local const std::atomic<bool>* own_stop = nullptr;  // flag of the scheduler of this thread

// Never destroyed: the thread may run while the program exits.
Scheduler& scheduler() {
  static Scheduler& only = *new Scheduler;
  return only;
}

std::int64_t now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

Callback* find(Scheduler& s, HDSchedulerHandle handle) {
  const auto found = std::find_if(s.callbacks.begin(), s.callbacks.end(),
                                  [&](const Callback& c) { return c.handle == handle; });
  return found == s.callbacks.end() ? nullptr : &*found;
}

void remove(Scheduler& s, HDSchedulerHandle handle) {
  std::erase_if(s.callbacks, [&](const Callback& c) { return c.handle == handle; });
  s.changed.notify_all();
}

/// Adds a callback after those of its priority; 0 if there is no room. Lock required.
HDSchedulerHandle add(Scheduler& s, HDSchedulerCallback call, void* data, HDushort priority) {
  if (s.callbacks.size() >= kCallbacksMax) return 0;
  const auto behind = std::find_if(s.callbacks.begin(), s.callbacks.end(),
                                   [&](const Callback& c) { return c.priority < priority; });
  const HDSchedulerHandle handle = s.next++;
  s.callbacks.insert(behind, {handle, call, data, priority});
  return handle;
}

/// Runs each callback once. Callbacks may schedule and unschedule callbacks. If one stops the
/// scheduler, none of the others runs.
void run_callbacks(Scheduler& s) {
  static std::atomic<std::uint64_t> runs{0};
  own_run = runs.fetch_add(1) + 1;
  std::vector<HDSchedulerHandle> due;
  {
    const std::lock_guard lock(s.mutex);
    for (const Callback& callback : s.callbacks) due.push_back(callback.handle);
  }
  for (const HDSchedulerHandle handle : due) {
    if (scheduler_stopped()) break;
    Callback now;
    {
      const std::lock_guard lock(s.mutex);
      Callback* found = find(s, handle);
      if (found == nullptr || found->leaving) continue;  // unscheduled meanwhile
      found->running = true;
      now = *found;
    }
    const HDCallbackCode code = now.call(now.data);
    const std::lock_guard lock(s.mutex);
    if (Callback* found = find(s, handle)) {
      found->running = false;
      if (code != HD_CALLBACK_CONTINUE) {
        remove(s, handle);
        continue;
      }
    }
    s.changed.notify_all();
  }
  end_open_frames();
}

/// Returns the first open arm, which sets the pace; -1 if there is none.
int pacing_arm() {
  const std::lock_guard lock(devices().mutex);
  for (HHD handle = 0; handle < kArmsMax; ++handle) {
    if (is_open(handle)) return static_cast<int>(handle);
  }
  return -1;
}

/// Lets the other open arms whose ticks wait for the program make as many ticks as the arm that
/// sets the pace.
void advance_others(int pacing, std::uint64_t ticks) {
  for (int arm = 0; arm < kArmsMax; ++arm) {
    ArmReading reading;
    if (arm == pacing || !arms::is_paced(arm) || !arms::read(arm, reading)) continue;
    arms::wait_for_tick(arm, reading.tick + ticks - 1);
  }
}

void loop(Scheduler& s, const std::atomic<bool>& stop) {
  on_scheduler_thread = true;
  own_stop = &stop;
  // Without the permission, the thread runs with more jitter.
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  std::uint64_t tick = 0;
  int paced_by = -1;
  while (!stop.load()) {
    HDulong rate = 0;
    {
      const std::lock_guard lock(s.mutex);
      rate = s.rate;
    }
    const int arm = pacing_arm();
    ArmReading reading;
    if (arm != paced_by) {  // another arm has other tick numbers
      paced_by = arm;
      tick = arms::read(arm, reading) ? reading.tick : 0;
    }
    // Without an open arm, it sleeps for a period.
    const double every = std::round(arms::facts(arm).rate / static_cast<double>(rate));
    const std::uint64_t ticks = static_cast<std::uint64_t>(std::max(every, 1.0));
    arms::wait_for_tick(arm, tick + ticks - 1);
    advance_others(arm, ticks);
    if (arms::read(arm, reading)) tick = reading.tick;
    if (stop.load()) break;
    s.tick_began_ns.store(now_ns());
    run_callbacks(s);
  }
}

void end_thread(std::thread& thread) {
  if (!thread.joinable()) return;
  if (thread.get_id() == std::this_thread::get_id()) {
    thread.detach();  // a callback stopped its own scheduler
  } else {
    thread.join();
  }
}

/// Removes all forces when the scheduler has stopped.
void end_forces() {
  const std::lock_guard lock(devices().mutex);
  for (HHD handle = 0; handle < kArmsMax; ++handle) {
    if (!is_open(handle)) continue;
    remove_command(handle);
  }
}

}  // namespace

std::uint64_t scheduler_run() noexcept {
  return own_run;
}

bool scheduler_stopped() noexcept {
  return own_stop != nullptr && own_stop->load();
}

}  // namespace thimble::compat::hd

using namespace thimble::compat;
using namespace thimble::compat::hd;

extern "C" {

void hdStartScheduler(void) {
  Scheduler& s = scheduler();
  const std::lock_guard lock(s.mutex);
  if (s.running) return;
  end_thread(s.thread);  // thread of a scheduler that stopped itself
  s.running = true;
  s.stop = std::make_shared<std::atomic<bool>>(false);
  s.thread = std::thread([&s, stop = s.stop] { loop(s, *stop); });
}

void hdStopScheduler(void) {
  Scheduler& s = scheduler();
  std::thread thread;
  {
    const std::lock_guard lock(s.mutex);
    if (!s.running) return;
    s.running = false;
    s.stop->store(true);
    thread = std::move(s.thread);
    s.changed.notify_all();
  }
  end_thread(thread);
  end_forces();
}

void hdSetSchedulerRate(HDulong hertz) {
  // Every tick of the arm, or every second, third and so on.
  if (hertz == 0 || hertz > kFullRate || kFullRate % hertz != 0) {
    record_wrong_call(HD_INVALID_VALUE, __func__, "the rate must be 1000 Hz divided by an integer");
    return;
  }
  Scheduler& s = scheduler();
  const std::lock_guard lock(s.mutex);
  s.rate = hertz;
}

HDSchedulerHandle hdScheduleAsynchronous(HDSchedulerCallback callback, void* data,
                                         HDushort priority) {
  if (callback == nullptr) {
    record_wrong_call(HD_INVALID_VALUE, __func__, "the callback is null");
    return 0;
  }
  Scheduler& s = scheduler();
  const std::lock_guard lock(s.mutex);
  const HDSchedulerHandle handle = add(s, callback, data, priority);
  if (handle == 0) record_wrong_call(HD_SCHEDULER_FULL, __func__, "too many callbacks");
  return handle;
}

void hdScheduleSynchronous(HDSchedulerCallback callback, void* data, HDushort priority) {
  if (callback == nullptr) {
    record_wrong_call(HD_INVALID_VALUE, __func__, "the callback is null");
    return;
  }
  Scheduler& s = scheduler();
  std::unique_lock lock(s.mutex);
  if (!s.running || on_scheduler_thread) {
    // The scheduler cannot run it while this thread waits.
    lock.unlock();
    callback(data);
    return;
  }
  const HDSchedulerHandle handle = add(s, callback, data, priority);
  if (handle == 0) {
    record_wrong_call(HD_SCHEDULER_FULL, __func__, "too many callbacks");
    return;
  }
  s.changed.wait(lock, [&] {
    const Callback* found = find(s, handle);
    return found == nullptr || (!s.running && !found->running);
  });
  remove(s, handle);
}

void hdUnschedule(HDSchedulerHandle handle) {
  Scheduler& s = scheduler();
  std::unique_lock lock(s.mutex);
  Callback* callback = find(s, handle);
  if (callback == nullptr) {
    record_wrong_call(HD_INVALID_VALUE, __func__, "no callback has this handle");
    return;
  }
  callback->leaving = true;
  // The callback's data may be destroyed after this function returns.
  if (!on_scheduler_thread) {
    s.changed.wait(lock, [&] {
      const Callback* found = find(s, handle);
      return found == nullptr || !found->running;
    });
  }
  remove(s, handle);
}

HDboolean hdWaitForCompletion(HDSchedulerHandle handle, HDWaitCode code) {
  Scheduler& s = scheduler();
  std::unique_lock lock(s.mutex);
  if (code == HD_WAIT_CHECK_STATUS) return find(s, handle) != nullptr ? HD_TRUE : HD_FALSE;
  if (code != HD_WAIT_INFINITE) {
    record_wrong_call(HD_INVALID_VALUE, __func__, "no wait code has this number");
    return HD_FALSE;
  }
  if (on_scheduler_thread) {
    record_wrong_call(HD_INVALID_OPERATION, __func__, "a callback cannot wait for callbacks");
    return HD_FALSE;
  }
  s.changed.wait(lock, [&] { return find(s, handle) == nullptr || !s.running; });
  return find(s, handle) == nullptr ? HD_TRUE : HD_FALSE;
}

HDdouble hdGetSchedulerTimeStamp(void) {
  const std::int64_t began_ns = scheduler().tick_began_ns.load();
  return began_ns == 0 ? 0 : 1e-9 * static_cast<double>(now_ns() - began_ns);
}

}  // extern "C"
