#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "support/scratch.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {

/// Folder of the tests' small meshes.
inline const std::filesystem::path kMeshFolder =
    std::filesystem::path(THIMBLE_TEST_DATA) / "meshes";

/// Returns the bytes of a file.
inline std::string bytes_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Writes a file of this name into a folder that only the tests use. Returns its path.
inline std::filesystem::path write_mesh_file(const std::string& name, const std::string& bytes) {
  const std::filesystem::path file = support::scratch_folder() / "mesh_text" / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

/// Returns the mesh of a file with these bytes.
inline driver::Result<TriangleMesh> load_text(const std::string& name, const std::string& bytes,
                                              MeshFileInfo* info = nullptr) {
  return load_mesh(write_mesh_file(name, bytes), info);
}

/// Returns the error for a file with these bytes, without its folder; "read" if it is accepted.
inline std::string refusal(const std::string& name, const std::string& bytes) {
  const auto mesh = load_text(name, bytes);
  if (mesh) return "read";
  const std::string& whole = mesh.error().message;
  const std::size_t begin = whole.find(name);
  return begin == std::string::npos ? whole : whole.substr(begin);
}

}  // namespace thimble::render
