#pragma once

#include <HD/hd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "compat/core/arm_data.h"

namespace thimble::compat::hd {

/// The state of an arm that a frame shows, and what is asked in it.
struct Frame {
  ArmReading now;                          ///< Of the tick that the frame began with.
  ArmReading last;                         ///< Of the frame before.
  std::array<double, 3> f_asked_W{};       ///< N; stands until it is set anew.
  std::array<double, 3> torque_asked_W{};  ///< N m; the same.
  bool open = false;                       ///< It was begun and not ended.
  std::thread::id owner{};                 ///< Who began it.
};

/// One arm that a program has by HDAPI. Its handle is the arm's number.
struct Device {
  bool open = false;
  Frame frame;
  bool force_output = false, force_clamping = false, force_ramping = false;
  bool force_limit = true, one_frame_limit = false;
  double ramping_rate = 1000;                ///< N/s
  double velocity_limit = 0;                 ///< mm/s; 0: the gate's
  double impulse_limit = 0;                  ///< N/ms; kept and given back
  std::array<double, 4> light{};             ///< kept and given back
  std::array<double, 3> joint_references{};  ///< kept and given back
  std::int64_t enabled_ns = 0;               ///< When force was switched on, by the arm's clock.
  std::uint64_t framed_tick = 0;             ///< Of the newest frame, plus one.
  driver::Fault fault_told = driver::Fault::kNone;
  driver::LinkState link_reported = driver::LinkState::kConnected;
  bool warm_told = false;
};

/// All arms of the process. Locked by `mutex` while it is read or changed; never while a callback
/// runs or an arm is waited for.
struct Devices {
  std::mutex mutex;
  std::array<Device, kArmsMost> all;
  std::atomic<HHD> current{0};  ///< Of threads that chose none: the newest choice of any.
};

/// Returns them. They are never destroyed: threads of the program may ask while it exits.
Devices& devices() noexcept;

/// Returns the arm's number that calls of this thread are about, open or not.
HHD current_device() noexcept;
/// Makes it another one.
void set_current_device(HHD device) noexcept;
/// Returns whether a handle is of an arm that is open. Under the lock.
bool is_open(HHD device) noexcept;
/// Returns the current device if it is open; else null, and the error HD_BAD_HANDLE is kept, told
/// as a wrong call of `function`. Under the lock.
Device* current_open(const char* function) noexcept;
/// Returns what a thread sees of a device: its frame, or the newest tick outside of one. Under the
/// lock.
ArmReading seen(HHD device) noexcept;

/// Returns whether this thread belongs to a scheduler that was stopped, by one of its own
/// callbacks: no frame that it ends asks for a force.
bool scheduler_stopped() noexcept;

/// Ends a frame that this thread left open when its callbacks were over, with HD_FRAME_ERROR.
void end_forgotten_frames() noexcept;

}  // namespace thimble::compat::hd
