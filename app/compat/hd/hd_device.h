#pragma once

#include <HD/hd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "compat/core/arm_data.h"

namespace thimble::compat::hd {

/// The state of an arm shown in a frame, and the requests made in it.
struct Frame {
  ArmReading now;                          ///< State at the start of the frame.
  ArmReading last;                         ///< State of the previous frame.
  std::array<double, 3> f_asked_W{};       ///< N; valid until it is set again.
  std::array<double, 3> torque_asked_W{};  ///< N m; likewise.
  bool open = false;                       ///< The frame was begun and not ended.
  std::thread::id owner{};                 ///< The thread that began it.
};

/// One arm that a program has opened by HDAPI. Its handle is the arm's number.
struct Device {
  bool open = false;
  Frame frame;
  bool force_output = false, force_clamping = false, force_ramping = false;
  bool force_limit = true, one_frame_limit = false;
  double ramping_rate = 1000;                ///< N/s
  double velocity_limit = 0;                 ///< mm/s; 0: the gate's
  double impulse_limit = 0;                  ///< N/ms; only stored and returned
  std::array<double, 4> light{};             ///< only stored and returned
  std::array<double, 3> joint_references{};  ///< only stored and returned
  std::int64_t enabled_ns = 0;               ///< Time of the last enabling, arm's clock.
  std::uint64_t framed_tick = 0;             ///< Tick of the newest frame, plus one.
  driver::Fault reported_fault = driver::Fault::kNone;
  driver::LinkState link_reported = driver::LinkState::kConnected;
  bool warm_reported = false;
};

/// All arms of the process. Lock `mutex` to read or change it, but never while a callback runs or
/// during a wait for an arm.
struct Devices {
  std::mutex mutex;
  std::array<Device, kArmsMax> all;
  std::atomic<HHD> current{0};  ///< The newest choice of any thread, as the default.
};

/// Returns the arms. They are never destroyed: threads of the program may use them while it exits.
Devices& devices() noexcept;

/// Returns the number of this thread's current arm, open or not.
HHD current_device() noexcept;
/// Changes this thread's current arm.
void set_current_device(HHD device) noexcept;
/// Returns whether a handle is that of an open arm. Lock required.
bool is_open(HHD device) noexcept;
/// Returns the current device if it is open. Otherwise returns null, keeps the error HD_BAD_HANDLE,
/// and records a wrong call of `function`. Lock required.
Device* current_open(const char* function) noexcept;
/// Returns the visible state of a device for this thread: its frame, or the newest tick outside of
/// a frame. Lock required.
ArmReading seen(HHD device) noexcept;

/// Returns whether this thread belongs to a scheduler that one of its own callbacks stopped: frames
/// that it ends request no force.
bool scheduler_stopped() noexcept;

/// Ends a frame that this thread left open after its callbacks, with HD_FRAME_ERROR.
void end_open_frames() noexcept;

}  // namespace thimble::compat::hd
