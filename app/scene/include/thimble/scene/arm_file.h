#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/board.h"
#include "thimble/driver/energy_guard.h"
#include "thimble/driver/export.h"
#include "thimble/driver/heat_guard.h"
#include "thimble/driver/result.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::scene {

/// Where the tip may work: a box along the axes of the world, m.
struct WorkspaceBox {
  Eigen::Vector3d min_W{0, 0, 0};  ///< Lowest corner.
  Eigen::Vector3d max_W{0, 0, 0};  ///< Highest corner.

  /// Returns whether a point (W, m) is in it or on its sides. Real-time: safe.
  bool holds(const Eigen::Vector3d& p_W) const noexcept {
    return (p_W.array() >= min_W.array()).all() && (p_W.array() <= max_W.array()).all();
  }
  /// Returns its middle, m. Real-time: safe.
  Eigen::Vector3d middle() const noexcept { return (min_W + max_W) / 2; }
};

/// What an arm's maker or refitter declares of it; scenes that ask for more are told so.
struct DeclaredLimits {
  double force = 0;             ///< N
  double stiffness = 0;         ///< N/m
  double damping = 0;           ///< N s/m
  double continuous_force = 0;  ///< What the arm bears for as long as one likes, N; 0: not known.
};

/// What an arm file says of the gate's energy stage; what it leaves open follows from the arm.
struct EnergyChoice {
  driver::EnergyStage stage = driver::EnergyStage::kNone;  ///< Which stage the gate has.
  std::optional<double> mass{};                            ///< kg
  std::optional<double> allowance;                         ///< J
  std::optional<double> reservoir;                         ///< J
  std::optional<double> slope;                             ///< N/m
};

/// One arm, as its file describes it: geometry, motors, limits, place, and how it is simulated.
struct ArmFile {
  std::string name;         ///< For people.
  std::string description;  ///< One line; may be empty.
  /// What the simulated arm speaks, and the real one on the first of its boards.
  driver::ArmKind protocol = driver::ArmKind::kPolhem;
  /// The boards that this arm may have, with these signs and currents; never empty. A board of
  /// unknown kind is used with no other file than one that names it here.
  std::vector<driver::BoardKind> boards = {driver::BoardKind::kMbedHid14};
  int board_model = 0;        ///< What its board calls itself in text lines; 0: not known.
  driver::ArmModel model;     ///< Build, motors, encoders, and the gimbal if one is mounted.
  driver::GateLimits limits;  ///< Of the safety gate.
  std::map<std::string, int, std::less<>> gate_lines;  ///< Line of each key of the section `gate`.
  EnergyChoice energy;                                 ///< Of the safety gate.
  /// Longest time a force is held while no encoder counts, s; none: the driver's own.
  std::optional<double> hold_unchanged{};
  driver::HeatSettings heat{};  ///< What the motors carry for long; none: not known.
  DeclaredLimits declared;      ///< What its maker promises.
  /// What the motors carry of the arm's own weight at the tip in every run, N; 0: nothing.
  double carried_weight = 0;
  /// First moments of mass along links B and C of a serial arm that they carry as well, kg m.
  Eigen::Vector2d carried_moments{0, 0};
  double carried_most = 0;               ///< The most of all that over the workspace, N.
  double velocity_corner_frequency = 0;  ///< Hz
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of the base in the world.
  Eigen::Vector3d p_WB{0, 0, 0};                       ///< Position of the base, m.
  WorkspaceBox workspace;                              ///< Where the tip may work.
  bool can_simulate = false;                           ///< The file has a section `simulation`.
  device_sim::SimulatedArmSettings simulated;          ///< What that section says.

  /// Returns whether the arm is of one build: `file.is<driver::DeltaArm>()`. Real-time: safe.
  template <class Geometry>
  bool is() const noexcept {
    return std::holds_alternative<Geometry>(model.geometry);
  }
};

/// Reads the arm file that a person means: a name ("vintage_phantom") or a path, as
/// `find_arm_file` finds it; app/arms/vintage_phantom.yaml shows the form. The error lists the
/// names that are known, or tells up to five mistakes of the file, one per line, with file and
/// line; a limit of the gate that protects nobody is one: force_max above the declared force,
/// soft_start below 0.05 s, rise_max above 1e5 N/s, watchdog above 1 s, stall not below watchdog.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<ArmFile> load_arm(const std::filesystem::path& arm);

}  // namespace thimble::scene
