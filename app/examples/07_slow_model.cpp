// Renders a simulation that is far too slow for the servo loop. A thread at 60 Hz publishes a local
// model of the force around the tip, which the servo loop evaluates 1000 times per second.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "thimble/driver/snapshot.h"
#include "thimble/render/multirate/local_model.h"
#include "thimble/render/multirate/model_touch.h"
#include "thimble/scene/simulated_device.h"

using thimble::driver::DeviceState;
using thimble::driver::Snapshot;
using thimble::driver::TickRecord;
namespace render = thimble::render;

/// Example of a slow model, such as a finite-element body: a pad whose stiffness grows with the
/// depth. One call takes 10 ms and computes the force at one point.
render::LocalModel simulate(const TickRecord& tick) {
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const Eigen::Vector3d p_WT = Eigen::Map<const Eigen::Vector3d>(tick.p_WT.data());
  const double depth = -p_WT.z();  // the top of the pad is at z = 0
  render::LocalModel model;
  model.time_ns = tick.time_ns;  // time of the state that it is computed for
  model.n_W = {0, 0, 1};
  model.damping = 0.5;  // N s/m
  double stiffness = 200;
  if (depth > 0) {
    model.p_WR = p_WT;
    model.f_T_W = {0, 0, 200 * depth + 5e4 * depth * depth};
    stiffness = 200 + 1e5 * depth;  // -df/dz
  } else {
    // The tip is free: return the surface that it would touch.
    model.p_WR = {p_WT.x(), p_WT.y(), 0};
  }
  model.stiffness(2, 2) = stiffness;
  return model;
}

int main() {
  auto opened = thimble::scene::SimulatedDevice::open(
      "vintage_phantom", {{0.0, {0, 0, 0.01}}, {0.6, {0, 0, -0.01}}, {2.0, {0, 0, -0.01}}});
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  thimble::scene::SimulatedDevice& arm = **opened;
  if (!arm.device().activate()) return 1;
  Snapshot<TickRecord> tip;  // state of the tip, written by the servo thread
  render::ModelSlot slot;    // latest local model, read by the servo thread
  // Stable with this arm, loop and hand: (b + B) / L = 3 N s/m / 1.5 ms, less a margin.
  auto made = render::ModelTouch::make(slot, {.stiffness_max = 1400});
  if (!made) {
    std::fprintf(stderr, "%s\n", made.error().message.c_str());
    return 1;
  }
  render::ModelTouch& touch = **made;

  std::atomic<bool> over{false};
  std::thread slow([&] {
    TickRecord tick;
    while (!over.load()) {
      if (tip.load(tick)) {
        if (auto published = slot.publish(simulate(tick)); !published) {
          std::fprintf(stderr, "%s\n", published.error().message.c_str());
        }
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(6));
    }
  });

  auto law = [&](const DeviceState& state) noexcept { return touch.update(state); };
  double force = 0, depth = 0;
  auto show = [&](const TickRecord& tick) noexcept {
    tip.store(tick);
    force = tick.f_sent_W[2];
    depth = -tick.p_WT[2];
    // Virtual time would run ahead of the other thread, unlike the time of a real arm, so it waits
    // here.
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  arm.run(2.0, law, show);
  over.store(true);
  slow.join();
  const double truth = 200 * depth + 5e4 * depth * depth;
  const std::string_view age = render::name(touch.age());
  std::printf("%d models in 2 s; %.2f N at %.2f mm, where the pad gives %.2f N (%.*s).\n",
              static_cast<int>(touch.counters().taken), force, depth * 1e3, truth,
              static_cast<int>(age.size()), age.data());
  return std::abs(force - truth) < 0.1 * truth ? 0 : 1;
}
