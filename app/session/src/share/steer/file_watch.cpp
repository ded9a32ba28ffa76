#include "share/steer/file_watch.h"

#include <sys/stat.h>

#include <algorithm>

#include "text_file.h"

namespace thimble::session {

FileWatch::FileWatch(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& path : files) {
    if (path.empty()) continue;
    File file;
    file.path = path;
    file.seen = stamp_of(path);
    file.first = file.reported = scene::text_of(path);
    files_.push_back(std::move(file));
  }
}

FileWatch::Stamp FileWatch::stamp_of(const std::filesystem::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {};
  return {
      .inode = status.st_ino,
      .bytes = status.st_size,
      .written_ns = status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec};
}

bool FileWatch::step() {
  bool changed = false;
  for (File& file : files_) {
    const Stamp now = stamp_of(file.path);
    file.fresh = file.fresh || now != file.seen;
    file.still = now == file.seen ? file.still + 1 : 0;
    file.seen = now;
    if (!file.fresh || file.still < kSettled || now.bytes < 0) continue;
    file.fresh = false;
    std::string text = scene::text_of(file.path);
    if (text == file.reported) continue;  // written without a change
    file.reported = std::move(text);
    changed = true;
  }
  return changed;
}

bool FileWatch::as_at_first() const {
  return std::all_of(files_.begin(), files_.end(),
                     [](const File& file) { return file.reported == file.first; });
}

}  // namespace thimble::session
