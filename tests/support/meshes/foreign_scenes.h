#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "mesh/contact_mesh.h"
#include "mesh/overlapping_parts.h"
#include "support/meshes/solid_triangles.h"
#include "support/random.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/repair_mesh.h"

namespace thimble::support {

/// A mesh file that contact accepts, in its own unit.
struct ForeignMesh {
  std::filesystem::path file;
  render::TriangleMesh mesh;
  bool repaired = false;  ///< Accepted with `repair: true` only.
  std::size_t parts = 1;  ///< Parts of the mesh that are separate solids.
  bool inverted = false;  ///< Has faces with the outside behind them.
};

/// All meshes of a folder and of the folders in it.
struct ForeignMeshes {
  std::vector<ForeignMesh> meshes;
  int files = 0;      ///< Files with the ending of a mesh.
  int refused = 0;    ///< Files that cannot be read or touched, also after a repair.
  int too_large = 0;  ///< Files with more than `triangles_max` triangles.
};

/// Reads all mesh files below `folder`, in the order of their names.
inline ForeignMeshes read_foreign_meshes(const std::filesystem::path& folder,
                                         std::size_t triangles_max) {
  constexpr std::array kEndings{".off", ".obj", ".stl", ".ply", ".gltf",
                                ".glb", ".3mf", ".dae", ".amf", ".3ds"};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    std::string ending = entry.path().extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end()) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  ForeignMeshes all;
  for (const auto& file : files) {
    ++all.files;
    auto mesh = render::load_mesh(file);
    if (!mesh) {
      ++all.refused;
      continue;
    }
    if (mesh->triangles.size() > triangles_max) {
      ++all.too_large;
      continue;
    }
    ForeignMesh one{.file = file, .mesh = std::move(mesh).value()};
    if (!render::ContactMesh::build(one.mesh)) {
      one.mesh = render::repair_mesh(one.mesh).mesh;
      one.repaired = true;
      if (one.mesh.triangles.size() > triangles_max || !render::ContactMesh::build(one.mesh)) {
        ++all.refused;
        continue;
      }
    }
    one.inverted = SolidTriangles({one.mesh}).has_inverted_faces();
    one.parts = std::max<std::size_t>(1, render::overlapping_parts(one.mesh).size());
    all.meshes.push_back(std::move(one));
  }
  return all;
}

/// An object of a scene, as the keys of a scene file name it.
struct ForeignObject {
  const ForeignMesh* source = nullptr;
  double size = 0;                    ///< m
  std::array<double, 3> degrees{};    ///< About x, then y, then z.
  Eigen::Vector3d position{0, 0, 0};  ///< m, of the middle of its box.
  double stiffness = 0;               ///< N/m

  /// Returns the mesh in W, placed as a scene places it.
  render::TriangleMesh mesh() const {
    const Eigen::Matrix3d R = (Eigen::AngleAxisd(radians(2), Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(radians(1), Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(radians(0), Eigen::Vector3d::UnitX()))
                                  .toRotationMatrix();
    Eigen::AlignedBox3d file_box, turned_box;
    for (const Eigen::Vector3d& p : source->mesh.vertices) {
      file_box.extend(p);
      turned_box.extend(R * p);
    }
    const double scale = size / file_box.sizes().maxCoeff();
    return render::placed(source->mesh, scale, R, position - scale * turned_box.center());
  }

  std::string yaml(std::size_t number) const {
    std::ostringstream text;
    text.precision(17);
    text << "  - name: o" << number << "\n    mesh: " << source->file.string()
         << (source->repaired ? "\n    repair: true" : "") << "\n    size: " << size
         << "\n    rotate_degrees: [[x, " << degrees[0] << "], [y, " << degrees[1] << "], [z, "
         << degrees[2] << "]]\n    position: [" << position.x() << ", " << position.y() << ", "
         << position.z() << "]\n    stiffness: " << stiffness << "\n";
    return text.str();
  }

 private:
  double radians(std::size_t axis) const { return degrees[axis] * std::numbers::pi / 180; }
};

/// Draws a scene with 2 to 20 overlapping solids. Its first object is the given mesh; if that has
/// several parts, it may be the only one.
inline std::vector<ForeignObject> draw_foreign_scene(const ForeignMesh& first,
                                                     const std::vector<ForeignMesh>& meshes,
                                                     std::size_t triangles_max, Random& random) {
  constexpr std::size_t kSolidsMax = 20;
  const double spread = random.uniform(0.005, 0.02);
  const bool equal = random.uniform(0, 1) < 0.5;
  std::vector<ForeignObject> objects;
  std::size_t solids = 0, triangles = 0;
  const auto add = [&](const ForeignMesh& mesh, const Eigen::Vector3d& position) {
    ForeignObject object{.source = &mesh, .size = random.uniform(0.015, 0.05)};
    // Some stand on the axes, so that faces of copies are parallel.
    const bool turned = random.uniform(0, 1) < 0.6;
    for (double& angle : object.degrees) {
      angle = turned ? random.uniform(-180, 180) : 90 * std::floor(random.uniform(0, 4));
    }
    object.position = position;
    object.stiffness = equal ? 800 : random.uniform(200, 1000);
    solids += mesh.parts;
    triangles += mesh.mesh.triangles.size();
    objects.push_back(object);
  };
  add(first, {0, 0, 0});
  if (first.parts >= 2 && random.uniform(0, 1) < 0.5) {
    objects[0].size = 0.05;
    return objects;
  }
  const auto count = static_cast<std::size_t>(random.uniform(2, kSolidsMax + 1));
  const bool copies = random.uniform(0, 1) < 0.4;
  for (int attempt = 0; objects.size() < count && attempt < 100; ++attempt) {
    const ForeignMesh& next = copies ? first : meshes[random.bits() % meshes.size()];
    const bool fits = solids + next.parts <= kSolidsMax &&
                      triangles + next.mesh.triangles.size() <= triangles_max;
    if (fits || objects.size() < 2) add(next, random.in_box(spread));
  }
  return objects;
}

}  // namespace thimble::support
