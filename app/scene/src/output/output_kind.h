#pragma once

#include <filesystem>

#include "thimble/driver/export.h"

namespace thimble::output {

/// Treatment of an existing file of the same kind.
enum class Existing {
  kReplace,  ///< Replaced by the complete new file.
  /// Replaced only if the user allows it, because measurements cannot be repeated.
  kReplaceForced,
  kKeep,  ///< Never replaced.
};

/// Kind of an output file. A file of another kind is never overwritten.
struct OutputKind {
  const char* name;  ///< Name with its article: "a table (CSV)".
  /// Returns whether an existing, non-empty file is of this kind.
  bool (*matches)(const std::filesystem::path&);
  Existing existing = Existing::kReplace;
  bool owner_only = false;  ///< True for mode 0600, whatever the umask.
  bool needs_file = false;  ///< True if it cannot be written to devices and pipes.
  bool shared = false;      ///< True if several programs append to it; then it is not locked.
};

// Kinds identified by their first bytes.
THIMBLE_EXPORT extern const OutputKind kTable;  ///< CSV: a heading of several columns, or numbers.
THIMBLE_EXPORT extern const OutputKind kSound;  ///< WAV
THIMBLE_EXPORT extern const OutputKind kPng;    ///< PNG, animated or not.
THIMBLE_EXPORT extern const OutputKind kSvg;    ///< SVG
THIMBLE_EXPORT extern const OutputKind kAnimation;  ///< MP4 or GIF
THIMBLE_EXPORT extern const OutputKind kMesh;       ///< OFF
THIMBLE_EXPORT extern const OutputKind kPageFile;   ///< Mesh for disk paging.
THIMBLE_EXPORT extern const OutputKind kJson;       ///< JSON
THIMBLE_EXPORT extern const OutputKind kXml;        ///< XML
THIMBLE_EXPORT extern const OutputKind kWebPage;    ///< HTML made by Thimble.
THIMBLE_EXPORT extern const OutputKind kArmFile;    ///< Arm file; no file is replaced by one.
/// Table of `thimble study accuracy --table`.
THIMBLE_EXPORT extern const OutputKind kQualityTable;
THIMBLE_EXPORT extern const OutputKind kMotionTrace;  ///< Trace of `thimble plug --trace`.
THIMBLE_EXPORT extern const OutputKind kLogFile;      ///< Log; a message per line.
/// Text with a fixed name in a folder that Thimble writes: scripts, notes, data of plots. Never
/// replaces binary files.
THIMBLE_EXPORT extern const OutputKind kPlainText;
/// Data of plots, in the subfolder that only Thimble writes.
extern const OutputKind kPlotData;

/// Subfolder of a folder of results for the data of its plots.
inline constexpr const char* kDataFolder = "data";

/// Returns the kind of a file in a folder of results, by its extension.
THIMBLE_EXPORT const OutputKind& kind_of_name(const std::filesystem::path& file);

}  // namespace thimble::output
