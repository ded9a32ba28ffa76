#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "thimble/device_sim/sim_transport.h"
#include "thimble/device_sim/simulated_arm.h"
#include "thimble/driver/arms/hfab/hfab_models.h"
#include "thimble/driver/arms/hfab/hfab_wire.h"
#include "thimble/driver/device.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"

/// Is a simulated vintage PHANTOM on your desk, with a hand that leads it along a way, and the
/// device that a program opens. The world's origin is where the tip is at home; x points to the
/// user, z up. app/arms/vintage_phantom.yaml has the sources of the numbers.
class DeskArm {
 public:
  /// Takes where the hand wants to be (m) at which time (s). Throws std::runtime_error with a
  /// sentence if the arm cannot be opened.
  explicit DeskArm(const std::vector<std::pair<double, Eigen::Vector3d>>& hand_W)
      : arm_(model(), settings(), way(hand_W)) {
    auto opened = thimble::driver::Device::open(
        std::make_unique<thimble::driver::WireLink>(
            std::make_unique<thimble::device_sim::SimTransport>(clock_, arm_),
            std::make_unique<thimble::driver::hfab::HfabArm>(model())),
        {.p_WB = -home(),
         .limits = {.force_max = 5,     // N
                    .speed_max = 3,     // m/s
                    .rise_max = 2000,   // N/s
                    .soft_start = 0.3,  // s
                    .stall_ns = 20'000'000,
                    .watchdog_ns = 100'000'000},
         .velocity_corner_frequency = 100},
        clock_.now_ns());
    if (!opened) throw std::runtime_error(opened.error().message);
    device_ = std::move(opened).value();
  }

  thimble::driver::Device& device() { return *device_; }

  /// Lets a force law act at 1 kHz for some seconds of virtual time; each tick is told to `sink`.
  template <class Law, class Sink>
  thimble::driver::ServoEnd run(double seconds, Law& law, Sink& sink) {
    const std::atomic<bool> stop{false};
    return thimble::driver::run_servo(
        *device_, clock_, thimble::driver::ForceLaw(law), thimble::driver::TickSink(sink),
        {.period_ns = 1'000'000, .ticks = static_cast<std::uint64_t>(1000 * seconds)}, stop);
  }

 private:
  static auto model() { return thimble::driver::hfab::vintage_model(); }
  static Eigen::Vector3d home() { return model().geometry.forward({0, std::numbers::pi / 2, 0}); }
  static thimble::device_sim::SimulatedArmSettings settings() {
    return {.plant = {.mass = 0.075, .viscous = 0.005, .coulomb = 0.04},
            .hand = {.mass = 0.025, .stiffness = 300, .damping = 3},
            .motors = {.current_max = 6},
            .firmware = {},
            .wire = {}};
  }
  static thimble::device_sim::HandPath way(
      const std::vector<std::pair<double, Eigen::Vector3d>>& hand_W) {
    std::vector<thimble::device_sim::HandPath::Point> points;
    points.reserve(hand_W.size());
    for (const auto& [time, p_WH] : hand_W) points.push_back({time, p_WH + home()});
    return thimble::device_sim::HandPath(points);
  }

  thimble::driver::VirtualClock clock_;
  thimble::device_sim::SimulatedArm arm_;
  std::unique_ptr<thimble::driver::Device> device_;  // holds the wire to the arm, so it goes first
};
