#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/render/effect/effect_table.h"
#include "thimble/render/effect/map_settings.h"

namespace thimble::support {

using render::MapSettings;

/// The PHANTOM-like arm at 1 kHz, as effects know it [PHYSICS 0].
inline render::EffectContext phantom_context() {
  render::EffectContext context;
  context.encoder_step = 3e-5;
  context.force_max = 8.5;
  context.tip_mass = 0.075;
  context.tip_damping = 0.005;
  context.tip_coulomb = 0.04;
  context.surface_stiffness = 1000;
  return context;
}

inline const render::EffectKind* friction_kind(std::string_view name) {
  for (const render::EffectKind& kind : render::effect_table()) {
    if (kind.group == "friction" && kind.name == name) return &kind;
  }
  return nullptr;
}

/// Builds a friction of the table; empty if its settings were refused.
inline std::unique_ptr<render::AnyStage> make_friction(
    std::string_view name, MapSettings settings,
    const render::EffectContext& context = phantom_context()) {
  const render::EffectKind* kind = friction_kind(name);
  if (kind == nullptr) return nullptr;
  const render::StageBuilder build = kind->read(settings, context);
  if (!settings.mistakes().empty()) return nullptr;
  return build();
}

/// Returns the names of all frictions of the table.
inline std::vector<std::string> friction_names() {
  std::vector<std::string> names;
  for (const render::EffectKind& kind : render::effect_table()) {
    if (kind.group == "friction") names.emplace_back(kind.name);
  }
  return names;
}

/// Returns the complaints about the settings of a friction.
inline std::vector<std::string> complaints_of(
    std::string_view name, MapSettings settings,
    const render::EffectContext& context = phantom_context()) {
  friction_kind(name)->read(settings, context);
  return settings.mistakes();
}

/// Moves a tip over a surface tick by tick.
struct Rubbing {
  render::AnyStage& friction;
  double dt = 0.001;
  Eigen::Vector3d n_W{0, 0, 1};
  double load = 1;       // N
  double depth = 0.001;  // m
  render::SurfaceResponse response{};

  /// Touches at a point (m) and gives the friction's force on the hand, N.
  Eigen::Vector3d at(const Eigen::Vector3d& p_WT) {
    driver::DeviceState state;
    state.dt = dt;
    state.p_WT = p_WT;
    response = {};
    response.contact = {
        .touching = true, .triangle = 0, .depth = depth, .n_W = n_W, .p_WP = p_WT + depth * n_W};
    response.f_T_W = load * n_W;
    friction.touch(state, response);
    return response.f_T_W - load * n_W;
  }

  /// The same along x; gives the force along x.
  double at_x(double x) { return at({x, 0, 0}).x(); }
};

}  // namespace thimble::support
