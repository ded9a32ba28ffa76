#include "view/start/file_dialog.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

/// Returns the path of a program in the absolute folders of PATH; empty if there is none.
fs::path find_program(const char* name) {
  const char* path = std::getenv("PATH");
  std::string_view rest = path != nullptr ? path : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    const fs::path file = fs::path(folder) / name;
    if (file.is_absolute() && access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

}  // namespace

FileDialog::FileDialog() {
  for (const char* name : {"zenity", "kdialog"}) {
    if (program_.empty()) program_ = find_program(name);
  }
}

driver::Result<void> FileDialog::ask() {
  if (open() || !available()) return {};
  const std::vector<std::string> arguments =
      program_.filename() == "zenity"
          ? std::vector<std::string>{"--file-selection", "--title=Open a scene, mesh or recording"}
          : std::vector<std::string>{"--title", "Open a scene, mesh or recording",
                                     "--getopenfilename"};
  auto started = ChildProcess::start(program_, arguments, {.keep_output = true, .quiet = true});
  if (!started) return started.error();
  process_ = std::move(started).value();
  return {};
}

std::optional<std::string> FileDialog::take_path() {
  if (!process_) return {};
  const auto code = process_->ended();
  if (!code) return {};
  std::string path = process_->text();
  process_.reset();
  if (*code != 0) return {};  // cancelled
  while (!path.empty() && (path.back() == '\n' || path.back() == '\r')) path.pop_back();
  if (path.empty()) return {};
  return path;
}

}  // namespace thimble::view
