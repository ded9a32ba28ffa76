#include "thimble/render/mesh/mesh_file.h"

#include <fmt/core.h>

#include <fstream>
#include <string>
#include <system_error>

#include "mesh/file/off_text.h"

namespace thimble::render {
namespace {

bool write_off(const TriangleMesh& mesh, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << off_text(mesh);
  stream.close();
  return static_cast<bool>(stream);
}

}  // namespace

std::string off_text(const TriangleMesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  for (const Eigen::Vector3d& p : mesh.vertices) {
    text += fmt::format("{:.17g} {:.17g} {:.17g}\n", p.x(), p.y(), p.z());
  }
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

driver::Result<void> save_mesh(const TriangleMesh& mesh, const std::filesystem::path& file) {
  if (file.extension() != ".off") {
    return driver::Error{file.string() +
                         ": meshes are written as OFF; use a name that ends in .off."};
  }
  std::error_code status;
  // A symbolic link stays; its target is replaced.
  const std::filesystem::path target = std::filesystem::is_symlink(file, status)
                                           ? std::filesystem::weakly_canonical(file, status)
                                           : file;
  std::filesystem::path unfinished = target;
  unfinished.replace_extension(".thimble-part.off");
  if (!write_off(mesh, unfinished)) {
    std::filesystem::remove(unfinished, status);
    return driver::Error{file.string() +
                         ": the file cannot be written; check the folder and the free disk space."};
  }
  std::filesystem::rename(unfinished, target, status);
  if (status) {
    const std::string reason = status.message();
    std::filesystem::remove(unfinished, status);
    return driver::Error{file.string() + ": the file cannot be written: " + reason + "."};
  }
  return {};
}

}  // namespace thimble::render
