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

/// Stage of a device.
enum class DeviceStage : std::uint8_t {
  kIdle,     ///< Reports are read; zero force is sent.
  kActive,   ///< Forces are sent through the gate.
  kFault,    ///< Zero force is sent; the fault is latched.
  kWaiting,  ///< Zero force is sent until the enabling input is held (HoldToRun).
};

/// Last stage. A larger value in a file or in shared memory is damaged.
inline constexpr DeviceStage kLastStage = DeviceStage::kWaiting;

/// State of the link to an arm. It is independent of the fault. An arm whose force is off for
/// another reason can be disconnected, and a lost arm can return while its fault is latched.
enum class LinkState : std::uint8_t {
  kConnected,  ///< Reports arrive.
  /// The link is open, but no report has arrived for `DeviceSettings::silence_limit_ns`, or at all.
  kSilent,
  kLost,  ///< The arm is disconnected; the device waits for a new link.
};

/// Last link state. A larger value in a file or in shared memory is damaged.
inline constexpr LinkState kLastLinkState = LinkState::kLost;

/// Returns the short name of a link state in reports ("lost"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(LinkState state) noexcept;

/// Complete data of one tick, as plain numbers for the snapshot, the recorder and reports.
/// Trivially copyable. Frames: W world, T tip, P proxy.
struct TickRecord {
  /// Value of `setting` if no setting was changed in this tick.
  static constexpr std::int16_t kNoSetting = -1;
  /// Value of `setting` if a program's law or a topic provided all or a part of the force.
  static constexpr std::int16_t kOtherLaw = -2;

  /// Number of the tick, from 0; missing numbers are missed ticks.
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;  ///< Start of the tick on the loop's clock, ns.
  std::int64_t due_ns = 0;   ///< Time at which the tick was due, ns.
  /// Time from wake-up to write on the loop's clock, ns (0 in virtual time).
  std::int64_t work_ns = 0;
  std::array<std::int32_t, 3> counts{};  ///< Raw encoder counts.
  std::array<double, 3> q{};             ///< Joint angles, rad.
  std::array<double, 3> p_WT{};          ///< Position of the tip, m.
  std::array<double, 3> v_WT{};          ///< Velocity of the tip, m/s.
  std::array<double, 3> p_WP{};          ///< Position of the proxy, m.
  std::array<double, 3> n_W{};           ///< Unit normal of the contact.
  std::array<double, 3> f_wanted_W{};    ///< Force requested by the force law, N.
  std::array<double, 3> f_sent_W{};      ///< Acting force, N: `Device::f_sent_W`.
  std::array<double, 3> heat{};          ///< Heat of the motors; 1 is the limit of the winding.
  /// Quaternion of the stylus (w, x, y, z); zeros: unknown.
  TipQuaternion q_WT{};
  std::array<float, 3> gimbal{};  ///< Gimbal angles, rad; zeros without a gimbal.
  float gripper = 0;              ///< Gripper opening, m; 0: closed, or none.
  double depth = 0;               ///< Penetration depth, m.
  double setting_value = 0;       ///< Requested value of `setting`; in recordings.
  double gain = 1;                ///< Fraction of the scene's force; in recordings.
  std::int32_t feature = -1;      ///< Active triangle.
  std::int16_t object = -1;       ///< Number of the touched object in the scene.
  std::uint16_t hops = 0;         ///< Triangles crossed in this tick.
  std::uint16_t buttons = 0;      ///< Buttons, one bit each; bit 0 is the first button.
  /// Setting of the scene that was changed; in recordings.
  std::int16_t setting = kNoSetting;
  bool in_contact = false;                 ///< True if the tip is in contact with an object.
  bool fresh = false;                      ///< True if a new report arrived for this tick.
  bool has_gripper = false;                ///< True if the arm has a gripper.
  DeviceStage stage = DeviceStage::kIdle;  ///< Stage of the device after the tick.
  Fault fault = Fault::kNone;              ///< Fault that keeps the force off.
  LinkState link = LinkState::kConnected;  ///< State of the link after the tick.
  /// True if the home pose is required before any force (Device::home_needed).
  bool home_needed = false;
};

/// Returns the record of a tick before its force has passed the gate: the state that the device
/// read and the command of the law. The sent force, stage, fault and heat have their initial
/// values. Real-time: safe.
THIMBLE_EXPORT TickRecord record_of(const DeviceState& state, const ForceCommand& command) noexcept;

}  // namespace thimble::driver
