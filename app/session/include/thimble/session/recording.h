#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"

namespace thimble::session {

// Recordings as plain data. How they lie in the file (HDF5, one data set per column): the columns
// below, and app/guide. Real-time: never from the servo thread, all of it.

/// What a recording is of: enough to run the same again.
struct RecordingInfo {
  std::string scene;       ///< Its name.
  std::string scene_file;  ///< Where it was read from.
  std::string scene_text;  ///< The file's text.
  std::string arm;         ///< Its name.
  std::string arm_file;    ///< Where its description was read from.
  std::string arm_text;    ///< The file's text.
  std::string device;      ///< "sim", or the name of the arm on the desk.
  std::string clock;       ///< "virtual" or "wall".
  std::string program;     ///< Version, revision, build type and compiler.
  double rate = 0;         ///< Hz
  std::uint64_t seed = 0;  ///< Of everything random in the simulation.
  /// What the scene calls the arm, where it has several; each has a recording of its own.
  std::string arm_in_scene{};
  /// Names of the objects that the tip of a simulated arm starts in, a comma between two.
  std::string inside_at_start{};
  /// What else was asked for that changes the result, a line each ("quality: draft"); empty if
  /// nothing was.
  std::string options{};
};

/// Returns where the recording of one of several arms lies that is asked for as `path`: beside it,
/// with the arm's name (touch_left.h5); of a single arm, which has no name, `path` itself.
THIMBLE_EXPORT std::filesystem::path file_of_arm(const std::filesystem::path& path,
                                                 const std::string& arm_in_scene);

/// A recording in memory.
struct Recording {
  RecordingInfo info;                     ///< What it is of.
  std::vector<driver::TickRecord> ticks;  ///< Every tick, oldest first.
  /// False if it was cut off, or lacks ticks: after a crash, a full disk, or its longest time.
  bool complete = false;
};

/// One column of a recording: one number or some of each tick.
struct THIMBLE_EXPORT RecordingColumn {
  /// What a number is in the file: unsigned, signed or floating, and its bits.
  enum class Type : std::uint8_t { kU8, kU16, kI16, kI32, kI64, kU64, kF32, kF64 };

  const char* name;    ///< Of the data set in the file.
  const char* unit;    ///< SI; "1" for numbers and flags.
  const char* about;   ///< What it is, with its frame.
  Type type;           ///< Of each number.
  std::size_t width;   ///< Numbers per tick: 1, 3, or 4 of a quaternion.
  std::size_t offset;  ///< Of the first in driver::TickRecord, bytes.
  bool later = false;  ///< Older recordings do not have it; there its numbers are 0.

  /// Returns whether its three numbers belong to joints, motors or the gimbal's axes, in the arm's
  /// order; otherwise three numbers are x, y and z of a vector.
  bool by_axis() const noexcept;

  /// Returns the bytes of one number.
  std::size_t element() const noexcept;
  /// Returns the bytes per tick.
  std::size_t bytes() const noexcept { return element() * width; }
};

/// Returns all columns: every field of driver::TickRecord is in one.
THIMBLE_EXPORT std::span<const RecordingColumn> recording_columns() noexcept;

/// Reads a recording, complete or cut off. The error says what the file is not, or which part of it
/// makes no sense.
THIMBLE_EXPORT driver::Result<Recording> read_recording(const std::filesystem::path& path);

/// Writes a whole recording at once, as complete. `overwrite`: an existing recording of that name
/// is replaced; a file of another kind never is. The error says what cannot be written.
THIMBLE_EXPORT driver::Result<void> write_recording(const std::filesystem::path& path,
                                                    const RecordingInfo& info,
                                                    std::span<const driver::TickRecord> ticks,
                                                    bool overwrite = false);

/// Writes a recording as a table: a line that names the columns with their units
/// ("p_WT.x [m]"), then one per tick, numbers so that they read back to the bit.
THIMBLE_EXPORT driver::Result<void> write_csv(const Recording& recording,
                                              const std::filesystem::path& path);

/// How the forces of a replayed run compare with the recorded ones: what the scene asked of the
/// arm, tick by tick.
struct ReplayComparison {
  std::uint64_t ticks = 0;             ///< That were compared.
  std::uint64_t differing = 0;         ///< Ticks whose force is not the same to the bit.
  std::optional<std::uint64_t> first;  ///< Number of the first of them.
  double largest = 0;                  ///< Of all differences of force, N.
};

/// A recorded hand that touched a scene again.
struct Replay {
  Recording felt;             ///< The recorded ticks with the scene's new answers.
  ReplayComparison compared;  ///< With the recorded answers.
};

/// Lets a recorded hand touch a scene again, in virtual time: each tick's state of the arm, to the
/// bit, is given to the scene's force law. `scene`: file or name; empty: that of the recording. The
/// arm file is the recording's. The error names the file and what to mend.
THIMBLE_EXPORT driver::Result<Replay> replay(const Recording& recording,
                                             const std::string& scene = {});

/// Lets the recorded hands of a scene with several arms touch it again together, a recording each,
/// in any order. The replays come in the order of the recordings. The error also says which arm is
/// missing, or that the recordings are not of one run. Real arms' files are not put in place of the
/// scene's.
THIMBLE_EXPORT driver::Result<std::vector<Replay>> replay_together(
    std::span<const Recording> recordings, const std::string& scene = {});

/// Fails with what keeps a replay from being the same to the bit: another scene, arm file or build,
/// or ticks that the recording lacks. `scene` as for `replay`.
THIMBLE_EXPORT driver::Result<void> check_repeatable(const Recording& recording,
                                                     const std::string& scene = {});

}  // namespace thimble::session
