#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <string_view>

#include "surface/friction/friction_settings.h"
#include "surface/friction/tangent_motion.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// A friction law: the response of one kind of friction to slip along the surface.
///
/// `pull` returns the friction force (N in W) along the surface, in the direction in which the tip
/// moved. The hand feels its opposite. `turn` carries the state along when the normal turns.
/// `forget` ends the contact. `coulomb` returns the coefficients, which may be changed between two
/// ticks. All Real-time: safe. `kName` is its name in scenes. `Settings` are its settings in
/// scenes, read by `Settings::read`; a law is constructed from them. If a tip that is held still
/// does not come to rest on a law, its constant `kRests` is false.
template <class Law>
concept FrictionLaw = std::constructible_from<Law, const typename Law::Settings&> &&
    std::default_initializable<typename Law::Settings> &&
    std::convertible_to<decltype(Law::kName), std::string_view> &&
    requires(Law law, const SlideTick& tick, const Turn& turn) {
  { law.pull(tick) }
  noexcept->std::same_as<Eigen::Vector3d>;
  { law.turn(turn) }
  noexcept->std::same_as<void>;
  { law.forget() }
  noexcept->std::same_as<void>;
  { law.coulomb() }
  noexcept->std::same_as<CoulombSettings&>;
} && requires(typename Law::Settings settings, SettingsReader& reader,
              const EffectContext& context) {
  settings.read(reader, context);
};

/// A friction on a surface: a SurfaceStage around a FrictionLaw.
///
/// It acts only along the surface, and only as far as the surface presses back. So it ends with the
/// contact, and leaving neither pulls nor sticks. It comes after the surface's spring and uses the
/// normal force from there, so it includes textures and damping. All positions and forces are in W;
/// values that are not finite give no friction. Real-time: safe.
template <FrictionLaw Law>
class FrictionStage {
 public:
  static constexpr std::string_view kGroup = "friction";
  static constexpr std::string_view kName = Law::kName;
  static constexpr EffectOrder kOrder = EffectOrder::kTangential;
  static constexpr bool kRests = [] {
    if constexpr (requires { Law::kRests; }) return Law::kRests;
    return true;
  }();
  using Settings = typename Law::Settings;  ///< Settings of the law.

  /// Takes settings validated by Settings::read. Real-time: never from the servo thread.
  FrictionStage(const Settings& settings, const EffectContext& context)
      : law_(settings), motion_(context.tick) {}

  void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept {
    SlideTick tick;
    Turn turn;
    if (!motion_.follow(state, response, tick, turn)) {
      law_.forget();
      return;
    }
    law_.turn(turn);
    const Eigen::Vector3d pull = law_.pull(tick);
    // Written so that NaN means no force.
    if (!(pull.squaredNorm() < HUGE_VAL)) {
      law_.forget();
      return;
    }
    response.f_T_W -= pull - pull.dot(tick.n_W) * tick.n_W;
  }

  void leave() noexcept {
    motion_.leave();
    law_.forget();
  }

  /// Lists the coefficient. The stiffness of the friction depends on arm and loop, and is fixed.
  /// Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings) {
    settings.add<[](FrictionStage& stage, double mu) noexcept {
      stage.law_.coulomb().set_sliding(mu);
    }>(*this, {.name = "coefficient",
               .unit = "",
               .min = kLiveCoefficientMin,
               .max = kLiveCoefficientMax,
               .value = law_.coulomb().sliding,
               .sensitivity = {.per_force = law_.coulomb().ratio()}});
  }

 private:
  // Range of the live coefficient: less is not felt, more does not occur [chosen].
  static constexpr double kLiveCoefficientMin = 0.01, kLiveCoefficientMax = 1.5;

  Law law_;
  TangentMotion motion_;
};

}  // namespace thimble::render
