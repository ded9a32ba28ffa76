#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "compat/core/arm_access.h"
#include "compat/core/open_channel.h"
#include "compat/server/arm_server.h"
#include "support/scratch.h"
#include "thimble/driver/snapshot.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/session/session.h"

namespace thimble::compat {

/// Records the true force of the first arm's simulated motors in each tick, instead of the sent
/// force.
class MotorWatch final : public session::TickObserver {
 public:
  void take(const driver::TickRecord&) noexcept override {
    const auto* arm = arm_.load();
    if (arm == nullptr) return;
    const Eigen::Vector3d f_W = arm->f_T_W();
    force_.store({f_W.x(), f_W.y(), f_W.z()});
  }
  void look_at(const scene::ArmSimulation* arm) { arm_.store(arm); }
  Eigen::Vector3d force_W() const {
    std::array<double, 3> f{};
    force_.load(f);
    return {f[0], f[1], f[2]};
  }

 private:
  std::atomic<const scene::ArmSimulation*> arm_{nullptr};
  driver::Snapshot<std::array<double, 3>> force_;
};

/// Returns options of a rig whose ticks wait for the program, so that on a busy machine no force is
/// late. `arm`: name or file; empty: the vintage PHANTOM.
inline ExecOptions in_step(const char* arm = "") {
  ExecOptions options;
  options.arms = {{.arm_file = arm}};
  options.paced = true;
  return options;
}

/// `thimble exec` in this process: the server runs on its own thread, and its channel replaces the
/// one that the environment names.
class ExecRig {
 public:
  explicit ExecRig(ExecOptions options = {}) {
    // Recordings of faults must not leave the folder of the test.
    setenv("XDG_STATE_HOME", support::scratch_folder().c_str(), 1);
    options.program = "test";
    options.opened = [this](std::size_t arm, session::Session& session) {
      if (arm != 0) return;
      motors.look_at(session.simulation());
      EXPECT_TRUE(session.add_observer(motors));
    };
    auto made = ArmServer::make(options, stop_);
    if (!made) throw std::runtime_error(made.error().message);
    server_ = std::move(made).value();
    use_channel(&server_->channel(), server_->address());
    thread_ = std::thread([this] {
      while (!stop_.load()) server_->step(5'000'000);
    });
  }
  ~ExecRig() {
    for (int arm = 0; arm < kArmsMax; ++arm) {
      while (arms::close(arm)) {
      }
    }
    end();
    use_channel(nullptr);
  }

  /// Returns the shared memory of the server, and its file.
  Channel& channel() { return server_->channel(); }
  std::string address() const { return server_->address(); }

  /// Ends the server and returns its report.
  std::string end() {
    if (thread_.joinable()) {
      stop_.store(true);
      thread_.join();
      server_->end();
    }
    return server_->report();
  }
  /// Waits for `ticks` ticks of an arm.
  static void wait(int arm, int ticks) {
    ArmReading reading;
    arms::read(arm, reading);
    arms::wait_for_tick(arm, reading.tick + static_cast<std::uint64_t>(ticks) - 1);
  }

  MotorWatch motors;

 private:
  std::atomic<bool> stop_{false};
  std::unique_ptr<ArmServer> server_;
  std::thread thread_;
};

}  // namespace thimble::compat
