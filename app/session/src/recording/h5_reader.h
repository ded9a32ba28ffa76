#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "system/run_apart.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// The numbers at the beginning of what `read_h5` writes. The texts follow in the order of
/// `recording_texts`, each as its length (std::uint64_t) and its bytes; then the columns that are
/// present, one after the other, as they lie in memory.
struct H5Head {
  std::uint64_t good = 0;     ///< 0: what follows is the sentence that says why not.
  std::uint64_t rows = 0;     ///< Ticks.
  std::uint64_t columns = 0;  ///< Bit i is set if column i of `recording_columns` is present.
  std::uint64_t complete = 0;
  std::uint64_t seed = 0;
  double rate = 0;  ///< Hz
};

/// A text of a recording: its data set and its member of RecordingInfo.
struct RecordingText {
  const char* name;
  std::string RecordingInfo::*text;
  bool later = false;    ///< Older recordings do not have it.
  bool is_name = false;  ///< It is shown to users; the others are texts of files and paths.
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
};

/// Returns the memory in bytes that a recording may take of which `stored` bytes are on the disk.
std::uint64_t max_recording_memory(std::uint64_t stored) noexcept;

/// Reads a recording from an open regular file and writes it as plain data. HDF5 1.10 does not
/// survive all damage of its own tables, so this belongs into a process of its own (run_apart),
/// which afterwards can open no further file. `size`, `stored`: of the file, as of
/// driver::RegularFile.
void read_h5(int descriptor, std::uint64_t size, std::uint64_t stored, driver::ApartWriter& out);

}  // namespace thimble::session
