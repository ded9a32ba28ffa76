#include "mesh/file/assimp_scene.h"

#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "mesh/file/read_off.h"
#include "mesh/file/triangulate_polygon.h"

namespace thimble::render {
namespace {

using driver::Error;
using Eigen::Matrix4d;

// A node that is still to be visited, and its pose in the file's frame.
struct Stop {
  const aiNode* node = nullptr;
  Matrix4d place = Matrix4d::Identity();
};

Matrix4d matrix_of(const aiMatrix4x4& m) {
  Matrix4d matrix;
  matrix << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return matrix;
}

// Puts one part of a scene where its node stands.
driver::Result<void> append(const aiMesh& part, const Matrix4d& place, TriangleMesh& mesh) {
  const std::size_t first = mesh.vertices.size();
  if (first + part.mNumVertices > std::numeric_limits<std::int32_t>::max()) {
    return Error{"it has more than 2^31 - 1 vertices."};
  }
  const Eigen::Affine3d pose(place);
  const bool stays = place.isIdentity(0);
  const bool mirrored = pose.linear().determinant() < 0;
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    Eigen::Vector3d vertex(v.x, v.y, v.z);
    if (!stays) vertex = pose * vertex;
    for (const double x : vertex) {
      if (!(std::abs(x) <= kCoordinateMax)) {
        return Error{"vertex " + std::to_string(first + i) +
                     " has a coordinate that is not a number between -1e15 and 1e15."};
      }
    }
    mesh.vertices.push_back(vertex);
  }
  const std::size_t begin = mesh.triangles.size();
  std::vector<std::int32_t> corners;
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    corners.clear();
    for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
      if (face.mIndices[corner] >= part.mNumVertices) {
        return Error{"face " + std::to_string(f) + " names a vertex that does not exist."};
      }
      corners.push_back(static_cast<std::int32_t>(first + face.mIndices[corner]));
    }
    if (corners.size() >= 3) triangulate_polygon(mesh.vertices, corners, mesh.triangles);
  }
  for (std::size_t t = begin; mirrored && t < mesh.triangles.size(); ++t) {
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  return {};
}

void tell_what_is_left_out(const aiScene& scene, std::vector<std::string>& notes) {
  bool bones = false, lines = false;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    bones = bones || scene.mMeshes[i]->mNumBones > 0;
    lines = lines || (scene.mMeshes[i]->mPrimitiveTypes &
                      (aiPrimitiveType_POINT | aiPrimitiveType_LINE)) != 0;
  }
  if (bones || scene.mNumAnimations > 0) {
    notes.push_back("Bones and animations were left out: the mesh stands as at rest.");
  }
  if (lines) notes.push_back("Lines and points were left out: they cannot be touched.");
}

}  // namespace

driver::Result<TriangleMesh> mesh_of_scene(const aiScene& scene, std::vector<std::string>& notes) {
  TriangleMesh mesh;
  std::vector<Stop> stops;
  if (scene.mRootNode != nullptr) {
    stops.push_back({scene.mRootNode, matrix_of(scene.mRootNode->mTransformation)});
  }
  std::size_t moved = 0, parts = 0;
  while (!stops.empty()) {
    const Stop stop = stops.back();
    stops.pop_back();
    for (unsigned i = 0; i < stop.node->mNumMeshes; ++i) {
      const unsigned number = stop.node->mMeshes[i];
      if (number >= scene.mNumMeshes) return Error{"a node names a part that does not exist."};
      if (auto done = append(*scene.mMeshes[number], stop.place, mesh); !done) return done.error();
      ++parts;
      moved += !stop.place.isIdentity(0);
    }
    // The first child on top: parts stay in the file's order.
    for (unsigned i = stop.node->mNumChildren; i-- > 0;) {
      const aiNode* const child = stop.node->mChildren[i];
      stops.push_back({child, stop.place * matrix_of(child->mTransformation)});
    }
  }
  if (mesh.triangles.empty()) return Error{"it has no face with three corners."};
  if (moved > 0) {
    notes.push_back(std::to_string(moved) + " of " + std::to_string(parts) +
                    (parts == 1 ? " part was" : " parts were") +
                    " put where the file's nodes say.");
  }
  tell_what_is_left_out(scene, notes);
  return mesh;
}

}  // namespace thimble::render
