#include "scene_effects.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "energy_choice.h"
#include "real_arm.h"
#include "yaml_settings.h"

namespace thimble::app {
namespace {

/// Gives the groups of the table, each once, in its order.
std::vector<std::string_view> group_names() {
  std::vector<std::string_view> groups;
  for (const render::EffectKind& kind : render::effect_table()) {
    if (std::find(groups.begin(), groups.end(), kind.group) == groups.end()) {
      groups.push_back(kind.group);
    }
  }
  return groups;
}

/// Finds which effect an entry of the list names; nullptr if none, and notes why.
const render::EffectKind* named_effect(YamlMap& entry) {
  const render::EffectKind* found = nullptr;
  std::string known;
  for (const std::string_view group : group_names()) {
    known += (known.empty() ? "" : " or ") + std::string(group) + ": NAME";
    if (!entry.has(group)) continue;
    if (found != nullptr) {
      entry.reject(group, "stands beside another effect; begin a list entry of its own");
      return nullptr;
    }
    std::vector<const render::EffectKind*> kinds;
    std::vector<std::string_view> names;
    for (const render::EffectKind& kind : render::effect_table()) {
      if (kind.group != group) continue;
      kinds.push_back(&kind);
      names.push_back(kind.name);
    }
    found = kinds[entry.require_choice(group, names)];
  }
  if (found == nullptr) entry.reject("", "expected " + known);
  return found;
}

/// Is the longest step that one count makes at the tip, m: the largest column sum [STABILITY 9].
double tip_step(const ArmFile& arm, const Eigen::Matrix3d& J_BT) {
  if (arm.model.fractional_counts) return 0;
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double joint_step =
        2 * std::numbers::pi /
        (arm.model.encoders[k].counts_per_motor_turn * arm.model.drives[k].ratio);
    longest =
        std::max(longest, J_BT.col(static_cast<Eigen::Index>(k)).cwiseAbs().sum() * joint_step);
  }
  return longest;
}

/// Finds the longest step of one count over a serial arm's workspace: its corners, middles, centre.
double tip_step_over_workspace(const ArmFile& arm) {
  double longest = 0;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d share(i % 3 / 2.0, i / 3 % 3 / 2.0, i / 9 / 2.0);
    const Eigen::Vector3d p_W =
        arm.workspace.min_W + share.cwiseProduct(arm.workspace.max_W - arm.workspace.min_W);
    const auto q = arm.model.geometry.inverse(arm.R_WB.transpose() * (p_W - arm.p_WB));
    if (q) longest = std::max(longest, tip_step(arm, arm.model.geometry.jacobian(*q)));
  }
  return longest;
}

/// Finds the longest step of one count at the home pose of an arm that is no serial one; twice
/// that, for elsewhere in the workspace it is longer (Falcon: 0.016 to 0.057 mm, driver/README.md).
double tip_step_at_home(const ArmFile& arm) {
  using driver::ArmKind;
  const ArmKind kind = arm.protocol == ArmProtocol::kFalconPacket ? ArmKind::kFalcon
                       : arm.protocol == ArmProtocol::kWoody8Byte ? ArmKind::kWoody
                                                                  : ArmKind::kPolhem;
  const auto protocol = make_arm(arm, kind);
  driver::ArmReading home;
  for (std::size_t k = 0; k < 3; ++k) home.counts[k] = arm.model.encoders[k].home_counts;
  const Eigen::Vector3d p_BT = protocol->pose(home).p_BT;
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    driver::ArmReading next = home;
    ++next.counts[k];
    longest = std::max(longest, (protocol->pose(next).p_BT - p_BT).cwiseAbs().sum());
  }
  return 2 * longest;
}

}  // namespace

render::EffectSurroundings surroundings_of(const ArmFile& arm, double rate) {
  render::EffectSurroundings surroundings;
  surroundings.tick = 1 / rate;
  surroundings.delay = loop_delay(arm);
  surroundings.force_max = arm.limits.force_max;
  surroundings.tip_mass = arm.simulated.plant.mass;
  surroundings.tip_damping = arm.simulated.plant.viscous;
  surroundings.tip_coulomb = arm.simulated.plant.coulomb;
  surroundings.encoder_step =
      arm.shape == ArmShape::kSerial ? tip_step_over_workspace(arm) : tip_step_at_home(arm);
  return surroundings;
}

std::vector<render::EffectPlan> read_effects(YamlMap& object, const std::filesystem::path& folder,
                                             const render::EffectSurroundings& surroundings) {
  std::vector<render::EffectPlan> plans;
  for (YamlMap& entry : object.require_maps("effects")) {
    const render::EffectKind* kind = named_effect(entry);
    if (kind == nullptr) continue;
    YamlSettings settings(entry, folder);
    plans.push_back({kind, kind->read(settings, surroundings)});
    settings.finish();
  }
  std::stable_sort(plans.begin(), plans.end(),
                   [](const auto& a, const auto& b) { return a.kind->order < b.kind->order; });
  return plans;
}

render::FieldBuilder read_field(YamlMap& object, const std::filesystem::path& folder,
                                const render::EffectSurroundings& surroundings) {
  std::vector<std::string_view> names;
  for (const render::FieldKind& kind : render::field_table()) names.push_back(kind.name);
  const render::FieldKind& kind = render::field_table()[object.require_choice("field", names)];
  YamlSettings settings(object, folder);
  render::FieldBuilder build = kind.read(settings, surroundings);
  settings.finish();
  return build;
}

}  // namespace thimble::app
