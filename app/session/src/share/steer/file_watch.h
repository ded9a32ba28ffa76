#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace thimble::session {

/// A watch over the files that a run was made of, which tells when a person has written one of them
/// anew. Real-time: never from the servo thread.
class FileWatch {
 public:
  /// Looks for which a file must stand still until it counts as written: programs write in several
  /// steps. With `step` called ten times a second that is a fifth of a second. [chosen]
  static constexpr int kSettled = 2;

  /// Watches nothing.
  FileWatch() = default;
  /// Watches `files` from what they hold now; those without a name are left out.
  explicit FileWatch(const std::vector<std::filesystem::path>& files);

  /// Looks once. Returns whether what the files hold is something else than when this last said so,
  /// and stands still; a file that is gone is waited for.
  bool step();
  /// Returns whether the files hold what they held at first.
  bool as_at_first() const;

 private:
  struct Stamp {
    ino_t inode = 0;
    off_t bytes = -1;  // -1: there is no such file
    std::int64_t written_ns = 0;
    bool operator==(const Stamp&) const = default;
  };
  struct File {
    std::filesystem::path path;
    std::string first;   // what it held at first
    std::string told;    // and when a change was told last
    Stamp seen;          // at the last look
    int still = 0;       // looks since it changed
    bool fresh = false;  // it has changed since it was read
  };
  static Stamp stamp_of(const std::filesystem::path& path);

  std::vector<File> files_;
};

}  // namespace thimble::session
