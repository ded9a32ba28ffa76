#pragma once

#include <array>
#include <cstdint>

#include "thimble/driver/fault.h"
#include "thimble/driver/tick_record.h"

namespace thimble::compat {

// What goes between a program that was written for another arm and `thimble exec`, as plain data.
// SI units. World: x to the user, y to the user's right, z up. Frames: W world, T tip.

/// How many arms a program may have open at once.
inline constexpr int kArmsMost = 4;

/// How an arm moves its tip.
enum class ArmBuild : std::uint8_t {
  kSerial,   ///< Links one behind the other (PHANTOM family).
  kLinkage,  ///< Links driven over a parallel linkage.
  kDelta,    ///< Three legs that meet at the tip (Falcon).
};

/// What an open arm is and bears: it does not change while it is open.
struct ArmFacts {
  std::array<char, 64> name{};            ///< Of its arm file; ends with a 0.
  std::array<char, 64> serial{};          ///< What the real arm is known by; "sim" and a number.
  ArmBuild build = ArmBuild::kSerial;     ///< Of its geometry.
  bool simulated = true;                  ///< No motor of an arm pulls.
  bool has_orientation = false;           ///< It tells how the stylus is turned.
  bool has_gimbal = false;                ///< The angles of the gimbal's axes are known.
  bool has_gripper = false;               ///< It tells how far a gripper is open.
  bool has_joints = false;                ///< Joint angles and Jacobian are the arm's.
  double rate = 1000;                     ///< Of the loop, Hz.
  double force_max = 0;                   ///< The gate's limit, N.
  double force_continuous = 0;            ///< What the arm bears for long, N; 0: not known.
  double stiffness_max = 0;               ///< What its maker declares, N/m.
  double damping_max = 0;                 ///< The same, N s/m.
  double speed_max = 0;                   ///< The gate's limit, m/s.
  std::int64_t stall_ns = 0;              ///< Gap after which the gate opens anew, ns.
  std::array<double, 3> workspace_min{};  ///< Lowest corner of the box where the tip may work, m.
  std::array<double, 3> workspace_max{};  ///< Highest corner, m.
};

/// What the gate did with a tick's force.
struct GateCuts {
  bool limited = false;       ///< Cut to the arm's largest force.
  bool rise_limited = false;  ///< Held back because it grew too fast.
  bool soft_started = false;  ///< Cut by the soft start.
  bool damped = false;        ///< Changed by the energy stage.
};

/// What is known of an arm after a tick.
struct ArmReading {
  std::uint64_t tick = 0;        ///< Number of the tick.
  std::int64_t time_ns = 0;      ///< When it began, on the clock of the run.
  std::array<double, 3> p_WT{};  ///< Tip, m.
  std::array<double, 3> v_WT{};  ///< Its velocity, m/s.
  std::array<double, 9> R_WT{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< Of the stylus, row by row.
  std::array<double, 3> w_WT{};          ///< Angular velocity of the stylus, rad/s.
  std::array<double, 3> q{};             ///< Joint angles, rad.
  std::array<double, 9> J_WT{};          ///< d p_WT / d q, m/rad, row by row; zeros: no joints.
  std::array<float, 3> gimbal{};         ///< Angles of the gimbal's axes, rad.
  float gripper = 0;                     ///< Opening, m.
  std::array<std::int32_t, 3> counts{};  ///< Of the encoders.
  std::uint16_t buttons = 0;             ///< One bit each; bit 0 is the arm's first.
  std::array<double, 3> f_client_W{};    ///< What the program asked for, as this tick took it, N.
  std::array<double, 3> f_asked_W{};     ///< That and the scene's force: what the gate got, N.
  std::array<double, 3> f_sent_W{};      ///< What the gate let through, N.
  std::array<double, 3> heat{};          ///< Of the motors; 1: the winding's limit.
  GateCuts cuts;                         ///< What the gate did in this tick.
  bool stalled = false;                  ///< The program's force is off: it was not renewed.
  driver::DeviceStage stage = driver::DeviceStage::kIdle;  ///< Of the arm.
  driver::Fault fault = driver::Fault::kNone;              ///< That keeps the force off.
  driver::LinkState link = driver::LinkState::kConnected;  ///< To the arm, whatever the fault is.
};

/// What a program asks of an arm.
struct ForceAsked {
  std::array<double, 3> f_W{};       ///< Force on the hand, N. Not finite: the gate's fault.
  std::array<double, 3> torque_W{};  ///< N m; taken, counted in the report, and not felt.
  double gripper = 0;                ///< N; the same.
};

}  // namespace thimble::compat
