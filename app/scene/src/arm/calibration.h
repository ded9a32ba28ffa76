#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "thimble/driver/arm.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

// What differs from one arm to the next of its kind: where its encoders have their zero, and which
// way they and the motors count. Kept per name of the arm (FoundArm::name) under
// $XDG_CONFIG_HOME/thimble/arms (or ~/.config/thimble/arms). Real-time: never from the servo
// thread.

/// The calibration of one arm.
struct Calibration {
  std::array<std::int32_t, 3> home_counts{};  ///< What the encoders read in the home pose.
  std::array<int, 3> encoder_sign{1, 1, 1};   ///< 1 or -1 per axis.
  std::array<int, 3> motor_sign{1, 1, 1};     ///< 1 or -1 per axis.
  /// Name of the installed arm file that it was found with; it is the arm's from then on. Empty:
  /// not known.
  std::string arm_file{};

  /// Compares all of it.
  friend bool operator==(const Calibration&, const Calibration&) = default;
};

/// Returns the file that holds the calibration of an arm of this name. Signs that do not belong
/// into a file name become '_'.
THIMBLE_EXPORT std::filesystem::path calibration_file(const std::string& name);

/// Returns the calibration of an arm; empty if it has none. Fails on a file that is wrong, with
/// line.
driver::Result<std::optional<Calibration>> load_calibration(const std::string& name);

/// Keeps the calibration of an arm: written whole or not at all.
THIMBLE_EXPORT driver::Result<void> save_calibration(const std::string& name,
                                                     const Calibration& calibration);

/// Puts a calibration into an arm file's data.
void apply(const Calibration& calibration, ArmFile& file);

/// Returns the calibration found from what the arm reported in its home pose, and after the user
/// moved the grip from there towards him (x), to his right (y), and up (z). Motors keep the
/// direction that they have to their encoders in the file; `thimble feel-check` proves it. Fails if
/// the movements were too small (below 20 mm) or did not tell one set of signs from another.
THIMBLE_EXPORT driver::Result<Calibration> find_calibration(
    const ArmFile& file, driver::ArmKind kind, const driver::ArmReading& home,
    const std::array<driver::ArmReading, 3>& moved);

}  // namespace thimble::scene
