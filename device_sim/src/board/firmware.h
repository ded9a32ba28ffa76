#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "board/board_bytes.h"
#include "split_mix.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// Counts what the firmware met.
struct FirmwareCounters {
  std::uint64_t messages = 0;        ///< Valid messages.
  std::uint64_t malformed = 0;       ///< Messages of a length nobody knows; ignored.
  std::uint64_t over_range = 0;      ///< Currents beyond the range, taken as zero.
  std::uint64_t missed_edges = 0;    ///< Steps of the encoders that were not counted.
  std::uint64_t presets = 0;         ///< Messages that set the encoder counters.
  std::uint64_t watchdog_fired = 0;  ///< Times the motors went off for want of messages.
};

/// What runs on the arm's own board: it samples encoders into reports, and turns messages into
/// wanted motor currents. It knows no clock; whoever owns it tells it the time.
///
/// The motors are off until the first message and after the watchdog fired, until the next message.
/// A preset message sets the counters, clears the button flag and asks for zero current, as the
/// published firmware does [S, DEVICES 1]. All functions are Real-time: safe.
class Firmware {
 public:
  /// The time of an event that is not going to happen, ns.
  static constexpr std::int64_t kNever_ns = INT64_MAX;

  /// Makes the board of a model's motors and encoders; its geometry does not matter. Fails if a
  /// period is not above zero, the range negative, an encoder has no counts, the wiring names a
  /// joint that is not there, or it cannot speak what it is asked to. Real-time: never from the
  /// servo thread.
  static driver::Result<Firmware> make(const driver::ArmModel& model,
                                       const FirmwareSettings& settings);

  /// Samples the encoders of an arm at these true joint angles, and those of its gimbal (rad), into
  /// the report with this number that the board would send.
  BoardBytes sample(const Eigen::Vector3d& q, const Eigen::Vector3d& gimbal = {0, 0, 0},
                    std::uint16_t number = 0) const noexcept;

  /// Samples angles that are wrong by up to `error` (rad) into `bytes`, if they give the same
  /// counts as the true ones would; returns false, and leaves it alone, where that is not sure.
  bool sample_about(const Eigen::Vector3d& q, double error, const Eigen::Vector3d& gimbal,
                    std::uint16_t number, BoardBytes& bytes) const noexcept;

  /// Returns whether its counters miss edges; then `sample_about` is never sure.
  bool misses_edges() const noexcept { return settings_.missed_edges > 0; }
  /// Lets the counters miss some of the edges that the encoders passed since the last call, at
  /// these true joint angles (rad): each with the chance FirmwareSettings::missed_edges. At most
  /// kEdgesMost of each encoder are looked at, which is beyond what an arm does in a period.
  void miss_edges(const Eigen::Vector3d& q, SplitMix& chance) noexcept;
  /// How many edges of an encoder `miss_edges` looks at.
  static constexpr std::int64_t kEdgesMost = 100'000;

  /// Takes a message that arrived at `time_ns`. Returns the counters that it asks for, if it is a
  /// preset: then `preset` is due at once.
  std::optional<BoardCounters> receive(std::span<const std::byte> message,
                                       std::int64_t time_ns) noexcept;
  /// Sets the counters of an arm and a gimbal at these true angles (rad).
  void preset(const BoardCounters& counters, const Eigen::Vector3d& q,
              const Eigen::Vector3d& gimbal = {0, 0, 0}) noexcept;

  /// Restarts the board of an arm and a gimbal at these true angles (rad): its motors are off until
  /// the next message, and its counters begin at zero.
  void restart(const Eigen::Vector3d& q, const Eigen::Vector3d& gimbal = {0, 0, 0}) noexcept;

  /// Switches the motors off if no message came for the watchdog's time.
  void watch(std::int64_t time_ns) noexcept;

  /// Returns when `watch` will act unless a message comes, ns, or kNever_ns while the motors are
  /// off.
  std::int64_t watchdog_due_ns() const noexcept { return watchdog_due_ns_; }

  /// Presses the calibration button; its flag stays set until a preset.
  void press_button() noexcept { button_ = true; }

  /// Returns the currents the motors are asked for, joint by joint, A.
  const Eigen::Vector3d& currents() const noexcept { return amperes_; }

  /// Returns whether the amplifiers are enabled.
  bool motors_on() const noexcept { return watchdog_due_ns_ != kNever_ns; }

  const FirmwareCounters& counters() const noexcept { return counters_; }

 private:
  Firmware(const driver::ArmModel& model, const FirmwareSettings& settings) noexcept;
  Eigen::Vector3d counts_at(const Eigen::Vector3d& q) const noexcept;
  Eigen::Vector3d gimbal_counts_at(const Eigen::Vector3d& gimbal) const noexcept;
  void set_counters(const BoardCounters& counters, const Eigen::Vector3d& q,
                    const Eigen::Vector3d& gimbal) noexcept;
  void report(const Eigen::Vector3d& counts, const Eigen::Vector3d& gimbal, std::uint16_t number,
              BoardBytes& bytes) const noexcept;
  bool countable() const noexcept;

  FirmwareSettings settings_;
  std::optional<driver::Gimbal> gimbal_;
  Eigen::Vector3d counts_per_radian_;  // with the encoder's sign
  Eigen::Vector3d home_counts_;        // and what the counters have missed
  double counts_per_radian_most_;      // of any joint
  bool countable_;                     // gains, home and presets leave counts their digits
  FirmwareCounters counters_;
  // What presets added to the counters.
  Eigen::Vector3d preset_counts_{0, 0, 0}, preset_gimbal_{0, 0, 0};
  std::array<std::int64_t, 3> edges_{};  // where the encoders were at the last `miss_edges`
  bool looked_ = false;
  Eigen::Vector3d amperes_{0, 0, 0};
  std::int64_t watchdog_due_ns_ = kNever_ns;
  bool button_ = false;
};

}  // namespace thimble::device_sim
