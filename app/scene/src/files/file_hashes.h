#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// Hashes of the contents of the files that a scene reads, so that a replay can name a file that
/// has changed. Construct it when the scene is read: the files are hashed later, and a file that
/// was written in between gets no hash. Real-time: never from the servo thread.
class THIMBLE_EXPORT FileHashes {
 public:
  /// Notes size and time of each file. `inputs`: Scene::inputs.
  explicit FileHashes(const std::vector<std::filesystem::path>& inputs);

  /// Returns a heading and one line per file: its hash, 16 hexadecimal digits or dashes, a space
  /// and its absolute path. A bag that is a folder has one line per file in it, and a glTF file one
  /// more for each of its buffers. The first call reads the files. May be called from several
  /// threads.
  std::string text();

 private:
  struct Noted {
    std::filesystem::path path;
    ino_t inode = 0;
    off_t bytes = -1;  // -1: no such file.
    std::int64_t written_ns = 0;
    bool operator==(const Noted&) const = default;
  };
  static Noted noted(const std::filesystem::path& path);

  std::vector<Noted> files_;
  std::mutex mutex_;  // for `text_`
  std::string text_;  // Empty until the files are hashed.
};

/// Fails if a file that a scene reads has changed since a recording with the hashes `recorded`
/// (`FileHashes::text`); the error names it. `inputs`: those of the scene now, with the same text
/// as in the recording. The files may be in another folder. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> check_file_hashes(
    const std::string& recorded, const std::vector<std::filesystem::path>& inputs);

}  // namespace thimble::scene
