#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
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

namespace thimble::driver {
struct DeviceSettings;
struct WireTable;
}  // namespace thimble::driver

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

/// How the home pose of an arm, in which its encoders are set to `home_counts`, is known.
enum class HomeMethod {
  kUnknown,   ///< The arm file does not state it.
  kStop,      ///< The links are pushed against a mechanical stop.
  kJig,       ///< A jig or a mark holds the links.
  kIndex,     ///< Index marks of the encoders.
  kAbsolute,  ///< Absolute encoders.
  kButton,    ///< The board sets its counters when its button is pressed.
};

/// Names of the methods in arm files, from kStop on.
inline constexpr std::array<std::string_view, 5> kHomeMethods{"stop", "jig", "index", "absolute",
                                                              "button"};

/// Home pose of an arm, and a second pose by which `thimble calibrate` checks it.
struct HomePose {
  HomeMethod how = HomeMethod::kUnknown;  ///< How the home pose is known.
  /// Position of the tip in the second pose, m, world; empty: no check.
  std::optional<Eigen::Vector3d> check_p_WT{};
  double within = 0.005;  ///< Largest distance from it, m.
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
  /// Wire of the protocol `described`; otherwise null.
  std::shared_ptr<const driver::WireTable> wire{};
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
  HomePose home{};                                     ///< How the home pose is known and checked.
  /// True if the file has a section `simulation`.
  bool can_simulate = false;
  device_sim::SimulatedArmSettings simulated;  ///< Contents of that section.

  /// Returns the number of motors, 1 to 3: the number of axes of the base along which the tip
  /// moves. Real-time: safe.
  int motors() const noexcept { return driver::motor_count(model.geometry); }
  /// Returns the point closest to p_W (m, world) to which the tip can be led: on the line or in the
  /// plane of an arm with one or two motors, else p_W itself. Real-time: safe.
  Eigen::Vector3d on_axes(const Eigen::Vector3d& p_W) const noexcept {
    if (motors() == 3) return p_W;
    const Eigen::Vector3d across = Eigen::Vector3d::Ones() - driver::free_axes(motors());
    Eigen::Vector3d p = p_W - R_WB * (R_WB.transpose() * (p_W - p_WB)).cwiseProduct(across);
    // Without a rounding error across the line or plane, so that the workspace contains the point.
    for (int axis = 0; axis < 3; ++axis) {
      if (workspace.min_W[axis] == workspace.max_W[axis]) p[axis] = workspace.min_W[axis];
    }
    return p;
  }

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

/// Returns the device settings of an arm file for a loop of `rate` (Hz): place, gate limits, energy
/// stage, motion watch, heat and workspace walls. `stage`, if set, replaces the arm's energy stage.
/// `driver::DeviceSettings` is in `thimble/driver/device.h`. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT driver::DeviceSettings device_settings(
    const ArmFile& arm, double rate, std::optional<driver::EnergyStage> stage = {});

}  // namespace thimble::scene
