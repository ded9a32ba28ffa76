#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace thimble::render {

/// Bounds by how much a force changes with a setting: the sum of these times what they are named
/// after, N per unit of the setting.
struct ForceSensitivity {
  double per_depth = 0;      ///< Times the depth, m.
  double per_speed = 0;      ///< Times the speed of the tip, m/s.
  double per_force = 0;      ///< Times the object's force, N.
  double per_stiffness = 0;  ///< Times the stiffness of the object's surface, N/m.
  double always = 0;         ///< N
};

/// One setting of a force law that can be changed between two ticks. The stage that it belongs
/// to must outlive it.
struct LiveSetting {
  std::string name;            ///< As a scene names it, with its group: "friction coefficient".
  std::string unit;            ///< SI.
  double least = 0, most = 0;  ///< Its bounds.
  double value = 0;            ///< As the scene has it.
  ForceSensitivity
      sensitivity{};      ///< How fast it may be turned while it is felt follows from that.
  void* stage = nullptr;  ///< Whose it is.
  /// Sets the value, which must be within its bounds. Real-time: safe.
  void (*set)(void* stage, double value) noexcept = nullptr;
};

/// Collects the settings of an object's stages that can be changed while they are felt: those that
/// need nothing computed anew. A stage tells of its own by `list_settings(LiveSettings&)`; one that
/// has none need not say so. Real-time: never from the servo thread.
class LiveSettings {
 public:
  /// Takes how stiff and how damped a surface may be made (N/m, N s/m); what a scene has is
  /// allowed as well.
  LiveSettings(double stiffness_max, double damping_max)
      : stiffness_max_(stiffness_max), damping_max_(damping_max) {}

  /// Adds a setting of `stage`, which `Set(stage, value)` changes; bounds that do not hold its
  /// value are widened, and one that cannot be changed at all is left out.
  template <auto Set, class Stage>
  void add(Stage& stage, LiveSetting setting) {
    static_assert(std::is_nothrow_invocable_v<decltype(Set), Stage&, double>);
    setting.least = std::min(setting.least, setting.value);
    setting.most = std::max(setting.most, setting.value);
    // Written so that NaN is left out.
    if (!(setting.least < setting.most)) return;
    if (!group_.empty()) setting.name = group_ + ' ' + setting.name;
    setting.stage = &stage;
    setting.set = [](void* self, double value) noexcept { Set(*static_cast<Stage*>(self), value); };
    settings_.push_back(std::move(setting));
  }

  /// Names the group of the settings that follow; empty: none.
  void set_group(std::string_view group) { group_ = group; }
  /// Adds what another list has.
  void take(const LiveSettings& other) {
    settings_.insert(settings_.end(), other.settings_.begin(), other.settings_.end());
  }

  double stiffness_max() const { return stiffness_max_; }             ///< N/m.
  double damping_max() const { return damping_max_; }                 ///< N s/m.
  const std::vector<LiveSetting>& list() const { return settings_; }  ///< Lists them.

 private:
  double stiffness_max_, damping_max_;
  std::string group_;
  std::vector<LiveSetting> settings_;
};

/// Lets a stage tell of its settings, if it has any to tell of.
template <class Stage>
void list_settings_of(Stage& stage, LiveSettings& settings) {
  if constexpr (requires { stage.list_settings(settings); }) stage.list_settings(settings);
}

}  // namespace thimble::render
