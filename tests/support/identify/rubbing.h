#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/render/effect/effect_table.h"
#include "thimble/render/effect/map_settings.h"

namespace thimble::support {

using render::MapSettings;

/// Returns the PHANTOM-like arm at 1 kHz as the context of effects [PHYSICS 0].
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

/// Builds a friction of the table; returns null if its settings are invalid.
inline std::unique_ptr<render::AnyStage> make_friction(
    std::string_view name, MapSettings settings,
    const render::EffectContext& context = phantom_context()) {
  const render::EffectKind* kind = friction_kind(name);
  if (kind == nullptr) return nullptr;
  const render::StageBuilder build = kind->read(settings, context);
  if (!settings.mistakes().empty()) return nullptr;
  return build();
}

/// Returns the names of all friction models of the table.
inline std::vector<std::string> friction_names() {
  std::vector<std::string> names;
  for (const render::EffectKind& kind : render::effect_table()) {
    if (kind.group == "friction") names.emplace_back(kind.name);
  }
  return names;
}

/// Records the keys that an effect reads.
class NotedSettings final : public render::SettingsReader {
 public:
  bool has(std::string_view key) override {
    note(key);
    return false;
  }
  void number(std::string_view key, double&, const render::NumberLimits&) override { note(key); }
  void vector(std::string_view key, Eigen::Vector3d&, const render::NumberLimits&) override {
    note(key);
  }
  void choice(std::string_view key, std::size_t&, const std::vector<std::string_view>&) override {
    note(key);
  }
  void file(std::string_view key, std::filesystem::path&) override { note(key); }
  void list(std::string_view key, const std::function<void(SettingsReader&)>&) override {
    note(key);
  }
  void reject(std::string_view, const std::string&) override {}

  /// Returns whether a key was read.
  bool asked(std::string_view key) const { return keys_.contains(std::string(key)); }

 private:
  void note(std::string_view key) { keys_.emplace(key); }

  std::set<std::string> keys_;
};

/// Returns the names of all friction models of the table that have a setting.
inline std::vector<std::string> frictions_with(std::string_view setting) {
  std::vector<std::string> names;
  for (const std::string& name : friction_names()) {
    NotedSettings settings;
    friction_kind(name)->read(settings, phantom_context());
    if (settings.asked(setting)) names.push_back(name);
  }
  return names;
}

/// Returns the errors about the settings of a friction.
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

  /// Touches at a point (m); returns the friction force on the hand, N.
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

  /// The same along x; returns the force along x.
  double at_x(double x) { return at({x, 0, 0}).x(); }
};

}  // namespace thimble::support
