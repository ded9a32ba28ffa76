#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "board/board_bytes.h"
#include "board/reference_program.h"
#include "split_mix.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// Event counters of the firmware.
struct FirmwareCounters {
  std::uint64_t messages = 0;        ///< Valid messages.
  std::uint64_t malformed = 0;       ///< Messages of unknown length; ignored.
  std::uint64_t over_range = 0;      ///< Currents beyond the range, taken as zero.
  std::uint64_t missed_edges = 0;    ///< Encoder steps that were not counted.
  std::uint64_t presets = 0;         ///< Messages that set the encoder counters.
  std::uint64_t watchdog_fired = 0;  ///< Times that the watchdog switched the motors off.
};

/// Firmware of the arm's board: samples encoders into reports, and turns messages into motor
/// currents. It has no clock; its owner passes the time.
///
/// The motors are off until the first message; after the watchdog fired, they are off until the
/// next one. A preset message sets the counters, clears the button flag and requests zero current,
/// as the published firmware does [S, DEVICES 1]. All functions are Real-time: safe.
class Firmware {
 public:
  /// The time of an event that will not happen, ns.
  static constexpr std::int64_t kNever_ns = INT64_MAX;

  /// Makes the board for a model's motors and encoders; its geometry does not matter. Fails if a
  /// period is not above zero, the range is negative, or an encoder has no counts. Also fails if
  /// the wiring names a joint that does not exist, or the protocol cannot carry the settings.
  /// Real-time: never from the servo thread.
  static driver::Result<Firmware> make(const driver::ArmModel& model,
                                       const FirmwareSettings& settings);

  /// Samples the encoders at these true joint angles and gimbal angles (rad). Returns the report
  /// with this number that the board would send.
  BoardBytes sample(const Eigen::Vector3d& q, const Eigen::Vector3d& gimbal = {0, 0, 0},
                    std::uint16_t number = 0) const noexcept;

  /// Samples joint angles with an error of up to `error` (rad) into `bytes` if they certainly give
  /// the same counts as the true ones. Otherwise returns false and leaves `bytes` unchanged.
  bool sample_about(const Eigen::Vector3d& q, double error, const Eigen::Vector3d& gimbal,
                    std::uint16_t number, BoardBytes& bytes) const noexcept;

  /// Returns whether the counters miss edges; then `sample_about` always returns false.
  bool misses_edges() const noexcept { return settings_.missed_edges > 0; }
  /// Makes the counters miss some of the edges that the encoders passed since the last call, at
  /// these true joint angles (rad). Each is missed with the probability
  /// FirmwareSettings::missed_edges. At most kEdgesMax edges per encoder are processed, which is
  /// more than an arm passes in a period.
  void miss_edges(const Eigen::Vector3d& q, SplitMix& chance) noexcept;
  /// Max. number of edges of an encoder that `miss_edges` processes.
  static constexpr std::int64_t kEdgesMax = 100'000;

  /// Takes a message that arrived at `time_ns`. If it is a preset, returns its counters; the caller
  /// must then call `preset` at once.
  std::optional<BoardCounters> receive(std::span<const std::byte> message,
                                       std::int64_t time_ns) noexcept;
  /// Sets the counters at these true joint and gimbal angles (rad).
  void preset(const BoardCounters& counters, const Eigen::Vector3d& q,
              const Eigen::Vector3d& gimbal = {0, 0, 0}) noexcept;

  /// Restarts the board at these true joint and gimbal angles (rad): its motors are off until the
  /// next message, and its counters begin at zero.
  void restart(const Eigen::Vector3d& q, const Eigen::Vector3d& gimbal = {0, 0, 0}) noexcept;

  /// Returns whether the board runs the reference firmware. Its `sample` then gives only the values
  /// that the firmware measures, and `tick` must be called with them.
  bool has_program() const noexcept { return settings_.reference; }
  /// Lets the reference firmware begin a loop with the values of `sample` in `bytes`; replaces them
  /// by its report.
  void tick(std::int64_t time_ns, BoardBytes& bytes) noexcept;
  /// Sets supply, temperature and encoder error that the reference firmware measures.
  void set_health(const BoardHealth& health) noexcept { health_ = health; }

  /// Switches the motors off if no message came within the watchdog's time.
  void watch(std::int64_t time_ns) noexcept;

  /// Returns the time when `watch` will act if no message comes, ns; kNever_ns while the motors are
  /// off.
  std::int64_t watchdog_due_ns() const noexcept { return watchdog_due_ns_; }

  /// Presses the calibration button; its flag remains set until a preset.
  void press_button() noexcept { button_ = true; }

  /// Returns the requested motor currents, joint by joint, A.
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
  ReferenceProgram& program() noexcept {
    return settings_.program != nullptr ? *settings_.program : *own_program_;
  }
  void take_outputs(std::int64_t time_ns) noexcept;

  FirmwareSettings settings_;
  std::optional<driver::Gimbal> gimbal_;
  Eigen::Vector3d counts_per_radian_;  // with the encoder's sign
  Eigen::Vector3d home_counts_;        // includes the edges that the counters have missed
  double max_counts_per_radian_;       // max. over the joints
  bool countable_;  // gains, home and presets leave enough digits for exact counts
  FirmwareCounters counters_;
  // Added to the counters by presets.
  Eigen::Vector3d preset_counts_{0, 0, 0}, preset_gimbal_{0, 0, 0};
  std::array<std::int64_t, 3> edges_{};  // encoder positions at the last `miss_edges`
  bool looked_ = false;
  Eigen::Vector3d amperes_{0, 0, 0};
  std::int64_t watchdog_due_ns_ = kNever_ns;
  bool button_ = false;
  std::optional<HostProgram> own_program_;
  BoardHealth health_;
};

}  // namespace thimble::device_sim
