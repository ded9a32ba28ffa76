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

/// Workspace of the tip: a box aligned with the world axes, m.
struct WorkspaceBox {
  Eigen::Vector3d min_W{0, 0, 0};  ///< Minimum corner, m.
  Eigen::Vector3d max_W{0, 0, 0};  ///< Maximum corner, m.

  /// Returns whether a point (W, m) is inside or on the boundary. Real-time: safe.
  bool holds(const Eigen::Vector3d& p_W) const noexcept {
    return (p_W.array() >= min_W.array()).all() && (p_W.array() <= max_W.array()).all();
  }
  /// Returns the centre, m. Real-time: safe.
  Eigen::Vector3d middle() const noexcept { return (min_W + max_W) / 2; }
};

/// Limits declared by the manufacturer or refitter of an arm. A scene that exceeds them is
/// reported.
struct DeclaredLimits {
  double force = 0;      ///< Largest force, N.
  double stiffness = 0;  ///< Largest stiffness, N/m.
  double damping = 0;    ///< Largest damping, N s/m.
  /// Force that the arm can exert for an unlimited time, N; 0: unknown.
  double continuous_force = 0;
};

/// Energy stage of the gate, from an arm file. The members have the meanings of those in
/// driver::EnergyGuardSettings. Empty values are derived from the arm.
struct EnergyChoice {
  driver::EnergyStage stage = driver::EnergyStage::kNone;  ///< Energy stage.
  std::optional<double> mass{};                            ///< Mass, kg.
  std::optional<double> allowance;                         ///< Allowance, J.
  std::optional<double> reservoir;                         ///< Reservoir, J.
  std::optional<double> slope;                             ///< Slope of the bound, N/m.
};

/// Contents of an arm file: geometry, motors, limits, place and simulation.
struct ArmFile {
  std::string name;         ///< Name to display.
  std::string description;  ///< Description in one line; may be empty.
  /// Protocol of the simulated arm, and of the real arm on the first of `boards`.
  driver::ArmKind protocol = driver::ArmKind::kPolhem;
  /// Boards that this arm may have with the signs and currents of this file; never empty. A board
  /// of unknown kind can be used only with a file that lists it here.
  std::vector<driver::BoardKind> boards = {driver::BoardKind::kMbedHid14};
  /// Model number that the board reports in text lines; 0: unknown.
  int board_model = 0;
  /// Geometry, motors, encoders, and the gimbal if one is mounted.
  driver::ArmModel model;
  driver::GateLimits limits;  ///< Limits of the safety gate.
  /// Line number of each key of the section `gate`.
  std::map<std::string, int, std::less<>> gate_lines;
  EnergyChoice energy;  ///< Energy stage of the safety gate.
  /// Longest time a force is held while the encoder counts do not change, s; if empty, the driver's
  /// default.
  std::optional<double> hold_unchanged{};
  driver::HeatSettings heat{};  ///< Thermal limits of the motors, if known.
  DeclaredLimits declared;      ///< Limits declared by the manufacturer.
  /// Weight of the arm at the tip that the motors compensate in every run, N; 0: none.
  double carried_weight = 0;
  /// First moments of mass along links B and C of a serial arm, also compensated, kg m.
  Eigen::Vector2d carried_moments{0, 0};
  /// Largest compensation force over the workspace, N.
  double max_carried_force = 0;
  /// Corner frequency of the velocity estimate, Hz.
  double velocity_corner_frequency = 0;
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of the base in the world.
  Eigen::Vector3d p_WB{0, 0, 0};                       ///< Position of the base in the world, m.
  WorkspaceBox workspace;                              ///< Workspace of the tip.
  /// True if the file has a section `simulation`.
  bool can_simulate = false;
  device_sim::SimulatedArmSettings simulated;  ///< Contents of that section.

  /// Returns whether the arm has the given geometry: `file.is<driver::DeltaArm>()`. Real-time:
  /// safe.
  template <class Geometry>
  bool is() const noexcept {
    return std::holds_alternative<Geometry>(model.geometry);
  }
};

/// Reads an arm file, given by name ("vintage_phantom") or path (see `find_arm_file`).
/// app/arms/vintage_phantom.yaml is an example. The error lists the known names, or up to five
/// mistakes of the file, one per line, with file and line. A gate limit that gives no protection is
/// a mistake. Examples are force_max above the declared force, soft_start below 0.05 s, rise_max
/// above 1e5 N/s, watchdog above 1 s, and stall not below watchdog. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT driver::Result<ArmFile> load_arm(const std::filesystem::path& arm);

}  // namespace thimble::scene
