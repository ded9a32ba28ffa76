#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "thimble/driver/export.h"
#include "thimble/driver/fault.h"
#include "thimble/driver/orientation.h"

namespace thimble::driver {

struct DeviceState;
struct ForceCommand;

/// Where a device is in its life.
enum class DeviceStage : std::uint8_t {
  kIdle,     ///< Reports are read, zero force is sent.
  kActive,   ///< Forces are sent through the gate.
  kFault,    ///< Zero force, latched; see the fault.
  kWaiting,  ///< Zero force until the enabling input is held (HoldToRun).
};

/// The last of the stages; a larger value in a file or in shared memory is damaged.
inline constexpr DeviceStage kLastStage = DeviceStage::kWaiting;

/// State of the link to an arm. It is independent of the fault: an arm whose force is off for
/// another reason can be pulled, and a lost arm can come back while its fault is still latched.
enum class LinkState : std::uint8_t {
  kConnected,  ///< Reports arrive.
  kSilent,     ///< The link is open; no report for `DeviceSettings::silence_limit_ns`, or none yet.
  kLost,       ///< The arm is gone from the wire; the device waits for a new link.
};

/// The last of the link states; a larger value in a file or in shared memory is damaged.
inline constexpr LinkState kLastLinkState = LinkState::kLost;

/// Returns the short name of a link state as it stands in reports ("lost"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(LinkState state) noexcept;

/// Holds everything one tick did, as plain numbers: what the snapshot shows, the recorder keeps and
/// reports are made of. Trivially copyable. Frames: W world, T tip, P proxy.
struct TickRecord {
  static constexpr std::int16_t kNoSetting = -1;  ///< `setting`: none was turned in this tick.
  /// `setting`: the force is not, or not only, the scene's: a program's law or a topic gave it.
  static constexpr std::int16_t kOtherLaw = -2;

  std::uint64_t tick = 0;    ///< number of the tick, from 0; gaps are ticks that were missed
  std::int64_t time_ns = 0;  ///< When the tick began, on the loop's clock.
  std::int64_t due_ns = 0;   ///< When it should have begun.
  std::int64_t work_ns = 0;  ///< From wake-up to write, on the loop's clock (0 in virtual time).
  std::array<std::int32_t, 3> counts{};    ///< of the encoders, as they came over the wire
  std::array<double, 3> q{};               ///< rad
  std::array<double, 3> p_WT{};            ///< m
  std::array<double, 3> v_WT{};            ///< m/s
  std::array<double, 3> p_WP{};            ///< m
  std::array<double, 3> n_W{};             ///< unit normal
  std::array<double, 3> f_wanted_W{};      ///< N, what the force law asked for
  std::array<double, 3> f_sent_W{};        ///< N, what stands: `Device::f_sent_W`
  std::array<double, 3> heat{};            ///< of the motors; 1: the winding's limit
  TipQuaternion q_WT{};                    ///< of the stylus (w, x, y, z); zeros: not known
  std::array<float, 3> gimbal{};           ///< rad; zeros where there is none
  float gripper = 0;                       ///< opening, m; 0: closed, or none
  double depth = 0;                        ///< m
  double setting_value = 0;                ///< what `setting` was asked to become; in recordings
  double gain = 1;                         ///< share of the scene's force; in recordings
  std::int32_t feature = -1;               ///< active triangle
  std::int16_t object = -1;                ///< which of the scene's objects
  std::uint16_t hops = 0;                  ///< triangles crossed in this tick
  std::uint16_t buttons = 0;               ///< one bit each; bit 0 is the arm's first
  std::int16_t setting = kNoSetting;       ///< of the scene, that was turned; in recordings
  bool in_contact = false;                 ///< the tip is held outside an object
  bool fresh = false;                      ///< a new report came for this tick
  bool has_gripper = false;                ///< the arm has a gripper
  DeviceStage stage = DeviceStage::kIdle;  ///< of the device, after the tick
  Fault fault = Fault::kNone;              ///< that keeps the force off
  LinkState link = LinkState::kConnected;  ///< of the device, after the tick
  bool home_needed = false;                ///< no force before the home pose: Device::home_needed
};

/// Returns what a tick is known by before its force went through the gate: what the device read and
/// what the law answered. What was sent, stage, fault and heat are left as they begin.
/// Real-time: safe.
THIMBLE_EXPORT TickRecord record_of(const DeviceState& state, const ForceCommand& command) noexcept;

}  // namespace thimble::driver
