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

// Recordings as plain data. The columns below and app/guide describe the file (HDF5, one data set
// per column). Real-time: none of these functions may be called from the servo thread.

/// Origin of a recording: enough to repeat the run.
struct RecordingInfo {
  std::string scene;       ///< Name of the scene.
  std::string scene_file;  ///< Path of the scene file.
  std::string scene_text;  ///< Text of the scene file.
  std::string arm;         ///< Name of the arm.
  std::string arm_file;    ///< Path of the arm file.
  std::string arm_text;    ///< Text of the arm file.
  std::string device;      ///< "sim", or the name of the real arm.
  std::string clock;       ///< Clock: "virtual" or "wall".
  std::string program;     ///< Program: version, revision, build type and compiler.
  double rate = 0;         ///< Rate of the servo loop, Hz.
  std::uint64_t seed = 0;  ///< Seed of all random numbers in the simulation.
  /// Name of the arm in a scene with several arms, which has one recording per arm; otherwise
  /// empty.
  std::string arm_in_scene{};
  /// Names of the objects in which the tip of a simulated arm starts, separated by commas.
  std::string inside_at_start{};
  /// Other options that change the result, one per line ("quality: draft"); empty if there are
  /// none.
  std::string options{};
  /// Hashes of the other files that the scene reads (meshes with their buffers, pictures, bags),
  /// one line per file: "0123456789abcdef /home/ann/pad.obj", after a heading. Empty in recordings
  /// of versions before 0.3.
  std::string file_hashes{};
};

/// Returns the file for the recording of one of several arms if `path` is requested: a file in the
/// same folder with the arm's name appended (touch_left.h5). Returns `path` if `arm_in_scene` is
/// empty.
THIMBLE_EXPORT std::filesystem::path file_of_arm(const std::filesystem::path& path,
                                                 const std::string& arm_in_scene);

/// Recording in memory.
struct Recording {
  RecordingInfo info;                     ///< Origin of the recording.
  std::vector<driver::TickRecord> ticks;  ///< All ticks, oldest first.
  /// False if ticks are missing or the file was cut off: after a crash, a full disk, or the maximum
  /// duration.
  bool complete = false;
};

/// Column of a recording: one or several numbers of each tick.
struct THIMBLE_EXPORT RecordingColumn {
  /// Type of a number in the file: unsigned, signed or floating point, with its number of bits.
  enum class Type : std::uint8_t { kU8, kU16, kI16, kI32, kI64, kU64, kF32, kF64 };

  const char* name;    ///< Name of the data set in the file.
  const char* unit;    ///< SI unit; "1" for counts and flags.
  const char* about;   ///< Description, with the frame.
  Type type;           ///< Type of each number.
  std::size_t width;   ///< Numbers per tick: 1, 3, or 4 for a quaternion.
  std::size_t offset;  ///< Offset of the first number in driver::TickRecord, bytes.
  bool later = false;  ///< True if older recordings lack the column; its numbers are then 0.

  /// Returns whether the three numbers belong to joints, motors or gimbal axes, in the arm's order.
  /// Otherwise three numbers are the x, y and z of a vector.
  bool by_axis() const noexcept;

  /// Returns the size of one number, bytes.
  std::size_t element() const noexcept;
  /// Returns the size of the column per tick, bytes.
  std::size_t bytes() const noexcept { return element() * width; }
};

/// Returns all columns. They cover every field of driver::TickRecord.
THIMBLE_EXPORT std::span<const RecordingColumn> recording_columns() noexcept;

/// Reads a recording, complete or cut off. The error says why the file is not a recording, or which
/// part of it is invalid.
THIMBLE_EXPORT driver::Result<Recording> read_recording(const std::filesystem::path& path);

/// Writes a whole recording at once and marks it complete. With `overwrite`, replaces an existing
/// recording of that name; a file of another kind is never replaced. The error says what cannot be
/// written.
THIMBLE_EXPORT driver::Result<void> write_recording(const std::filesystem::path& path,
                                                    const RecordingInfo& info,
                                                    std::span<const driver::TickRecord> ticks,
                                                    bool overwrite = false);

/// Writes a recording as CSV: a header line with names and units ("p_WT.x [m]"), then one line per
/// tick. Numbers have enough digits to be read back bit-identically.
THIMBLE_EXPORT driver::Result<void> write_csv(const Recording& recording,
                                              const std::filesystem::path& path);

/// Comparison of replayed with recorded forces: those that the force law requested, tick by tick.
struct ReplayComparison {
  std::uint64_t ticks = 0;             ///< Number of ticks compared.
  std::uint64_t differing = 0;         ///< Number of ticks whose forces are not bit-identical.
  std::optional<std::uint64_t> first;  ///< Number of the first differing tick.
  double largest = 0;                  ///< Largest difference of force, N.
};

/// Result of a replay.
struct Replay {
  Recording felt;  ///< Recorded ticks with the forces and contacts that the replay computed.
  ReplayComparison compared;  ///< Comparison with the recorded forces.
};

/// Replays a recording in virtual time: passes the arm state of each tick, bit-identical to the
/// recorded one, to the scene's force law. `scene` is a file or a name; if empty, the scene of the
/// recording is used. The arm file is that of the recording. The error names the file and the fix.
THIMBLE_EXPORT driver::Result<Replay> replay(const Recording& recording,
                                             const std::string& scene = {});

/// Replays the recordings of a scene with several arms together, one recording per arm, in any
/// order. Returns the replays in the order of the recordings. The error also names a missing arm,
/// or says that the recordings belong to different runs. The scene's arm files are not replaced by
/// those of real arms.
THIMBLE_EXPORT driver::Result<std::vector<Replay>> replay_together(
    std::span<const Recording> recordings, const std::string& scene = {});

/// Fails with the reason why a replay would not be bit-identical: another scene, arm file or build,
/// a changed file that the scene reads, or missing ticks. `scene` as for `replay`.
THIMBLE_EXPORT driver::Result<void> check_repeatable(const Recording& recording,
                                                     const std::string& scene = {});

/// Returns a sentence that names the files that `check_repeatable` cannot check, because the
/// recording has no hashes of them; empty if there are none. `scene` as for `replay`.
THIMBLE_EXPORT std::string unhashed_files(const Recording& recording,
                                          const std::string& scene = {});

}  // namespace thimble::session
