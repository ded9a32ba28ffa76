#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "system/run_in_sandbox.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Header of the output of `read_h5`. The texts follow in the order of `kRecordingTexts`, each as
/// its length (std::uint64_t) and its bytes. Then the present columns follow, one after the other,
/// in memory layout.
struct H5Head {
  std::uint64_t good = 0;     ///< 0: an error message follows.
  std::uint64_t rows = 0;     ///< Number of ticks.
  std::uint64_t columns = 0;  ///< Bit i is set if column i of `recording_columns` is present.
  std::uint64_t complete = 0;
  std::uint64_t seed = 0;
  double rate = 0;  ///< Rate of the loop, Hz.
};

/// Text of a recording: its data set and its member of RecordingInfo.
struct RecordingText {
  const char* name;
  std::string RecordingInfo::*text;
  bool later = false;    ///< True if older recordings lack it.
  bool is_name = false;  ///< True if it is shown to users; the others are texts of files and paths.
};

/// All texts of a recording.
inline constexpr std::array kRecordingTexts{
    RecordingText{"scene", &RecordingInfo::scene, false, true},
    RecordingText{"scene_file", &RecordingInfo::scene_file},
    RecordingText{"scene_text", &RecordingInfo::scene_text},
    RecordingText{"arm", &RecordingInfo::arm, false, true},
    RecordingText{"arm_file", &RecordingInfo::arm_file},
    RecordingText{"arm_text", &RecordingInfo::arm_text},
    RecordingText{"device", &RecordingInfo::device, false, true},
    RecordingText{"clock", &RecordingInfo::clock, false, true},
    RecordingText{"program", &RecordingInfo::program, false, true},
    RecordingText{"arm_in_scene", &RecordingInfo::arm_in_scene, true, true},
    RecordingText{"options", &RecordingInfo::options, true},
    RecordingText{"inside_at_start", &RecordingInfo::inside_at_start, true, true},
    RecordingText{"file_hashes", &RecordingInfo::file_hashes, true},
};

/// Returns the largest memory, bytes, that reading a recording with `stored` bytes on disk may use.
std::uint64_t max_recording_memory(std::uint64_t stored) noexcept;

/// Reads a recording from an open regular file and writes it as plain data. HDF5 1.10 can crash on
/// damaged tables, so this must run in a separate process (run_in_sandbox), which cannot open
/// further files afterwards. `size`, `stored`: of the file, as in driver::RegularFile.
void read_h5(int descriptor, std::uint64_t size, std::uint64_t stored, driver::SandboxWriter& out);

}  // namespace thimble::session
