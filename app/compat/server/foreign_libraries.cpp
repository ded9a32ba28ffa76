#include "compat/server/foreign_libraries.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

namespace thimble::compat {
namespace {

namespace fs = std::filesystem;

constexpr int kDepthMax = 8;  // generations of processes [chosen: a shell script in a shell script]

/// Returns whether a file has the name of a vendor's library, of any version.
bool is_vendors(std::string_view file) {
  constexpr std::string_view kNames[] = {"libHD.so",  "libHL.so",  "libhdPhantom.so",
                                         "libdhd.so", "libdrd.so", "libPhantomIOLib42.so"};
  return std::any_of(std::begin(kNames), std::end(kNames), [&](std::string_view name) {
    return file.starts_with(name) && (file.size() == name.size() || file[name.size()] == '.');
  });
}

void add_libraries(pid_t process, const fs::path& ours, int depth, std::set<std::string>& found) {
  const std::string place = "/proc/" + std::to_string(process);
  std::ifstream maps(place + "/maps");
  for (std::string line; std::getline(maps, line);) {
    const std::size_t begin = line.find('/');
    if (begin == std::string::npos) continue;
    const fs::path file = line.substr(begin);
    if (is_vendors(file.filename().string()) && file.parent_path() != ours) {
      found.insert(file.string());
    }
  }
  if (depth == 0) return;
  std::ifstream children(place + "/task/" + std::to_string(process) + "/children");
  for (pid_t child = 0; children >> child;) add_libraries(child, ours, depth - 1, found);
}

}  // namespace

std::set<std::string> foreign_libraries(pid_t process, const fs::path& ours) {
  std::error_code unknown;
  fs::path folder = fs::canonical(ours, unknown);  // as the kernel names it
  if (unknown) folder = ours;
  std::set<std::string> found;
  add_libraries(process, folder, kDepthMax, found);
  return found;
}

}  // namespace thimble::compat
