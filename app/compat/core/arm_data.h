#pragma once

#include <array>
#include <cstdint>

#include "thimble/driver/fault.h"
#include "thimble/driver/tick_record.h"

namespace thimble::compat {

// Plain data exchanged between `thimble exec` and a program for another maker's arm. SI units.
// World: x to the user, y to the user's right, z up. Frames: W world, T tip.

/// Maximum number of arms that a program may have open.
inline constexpr int kArmsMax = 4;

/// Mechanism of an arm.
enum class ArmBuild : std::uint8_t {
  kSerial,   ///< Serial links (PHANTOM family).
  kLinkage,  ///< Links driven over a parallel linkage.
  kDelta,    ///< Three legs that meet at the tip (Falcon).
};

/// Properties and limits of an open arm. Constant while it is open.
struct ArmFacts {
  std::array<char, 64> name{};            ///< Name in its arm file; ends with a 0.
  std::array<char, 64> serial{};          ///< Name of the real arm; "sim" and its number.
  ArmBuild build = ArmBuild::kSerial;     ///< Mechanism.
  bool simulated = true;                  ///< No real motors.
  bool has_orientation = false;           ///< The arm reports the orientation of the stylus.
  bool has_gimbal = false;                ///< The angles of the gimbal's axes are known.
  bool has_gripper = false;               ///< The arm reports the opening of a gripper.
  bool has_joints = false;                ///< Joint angles and Jacobian are those of the arm.
  double rate = 1000;                     ///< Rate of the loop, Hz.
  double force_max = 0;                   ///< The gate's limit, N.
  double force_continuous = 0;            ///< Continuous force of the arm, N; 0: unknown.
  double stiffness_max = 0;               ///< Declared by its maker, N/m.
  double damping_max = 0;                 ///< Declared by its maker, N s/m.
  double speed_max = 0;                   ///< The gate's limit, m/s.
  double rise_max = 0;                    ///< The gate's limit of the force's change, N/s.
  std::int64_t stall_ns = 0;              ///< Pause after which the force rises slowly again, ns.
  std::array<double, 3> workspace_min{};  ///< Minimum corner of the workspace of the tip, m.
  std::array<double, 3> workspace_max{};  ///< Maximum corner, m.
};

/// Changes of a tick's force by the gate.
struct GateCuts {
  bool limited = false;       ///< Limited to the arm's maximum force.
  bool rise_limited = false;  ///< Limited in its rate of increase.
  bool soft_started = false;  ///< Reduced by the soft start.
  bool damped = false;        ///< Changed by the energy stage.
};

/// State of an arm after a tick.
struct ArmReading {
  std::uint64_t tick = 0;                                 ///< Number of the tick.
  std::int64_t time_ns = 0;                               ///< Its start, on the clock of the run.
  std::array<double, 3> p_WT{};                           ///< Tip, m.
  std::array<double, 3> v_WT{};                           ///< Its velocity, m/s.
  std::array<double, 9> R_WT{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< Stylus orientation, row by row.
  std::array<double, 3> w_WT{};          ///< Angular velocity of the stylus, rad/s.
  std::array<double, 3> q{};             ///< Joint angles, rad.
  std::array<double, 9> J_WT{};          ///< d p_WT / d q, m/rad, row by row; zeros: no joints.
  std::array<float, 3> gimbal{};         ///< Angles of the gimbal's axes, rad.
  float gripper = 0;                     ///< Opening, m.
  std::array<std::int32_t, 3> counts{};  ///< Encoder counts.
  std::uint16_t buttons = 0;             ///< One bit each; bit 0 is the arm's first.
  std::array<double, 3> f_client_W{};    ///< The program's force in this tick, N.
  std::array<double, 3> f_asked_W{};     ///< Program and scene: the gate's input, N.
  std::array<double, 3> f_sent_W{};      ///< The output of the gate, N.
  std::array<double, 3> heat{};          ///< Heat of the motors; 1: the winding's limit.
  GateCuts cuts;                         ///< Changes by the gate in this tick.
  bool stalled = false;                  ///< The program's force is off because it was not renewed.
  driver::DeviceStage stage = driver::DeviceStage::kIdle;  ///< Stage of the arm.
  driver::Fault fault = driver::Fault::kNone;              ///< The fault that keeps the force off.
  driver::LinkState link = driver::LinkState::kConnected;  ///< Link to the arm, even in a fault.
};

/// A program's request to an arm.
struct ForceRequest {
  std::array<double, 3> f_W{};       ///< Force on the hand, N. If not finite: a fault of the gate.
  std::array<double, 3> torque_W{};  ///< N m; counted in the report and otherwise ignored.
  double gripper = 0;                ///< Gripper force, N; likewise ignored.
};

}  // namespace thimble::compat
