#include "bringup/doctor_files.h"

#include <algorithm>
#include <string>
#include <system_error>

namespace thimble::bringup {
namespace {

namespace fs = std::filesystem;

/// The scan that identifies a folder of scans; the first touch needs it.
constexpr const char* kFirstScan = "elephant.off";

bool is_there(const fs::path& path) {
  std::error_code status;
  return fs::exists(path, status);
}

/// Lists folders in their order, with those that exist.
std::string in_order(const std::vector<fs::path>& folders) {
  std::string text;
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    text += (text.empty() ? "" : ", ") + folder.string() + (is_there(folder) ? " (exists)" : "");
  }
  return text;
}

}  // namespace

Finding examine_names(const std::vector<fs::path>& folders) {
  const std::string what =
      "Scenes and arms are searched by name in this order: " + in_order(folders) + ".";
  if (std::any_of(folders.begin(), folders.end(),
                  [](const fs::path& folder) { return is_there(folder / "scenes"); })) {
    return {Health::kGood, what, {}};
  }
  return {Health::kAdvice, what, "Install the package thimble, or pass the paths of files"};
}

Finding examine_scans(const scene::ScanPlaces& places) {
  std::vector<fs::path> folders = places.folders;
  if (!places.unpacked.empty()) folders.push_back(places.unpacked);
  const std::string order = "; searched in this order: " + in_order(folders) + ".";
  for (const fs::path& folder : folders) {
    if (is_there(folder / kFirstScan)) {
      return {Health::kGood, "The scanned meshes are in " + folder.string() + order, {}};
    }
  }
  if (!places.archive.empty() && is_there(places.archive) && !is_there(places.unpacked)) {
    return {Health::kGood,
            "The scanned meshes in " + places.archive.string() + " are unpacked to " +
                places.unpacked.string() + " on first use" + order,
            {}};
  }
  return {Health::kAdvice, "The scanned meshes of some scenes are not installed" + order,
          "sudo apt install libcgal-demo, or run app/fetch_meshes.sh in the sources; a scene "
          "without them: thimble run water_balloon"};
}

}  // namespace thimble::bringup
