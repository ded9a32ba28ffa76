#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace thimble::session {

/// Detects changes of the files from which a run was made. Real-time: never from the servo thread.
class FileWatch {
 public:
  /// Number of checks for which a file must be unchanged to count as written, because programs
  /// write in several steps. With `step` called ten times a second it is a fifth of a second.
  /// [chosen]
  static constexpr int kSettled = 2;

  /// Constructs a watch without files.
  FileWatch() = default;
  /// Watches `files` for changes from their current contents; empty names are ignored.
  explicit FileWatch(const std::vector<std::filesystem::path>& files);

  /// Checks once. Returns whether the contents differ from those at the last reported change and
  /// are stable. Missing files are awaited.
  bool step();
  /// Returns whether the files have their initial contents.
  bool as_at_first() const;

 private:
  struct Stamp {
    ino_t inode = 0;
    off_t bytes = -1;  // -1: no such file.
    std::int64_t written_ns = 0;
    bool operator==(const Stamp&) const = default;
  };
  struct File {
    std::filesystem::path path;
    std::string first;     // Initial contents.
    std::string reported;  // Contents at the last reported change.
    Stamp seen;            // At the last check.
    int still = 0;         // Number of checks since it changed.
    bool fresh = false;    // True if it has changed since it was read.
  };
  static Stamp stamp_of(const std::filesystem::path& path);

  std::vector<File> files_;
};

}  // namespace thimble::session
