#include "hil/friction_at_rest.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "bringup/hold_place.h"
#include "bringup/push_direction.h"
#include "object_sections.h"
#include "stability/friction_rig.h"
#include "stability/rest_trial.h"
#include "stability/signal.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/effect/map_settings.h"

namespace thimble::hil {
namespace {

using Eigen::Vector3d;

constexpr const char* kName = "friction_at_rest";
constexpr double kRate = 1000;        // Hz, of BenchArm
constexpr double kCorner = 50;        // Hz [PHYSICS 2.5]
constexpr double kLoad = 0.5;         // N, of the surface; not sent
constexpr double kDepth = 0.001;      // m, below a friction's fade [chosen]
constexpr double kCoefficient = 0.5;  // [PHYSICS 2.2]
constexpr double kWay = 0.02;         // m, motion of the leading spring's end
constexpr double kRubbed = 1.0;       // s
constexpr double kSettled = 1.0;      // s after the stop
constexpr double kListened = 1.0;     // s

std::unique_ptr<render::AnyStage> default_friction(const scene::ArmFile& file) {
  const auto table = render::effect_table();
  const auto kind = std::find_if(table.begin(), table.end(), [](const render::EffectKind& one) {
    return one.group == "friction" && one.name == "bristle";
  });
  render::MapSettings settings({{"coefficient", kCoefficient}}, {});
  return kind->read(settings, scene::effect_context_of(file, kRate))();
}

}  // namespace

HilResult check_friction_at_rest(const HilRig& rig) {
  if (rig.file.motors() == 1) {
    return skipped(
        kName, "The tip of an arm with one motor moves on a line, so it has no surface to rub.");
  }
  // Along x with three motors: the surface's normal is z, and rubbing needs one axis only.
  const Vector3d direction_W =
      rig.file.motors() == 3 ? Vector3d(Vector3d::UnitX()) : bringup::push_direction(rig.file);
  auto opened = open_active(rig, TipHold::kFree);
  if (!opened) return broken_off(kName, opened.error().message, nullptr);
  bringup::BenchArm& bench = **opened;
  const auto friction = default_friction(rig.file);
  stability::EvenSurface surface(*friction, kLoad, kDepth);
  const Vector3d p_start_W = bench.device().state().p_WT;
  bringup::HoldPlace lead(p_start_W);
  const double begin = bench.now();
  std::vector<double> sent, x;
  double slid = 0;
  const auto law = [&](const driver::DeviceState& state) -> Vector3d {
    const double time = bench.now() - begin;
    lead.go_to(p_start_W + kWay * std::min(1.0, time / kRubbed) * direction_W);
    slid = std::max(slid, (state.p_WT - p_start_W).norm());
    sent.push_back(direction_W.dot(bench.device().f_sent_W()));
    x.push_back(direction_W.dot(state.p_WT));
    // The hand holds the surface's force, so that only friction is requested.
    Vector3d f_W = surface(state).f_T_W;
    f_W += lead.force(1 / kRate, state.p_WT, state.v_WT);
    const double length = f_W.norm();
    return length > 0.95 * kHilForceMax ? Vector3d(f_W * (0.95 * kHilForceMax / length)) : f_W;
  };
  if (!bench.run(kRubbed + kSettled + kListened, law, rig.stop)) {
    return broken_off(kName, "", &bench);
  }
  bench.device().deactivate();
  const auto listened = static_cast<std::size_t>(kListened * kRate);
  const std::vector<double> fast = stability::high_passed(sent, kRate, kCorner);
  const double loud = stability::root_mean_square(std::span(fast).last(listened));
  const auto [lowest, highest] =
      std::minmax_element(x.end() - static_cast<long>(listened), x.end());
  const double moved = *highest - *lowest;
  return judged(
      kName,
      fmt::format("After {:.1f} mm of sliding and a stop, the force above {:g} Hz is {:.2f} mN RMS "
                  "(perceptible from {:g} mN), and the tip moves by {:.0f} um.",
                  1e3 * slid, kCorner, 1e3 * loud, 1e3 * stability::kRestFelt, 1e6 * moved),
      {{"rubbed_way", 1e3 * slid, "mm", "> 1", ""},
       {"force_above_50_hz", 1e3 * loud, "mN RMS",
        fmt::format("< {:g}", 1e3 * stability::kRestFelt), ""},
       {"tip_at_rest", 1e6 * moved, "um", "< 200", ""}});
}

}  // namespace thimble::hil
