#include "compat/hd/hd_device.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "compat/core/arm_access.h"
#include "compat/hd/hd_errors.h"
#include "compat/hd/hd_parameters.h"

namespace thimble::compat::hd {
namespace {

thread_local std::optional<HHD> chosen;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string text_of(const std::array<char, 64>& text) {
  return {text.data()};
}

/// Returns the arm for a name: none, "Default Device", one of our arms, or a number after "PHANToM"
/// as in other drivers; -1 if there is none.
int arm_named(const char* name) {
  const std::string wanted = lower(name == nullptr ? "" : name);
  if (wanted.empty() || wanted == "default device" || wanted == "default phantom") return 0;
  for (int arm = 0; arm < arms::count(); ++arm) {
    if (wanted == lower(arms::name(arm)) || wanted == lower(text_of(arms::facts(arm).name))) {
      return arm;
    }
  }
  if (wanted == "left device") return 0;
  if (wanted == "right device") return 1;
  const std::string family = "phantom";
  if (!wanted.starts_with(family)) return -1;
  const std::string number =
      wanted.substr(wanted.find_first_not_of(' ', family.size()) == std::string::npos
                        ? wanted.size()
                        : wanted.find_first_not_of(' ', family.size()));
  if (number.empty()) return 0;
  if (number.size() > 2 || !std::all_of(number.begin(), number.end(), ::isdigit)) return -1;
  return std::atoi(number.c_str()) - 1;
}

/// Reports changes of the program's force by the gate as HDAPI errors.
void report_force_errors(HHD handle, Device& device) noexcept {
  const ArmReading& now = device.frame.now;
  if (now.fault != device.reported_fault) {
    device.reported_fault = now.fault;
    switch (now.fault) {
      case driver::Fault::kNone:
        break;
      case driver::Fault::kOverSpeed:
        record_error(HD_EXCEEDED_MAX_VELOCITY, handle, static_cast<int>(now.fault));
        break;
      case driver::Fault::kTransportLost:
      case driver::Fault::kNoReports:
      case driver::Fault::kRefused:
        record_error(HD_COMM_ERROR, handle, static_cast<int>(now.fault));
        break;
      default:
        record_error(HD_DEVICE_FAULT, handle, static_cast<int>(now.fault));
    }
  }
  if (now.link != device.link_reported) {
    device.link_reported = now.link;
    // An arm can be unplugged as the cause of a fault, or after another one.
    const bool named_by_fault =
        now.fault == driver::Fault::kTransportLost || now.fault == driver::Fault::kNoReports;
    if (now.link == driver::LinkState::kLost && !named_by_fault) {
      record_error(HD_COMM_ERROR, handle, static_cast<int>(driver::Fault::kTransportLost));
    }
  }
  if (now.tick == device.frame.last.tick) return;
  if (now.cuts.limited && device.force_limit && !device.force_clamping)
    record_error(HD_EXCEEDED_MAX_FORCE, handle);
  if (now.cuts.rise_limited && device.impulse_check)
    record_error(HD_EXCEEDED_MAX_FORCE_IMPULSE, handle);
  constexpr double kWarm = 0.8;  // of the winding's limit; the gate's own warning
  const bool warm = *std::max_element(now.heat.begin(), now.heat.end()) >= kWarm;
  if (warm && !device.warm_reported) record_error(HD_WARM_MOTORS, handle);
  device.warm_reported = warm;
}

/// Returns the length of a vector; NaN if a component is NaN.
double length_of(const std::array<double, 3>& v) noexcept {
  return std::hypot(v[0], v[1], v[2]);
}

/// Limits the change of the force since the last frame to the program's impulse limit. A weaker
/// force is never delayed. Returns whether the limit was exceeded.
bool limit_impulse(const Device& device, std::array<double, 3>& f_W) noexcept {
  if (!device.impulse_check || !(device.impulse_limit > 0)) return false;
  std::array<double, 3> change{};
  for (std::size_t i = 0; i < 3; ++i) change[i] = f_W[i] - device.f_sent_W[i];
  const std::int64_t passed_ns = device.frame.now.time_ns - device.sent_ns;
  const double passed_ms = std::max(1e-6 * static_cast<double>(passed_ns), 1.0);
  const double max_change = device.impulse_limit * passed_ms;
  const double length = length_of(change);
  // A force that is not finite goes to the gate unchanged.
  if (!(length > max_change) || !std::isfinite(length)) return false;
  if (length_of(f_W) < length_of(device.f_sent_W)) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    f_W[i] = device.f_sent_W[i] + change[i] * max_change / length;
  }
  return true;
}

/// Requests a device's force, after HDAPI's clamping and ramping.
void send(HHD handle, Device& device) noexcept {
  const ForceCommand& command = device.sent;
  ForceRequest asked{.f_W = command.f_W};
  // Both are torques that arms with three motors cannot exert; they are only counted.
  for (std::size_t i = 0; i < 3; ++i) asked.torque_W[i] = command.torque_W[i] + command.gimbal[i];
  const double length = length_of(asked.f_W);
  double max_force = length;
  if (device.force_clamping)
    max_force = std::min(max_force, arms::facts(static_cast<int>(handle)).force_max);
  if (device.force_ramping) {
    const double since = 1e-9 * static_cast<double>(device.frame.now.time_ns - device.enabled_ns);
    max_force = std::min(max_force, device.ramping_rate * std::max(since, 0.0));
  }
  // NaN is passed to the gate unchanged.
  if (max_force < length) {
    for (double& f : asked.f_W) f *= max_force / length;
  }
  if (limit_impulse(device, asked.f_W)) record_error(HD_EXCEEDED_MAX_FORCE_IMPULSE, handle);
  device.f_sent_W = asked.f_W;
  device.sent_ns = device.frame.now.time_ns;
  arms::ask_force(static_cast<int>(handle), asked);
}

/// Ends a frame. Its command replaces that of the frame before. A frame without a command requests
/// no force, except if another frame of the same tick has a command: that one stays in force.
void end_frame(HHD handle, Device& device) noexcept {
  Frame& frame = device.frame;
  frame.open = false;
  const bool keeps = !frame.commanded && device.framed.same_tick(device.commanded);
  if (frame.commanded) device.commanded = device.framed;
  if (!keeps) device.sent = frame.command;
  if (scheduler_stopped()) device.sent = {};
  // Outside of a frame, the program reads the command that is in force.
  frame.command = device.sent;
  if (device.force_output) send(handle, device);
}

}  // namespace

Devices& devices() noexcept {
  static Devices& only = *new Devices;
  return only;
}

HHD current_device() noexcept {
  return chosen.value_or(devices().current.load());
}

void set_current_device(HHD device) noexcept {
  chosen = device;
  devices().current.store(device);
}

bool is_open(HHD device) noexcept {
  return device < kArmsMax && devices().all[device].open;
}

Device* current_open(const char* function) noexcept {
  const HHD current = current_device();
  if (is_open(current)) return &devices().all[current];
  record_wrong_call(HD_BAD_HANDLE, function, "no arm is open and current (hdMakeCurrentDevice)");
  return nullptr;
}

void remove_command(HHD device) noexcept {
  Device& own = devices().all[device];
  own.frame.command = own.sent = {};
  own.frame.commanded = false;
  own.commanded = {};
  own.f_sent_W = {};
  arms::ask_force(static_cast<int>(device), {});
}

void apply_velocity_limit(HHD device) noexcept {
  constexpr double kMetres = 1e-3;  // per mm
  const Device& own = devices().all[device];
  arms::set_speed_limit(static_cast<int>(device),
                        own.velocity_check ? own.velocity_limit * kMetres : 0.0);
}

ArmReading seen(HHD device) noexcept {
  const Frame& frame = devices().all[device].frame;
  if (frame.open && frame.owner == std::this_thread::get_id()) return frame.now;
  ArmReading newest = frame.now;
  arms::read(static_cast<int>(device), newest);
  return newest;
}

void end_open_frames() noexcept {
  const std::lock_guard lock(devices().mutex);
  for (HHD handle = 0; handle < kArmsMax; ++handle) {
    Device& device = devices().all[handle];
    if (!device.frame.open || device.frame.owner != std::this_thread::get_id()) continue;
    record_error(HD_FRAME_ERROR, handle);
    arms::wrong_call("hdBeginFrame", "the frame was still open after the callbacks of the tick");
    end_frame(handle, device);
  }
}

}  // namespace thimble::compat::hd

using namespace thimble::compat;
using namespace thimble::compat::hd;

extern "C" {

HHD hdInitDevice(HDstring name) {
  const int arm = arm_named(name);
  if (arm < 0 || arm >= kArmsMax || (arms::count() > 0 && arm >= arms::count())) {
    record_wrong_call(HD_COMM_CONFIG_ERROR, __func__, "no arm has this name");
    return HD_INVALID_HANDLE;
  }
  const HHD handle = static_cast<HHD>(arm);
  {
    const std::lock_guard lock(devices().mutex);
    if (is_open(handle)) {
      record_wrong_call(HD_DEVICE_ALREADY_INITIATED, __func__, "the arm is already open");
      return HD_INVALID_HANDLE;
    }
  }
  const std::string trouble = arms::open(arm, "HDAPI");
  if (!trouble.empty()) {
    // The program itself prints only "failed to initialise".
    std::fprintf(stderr, "thimble: hdInitDevice: %s\n", trouble.c_str());
    record_wrong_call(HD_COMM_ERROR, __func__, trouble.c_str());
    return HD_INVALID_HANDLE;
  }
  std::unique_lock lock(devices().mutex);
  if (is_open(handle)) {  // another thread opened it meanwhile, so this opening is surplus
    lock.unlock();
    arms::close(arm);
    record_wrong_call(HD_DEVICE_ALREADY_INITIATED, __func__, "the arm is already open");
    return HD_INVALID_HANDLE;
  }
  Device& device = devices().all[handle];
  device = Device{};
  device.open = true;
  arms::read(arm, device.frame.now);
  device.frame.last = device.frame.now;
  set_current_device(handle);
  return handle;
}

void hdDisableDevice(HHD handle) {
  {
    const std::lock_guard lock(devices().mutex);
    if (!is_open(handle)) {
      record_wrong_call(HD_BAD_HANDLE, __func__, "no open arm has this handle");
      return;
    }
    devices().all[handle] = Device{};
  }
  arms::close(static_cast<int>(handle));
}

void hdMakeCurrentDevice(HHD handle) {
  const std::lock_guard lock(devices().mutex);
  if (is_open(handle)) {
    set_current_device(handle);
  } else {
    record_wrong_call(HD_BAD_HANDLE, __func__, "no open arm has this handle");
  }
}

HHD hdGetCurrentDevice(void) {
  const std::lock_guard lock(devices().mutex);
  return current_device();
}

void hdBeginFrame(HHD handle) {
  const std::lock_guard lock(devices().mutex);
  if (!is_open(handle)) {
    record_wrong_call(HD_BAD_HANDLE, __func__, "no open arm has this handle");
    return;
  }
  set_current_device(handle);
  Device& device = devices().all[handle];
  Frame& frame = device.frame;
  if (frame.open) {
    record_wrong_call(HD_ILLEGAL_BEGIN, __func__, "hdBeginFrame was called inside a frame");
    return;
  }
  ArmReading newest;
  if (!arms::read(static_cast<int>(handle), newest)) newest = frame.now;
  const FrameTime time{.tick = newest.tick + 1, .run = scheduler_run()};
  if (device.one_frame_limit && time.same_tick(device.framed)) {
    record_wrong_call(HD_ILLEGAL_BEGIN, __func__, "more than one frame in a tick");
    return;
  }
  device.framed = time;
  // Two frames in one tick show the same state; the previous frame is then that of the tick before.
  if (newest.tick != frame.now.tick) frame.last = frame.now;
  frame.now = newest;
  frame.command = {};
  frame.commanded = false;
  frame.open = true;
  frame.owner = std::this_thread::get_id();
  report_force_errors(handle, device);
}

void hdEndFrame(HHD handle) {
  const std::lock_guard lock(devices().mutex);
  if (!is_open(handle)) {
    record_wrong_call(HD_BAD_HANDLE, __func__, "no open arm has this handle");
    return;
  }
  Device& device = devices().all[handle];
  if (!device.frame.open) {
    record_wrong_call(HD_ILLEGAL_END, __func__, "hdEndFrame was called without hdBeginFrame");
    return;
  }
  if (device.frame.owner != std::this_thread::get_id()) {
    record_wrong_call(HD_ILLEGAL_END, __func__, "another thread began the frame");
    return;
  }
  end_frame(handle, device);
}

HDenum hdCheckCalibration(void) {
  const std::lock_guard lock(devices().mutex);
  const Device* device = current_open(__func__);
  if (device == nullptr) return HD_CALIBRATION_NEEDS_UPDATE;
  return arms::is_calibrated(static_cast<int>(current_device())) ? HD_CALIBRATION_OK
                                                                 : HD_CALIBRATION_NEEDS_UPDATE;
}

HDenum hdCheckCalibrationStyle(void) {
  return HD_CALIBRATION_AUTO;
}

void hdUpdateCalibration(HDenum style) {
  const std::lock_guard lock(devices().mutex);
  if (current_open(__func__) == nullptr) return;
  constexpr HDenum kStyles =
      HD_CALIBRATION_ENCODER_RESET | HD_CALIBRATION_AUTO | HD_CALIBRATION_INKWELL;
  if (style == 0 || (style & ~kStyles) != 0) {
    record_wrong_call(HD_INVALID_VALUE, __func__, "no calibration style has this number");
    return;
  }
  // Our arms are calibrated when they are opened (thimble calibrate).
  arms::mark_calibrated(static_cast<int>(current_device()));
}

void hdUpdateCalibrationMessage(HDenum style) {
  hdUpdateCalibration(style);
}

HDboolean hdDeploymentLicense(const char* vendor, const char* application, const char* password) {
  if (vendor != nullptr && application != nullptr && password != nullptr) return HD_TRUE;
  record_wrong_call(HD_INVALID_LICENSE, __func__, "a string is null");
  return HD_FALSE;
}

}  // extern "C"
