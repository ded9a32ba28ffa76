#include "output/output_plan.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "output/output_file.h"
#include "output/output_kind.h"

namespace thimble::output {
namespace {

namespace fs = std::filesystem;

driver::Error by_option(const std::string& option, const driver::Error& error) {
  return driver::Error{option + ": " + error.message};
}

/// Fails if no file can be created in a folder. A check of permissions is not enough: an
/// administrator has all of them, and a disk may be read-only.
driver::Result<void> check_writable(const fs::path& folder) {
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (unnamed >= 0) return ::close(unnamed), driver::Result<void>();
  std::string name = (folder / ".thimble-XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named < 0) {
    return cannot_write(folder, error_text(errno) + ". Name a writable folder.");
  }
  ::unlink(name.c_str());
  ::close(named);
  return {};
}

}  // namespace

OutputPlan::~OutputPlan() {
  for (const fs::path& key : reserved_) release_output(key);
  std::error_code ignored;
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) {
    ::rmdir(folder->c_str());  // fails if the folder is not empty
  }
}

void OutputPlan::read(const fs::path& path) {
  if (!path.empty()) inputs_.push_back(path);
}

void OutputPlan::write(const std::string& option, const fs::path& path, const OutputKind& kind,
                       bool replace) {
  if (!path.empty()) outputs_.push_back({option, path, &kind, Use::kKeep, replace});
}

void OutputPlan::check(const std::string& option, const fs::path& path, const OutputKind& kind,
                       bool replace) {
  if (!path.empty()) outputs_.push_back({option, path, &kind, Use::kCheck, replace});
}

void OutputPlan::write_folder(const std::string& option, const fs::path& path,
                              const std::vector<std::string>& names, bool plots) {
  if (!path.empty()) outputs_.push_back({option, path, nullptr, Use::kFolder, false, names, plots});
}

void OutputPlan::write_new_folder(const std::string& option, const fs::path& path) {
  if (!path.empty()) outputs_.push_back({option, path, nullptr, Use::kNewFolder});
}

driver::Result<void> OutputPlan::make_folder(const Output& output) {
  std::vector<fs::path> missing;
  std::error_code failed;
  fs::path folder = fs::absolute(output.path);
  if (!folder.has_filename()) folder = folder.parent_path();
  for (fs::path up = folder; !fs::exists(up, failed) && up.has_relative_path();
       up = up.parent_path()) {
    missing.push_back(up);
  }
  fs::create_directories(folder, failed);
  made_.insert(made_.end(), missing.rbegin(), missing.rend());
  if (failed) {
    return cannot_write(output.path, failed.message() + ". Name a writable folder.");
  }
  if (!fs::is_directory(folder, failed)) {
    return cannot_write(output.path, "it is not a folder. Name a folder.");
  }
  auto lock = FolderLock::take(folder);
  if (!lock) return lock.error();
  locks_.push_back(std::move(lock).value());
  if (auto writable = check_writable(folder); !writable) return writable;
  if (!output.plots) return {};
  const fs::path data = output.path / kDataFolder;
  if (fs::symlink_status(data, failed).type() == fs::file_type::not_found) return {};
  if (!fs::is_directory(data, failed)) {
    return cannot_write(data, "it is not a folder. Remove it, or name another folder.");
  }
  return check_writable(data);
}

driver::Result<void> OutputPlan::add_places(const Output& output,
                                            std::vector<Place>& places) const {
  auto found = resolve_output(output.path);
  if (!found) return found.error();
  places.push_back({output.option, output.path, *found});
  for (const std::string& name : output.names) {
    const fs::path path = output.path / name;
    auto inner = resolve_output(path);
    if (!inner) continue;  // its folder does not exist yet
    places.push_back({output.option, path, *inner});
    if (output.begun) continue;
    if (auto may = check_replaceable(path, *inner, kind_of_name(path), false); !may) return may;
  }
  if (output.kind == nullptr || output.begun) return {};
  return check_replaceable(output.path, *found, *output.kind, output.replace);
}

driver::Result<void> OutputPlan::compare(const std::vector<Place>& places) const {
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const fs::path& input : inputs_) {
      const auto read = resolve_output(input);
      if (!read || !read->exists || !same_place(*read, places[i].found)) continue;
      return driver::Error{places[i].option + ": " + places[i].path.string() +
                           " cannot be written: it is also an input of this command. Name another "
                           "file for the output."};
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (!same_place(places[i].found, places[k].found)) continue;
      return driver::Error{places[k].option + " and " + places[i].option +
                           " name the same place, " + places[i].path.string() +
                           ". Give each output its own name."};
    }
  }
  return {};
}

driver::Result<void> OutputPlan::begin() {
  std::vector<Place> places;
  // Folders come first: files may be in them.
  for (const bool folders : {true, false}) {
    for (const Output& output : outputs_) {
      if ((output.kind == nullptr) != folders) continue;
      auto added = folders && !output.begun ? make_folder(output) : driver::Result<void>();
      if (added) added = add_places(output, places);
      if (!added) return by_option(output.option, added.error());
    }
  }
  if (auto apart = compare(places); !apart) return apart;
  for (Output& output : outputs_) {
    if (std::exchange(output.begun, true)) continue;
    std::error_code failed;
    if (output.use == Use::kNewFolder && !fs::is_empty(output.path, failed)) {
      return by_option(output.option,
                       cannot_write(output.path, "the folder is not empty. Name a new one."));
    }
    if (output.use != Use::kKeep) continue;
    auto key = reserve_output(output.path, *output.kind, output.replace);
    if (!key) return by_option(output.option, key.error());
    reserved_.push_back(*key);
  }
  return {};
}

}  // namespace thimble::output
