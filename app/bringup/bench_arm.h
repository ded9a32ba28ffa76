#pragma once

#include <array>
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "bringup/loop_priority.h"
#include "heat_keeper.h"
#include "sleep_lock.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/tick_record.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::bringup {

/// One arm on the bench, real or simulated: for commands that try an arm out rather than touch
/// a scene with it. A simulated one runs on the virtual clock, with a hand that follows a path.
class BenchArm {
 public:
  /// Called in each tick; answers the requested force, N in the world.
  using Law = std::function<Eigen::Vector3d(const driver::DeviceState&)>;

  /// Opens a real arm, or, without one, a simulated arm of the file whose hand follows `hand_W`
  /// (seconds and points in the world, m). Forces stay below `force_max` (N) whatever the file
  /// allows. The loop of a real arm runs at real-time priority where the kernel grants it. `clock`
  /// is that of a simulated arm; empty: a VirtualClock. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<BenchArm>> open(
      const scene::ArmFile& file, const std::optional<driver::FoundArm>& real_arm,
      const std::filesystem::path& firmware,
      const std::vector<std::pair<double, Eigen::Vector3d>>& hand_W, double force_max,
      std::unique_ptr<driver::Clock> clock = nullptr);

  /// Opens an arm behind a link of the caller's, for which the file is what the driver believes, on
  /// the caller's clock. It counts as simulated; what is true of it is not known here.
  static driver::Result<std::unique_ptr<BenchArm>> open_link(const scene::ArmFile& file,
                                                             std::unique_ptr<driver::ArmLink> link,
                                                             std::unique_ptr<driver::Clock> clock,
                                                             double force_max);

  /// Runs the loop at 1 kHz for `duration` (s), until `stop` is set, or a fault; with `silent` it
  /// reads and sends nothing, so that the arm's watchdog can be seen. Answers false on a fault or a
  /// stop. A pose that cannot be is none as long as the device is idle: a check wants to see it.
  bool run(double duration, const Law& law, const std::atomic<bool>& stop, bool silent = false);

  /// Waits for `duration` (s) or until `stop` is set, and neither reads nor sends.
  void stay_silent(double duration, const std::atomic<bool>& stop);

  /// Sends zero force to an idle arm and reads it, `times` ticks: the only way to hear an arm that
  /// speaks when it is spoken to, after a silence.
  void ask(int times);

  /// Runs with zero force until `done` answers true or `stop` is set.
  bool hold(const std::function<bool()>& done, const std::atomic<bool>& stop);

  /// Waits for the reports of an idle arm as they come, for `duration` (s) or until `stop` is set:
  /// hands the time of each (s) to `heard`, and answers it by zero force.
  void listen(double duration, const std::function<void(double)>& heard,
              const std::atomic<bool>& stop);

  /// Hands each tick from now on to `sink`, after its force was sent; an empty one ends that.
  /// Silent ticks are left out.
  void watch(std::function<void(const driver::TickRecord&)> sink) { sink_ = std::move(sink); }

  driver::Device& device() { return *device_; }
  const driver::Device& device() const { return *device_; }
  driver::Fault fault() const { return device_->fault(); }
  /// Returns how long after the mean time of a report the ticks read it, s: 0 where all reports
  /// come at the same phase. The reports of a wire with jitter come late or early; so that each
  /// tick has one, ticks follow the latest of them.
  double read_late() const { return read_late_; }
  /// Returns how late the ticks of all loops began until now.
  const LateTicks& late() const { return late_; }
  /// Returns whether the arm is simulated.
  bool simulated() const { return !real_; }
  /// Returns the largest force that the motors made on the tip in any run, N: what was true of a
  /// simulated arm, whatever its driver believes; 0 for a real one.
  double true_force_max() const { return true_force_max_; }
  /// Returns the force that the motors make on the tip now, N: as `true_force_max`.
  double true_force() const { return simulation_ ? simulation_->f_T_W().norm() : 0; }
  /// Returns how much warmer than the room each winding of a simulated arm is, K: what is true,
  /// whatever its driver thinks; empty for a real one, and where the simulation has no heat.
  std::optional<Eigen::Vector3d> winding_rise() const {
    return simulation_ ? simulation_->winding_rise() : std::nullopt;
  }
  /// Returns the time, s.
  double now() const { return static_cast<double>(clock_->now_ns()) * 1e-9; }

 private:
  driver::Result<void> open_device(const scene::ArmFile& file,
                                   std::unique_ptr<driver::ArmLink> link, double force_max,
                                   const std::optional<driver::FoundArm>& real_arm);
  void align();
  std::int64_t first_due_ns() const;
  void tell(std::int64_t due_ns, std::int64_t now_ns, const Eigen::Vector3d& f_T_W);

  std::unique_ptr<scene::SleepLock> awake_;  // of a real arm
  std::unique_ptr<driver::Clock> clock_;
  std::unique_ptr<scene::ArmSimulation> simulation_;
  bool real_ = false;
  double true_force_max_ = 0;
  LateTicks late_;
  std::optional<std::int64_t> phase_ns_;                // a time at which a tick is due; empty: any
  double read_late_ = 0;                                // s
  std::unique_ptr<driver::CpuLatencyRequest> latency_;  // of a real arm
  std::function<void(const driver::TickRecord&)> sink_;
  std::uint64_t tick_ = 0;
  std::unique_ptr<driver::Device> device_;  // holds the wire to the simulation, so it goes first
  std::unique_ptr<scene::HeatKeeper> heat_keeper_;  // of a real arm whose file names its heat
};

}  // namespace thimble::bringup
