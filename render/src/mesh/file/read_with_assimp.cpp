#include "mesh/file/read_with_assimp.h"

#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>

#include "mesh/file/read_off.h"
#include "mesh/file/triangulate_polygon.h"

namespace thimble::render {
namespace {

using driver::Error;

driver::Result<void> append(const aiMesh& part, TriangleMesh& mesh) {
  const std::size_t first = mesh.vertices.size();
  if (first + part.mNumVertices > std::numeric_limits<std::int32_t>::max()) {
    return Error{"it has more than 2^31 - 1 vertices."};
  }
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    const Eigen::Vector3d vertex(v.x, v.y, v.z);
    for (const double x : vertex) {
      if (!(std::abs(x) <= kCoordinateMax)) {
        return Error{"vertex " + std::to_string(first + i) +
                     " has a coordinate that is not a number between -1e15 and 1e15."};
      }
    }
    mesh.vertices.push_back(vertex);
  }
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
  return {};
}

// Tells why Assimp refused a file, without the name that it gives to files in memory.
Error cannot_read(std::string ending, std::string reason) {
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (const auto name = reason.find(" for $$$"); name != std::string::npos) reason.resize(name);
  while (!reason.empty() && (reason.back() == '\n' || reason.back() == '.')) reason.pop_back();
  return Error{"this is no " + ending + " file that can be read (" + reason + ")."};
}

}  // namespace

driver::Result<TriangleMesh> read_with_assimp(std::string_view bytes, const std::string& ending) {
  if (bytes.empty()) return Error{"the file is empty."};
  try {
    Assimp::Importer importer;
    const aiScene* scene =
        importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, ending.c_str());
    if (scene == nullptr) {
      return cannot_read(ending, importer.GetErrorString());
    }
    TriangleMesh mesh;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
      if (auto appended = append(*scene->mMeshes[i], mesh); !appended) return appended.error();
    }
    if (mesh.triangles.empty()) return Error{"it has no face with three corners."};
    return mesh;
  } catch (const std::exception& exception) {
    return cannot_read(ending, exception.what());
  }
}

}  // namespace thimble::render
