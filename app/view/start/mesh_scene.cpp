#include "view/start/mesh_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <system_error>

#include "meshes/object_mesh.h"
#include "output/output_file.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shipped_files.h"
#include "user_folders.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

// Thickness of the open parts of a mesh, as a share of its size [chosen: a sheet that a fingertip
// does not pass through].
constexpr double kSheetShare = 0.03;

// A saved scene never replaces a file.
const output::OutputKind kSavedScene{.name = "a new scene",
                                     .matches = [](const fs::path&) { return false; },
                                     .existing = output::Existing::kKeep};

/// Returns a text in double quotes, as in YAML.
std::string quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    if (static_cast<unsigned char>(letter) < 0x20) {
      quoted += fmt::format("\\x{:02X}", static_cast<unsigned>(letter));
    } else {
      quoted += letter;
    }
  }
  return quoted + '"';
}

const char* rotation_of(char up) {
  return up == 'y'   ? "    rotate_degrees: [[x, 90]]     # y is up in the file\n"
         : up == 'x' ? "    rotate_degrees: [[y, -90]]    # x is up in the file\n"
                     : "";
}

std::string text_of_scene(const fs::path& mesh, const MeshTouch& touch, const std::string& extra) {
  // Places of the hand: over the mesh, and down onto its upper side [chosen].
  const double over = 0.5 * touch.size + 0.02;
  const double side = 0.15 * touch.size;
  return fmt::format(
      "# Made by the start window from a mesh file. All values are SI: m, s, N/m, N s/m.\n"
      "name: {0}\n"
      "description: {1}\n"
      "arm: vintage_phantom\n"
      "duration: 8\n"
      "\n"
      "objects:\n"
      "  - name: mesh\n"
      "    mesh: {2}\n"
      "    size: {3:.6g}                     # largest side of its box\n"
      "{4}"
      "    position: [0, 0, 0]           # centre of its box\n"
      "    stiffness: {5:.6g}\n"
      "    damping: 1\n"
      "{6}"
      "\n"
      "# A hand strokes the upper side. In the window, your own hand replaces it.\n"
      "hand:\n"
      "  path:\n"
      "    - {{t: 0, at: [{7:.4g}, 0, {8:.4g}]}}\n"
      "    - {{t: 1.5, on: mesh, near: [{7:.4g}, 0, {8:.4g}], press: 0.003}}\n"
      "    - {{t: 3.5, on: mesh, near: [-{7:.4g}, 0, {8:.4g}], press: 0.004}}\n"
      "    - {{t: 5, on: mesh, near: [0, {7:.4g}, {8:.4g}], press: 0.003}}\n"
      "    - {{t: 6.5, on: mesh, near: [0, -{7:.4g}, {8:.4g}], press: 0.004}}\n"
      "    - {{t: 8, at: [0, 0, {9:.4g}]}}\n",
      quoted(mesh.stem().string()),
      quoted("A hand strokes the mesh " + mesh.filename().string() + "."), quoted(mesh.string()),
      touch.size, rotation_of(touch.up), touch.stiffness, extra, side, over, over + 0.01);
}

}  // namespace

fs::path draft_of(const fs::path& mesh) {
  return scene::state_folder() / "start" / (scene::as_file_name(mesh.stem().string()) + ".yaml");
}

driver::Result<MeshTouch> suggest_touch(const fs::path& mesh) {
  render::MeshFileInfo info;
  const auto loaded = render::load_mesh(mesh, &info);
  if (!loaded) return loaded.error();
  MeshTouch touch;
  // OBJ has no axis; most programs write it with y up.
  touch.up = info.up != 0 ? info.up : info.kind == "OBJ" ? 'y' : 'z';
  if (!info.unit || loaded->vertices.empty()) return touch;
  Eigen::Vector3d min = loaded->vertices.front(), max = min;
  for (const Eigen::Vector3d& p : loaded->vertices) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  const double side = *info.unit * (max - min).maxCoeff();
  if (side >= kMeshSizeMin && side <= kMeshSizeMax) touch.size = side;
  return touch;
}

driver::Result<MeshScene> make_mesh_scene(const fs::path& mesh, const MeshTouch& touch,
                                          const fs::path& draft) {
  const std::array<std::string, 3> extras = {
      "", "    repair: true\n",
      fmt::format("    repair: true\n    open: {{thickness: {:.4g}}}\n", kSheetShare * touch.size)};
  std::error_code status;
  fs::create_directories(draft.parent_path(), status);
  std::string fault;
  for (const std::string& extra : extras) {
    MeshScene made{mesh.stem().string(), text_of_scene(mesh, touch, extra), {}};
    if (auto written = output::write_file(draft, output::kPlainText, made.text); !written) {
      return written.error();
    }
    const auto read = scene::load_scene(draft);
    if (!read) return read.error();
    const auto object = scene::load_object_mesh(read->objects.front());
    if (!object) {
      if (fault.empty()) fault = object.error().message;
      continue;
    }
    const render::MeshFindings findings = render::check_mesh(object->mesh_W);
    if (findings.touchable()) {
      made.notes = object->notes;
      return made;
    }
    // The first fault is that of the mesh as it is.
    if (fault.empty() && !findings.faults.empty()) {
      fault = mesh.string() + ": " + render::describe(findings.faults.front());
    }
  }
  return driver::Error{fault.empty() ? mesh.string() + ": the mesh cannot be touched." : fault};
}

driver::Result<fs::path> save_mesh_scene(const MeshScene& scene, const std::string& name) {
  const bool blank = std::all_of(name.begin(), name.end(),
                                 [](unsigned char letter) { return std::isspace(letter) != 0; });
  if (blank) return driver::Error{"The name is empty. Type a name for the scene."};
  const fs::path folder = scene::data_folder() / "scenes";
  const std::string stem = scene::as_file_name(name);
  const fs::path file = folder / (stem + ".yaml");
  // A scene of the user takes precedence over one of Thimble with its name.
  for (const scene::ShippedFile& known : scene::shipped_scenes()) {
    if (known.name == stem && known.path.parent_path() != folder) {
      return driver::Error{"Thimble has a scene " + stem + ". Choose another name."};
    }
  }
  std::error_code status;
  fs::create_directories(folder, status);
  if (fs::exists(file, status)) {
    return driver::Error{file.string() + " already exists. Choose another name."};
  }
  if (auto written = output::write_file(file, kSavedScene, scene.text); !written) {
    return written.error();
  }
  return file;
}

}  // namespace thimble::view
