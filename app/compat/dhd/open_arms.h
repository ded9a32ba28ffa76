#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "compat/core/arm_access.h"
#include "compat/dhd/regulator.h"

namespace thimble::compat::dhd {

/// Name of these libraries for the report.
inline constexpr const char* kApi = "DHD";

/// State of an arm's force: on, off, or never set by the program.
enum class ForceSwitch : std::uint8_t {
  kUnset,  ///< Never set by the program: its first force enables it.
  kOn,     ///< The force is on.
  kOff,    ///< The program or its watchdog switched it off: dhdEnableForce switches it on.
};

/// Causes of a force that is off, as dhdGetStatus returns them.
enum ForceOffCause : int {
  kForceOn = 0,
  kOffByVelocity = 2,
  kOffByWatchdog = 3,
  kOffBySoftware = 4,
  kOffByPull = 5,
};

/// Motions with bounds that are only stored: of wrist, gripper and single encoders.
enum class StoredMotion : std::uint8_t {
  kRotMove,
  kRotTrack,
  kGripMove,
  kGripTrack,
  kEncMove,
  kEncTrack
};
inline constexpr std::size_t kStoredMotions = 6;  ///< Number of those.

/// An arm that a program opened, with the program's settings. Any thread may read and set its
/// numbers.
struct OpenArm {
  int number = 0;                                       ///< Number of the arm in `arms`.
  std::atomic<bool> open{false};                        ///< Between dhdOpen and dhdClose.
  std::atomic<ForceSwitch> force{ForceSwitch::kUnset};  ///< State of its force.
  std::atomic<int> off_cause{kOffBySoftware};           ///< While `force` is kOff.
  std::atomic<bool> force_sent{false};          ///< A force was requested since it was enabled.
  std::atomic<bool> gravity{false};             ///< Stored and returned; see README.md.
  std::atomic<bool> brakes{true};               ///< As above.
  std::atomic<bool> emulate_button{false};      ///< A closed gripper is button 0.
  std::atomic<double> effector_mass{0};         ///< kg
  std::atomic<double> device_angle{0};          ///< rad
  std::atomic<double> base_angle_x{0};          ///< rad
  std::atomic<double> base_angle_z{0};          ///< rad
  std::atomic<double> max_force{-1};            ///< N; below zero: the gate's
  std::atomic<unsigned> velocity_threshold{0};  ///< m/s; 0: the gate's
  std::atomic<unsigned char> watchdog{0};       ///< 125 us; 0: the gate's
  std::atomic<double> vibration_frequency{0};   ///< Hz
  std::atomic<double> vibration_amplitude{0};   ///< N
  std::atomic<std::uint64_t> forces{0};         ///< Number of forces sent.
  std::mutex gap_mutex;                         ///< For the three below.
  double gap_time = 0, gap = 0, gap_speed = 0;  ///< s, m, m/s: last state of the gripper.
  std::uint64_t counted_forces = 0;             ///< Value of `forces` at the last dhdGetComFreq.
  std::int64_t counted_ns = 0;                  ///< Time of that call.
  /// The regulation runs because of drdAutoInit: a program's force ends it.
  std::atomic<bool> init_started{false};
  Regulator regulator;      ///< For the functions drd...
  std::mutex stored_mutex;  ///< For the array below.
  /// Bounds of motions that our arms cannot make; only stored and returned.
  std::array<PathBounds, kStoredMotions> stored_bounds{};
  std::atomic<double> stored_integral_gain{0};  ///< As above: regulation has no integral part.
};

/// Returns an open arm. If `id` names none, returns null and records an error.
OpenArm* open_arm(const char* function, char id) noexcept;
/// Opens an arm of `thimble exec`; returns its number, or -1.
int open_number(const char* function, int number) noexcept;
/// Closes an arm; returns 0 or -1.
int close_arm(const char* function, char id) noexcept;
/// Makes an open arm the default arm, which the id -1 means; returns 0 or -1.
int choose_arm(const char* function, char id) noexcept;
/// Returns the number of the default arm, or -1.
int chosen_arm() noexcept;

/// Reads the newest tick of an arm. If there is none, returns false and records an error.
bool read_arm(const char* function, const OpenArm& arm, ArmReading& reading) noexcept;

/// Returns the rotation from the world to the program's frame (U), from its base angles.
Eigen::Matrix3d user_rotation(const OpenArm& arm) noexcept;
/// Returns a vector of a reading.
inline Eigen::Map<const Eigen::Vector3d> vector_of(const std::array<double, 3>& v) noexcept {
  return Eigen::Map<const Eigen::Vector3d>(v.data());
}
/// Returns a matrix of a reading, which is stored row by row.
inline Eigen::Matrix3d matrix_of(const std::array<double, 9>& rows) noexcept {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

/// Returns whether dhdEnableExpertMode was called.
bool expert_mode() noexcept;

/// Enables the force of an arm if it was never set. False: it stays off.
bool enable_force_if_unset(OpenArm& arm) noexcept;
/// Switches the force of an arm off, for this cause.
void switch_off(OpenArm& arm, ForceOffCause cause) noexcept;

}  // namespace thimble::compat::dhd
