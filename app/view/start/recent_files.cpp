#include "view/start/recent_files.h"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <system_error>

#include "output/output_file.h"
#include "system/regular_file.h"
#include "user_folders.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFirstLine = "thimble recent files 1";
constexpr std::uint64_t kMaxBytes = 65536;  // [chosen: 6 paths of at most 4096 bytes, twice]

bool is_listed_name(const fs::path& file) {
  const std::string text = file.string();
  return file.is_absolute() && std::none_of(text.begin(), text.end(), [](char letter) {
           return static_cast<unsigned char>(letter) < 0x20;
         });
}

}  // namespace

fs::path RecentFiles::default_file() {
  return scene::state_folder() / "recent_scenes";
}

RecentFiles RecentFiles::load(const fs::path& file) {
  RecentFiles recent(file);
  std::error_code status;
  if (!fs::exists(file, status)) return recent;
  const auto broken = [&recent, &file](const std::string& fault) {
    recent.files_.clear();
    recent.warning_ = file.string() + ": the list of recent files is ignored, because " + fault +
                      " The next opened file replaces it.";
    return recent;
  };
  const auto text = driver::read_file(file, kMaxBytes);
  if (!text) return broken("it cannot be read: " + text.error().message);
  std::istringstream lines(*text);
  std::string line;
  if (!std::getline(lines, line) || line != kFirstLine) {
    return broken(std::string("its first line is not \"") + kFirstLine + "\".");
  }
  while (std::getline(lines, line)) {
    if (!is_listed_name(line)) return broken("a line is not an absolute path.");
    if (recent.files_.size() < kMax) recent.files_.emplace_back(line);
  }
  return recent;
}

driver::Result<void> RecentFiles::add(const fs::path& opened) {
  if (!is_listed_name(opened)) return {};
  files_ = load(file_).files_;
  std::erase(files_, opened);
  files_.insert(files_.begin(), opened);
  if (files_.size() > kMax) files_.resize(kMax);
  std::string text = std::string(kFirstLine) + '\n';
  for (const fs::path& file : files_) text += file.string() + '\n';
  std::error_code status;
  fs::create_directories(file_.parent_path(), status);
  return output::write_file(file_, output::kPlainText, text);
}

}  // namespace thimble::view
