#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// Kind of a joint.
enum class JointKind : std::uint8_t {
  kHinge,   ///< Turns about one axis.
  kSlider,  ///< Moves along one axis.
  kBall,    ///< Turns about a point.
  kFixed,   ///< Does not move.
  kSpring,  ///< A spring and a damper between two points.
};

/// A joint between two objects, or an object and the world. Places are those of the first tick.
struct THIMBLE_EXPORT JointChoice {
  JointKind kind = JointKind::kHinge;  ///< Kind.
  Eigen::Vector3d p_W{0, 0, 0};        ///< Place of the joint; end of a spring on `a`, m.
  Eigen::Vector3d axis_W{0, 0, 1};     ///< Axis of a hinge or slider; not zero.
  /// Limits of the travel: rad for a hinge, m for a slider. The first place is 0; the travel of `a`
  /// relative to `b` along or about the axis.
  std::optional<Eigen::Vector2d> limits{};
  double friction = 0;               ///< Dry friction, N or N m, >= 0.
  std::optional<double> speed{};     ///< Speed of a motor, m/s or rad/s.
  double motor_max = 1;              ///< Largest force (N) or torque (N m) of the motor, > 0.
  Eigen::Vector3d p_end_W{0, 0, 0};  ///< End of a spring on `b`, m.
  double stiffness = 100;            ///< Of a spring, N/m, > 0.
  double damping = 0;                ///< Of a spring, N s/m, >= 0.
  std::optional<double> length{};    ///< Of a spring at rest, m; empty: its first length.

  /// Reads the settings from a scene. Real-time: never from the servo thread.
  void read(SettingsReader& reader);

 private:
  void read_travel(SettingsReader& reader);
};

}  // namespace thimble::render
