#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace thimble::render {

/// Bounds on the change of a force with a setting, N per unit of the setting: the sum of the
/// members times the quantity in their name.
struct ForceSensitivity {
  double per_depth = 0;      ///< Factor of the depth, m.
  double per_speed = 0;      ///< Factor of the speed of the tip, m/s.
  double per_force = 0;      ///< Factor of the object's force, N.
  double per_stiffness = 0;  ///< Factor of the stiffness of the object's surface, N/m.
  double always = 0;         ///< Constant term, N.
};

/// Setting of a force law that can be changed between two ticks. Its stage must outlive it.
struct LiveSetting {
  std::string name;         ///< Name in a scene with its group: "friction coefficient".
  std::string unit;         ///< SI unit.
  double min = 0, max = 0;  ///< Smallest and largest value.
  double value = 0;         ///< Value in the scene.
  /// Sensitivity of the force, which limits the speed of a change.
  ForceSensitivity sensitivity{};
  void* stage = nullptr;  ///< Stage that owns the setting.
  /// Sets the value, which must be within its bounds. Real-time: safe.
  void (*set)(void* stage, double value) noexcept = nullptr;
};

/// Collects the settings of an object's stages that can be changed during contact because nothing
/// else must be recomputed. A stage lists its settings in `list_settings(LiveSettings&)`, which is
/// optional. Real-time: never from the servo thread.
class LiveSettings {
 public:
  /// Constructs an empty list with the largest stiffness (N/m) and damping (N s/m) of a surface. A
  /// larger value that a scene already has is allowed too.
  LiveSettings(double stiffness_max, double damping_max)
      : stiffness_max_(stiffness_max), damping_max_(damping_max) {}

  /// Adds a setting of `stage`, which `Set(stage, value)` changes. Bounds that exclude the value
  /// are widened; a setting with a single possible value is omitted.
  template <auto Set, class Stage>
  void add(Stage& stage, LiveSetting setting) {
    static_assert(std::is_nothrow_invocable_v<decltype(Set), Stage&, double>);
    setting.min = std::min(setting.min, setting.value);
    setting.max = std::max(setting.max, setting.value);
    // Written so that NaN is omitted.
    if (!(setting.min < setting.max)) return;
    if (!group_.empty()) setting.name = group_ + ' ' + setting.name;
    setting.stage = &stage;
    setting.set = [](void* self, double value) noexcept { Set(*static_cast<Stage*>(self), value); };
    settings_.push_back(std::move(setting));
  }

  /// Sets the group of the settings that follow; empty: none.
  void set_group(std::string_view group) { group_ = group; }
  /// Adds the settings of another list.
  void take(const LiveSettings& other) {
    settings_.insert(settings_.end(), other.settings_.begin(), other.settings_.end());
  }

  /// Returns the largest stiffness, N/m.
  double stiffness_max() const { return stiffness_max_; }
  /// Returns the largest damping, N s/m.
  double damping_max() const { return damping_max_; }
  const std::vector<LiveSetting>& list() const { return settings_; }  ///< Returns the settings.

 private:
  double stiffness_max_, damping_max_;
  std::string group_;
  std::vector<LiveSetting> settings_;
};

/// Adds the settings of a stage, if it has any.
template <class Stage>
void list_settings_of(Stage& stage, LiveSettings& settings) {
  if constexpr (requires { stage.list_settings(settings); }) stage.list_settings(settings);
}

}  // namespace thimble::render
