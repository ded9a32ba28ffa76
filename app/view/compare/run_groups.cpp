#include "view/compare/run_groups.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace thimble::view {
namespace {

/// Returns whether two recordings can be of two arms of one run, whose seeds differ by their places
/// in the scene.
bool can_be_one_run(const session::RecordingInfo& a, const session::RecordingInfo& b) {
  constexpr std::uint64_t kArmsMax = 8;
  const std::uint64_t apart = a.seed > b.seed ? a.seed - b.seed : b.seed - a.seed;
  return a.scene_text == b.scene_text && a.rate == b.rate && a.options == b.options &&
         a.file_hashes == b.file_hashes && apart < kArmsMax && a.arm_in_scene != b.arm_in_scene;
}

/// Returns a file without the name of its arm.
std::filesystem::path without_arm(const std::filesystem::path& file, const std::string& arm) {
  const std::string stem = file.stem().string();
  const std::string end = "_" + arm;
  if (!stem.ends_with(end)) return file;
  return file.parent_path() / stem.substr(0, stem.size() - end.size());
}

/// Returns the last `parts` parts of a path.
std::string end_of(const std::filesystem::path& file, std::size_t parts) {
  std::filesystem::path end;
  const auto all = static_cast<std::size_t>(std::distance(file.begin(), file.end()));
  std::size_t i = 0;
  for (const auto& part : file) {
    if (i++ + parts >= all) end /= part;
  }
  return end.string();
}

}  // namespace

std::vector<std::vector<std::size_t>> group_by_run(std::span<const session::Recording> recordings,
                                                   std::span<const std::filesystem::path> files) {
  std::vector<std::vector<std::size_t>> runs;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const session::RecordingInfo& info = recordings[i].info;
    const auto takes = [&](const std::vector<std::size_t>& run) {
      return std::all_of(run.begin(), run.end(), [&](std::size_t other) {
        return recordings[i].ticks.size() == recordings[other].ticks.size() &&
               can_be_one_run(info, recordings[other].info);
      });
    };
    const auto takes_by_name = [&](const std::vector<std::size_t>& run) {
      const std::size_t first = run.front();
      return takes(run) && without_arm(files[i], info.arm_in_scene) ==
                               without_arm(files[first], recordings[first].info.arm_in_scene);
    };
    auto found = runs.end();
    if (!info.arm_in_scene.empty()) {
      found = std::find_if(runs.begin(), runs.end(), takes_by_name);
      if (found == runs.end()) found = std::find_if(runs.begin(), runs.end(), takes);
    }
    if (found == runs.end()) {
      runs.push_back({i});
    } else {
      found->push_back(i);
    }
  }
  return runs;
}

std::vector<std::string> distinct_names(std::span<const std::filesystem::path> files) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::filesystem::path file = files[i].lexically_normal();
    const auto depth = static_cast<std::size_t>(std::distance(file.begin(), file.end()));
    const auto is_unique = [&](std::size_t parts) {
      return std::none_of(files.begin(), files.end(), [&](const auto& other) {
        const std::filesystem::path path = other.lexically_normal();
        return path != file && end_of(path, parts) == end_of(file, parts);
      });
    };
    std::size_t parts = 1;
    while (parts < depth && !is_unique(parts)) ++parts;
    std::string name = end_of(file, parts);
    const auto earlier = static_cast<std::size_t>(
        std::count_if(files.begin(), files.begin() + static_cast<std::ptrdiff_t>(i),
                      [&](const auto& other) { return other.lexically_normal() == file; }));
    if (earlier > 0) name += " (" + std::to_string(earlier + 1) + ")";
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace thimble::view
