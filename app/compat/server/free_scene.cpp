#include "compat/server/free_scene.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include "thimble/scene/shipped_files.h"

namespace thimble::compat {

driver::Result<std::unique_ptr<FreeScene>> FreeScene::make(const std::string& arm) {
  const auto found = scene::find_arm_file(arm.empty() ? "vintage_phantom" : arm);
  if (!found) return found.error();
  std::error_code status;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(status);
  std::string pattern = (folder / "thimble-free-XXXXXX.yaml").string();
  const int file = mkostemps(pattern.data(), 5, O_CLOEXEC);
  if (file < 0) {
    return driver::Error{"Cannot create a file in " + folder.string() +
                         ". Free some space there, or set TMPDIR to another folder."};
  }
  close(file);
  std::unique_ptr<FreeScene> scene(new FreeScene(pattern));
  std::ofstream text(scene->file_);
  // A field of strength zero, because a scene needs at least one object.
  text << fmt::format(
      "name: free\n"
      "description: Nothing to touch.\n"
      "arm: \"{}\"\n"
      "duration: 1\n"
      "objects:\n"
      "  - {{name: nothing, field: viscous, damping: 0}}\n"
      "hand:\n"
      "  path:\n"
      "    - {{t: 0, at: [0, 0, 0]}}\n",
      std::filesystem::absolute(*found).string());
  text.close();
  if (!text)
    return driver::Error{scene->file_.string() +
                         ": cannot be written. Check whether the disk is full."};
  return scene;
}

FreeScene::~FreeScene() {
  std::error_code status;
  std::filesystem::remove(file_, status);
}

}  // namespace thimble::compat
