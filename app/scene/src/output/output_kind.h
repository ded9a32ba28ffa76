#pragma once

#include <filesystem>

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
extern const OutputKind kTable;         ///< CSV: a heading of several columns, or numbers.
extern const OutputKind kSound;         ///< WAV
extern const OutputKind kPng;           ///< PNG, animated or not.
extern const OutputKind kSvg;           ///< SVG
extern const OutputKind kFilm;          ///< MP4 or GIF
extern const OutputKind kMesh;          ///< OFF
extern const OutputKind kPageFile;      ///< Mesh for disk paging.
extern const OutputKind kJson;          ///< JSON
extern const OutputKind kXml;           ///< XML
extern const OutputKind kWebPage;       ///< HTML made by Thimble.
extern const OutputKind kArmFile;       ///< Arm file; no file is replaced by one.
extern const OutputKind kQualityTable;  ///< Of `thimble study accuracy --table`.
extern const OutputKind kMotionTrace;   ///< Of `thimble plug --trace`.
extern const OutputKind kLogFile;       ///< Log; a message per line.
/// Text with a name of ours in a folder that Thimble writes: scripts, notes, data of plots. Binary
/// files are never replaced by it.
extern const OutputKind kPlainText;
/// Data of plots, in the subfolder that only Thimble writes.
extern const OutputKind kPlotData;

/// Returns the kind of a file in a folder of results, by the ending of its name.
const OutputKind& kind_of_name(const std::filesystem::path& file);

}  // namespace thimble::output
