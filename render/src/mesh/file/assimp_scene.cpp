#include "mesh/file/assimp_scene.h"

#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mesh/file/mesh_parts.h"
#include "mesh/file/triangulate_polygon.h"

namespace thimble::render {
namespace {

using driver::Error;
using Eigen::Matrix4d;

// A node to be visited, and its pose in the file's frame.
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

// Returns the triangles of one part of a scene, in its own frame.
driver::Result<TriangleMesh> part_of(const aiMesh& part) {
  TriangleMesh mesh;
  mesh.vertices.reserve(part.mNumVertices);
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    mesh.vertices.emplace_back(v.x, v.y, v.z);
  }
  std::vector<std::int32_t> corners;
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    corners.clear();
    for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
      if (face.mIndices[corner] >= part.mNumVertices) {
        return Error{"face " + std::to_string(f) + " refers to a vertex that does not exist."};
      }
      corners.push_back(static_cast<std::int32_t>(face.mIndices[corner]));
    }
    if (corners.size() >= 3 && !triangulate_polygon(mesh.vertices, corners, mesh.triangles)) {
      return Error{too_many_corners("face " + std::to_string(f), corners.size())};
    }
  }
  return mesh;
}

void note_omissions(const aiScene& scene, std::vector<std::string>& notes) {
  bool bones = false, lines = false;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    bones = bones || scene.mMeshes[i]->mNumBones > 0;
    lines = lines || (scene.mMeshes[i]->mPrimitiveTypes &
                      (aiPrimitiveType_POINT | aiPrimitiveType_LINE)) != 0;
  }
  if (bones || scene.mNumAnimations > 0) {
    notes.push_back("Bones and animations were ignored: the mesh is in its rest pose.");
  }
  if (lines) notes.push_back("Lines and points were ignored: only faces can be touched.");
}

}  // namespace

driver::Result<TriangleMesh> mesh_of_scene(const aiScene& scene, std::vector<std::string>& notes) {
  MeshParts parts;
  std::vector<Stop> stops;
  if (scene.mRootNode != nullptr) {
    stops.push_back({scene.mRootNode, matrix_of(scene.mRootNode->mTransformation)});
  }
  while (!stops.empty()) {
    const Stop stop = stops.back();
    stops.pop_back();
    for (unsigned i = 0; i < stop.node->mNumMeshes; ++i) {
      const unsigned number = stop.node->mMeshes[i];
      if (number >= scene.mNumMeshes) return Error{"a node refers to a part that does not exist."};
      const auto part = part_of(*scene.mMeshes[number]);
      if (!part) return part.error();
      if (auto added = parts.add(*part, Eigen::Affine3d(stop.place), true); !added) {
        return added.error();
      }
    }
    // The first child on top: parts stay in the file's order.
    for (unsigned i = stop.node->mNumChildren; i-- > 0;) {
      const aiNode* const child = stop.node->mChildren[i];
      stops.push_back({child, stop.place * matrix_of(child->mTransformation)});
    }
  }
  auto mesh = parts.take(notes);
  if (!mesh) return mesh;
  note_omissions(scene, notes);
  return mesh;
}

}  // namespace thimble::render
