#include "support/mock/mock_hd.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <map>
#include <thread>
#include <utility>

using thimble::support::MockHd;

namespace {

constexpr unsigned kDevice = 0;

MockHd& mock() {
  static MockHd one;
  return one;
}

std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

void expect(bool right, const std::string& what) {
  if (!right) mock().wrong.push_back(what);
}

/// The scheduler: tasks, the largest priority first, once per millisecond.
struct Task {
  unsigned (*call)(void*) = nullptr;
  void* data = nullptr;
  bool done = false;
};
struct Scheduler {
  std::recursive_mutex mutex;
  std::multimap<int, std::pair<unsigned long, Task>> tasks;
  unsigned long next = 1;
  std::atomic<bool> runs{false};
  std::thread thread;
};
Scheduler& scheduler() {
  static Scheduler one;
  return one;
}

/// Runs each task once; those that are done are tasks no more.
void run_tasks() {
  const std::lock_guard lock(scheduler().mutex);
  for (auto& [priority, entry] : scheduler().tasks) {
    Task& task = entry.second;
    task.done = task.call(task.data) == 0;
    const std::lock_guard mock_lock(mock().mutex);
    expect(!mock().frame, "a callback left its frame open");
    mock().frame = false;
  }
  std::erase_if(scheduler().tasks, [](const auto& task) { return task.second.second.done; });
}

void run_scheduler() {
  while (scheduler().runs) {
    run_tasks();
    const bool late = [] {
      const std::lock_guard lock(mock().mutex);
      return mock().late;
    }();
    std::this_thread::sleep_for(std::chrono::milliseconds(late ? 60 : 1));
  }
}

}  // namespace

extern "C" {

struct MockErrorInfo {
  unsigned code;
  int internal;
  unsigned device;
};

MockHd* mock_hd() {
  return &mock();
}

unsigned hdInitDevice(const char*) {
  const std::lock_guard lock(mock().mutex);
  expect(!mock().open, "hdInitDevice twice");
  if (!mock().there) {
    mock().pending_error = 0x0302;
    return 0xFFFFFFFF;
  }
  mock().open = true;
  ++mock().opened;
  mock().arm.time_ns = steady_ns();
  return kDevice;
}
void hdDisableDevice(unsigned device) {
  const std::lock_guard tasks_lock(scheduler().mutex);
  const std::lock_guard lock(mock().mutex);
  expect(scheduler().tasks.empty(), "hdDisableDevice with a callback scheduled");
  expect(device == kDevice && mock().open, "hdDisableDevice of a closed device");
  expect(!mock().scheduler, "hdDisableDevice while the scheduler runs");
  expect(mock().taken.empty() || mock().taken.back().isZero(0), "hdDisableDevice during a force");
  mock().open = mock().force_on = mock().asked_calibration = false;
  ++mock().closed;
}
MockErrorInfo hdGetError() {
  const std::lock_guard lock(mock().mutex);
  const unsigned code = std::exchange(mock().pending_error, 0);
  return {code, 0, kDevice};
}
const char* hdGetErrorString(unsigned) {
  return "failure requested by the test";
}
const char* hdGetString(unsigned) {
  return "Touch";
}
void hdGetIntegerv(unsigned name, int* values) {
  const std::lock_guard lock(mock().mutex);
  expect(mock().open, "hdGetIntegerv before hdInitDevice");
  if (name == 0x2555) {
    *values = mock().styles;
    return;
  }
  expect(name == 0x2000, "hdGetIntegerv of an unknown parameter");
  expect(mock().frame, "hdGetIntegerv outside of a frame");
  *values = mock().arm.buttons;
}
void hdGetDoublev(unsigned name, double* values) {
  const std::lock_guard lock(mock().mutex);
  expect(mock().open, "hdGetDoublev before hdInitDevice");
  if (name == 0x2603) {
    *values = mock().nominal;
    return;
  }
  expect(mock().frame, "hdGetDoublev outside of a frame");
  const auto& arm = mock().arm;
  if (name == 0x2050) {
    for (int i = 0; i < 3; ++i) values[i] = 1000 * arm.p_BT[i];
    if (mock().reports_nan) values[1] = std::numeric_limits<double>::quiet_NaN();
  } else if (name == 0x2051) {
    for (int i = 0; i < 3; ++i) values[i] = 1000 * arm.v_BT[i];
  } else if (name == 0x2052) {
    for (int i = 0; i < 16; ++i) values[i] = i % 5 == 0 ? 1 : 0;
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) values[4 * column + row] = arm.R_BT(row, column);
      values[12 + column] = 1000 * arm.p_BT[column];
    }
  } else {
    expect(false, "hdGetDoublev of an unknown parameter");
  }
}
void hdSetDoublev(unsigned name, const double* values) {
  const std::lock_guard lock(mock().mutex);
  expect(name == 0x2700, "hdSetDoublev of an unknown parameter");
  expect(mock().frame, "hdSetDoublev outside of a frame");
  const Eigen::Vector3d f(values[0], values[1], values[2]);
  expect(f.allFinite(), "a force that is NaN or infinite");
  expect(f.isZero(0) || mock().force_on, "a force before forces are on");
  expect(f.norm() <= mock().nominal + 1e-9, "more than the nominal force");
  mock().arm.f_T_B =
      mock().error >= 0x0200 && mock().error <= 0x0204 ? Eigen::Vector3d(0, 0, 0) : f;
  mock().taken.push_back(f);
}
void hdEnable(unsigned capability) {
  const std::lock_guard lock(mock().mutex);
  expect(capability == 0x4000, "hdEnable of an unknown capability");
  expect(mock().open && mock().asked_calibration && mock().calibrated,
         "forces on before the arm is calibrated");
  mock().force_on = true;
}
void hdBeginFrame(unsigned device) {
  const std::lock_guard lock(mock().mutex);
  expect(device == kDevice && mock().open, "hdBeginFrame before hdInitDevice");
  expect(!mock().frame, "hdBeginFrame in a frame");
  mock().frame = true;
  if (mock().open) mock().arm.advance_to(steady_ns());
}
void hdEndFrame(unsigned device) {
  const std::lock_guard lock(mock().mutex);
  expect(device == kDevice && mock().frame, "hdEndFrame without hdBeginFrame");
  mock().frame = false;
  ++mock().frames;
  mock().pending_error = mock().error;
}
unsigned hdCheckCalibration() {
  const std::lock_guard lock(mock().mutex);
  expect(mock().open, "hdCheckCalibration before hdInitDevice");
  mock().asked_calibration = true;
  return mock().calibrated ? 0x5000 : 0x5002;
}
void hdUpdateCalibration(unsigned style) {
  const std::lock_guard lock(mock().mutex);
  expect(mock().open && mock().scheduler, "hdUpdateCalibration without a scheduler");
  expect((static_cast<int>(style) & mock().styles) != 0, "an unsupported style");
  ++mock().calibrations;
  mock().calibrated = true;
}
void hdStartScheduler() {
  {
    const std::lock_guard lock(mock().mutex);
    expect(!mock().scheduler, "hdStartScheduler twice");
    expect(mock().open, "hdStartScheduler before hdInitDevice");
    mock().scheduler = true;
  }
  scheduler().runs = true;
  scheduler().thread = std::thread(run_scheduler);
}
void hdStopScheduler() {
  scheduler().runs = false;
  if (scheduler().thread.joinable()) scheduler().thread.join();
  const std::lock_guard lock(mock().mutex);
  expect(mock().scheduler, "hdStopScheduler without hdStartScheduler");
  mock().scheduler = false;
}
unsigned long hdScheduleAsynchronous(unsigned (*call)(void*), void* data, unsigned short priority) {
  const std::lock_guard lock(scheduler().mutex);
  {
    const std::lock_guard mock_lock(mock().mutex);
    expect(mock().open, "hdScheduleAsynchronous before hdInitDevice");
    expect(call != nullptr, "hdScheduleAsynchronous without a callback");
  }
  if (call == nullptr) return 0;
  const unsigned long handle = scheduler().next++;
  scheduler().tasks.emplace(-priority, std::make_pair(handle, Task{call, data}));
  return handle;
}
void hdUnschedule(unsigned long handle) {
  const std::lock_guard lock(scheduler().mutex);
  const std::size_t erased = std::erase_if(
      scheduler().tasks, [handle](const auto& task) { return task.second.first == handle; });
  const std::lock_guard mock_lock(mock().mutex);
  expect(erased == 1, "hdUnschedule of an unknown task");
}

}  // extern "C"
