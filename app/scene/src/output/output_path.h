#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::output {

/// The place that a name stands for, symbolic links followed.
struct OutputPath {
  std::filesystem::path target;  ///< Absolute, without links; may not exist yet.
  /// A device, pipe or descriptor (/dev/stdout): written as it is, never replaced.
  bool stream = false;
  bool exists = false;
  bool is_folder = false;
  dev_t device = 0;  ///< Of the file if it exists, otherwise of its folder.
  ino_t inode = 0;   ///< As above.
};

/// Resolves the name of an output. Fails if its folder does not exist, or if it names a kind of
/// file that is not written (a socket, a disk). Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<OutputPath> resolve_output(const std::filesystem::path& path);

/// Returns whether two names stand for one file, through any links. Two names that do not exist yet
/// are one if folder and name are. A stream is the same as nothing.
bool same_place(const OutputPath& a, const OutputPath& b);

/// Returns the error of an output: "PATH cannot be written: WHY."
THIMBLE_EXPORT driver::Error cannot_write(const std::filesystem::path& path,
                                          const std::string& why);

/// Returns the text of an errno.
THIMBLE_EXPORT std::string error_text(int number);

}  // namespace thimble::output
