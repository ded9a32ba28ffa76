#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/arm.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

// Calibration: data that differs between arms of one kind. It consists of the zeros of the encoders
// and the signs of encoders and motors. Stored by the name of the arm (FoundArm::name) under
// $XDG_CONFIG_HOME/thimble/arms (or ~/.config/thimble/arms). Real-time: none of these functions may
// be called from the servo thread.

/// Calibration of one arm.
struct Calibration {
  std::array<std::int32_t, 3> home_counts{};  ///< Encoder counts in the home pose.
  std::array<int, 3> encoder_sign{1, 1, 1};   ///< Sign of each encoder, 1 or -1.
  std::array<int, 3> motor_sign{1, 1, 1};     ///< Sign of each motor, 1 or -1.
  /// Name of the installed arm file used for the calibration, which is the arm's file from then on.
  /// Empty: unknown.
  std::string arm_file{};

  /// Compares all members.
  friend bool operator==(const Calibration&, const Calibration&) = default;
};

/// Returns the path of the calibration of an arm. Characters that are not allowed in a file name
/// become '_'.
THIMBLE_EXPORT std::filesystem::path calibration_file(const std::string& name);

/// Returns the calibration of an arm; empty if it has none. Fails if the file is invalid, with its
/// line.
driver::Result<std::optional<Calibration>> load_calibration(const std::string& name);

/// Saves the calibration of an arm atomically.
THIMBLE_EXPORT driver::Result<void> save_calibration(const std::string& name,
                                                     const Calibration& calibration);

/// Applies a calibration to the contents of an arm file.
void apply(const Calibration& calibration, ArmFile& file);

/// Returns the distance that a user is asked to move the tip from its home pose along an axis of
/// the world, m: at most 5 cm, and within the workspace.
THIMBLE_EXPORT double calibration_move(const ArmFile& file, const Eigen::Vector3d& p_WHome,
                                       int axis);

/// Returns the calibration computed from the readings of the arm in its home pose, and after the
/// user moved the grip from there towards the body (x), to the right (y), and up (z). `axes`: axes
/// of the world of these motions, as many as the arm has motors; `moved` has a reading for each.
/// The directions of the motors relative to their encoders are those of the file; `thimble
/// feel-check` verifies them. Fails if the movements were too small (below 40 % of
/// `calibration_move`) or do not determine the signs.
THIMBLE_EXPORT driver::Result<Calibration> find_calibration(
    const ArmFile& file, driver::ArmKind kind, const driver::ArmReading& home,
    const std::array<driver::ArmReading, 3>& moved, const std::vector<int>& axes = {0, 1, 2});

/// Compares the position of the tip in the second pose (ArmFile::home) with that of the reading
/// `there`, made in it. Fails if they are farther apart than the file allows; succeeds for a file
/// without a second pose.
THIMBLE_EXPORT driver::Result<void> check_home(const ArmFile& file, driver::ArmKind kind,
                                               const Calibration& calibration,
                                               const driver::ArmReading& there);

}  // namespace thimble::scene
