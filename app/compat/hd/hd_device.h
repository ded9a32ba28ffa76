#pragma once

#include <HD/hd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "compat/core/arm_data.h"

namespace thimble::compat::hd {

/// The forces and torques that a program sets. Zero at the start of each frame.
struct ForceCommand {
  std::array<double, 3> f_W{};       ///< N
  std::array<double, 3> torque_W{};  ///< N m; of the stylus.
  std::array<double, 3> gimbal{};    ///< N m; of the gimbal's axes.
};

/// The state of an arm shown in a frame, and the requests made in it.
struct Frame {
  ArmReading now;           ///< State at the start of the frame.
  ArmReading last;          ///< State of the previous frame.
  ForceCommand command;     ///< Command of this frame, or of the last ended one.
  bool commanded = false;   ///< The program has set a force or torque in it.
  bool open = false;        ///< The frame was begun and not ended.
  std::thread::id owner{};  ///< The thread that began it.
};

/// A moment of a frame: the arm's tick that it shows, and the run of the scheduler's callbacks in
/// which it was. Two frames are of one tick if they share either.
struct FrameTime {
  std::uint64_t tick = 0;  ///< Number of the arm's tick plus one; 0: none yet.
  std::uint64_t run = 0;   ///< Number of the scheduler's run; 0: on another thread.
  bool same_tick(const FrameTime& other) const noexcept {
    return (tick != 0 && tick == other.tick) || (run != 0 && run == other.run);
  }
};

/// One arm that a program has opened by HDAPI. Its handle is the arm's number.
struct Device {
  bool open = false;
  Frame frame;
  bool force_output = false, force_clamping = false, force_ramping = false;
  bool force_limit = true, one_frame_limit = false;
  bool impulse_check = true, velocity_check = true;
  double ramping_rate = 1000;                ///< N/s
  double velocity_limit = 0;                 ///< mm/s; 0: the gate's
  double impulse_limit = 0;                  ///< N/ms; 0: the gate's
  std::array<double, 4> light{};             ///< only stored and returned
  std::array<double, 3> joint_references{};  ///< only stored and returned
  std::int64_t enabled_ns = 0;               ///< Time of the last enabling, arm's clock.
  ForceCommand sent;                         ///< Command of the last ended frame.
  std::array<double, 3> f_sent_W{};          ///< N; its force after the program's limits.
  std::int64_t sent_ns = 0;                  ///< Its time, arm's clock.
  FrameTime framed;                          ///< Time of the newest frame.
  FrameTime commanded;                       ///< Time of the newest frame with a command.
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

/// Returns the number of the scheduler's run that this thread executes; 0 on other threads.
std::uint64_t scheduler_run() noexcept;

/// Removes the command of an arm, and requests no force. Lock required.
void remove_command(HHD device) noexcept;

/// Applies the speed limit of the program to an arm, or only the gate's if its check is off. Lock
/// required.
void apply_velocity_limit(HHD device) noexcept;

/// Ends a frame that this thread left open after its callbacks, with HD_FRAME_ERROR.
void end_open_frames() noexcept;

}  // namespace thimble::compat::hd
