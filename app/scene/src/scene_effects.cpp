#include "scene_effects.h"

#include <algorithm>
#include <string>
#include <utility>

#include "energy_guard_settings.h"
#include "worst_direction.h"
#include "yaml/yaml_settings.h"

namespace thimble::scene {
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
      entry.refuse(group, "stands beside another effect; begin a list entry of its own");
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
  if (found == nullptr) entry.refuse("", "expected " + known);
  return found;
}

}  // namespace

render::EffectContext effect_context_of(const ArmFile& arm, double rate) {
  render::EffectContext context;
  context.tick = 1 / rate;
  context.delay = loop_delay(arm);
  context.force_max = arm.limits.force_max;
  context.tip_mass = arm.simulated.plant.mass;
  context.tip_damping = arm.simulated.plant.viscous;
  context.tip_coulomb = arm.simulated.plant.coulomb;
  context.encoder_step = worst_over_workspace(arm).encoder_step;
  return context;
}

std::vector<render::EffectPlan> read_effects(YamlMap& object, const std::filesystem::path& folder,
                                             const render::EffectContext& context) {
  std::vector<render::EffectPlan> plans;
  for (YamlMap& entry : object.require_maps("effects")) {
    const render::EffectKind* kind = named_effect(entry);
    if (kind == nullptr) continue;
    entry.set_place("effects[] " + std::string(kind->group) + ": " + std::string(kind->name));
    YamlSettings settings(entry, folder);
    plans.push_back({kind, kind->read(settings, context)});
    settings.finish();
  }
  std::stable_sort(plans.begin(), plans.end(),
                   [](const auto& a, const auto& b) { return a.kind->order < b.kind->order; });
  return plans;
}

render::FieldBuilder read_field(YamlMap& object, const std::filesystem::path& folder,
                                const render::EffectContext& context) {
  std::vector<std::string_view> names;
  for (const render::FieldKind& kind : render::field_table()) names.push_back(kind.name);
  const render::FieldKind& kind = render::field_table()[object.require_choice("field", names)];
  object.set_place("objects[] field: " + std::string(kind.name));
  YamlSettings settings(object, folder);
  render::FieldBuilder build = kind.read(settings, context);
  settings.finish();
  return build;
}

}  // namespace thimble::scene
