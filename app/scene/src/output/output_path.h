#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::output {

/// File to which a name refers, with symbolic links resolved.
struct OutputPath {
  std::filesystem::path target;  ///< Absolute, without links; may not exist yet.
  /// True for a device, pipe or descriptor (/dev/stdout), which is written directly and never
  /// replaced.
  bool stream = false;
  bool exists = false;
  bool is_folder = false;
  dev_t device = 0;  ///< Device of the file if it exists, otherwise of its folder.
  ino_t inode = 0;   ///< Inode of the file if it exists, otherwise of its folder.
};

/// Resolves the name of an output. Fails if its folder does not exist, or if it is of a kind that
/// is not written (a socket, a disk). Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<OutputPath> resolve_output(const std::filesystem::path& path);

/// Returns whether two names refer to the same file, through any links. Two missing files are the
/// same if folder and name are. A stream is never the same as another file.
bool same_place(const OutputPath& a, const OutputPath& b);

/// Returns the error of an output: "PATH cannot be written: WHY."
THIMBLE_EXPORT driver::Error cannot_write(const std::filesystem::path& path,
                                          const std::string& why);

/// Returns the text of an errno.
THIMBLE_EXPORT std::string error_text(int number);

}  // namespace thimble::output
