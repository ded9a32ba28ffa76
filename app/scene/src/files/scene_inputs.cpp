#include "files/scene_inputs.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>

#include "files/scanned_meshes.h"
#include "text_file.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kScanScheme = "cgal:";

/// Returns whether a word is a number, of which a large scene has many.
bool is_number(std::string_view word) {
  double number = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), number);
  return status == std::errc() && end == word.data() + word.size();
}

void add_named(const std::string& word, const fs::path& folder, std::vector<fs::path>& files) {
  constexpr std::size_t kNameMax = 4096;  // bytes [S limits.h, PATH_MAX]
  if (word.empty() || word.size() > kNameMax) return;
  std::error_code status;
  if (word.starts_with(kScanScheme)) {
    if (auto scan = find_scan(word.substr(kScanScheme.size()))) files.push_back(*scan);
    return;
  }
  // Every word of the text is tried. Numbers and keys are not files.
  if (word.find('.') == std::string::npos || is_number(word)) return;
  const fs::path path = folder / word;
  if (fs::exists(path, status) &&
      (fs::is_regular_file(path, status) || fs::is_directory(path / ".", status)) &&
      path.filename() != "." && path.filename() != "..") {
    files.push_back(path);
  }
}

}  // namespace

std::vector<fs::path> scene_inputs(const fs::path& scene) {
  std::vector<fs::path> files;
  std::error_code status;
  if (!fs::is_regular_file(scene, status)) return files;
  files.push_back(scene);
  const std::string text = text_of(scene);
  const fs::path folder = scene.parent_path();
  constexpr std::string_view kBetweenWords = " \t\r\n\"'{}[],";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    // A value that extends to the end of its line may contain spaces.
    if (const std::size_t value = line.find(": "); value != std::string::npos) {
      std::string whole = line.substr(value + 2);
      whole.erase(0, whole.find_first_not_of(" \t\"'"));
      while (!whole.empty() && kBetweenWords.find(whole.back()) != std::string_view::npos) {
        whole.pop_back();
      }
      add_named(whole, folder, files);
    }
    for (std::size_t from = line.find_first_not_of(kBetweenWords); from < line.size();) {
      const std::size_t to = std::min(line.find_first_of(kBetweenWords, from), line.size());
      add_named(line.substr(from, to - from), folder, files);
      from = std::min(line.find_first_not_of(kBetweenWords, to), line.size());
    }
  }
  return files;
}

}  // namespace thimble::scene
