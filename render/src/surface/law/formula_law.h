#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "surface/law/law_formula.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// A force by a formula of the scene, in addition to that of the surface's spring. A SurfaceStage.
///
/// The formula gives the size of the force (N) along one direction: the normal, the motion along
/// the surface, or an axis of the object. The total force never pulls the tip into the surface. A
/// value that is not finite gives no force in that tick.
class FormulaLaw {
 public:
  static constexpr std::string_view kGroup = "law";
  static constexpr std::string_view kName = "formula";
  static constexpr EffectOrder kOrder = EffectOrder::kTangential;  // after the spring
  static constexpr bool kFreeText = true;  // the value of `law` is the formula

  enum class Direction : std::uint8_t { kNormal, kSliding, kX, kY, kZ };

  struct Settings {
    std::string formula;
    Direction direction = Direction::kNormal;
    std::vector<LawParameter> parameters;

    /// Reads `law`, `direction` and `parameters`. A formula with a mistake is rejected, with its
    /// place. Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext& context);
  };

  /// Takes settings validated by Settings::read. Real-time: never from the servo thread.
  FormulaLaw(const Settings& settings, const EffectContext& context);

  /// See SurfaceStage. Real-time: safe.
  void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept;
  void leave() noexcept { time_ = 0; }

  /// Returns the largest stiffness that the formula adds along the normal, N/m, at rest.
  double spring_stiffness() const noexcept { return stiffness_; }

  /// Lists the parameters with a range. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings);

 private:
  double stiffness_at_rest() const;

  std::unique_ptr<LawFormula> formula_;
  std::vector<LawParameter> parameters_;
  Direction direction_;
  Eigen::Matrix3d R_WO_;
  Eigen::Vector3d p_WO_;
  double stiffness_ = 0;
  double time_ = 0;  // s since the contact began
};

}  // namespace thimble::render
