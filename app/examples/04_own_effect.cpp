// Adds your own effect to a surface: one class with `touch` and `leave`.
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/scene/simulated_device.h"

using thimble::driver::DeviceState;
using thimble::driver::TickRecord;
namespace render = thimble::render;

/// Vibration under the finger: the depth oscillates in time, also while the hand is at rest.
class Hum {
 public:
  static constexpr std::string_view kGroup = "texture";
  static constexpr std::string_view kName = "hum";
  static constexpr render::EffectOrder kOrder = render::EffectOrder::kDepth;

  struct Settings {
    double amplitude = 2e-4;  // m
    double frequency = 100;   // Hz
    void read(render::SettingsReader& reader, const render::EffectContext&) {
      reader.number("amplitude", amplitude, {.unit = "m", .min = 0, .max = 0.001});
      reader.number("frequency", frequency, {.unit = "Hz", .min = 1, .max = 400});
    }
  };
  Hum(const Settings& settings, const render::EffectContext&) : settings_(settings) {}

  // Called in every tick of contact, before the surface's spring, which uses the resulting depth.
  void touch(const DeviceState& state, render::SurfaceResponse& response) noexcept {
    time_ += state.dt;
    const double phase = 2 * std::numbers::pi * settings_.frequency * time_;
    response.contact.depth += settings_.amplitude * std::sin(phase);
  }
  void leave() noexcept { time_ = 0; }

 private:
  Settings settings_;
  double time_ = 0;  // s since contact began
};

int main() {
  auto mesh = render::load_mesh(THIMBLE_SCENES "/clay_ball.off");
  if (!mesh) {
    std::fprintf(stderr, "%s\n", mesh.error().message.c_str());
    return 1;
  }
  for (Eigen::Vector3d& p : mesh->vertices) p.z() -= 0.03;  // moves its top to the origin
  static constexpr render::EffectKind kHum = render::effect_kind<Hum>();
  const render::EffectPlan hum{&kHum, []() -> std::unique_ptr<render::AnyStage> {
                                 return std::make_unique<render::AnyStageOf<Hum>>(Hum({}, {}));
                               }};
  auto object = render::build_object_touch(
      *mesh, {}, {.spring = {.stiffness = 800, .damping = 1}, .effects = {hum}});
  if (!object) {
    std::fprintf(stderr, "%s\n", object.error().message.c_str());
    return 1;
  }
  auto opened = thimble::scene::SimulatedDevice::open(
      "vintage_phantom", {{0.0, {0, 0, 0.01}}, {0.3, {0, 0, -0.004}}, {1.0, {0, 0, -0.004}}});
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  thimble::scene::SimulatedDevice& arm = **opened;
  if (!arm.device().activate()) return 1;
  auto law = [&](const DeviceState& state) noexcept { return (*object)->update(state); };
  double min_force = 1e9, max_force = 0;
  auto watch = [&](const TickRecord& tick) noexcept {
    if (tick.tick < 800) return;  // from then on the hand is at rest
    min_force = std::min(min_force, tick.f_sent_W[2]);
    max_force = std::max(max_force, tick.f_sent_W[2]);
  };
  arm.run(1.0, law, watch);
  std::printf("The hand is at rest, and the force oscillates between %.2f and %.2f N.\n", min_force,
              max_force);
  return max_force - min_force > 0.1 ? 0 : 1;
}
