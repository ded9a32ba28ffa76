#pragma once

#include <filesystem>

#include "thimble/driver/export.h"

namespace thimble::output {

/// What may happen to an existing file of the same kind.
enum class Existing {
  kReplace,        ///< It is replaced by the complete new one.
  kReplaceForced,  ///< Only if the user allows it: measurements cannot be made again.
  kKeep,           ///< Never replaced.
};

/// A kind of file that is written. A file of another kind is never overwritten.
struct OutputKind {
  const char* name;  ///< With its article: "a table (CSV)".
  /// Returns whether an existing file that is not empty is of this kind.
  bool (*matches)(const std::filesystem::path&);
  Existing existing = Existing::kReplace;
  bool owner_only = false;  ///< Mode 0600, whatever the umask.
  bool needs_file = false;  ///< Not written to devices and pipes.
  bool shared = false;      ///< Several programs append to it: it is not locked.
};

// Recognised by their first bytes.
THIMBLE_EXPORT extern const OutputKind kTable;  ///< CSV: a heading of several columns, or numbers.
THIMBLE_EXPORT extern const OutputKind kSound;  ///< WAV
THIMBLE_EXPORT extern const OutputKind kPng;    ///< PNG, animated or not.
THIMBLE_EXPORT extern const OutputKind kSvg;    ///< SVG
THIMBLE_EXPORT extern const OutputKind kFilm;   ///< MP4 or GIF
THIMBLE_EXPORT extern const OutputKind kMesh;   ///< OFF
THIMBLE_EXPORT extern const OutputKind kPageFile;      ///< Mesh for disk paging.
THIMBLE_EXPORT extern const OutputKind kJson;          ///< JSON
THIMBLE_EXPORT extern const OutputKind kXml;           ///< XML
THIMBLE_EXPORT extern const OutputKind kWebPage;       ///< HTML made by Thimble.
THIMBLE_EXPORT extern const OutputKind kArmFile;       ///< Arm file; no file is replaced by one.
THIMBLE_EXPORT extern const OutputKind kQualityTable;  ///< Of `thimble study accuracy --table`.
THIMBLE_EXPORT extern const OutputKind kMotionTrace;   ///< Of `thimble plug --trace`.
THIMBLE_EXPORT extern const OutputKind kLogFile;       ///< Log; a message per line.
/// Text with a name of ours in a folder that Thimble writes: scripts, notes, data of plots. Binary
/// files are never replaced by it.
THIMBLE_EXPORT extern const OutputKind kPlainText;
/// Data of plots, in the subfolder that only Thimble writes.
extern const OutputKind kPlotData;

/// Returns the kind of a file in a folder of results, by the ending of its name.
THIMBLE_EXPORT const OutputKind& kind_of_name(const std::filesystem::path& file);

}  // namespace thimble::output
