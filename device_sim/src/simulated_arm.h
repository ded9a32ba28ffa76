#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "board/firmware.h"
#include "board/wire_queue.h"
#include "hand/hand.h"
#include "hand/hand_path.h"
#include "hand/tremor.h"
#include "plant/arm_plant.h"
#include "plant/axis_dynamics.h"
#include "plant/drive_train_plant.h"
#include "plant/inverse_plant.h"
#include "plant/loaded_tip.h"
#include "split_mix.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// A complete arm at the other end of the wire: plant, encoders, motors, firmware and a hand,
/// driven by time only. It exchanges the bytes of the real arm and shares no state with the driver.
///
/// Events in time order. At each report period (the first at time 0) the firmware samples the
/// encoders; `delay_in` later the host can read that report. A message of the host reaches the
/// motors `delay_out` after its write. The watchdog fires when no message came within its time. At
/// equal times the encoders are sampled first, then messages arrive, then the watchdog is checked.
/// So a report shows the state before a message of the same moment, and a message just in time
/// keeps the motors on. Without delay this is an ideal zero-order hold. A host that reads at k
/// periods and writes at once sees the sample of that very moment, and its force acts from then on.
///
/// Between events the plant moves by its exact map, in sub-steps of at most 1 ms. The hand's point
/// moves at constant velocity in each; a corner of the path inside a sub-step is cut. Nothing
/// allocates after `make`. All functions but `make` are Real-time: safe; the duration of advance_to
/// grows with the time that passes.
class THIMBLE_EXPORT SimulatedArm {
 public:
  /// Makes the arm at rest at the path's first point, with time 0. `seed` determines the tremor's
  /// phases, late and lost frames, and missed edges. Fails if a constant is out of range or the
  /// path's start is out of reach. Real-time: never from the servo thread.
  static driver::Result<SimulatedArm> make(const driver::JointModel<driver::SerialArm>& model,
                                           const SimulatedArmSettings& settings, HandPath path,
                                           std::uint64_t seed = 0);
  /// As above, for an arm with a linkage (Polhem).
  static driver::Result<SimulatedArm> make(const driver::JointModel<driver::LinkageArm>& model,
                                           const SimulatedArmSettings& settings, HandPath path,
                                           std::uint64_t seed = 0);

  /// As above, for an arm of any geometry but a delta arm, which has its own bus
  /// (usb::SimulatedFalcon), and an arm behind its vendor's software. An arm with one or two motors
  /// moves only on the first axes of its base: the hand, the weight and a fixed mass act along
  /// these.
  static driver::Result<SimulatedArm> make(const driver::ArmModel& model,
                                           const SimulatedArmSettings& settings, HandPath path,
                                           std::uint64_t seed = 0);

  /// Advances to `time_ns`; a time in the past does nothing.
  void advance_to(std::int64_t time_ns) noexcept;

  /// Copies the newest report that the host can read at the present time. Returns its size, or 0 if
  /// none came since the last call. `skipped` is set to the number of older ones dropped. A report
  /// longer than the buffer is cut.
  std::size_t take_report(std::span<std::byte> buffer, std::uint32_t& skipped) noexcept;

  /// Returns the time when the next report can be read, ns; not before the present time.
  std::int64_t next_report_ns() const noexcept;

  /// Samples the encoders at the present time, for a board that sends only when asked; the report
  /// does not pass through the wire.
  BoardBytes sample_now() noexcept;

  /// Passes the host's bytes to the wire at the present time.
  void put_message(std::span<const std::byte> bytes) noexcept;

  /// Returns the hand. The caller that advances time may lead or hold it.
  Hand& hand() noexcept { return hand_; }

  /// Makes the hand take the tip (as at the beginning) or let go of it; without the hand only the
  /// arm's own mass and friction remain.
  void hold_tip(bool held) noexcept {
    held_ = held;
    mechanics().take_tip(tip_.dynamics(held));
  }

  /// Fixes a mass (kg, 0: none) to the tip and replaces an earlier one; gravity_B (m/s^2) acts on
  /// it. Fails if it is negative or not finite. Real-time: never from the servo thread.
  driver::Result<void> fix_mass(double mass, const Eigen::Vector3d& gravity_B);

  /// Restarts the board, like a reset of its microcontroller while it is plugged in. The motors are
  /// off until the next message, the counters restart from zero at the present pose, and frames in
  /// flight are lost.
  void restart_board() noexcept;

  /// Sets supply, temperature and encoder error that a board with the reference firmware measures.
  void set_board_health(const BoardHealth& health) noexcept { firmware_.set_health(health); }

  /// Presses the button on the arm, as a hand would.
  void press_button() noexcept { firmware_.press_button(); }

  /// Appends the memory that the arm uses in each tick, so that a caller with many arms can
  /// prefetch it. Real-time: never from the servo thread.
  void list_memory(std::vector<std::span<const std::byte>>& memory) const;

  // True state of the simulation, for tests and studies; a driver has no access to it.

  /// Returns the present time, ns.
  std::int64_t time_ns() const noexcept { return time_ns_; }
  /// Returns the mechanics.
  const Plant& plant() const noexcept {
    return std::visit([](const auto& plant) -> const Plant& { return plant; }, plant_);
  }
  /// Returns the board.
  const Firmware& firmware() const noexcept { return firmware_; }
  /// Returns the gimbal angles, rad, whether or not a gimbal is mounted.
  Eigen::Vector3d gimbal() const noexcept {
    return gimbal_.at(1e-9 * static_cast<double>(time_ns_));
  }
  /// Returns the point where the hand wants to be, m.
  const Eigen::Vector3d& p_BH() const noexcept { return plant().p_BH(); }
  /// Returns the number of reports and messages that the wire has lost (WireSettings::loss).
  std::uint64_t wire_losses() const noexcept { return losses_; }
  /// Returns the number of reports or messages lost because more than WireQueue::kFrames were in
  /// flight.
  std::uint64_t wire_overflows() const noexcept { return reports_.dropped() + messages_.dropped(); }

 private:
  using AnyPlant = std::variant<ArmPlant, LinkagePlant, SerialDriveTrainPlant,
                                LinkageDriveTrainPlant, LinkedSerialPlant, RubbingLinkagePlant,
                                BoardPlant, BoardDriveTrainPlant, RubbingBoardPlant>;

  SimulatedArm(const SimulatedArmSettings& settings, Hand hand, AnyPlant plant,
               const LoadedTip& tip, const Firmware& firmware, int motors, std::uint64_t seed);
  static driver::Result<SimulatedArm> make_by_inverse(const driver::ArmModel& model,
                                                      const SimulatedArmSettings& settings,
                                                      HandPath path, std::uint64_t seed);
  template <class MakePlant>
  static driver::Result<SimulatedArm> make_of(const driver::ArmModel& board,
                                              SimulatedArmSettings settings, HandPath path,
                                              std::uint64_t seed, const MakePlant& make_plant);
  Plant& mechanics() noexcept {
    return std::visit([](auto& plant) -> Plant& { return plant; }, plant_);
  }
  void sample_into(BoardBytes& report) noexcept;
  void sample() noexcept;
  void send(WireQueue& queue, std::span<const std::byte> bytes, std::int64_t delay_ns) noexcept;
  void receive(std::span<const std::byte> bytes) noexcept;
  void deliver() noexcept;

  std::int64_t report_period_ns_;
  WireSettings wire_;
  bool reports_at_once_, messages_at_once_;  // without delay, jitter and loss
  SplitMix wire_chance_, edge_chance_;
  Hand hand_;
  GimbalMotion gimbal_;
  AnyPlant plant_;
  LoadedTip tip_;
  Eigen::Vector3d free_B_;  // 1 for each axis along which the tip can move, else 0
  bool held_ = true;
  Firmware firmware_;
  std::int64_t time_ns_ = 0;
  std::int64_t next_sample_ns_ = 0;
  std::uint16_t number_ = 0;  // of the next report
  std::uint64_t losses_ = 0;
  WireQueue reports_, messages_;
  BoardBytes newest_{};         // newest report that the host can read
  std::uint32_t readable_ = 0;  // reports that became readable since one was last taken
};

}  // namespace thimble::device_sim
