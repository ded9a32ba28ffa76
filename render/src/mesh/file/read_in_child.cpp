#include "mesh/file/read_in_child.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <functional>
#include <sstream>
#include <string>

namespace thimble::render {
namespace {

constexpr int kSecondsMin = 2;
constexpr std::size_t kBytesPerSecond = 500'000;
constexpr std::size_t kMemoryMin = std::size_t{1} << 30;
constexpr std::size_t kMemoryPerByte = 200;

// Writes the error sentence, or an empty one, the information of the file, the mesh, and its
// attributes if they are read.
void write_mesh(const driver::Result<TriangleMesh>& mesh, const MeshFileInfo& info,
                const MeshAttributes* attributes, driver::SandboxWriter& out) {
  const std::string error = mesh ? std::string() : mesh.error().message;
  out.write_array(error.data(), error.size());
  if (!mesh) return;
  std::string lines;
  for (const std::string& note : info.notes) lines += note + '\n';
  out.write_array(lines.data(), lines.size());
  const double unit = info.unit.value_or(0);
  out.write(&unit, sizeof unit);
  out.write(&info.up, sizeof info.up);
  out.write_array(mesh->vertices.data(), mesh->vertices.size());
  out.write_array(mesh->triangles.data(), mesh->triangles.size());
  if (attributes == nullptr) return;
  out.write_array(attributes->uv.data(), attributes->uv.size());
  out.write_array(attributes->colours.data(), attributes->colours.size());
}

// Returns whether a list of attributes is empty or has an entry per triangle.
template <class Values>
bool fits(const Values& values, const TriangleMesh& mesh) {
  return values.empty() || values.size() == mesh.triangles.size();
}

// Returns whether each triangle names existing vertices.
bool has_its_vertices(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int32_t>(mesh.vertices.size());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [count](const auto& triangle) {
    return std::all_of(triangle.begin(), triangle.end(),
                       [count](std::int32_t vertex) { return vertex >= 0 && vertex < count; });
  });
}

}  // namespace

driver::SandboxLimits limits_of(std::size_t bytes) {
  return {.seconds = kSecondsMin + static_cast<int>(bytes / kBytesPerSecond),
          .bytes = kMemoryMin + kMemoryPerByte * bytes};
}

driver::Error unreadable(const std::string& kind, const std::string& reason) {
  std::string capitals = kind;
  std::transform(capitals.begin(), capitals.end(), capitals.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return {"the " + capitals + " file could not be read (" + reason + ")."};
}

driver::Result<TriangleMesh> read_in_child(const MeshReader& read, const std::string& kind,
                                           const driver::SandboxLimits& limits, MeshFileInfo& info,
                                           MeshAttributes* attributes) {
  const std::function<void(driver::SandboxWriter&)> work =
      [&read, attributes](driver::SandboxWriter& out) {
        MeshFileInfo found;
        const auto mesh = read(found);
        write_mesh(mesh, found, attributes, out);
      };
  const auto done = driver::run_in_sandbox(work, limits);
  if (!done) return unreadable(kind, "it " + done.error().message);
  driver::SandboxReader in(done->bytes());
  const driver::Error broken = unreadable(kind, "it crashes its reader");
  std::string error, notes;
  double unit = 0;
  TriangleMesh mesh;
  if (!in.take_array(error)) return broken;
  if (!error.empty()) return driver::Error{error};
  if (!in.take_array(notes) || !in.take(&unit, sizeof unit) || !in.take(&info.up, sizeof info.up) ||
      !in.take_array(mesh.vertices) || !in.take_array(mesh.triangles) || !has_its_vertices(mesh)) {
    return broken;
  }
  if (attributes != nullptr &&
      (!in.take_array(attributes->uv) || !in.take_array(attributes->colours) ||
       !fits(attributes->uv, mesh) || !fits(attributes->colours, mesh))) {
    return broken;
  }
  std::istringstream lines(notes);
  for (std::string line; std::getline(lines, line);) info.notes.push_back(line);
  if (unit > 0) info.unit = unit;
  return mesh;
}

}  // namespace thimble::render
