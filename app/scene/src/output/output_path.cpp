#include "output/output_path.h"

#include <sys/stat.h>

#include <cerrno>
#include <system_error>

namespace thimble::output {
namespace {

namespace fs = std::filesystem;

constexpr int kLinksMax = 40;  // same limit as Linux [S man 7 path_resolution]

/// Returns whether a name is a descriptor or device of the system, whatever it refers to: writing
/// to /dev/stdout must not replace the file that the shell has opened.
bool is_system_name(const fs::path& path) {
  const std::string text = fs::absolute(path).lexically_normal().string();
  return text.starts_with("/proc/") ||
         (text.starts_with("/dev/") && !text.starts_with("/dev/shm/"));
}

}  // namespace

std::string error_text(int number) {
  return std::generic_category().message(number);
}

driver::Error cannot_write(const fs::path& path, const std::string& why) {
  return driver::Error{path.string() + " cannot be written: " + why};
}

driver::Result<OutputPath> resolve_output(const fs::path& path) {
  if (path.empty()) return cannot_write(path, "the name is empty. Give a file name.");
  if (path == "-") {
    return cannot_write(path, "standard output is not supported here. Name a file.");
  }
  OutputPath found;
  struct stat about {};
  const bool there = ::stat(path.c_str(), &about) == 0;
  if (there && S_ISSOCK(about.st_mode)) return cannot_write(path, "it is a socket. Name a file.");
  if (there && S_ISBLK(about.st_mode)) return cannot_write(path, "it is a disk. Name a file.");
  if (there && !S_ISDIR(about.st_mode) && (!S_ISREG(about.st_mode) || is_system_name(path))) {
    found.target = path;
    found.stream = found.exists = true;
    return found;
  }
  fs::path target = fs::absolute(path);
  if (!target.has_filename()) target = target.parent_path();  // "folder/"
  std::error_code failed;
  for (int links = 0; fs::is_symlink(target, failed); ++links) {
    if (links == kLinksMax) return cannot_write(path, "its links form a loop. Name a file.");
    const fs::path to = fs::read_symlink(target, failed);
    if (failed) return cannot_write(path, failed.message() + ".");
    target = target.parent_path() / to;
  }
  const fs::path name = target.filename();
  const fs::path folder = fs::canonical(target.parent_path(), failed);
  if (failed || !fs::is_directory(folder)) {
    const std::string parent = target.parent_path().string();
    if (failed == std::errc::no_such_file_or_directory) {
      return cannot_write(
          path, "the folder " + parent + " does not exist. Create it, or name another place.");
    }
    return cannot_write(path, parent + ": " + (failed ? failed.message() : "not a folder") +
                                  ". Name another place.");
  }
  const bool by_dots = name == "." || name == "..";
  found.target = by_dots ? fs::canonical(target, failed) : folder / name;
  found.exists = ::stat(found.target.c_str(), &about) == 0;
  if (!found.exists && ::stat(folder.c_str(), &about) != 0) {
    return cannot_write(path, error_text(errno) + ".");
  }
  found.is_folder = found.exists && S_ISDIR(about.st_mode);
  found.device = about.st_dev;
  found.inode = about.st_ino;
  return found;
}

bool same_place(const OutputPath& a, const OutputPath& b) {
  if (a.stream || b.stream || a.exists != b.exists) return false;
  if (a.device != b.device || a.inode != b.inode) return false;
  return a.exists || a.target.filename() == b.target.filename();
}

}  // namespace thimble::output
