#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::view {

/// The files that the start window opened last, newest first, in a file of the user's state.
/// Real-time: never from the servo thread.
class RecentFiles {
 public:
  /// Maximum number of files [chosen: two rows of the start window at its first size].
  static constexpr std::size_t kMax = 6;

  /// Reads the list. If the file is missing, the list is empty. If it is broken, the list is empty
  /// and `warning` describes the fault.
  static RecentFiles load(const std::filesystem::path& file);

  /// Returns the place of the list: recent_scenes in the user's state folder.
  static std::filesystem::path default_file();

  /// Puts a file, an absolute path, first, and writes the list. The written list contains the files
  /// that another window added meanwhile. A file with a line break in its name is not listed. The
  /// error says why the list cannot be written.
  driver::Result<void> add(const std::filesystem::path& opened);

  const std::vector<std::filesystem::path>& files() const { return files_; }
  const std::string& warning() const { return warning_; }

 private:
  explicit RecentFiles(std::filesystem::path file) : file_(std::move(file)) {}

  std::filesystem::path file_;
  std::vector<std::filesystem::path> files_;
  std::string warning_;
};

}  // namespace thimble::view
