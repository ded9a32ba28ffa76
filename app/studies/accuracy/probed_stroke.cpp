#include "studies/accuracy/probed_stroke.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "studies/callgrind.h"

extern "C" [[gnu::noinline]] double thimble_probed_stroke(const thimble::studies::Stroke& stroke) {
  const double sum = stroke();
  asm volatile("");  // so that the call above is no tail call, and the function ends here
  return sum;
}

namespace thimble::studies {
namespace {

bool begins_with(const std::string& name, const std::string& prefix) {
  if (name.compare(0, prefix.size(), prefix) != 0) return false;
  return name.size() == prefix.size() || name[prefix.size()] == '/';
}

// Reads the count of one callgrind dump: "totals: 12345".
std::optional<double> totals_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::optional<double> totals;
  for (std::string line; std::getline(stream, line);) {
    if (line.compare(0, 8, "totals: ") == 0) totals = std::strtod(line.c_str() + 8, nullptr);
  }
  return totals;
}

// A temporary folder that the destructor removes with its content.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "thimble-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~ScratchFolder() {
    std::error_code status;
    if (!path_.empty()) std::filesystem::remove_all(path_, status);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

int probe_strokes(const std::string& prefix) {
  int count = 0;
  volatile double seen = 0;
  const std::string axis_name = prefix.substr(0, prefix.find('/'));
  for (const AxisMaker& maker : accuracy_axes()) {
    if (maker.name != axis_name) continue;
    const AccuracyAxis axis = maker.make();
    for (const AccuracyLine& line : axis.lines) {
      for (const AccuracyPoint& point : line.points) {
        std::string name = axis.name;
        name.append("/").append(line.name).append("/").append(point.name);
        if (!begins_with(name, prefix)) continue;
        seen = seen + thimble_probed_stroke(point.prepare());
        ++count;
        if (!point.baseline) continue;
        seen = seen + thimble_probed_stroke(point.baseline());
        ++count;
      }
    }
  }
  return count;
}

std::optional<std::vector<double>> count_strokes(const std::string& prefix) {
  return count_subject("accuracy/" + prefix);
}

std::optional<std::vector<double>> count_subject(const std::string& subject) {
  const ScratchFolder folder;
  if (folder.path().empty()) return std::nullopt;
  const bool counted =
      run_callgrind({"--toggle-collect=thimble_probed_stroke", "--dump-after=thimble_probed_stroke",
                     "--callgrind-out-file=" + (folder.path() / "out").string()},
                    {"cost-probe", subject, "1"});
  if (!counted) return std::nullopt;
  std::vector<double> counts;
  for (int i = 1;; ++i) {
    const auto file = folder.path() / ("out." + std::to_string(i));
    if (!std::filesystem::exists(file)) break;
    const auto totals = totals_of(file);
    if (!totals) return std::nullopt;
    counts.push_back(*totals);
  }
  return counts;
}

}  // namespace thimble::studies
