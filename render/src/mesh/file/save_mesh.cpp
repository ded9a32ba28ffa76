#include "thimble/render/mesh/mesh_file.h"

#include <fmt/core.h>

#include <fstream>
#include <string>
#include <system_error>

namespace thimble::render {
namespace {

bool write_off(const TriangleMesh& mesh, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (const Eigen::Vector3d& p : mesh.vertices) {
    stream << fmt::format("{:.17g} {:.17g} {:.17g}\n", p.x(), p.y(), p.z());
  }
  for (const auto& [a, b, c] : mesh.triangles) stream << "3 " << a << ' ' << b << ' ' << c << '\n';
  stream.close();
  return static_cast<bool>(stream);
}

}  // namespace

driver::Result<void> save_mesh(const TriangleMesh& mesh, const std::filesystem::path& file) {
  if (file.extension() != ".off") {
    return driver::Error{file.string() + ": a mesh is written as OFF; let the name end in .off."};
  }
  std::filesystem::path unfinished = file;
  unfinished += ".part";
  std::error_code status;
  if (!write_off(mesh, unfinished)) {
    std::filesystem::remove(unfinished, status);
    return driver::Error{file.string() +
                         ": the file cannot be written; check the folder and the space left."};
  }
  std::filesystem::rename(unfinished, file, status);
  if (status) {
    const std::string reason = status.message();
    std::filesystem::remove(unfinished, status);
    return driver::Error{file.string() + ": the file cannot be written: " + reason + "."};
  }
  return {};
}

}  // namespace thimble::render
