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

/// One real or simulated arm on the bench, for commands that test an arm without a scene. A
/// simulated arm runs on the virtual clock, with a hand that follows a path.
class BenchArm {
 public:
  /// Called in each tick; returns the requested force, N in the world.
  using Law = std::function<Eigen::Vector3d(const driver::DeviceState&)>;

  /// Opens a real arm or, without one, a simulated arm of the file whose hand follows `hand_W`
  /// (seconds and points in the world, m). Forces stay below `force_max` (N), whatever the file
  /// allows. The loop of a real arm runs at real-time priority if the kernel grants it. `clock` is
  /// for a simulated arm; empty: a VirtualClock. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<BenchArm>> open(
      const scene::ArmFile& file, const std::optional<driver::FoundArm>& real_arm,
      const std::filesystem::path& firmware,
      const std::vector<std::pair<double, Eigen::Vector3d>>& hand_W, double force_max,
      std::unique_ptr<driver::Clock> clock = nullptr);

  /// Opens an arm behind the caller's link, on the caller's clock. The file holds the constants
  /// that the driver assumes. The arm counts as simulated, but its true state is unknown here.
  static driver::Result<std::unique_ptr<BenchArm>> open_link(const scene::ArmFile& file,
                                                             std::unique_ptr<driver::ArmLink> link,
                                                             std::unique_ptr<driver::Clock> clock,
                                                             double force_max);

  /// Runs the loop at 1 kHz for `duration` (s), until `stop` is set, or until a fault. With
  /// `silent` it reads and sends nothing, so that the arm's watchdog can be observed. Returns false
  /// on a fault or a stop. An impossible pose is not a fault while the device is idle, so that a
  /// check can report it.
  bool run(double duration, const Law& law, const std::atomic<bool>& stop, bool silent = false);

  /// Waits for `duration` (s) or until `stop` is set, without reading or sending.
  void stay_silent(double duration, const std::atomic<bool>& stop);

  /// Sends zero force to an idle arm and reads it, for `times` ticks. After a silence this is the
  /// only way to read an arm that sends only when asked.
  void ask(int times);

  /// Runs with zero force until `done` returns true or `stop` is set.
  bool hold(const std::function<bool()>& done, const std::atomic<bool>& stop);

  /// Waits for each report of an idle arm, for `duration` (s) or until `stop` is set. Passes the
  /// time of each (s) to `heard`, and answers it with zero force.
  void listen(double duration, const std::function<void(double)>& heard,
              const std::atomic<bool>& stop);

  /// Passes each tick from now on to `sink`, after its force was sent; an empty function ends that.
  /// Silent ticks are omitted.
  void watch(std::function<void(const driver::TickRecord&)> sink) { sink_ = std::move(sink); }

  driver::Device& device() { return *device_; }
  const driver::Device& device() const { return *device_; }
  driver::Fault fault() const { return device_->fault(); }
  /// Returns the delay from the mean time of a report to the tick that reads it, s; 0 if all
  /// reports come at the same phase. With jitter, reports come late or early; the ticks follow the
  /// latest of them, so that each tick has one.
  double read_late() const { return read_late_; }
  /// Returns the lateness of the ticks of all loops so far.
  const LateTicks& late() const { return late_; }
  /// Returns whether the arm is simulated.
  bool simulated() const { return !real_; }
  /// Returns the largest force of the motors on the tip in any run, N. It is the true value of a
  /// simulated arm, whatever its driver assumes; 0 for a real one.
  double true_force_max() const { return true_force_max_; }
  /// Returns the present force of the motors on the tip, N; true value as in `true_force_max`.
  double true_force() const { return simulation_ ? simulation_->f_T_W().norm() : 0; }
  /// Returns the temperature of each winding of a simulated arm above the room, K: the true value,
  /// whatever its driver estimates. Empty for a real arm, and if the simulation has no heat.
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
  void report_tick(std::int64_t due_ns, std::int64_t now_ns, const Eigen::Vector3d& f_T_W);

  std::unique_ptr<scene::SleepLock> awake_;  // for a real arm
  std::unique_ptr<driver::Clock> clock_;
  std::unique_ptr<scene::ArmSimulation> simulation_;
  bool real_ = false;
  double true_force_max_ = 0;
  LateTicks late_;
  // Time at which a tick is due; empty: no alignment with reports.
  std::optional<std::int64_t> phase_ns_;
  double read_late_ = 0;                                // s
  std::unique_ptr<driver::CpuLatencyRequest> latency_;  // for a real arm
  std::function<void(const driver::TickRecord&)> sink_;
  std::uint64_t tick_ = 0;
  std::unique_ptr<driver::Device> device_;  // holds the wire to the simulation: destroyed first
  std::unique_ptr<scene::HeatKeeper> heat_keeper_;  // for a real arm whose file names its heat
};

}  // namespace thimble::bringup
