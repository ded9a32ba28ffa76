#include "thimble/render/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "mesh/file/gltf/read_gltf.h"
#include "mesh/file/mesh_kind.h"
#include "mesh/file/package/read_3mf.h"
#include "mesh/file/read_obj.h"
#include "mesh/file/read_off.h"
#include "mesh/file/read_ply.h"
#include "mesh/file/read_stl.h"
#include "mesh/file/read_with_assimp.h"
#include "mesh/file/weld_mesh.h"
#include "system/regular_file.h"

namespace thimble::render {
namespace {

constexpr std::array<std::string_view, 10> kEndings{"off", "obj", "stl", "ply", "gltf",
                                                    "glb", "3mf", "dae", "amf", "3ds"};

// 80 million triangles of the most compact format (binary STL). [chosen: a file of this size takes
// four times as much memory as contact]
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30;

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::string capitals(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

// Removes the byte order mark that editors put before a text.
driver::Result<void> drop_mark(std::string& bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    return driver::Error{"the text is encoded as UTF-16; save it as UTF-8."};
  }
  return {};
}

driver::Result<TriangleMesh> read(std::string bytes, const std::string& kind,
                                  const std::filesystem::path& file, MeshFileInfo& info,
                                  MeshAttributes* attributes) {
  const bool is_text = kind == "off" || kind == "obj" || kind == "stl" || kind == "ply";
  if (is_text) {
    if (auto done = drop_mark(bytes); !done) return done.error();
  }
  if (kind == "off") return read_off(bytes, file.string());
  if (kind == "obj") return read_obj(bytes, file.string(), info.notes, attributes);
  if (kind == "ply") return read_ply(bytes, info.notes, attributes);
  if (kind == "stl") return read_stl(bytes, file.string(), info.notes);
  if (kind == "3mf") return read_3mf(bytes, info);
  if (kind == "gltf" || kind == "glb") {
    return read_gltf(bytes, kind, file.parent_path(), info, attributes);
  }
  return read_with_assimp(bytes, kind, info);
}

driver::Result<TriangleMesh> load(const std::filesystem::path& file, MeshFileInfo* info,
                                  MeshAttributes* attributes) {
  const auto error = [&file](const std::string& sentence) {
    // Errors of a line of text already name file and line.
    return driver::Error{
        sentence.starts_with(file.string() + ':') ? sentence : file.string() + ": " + sentence};
  };
  std::error_code status;
  if (std::filesystem::is_directory(file, status)) {
    return error(std::string("this is not a file but a folder; expected an ") + kMeshEndings +
                 " file.");
  }
  const std::string ending = ending_of(file);
  if (std::find(kEndings.begin(), kEndings.end(), ending) == kEndings.end()) {
    return error("unknown file extension \"" + ending + "\"; expected an " + kMeshEndings +
                 " file.");
  }
  auto bytes = driver::read_file(file, kMaxFileBytes);
  if (!bytes) return error(bytes.error().message);
  MeshFileInfo found;
  found.kind = mesh_kind_of(*bytes, ending);
  if (found.kind != ending) {
    found.notes.push_back("Its contents are " + capitals(found.kind) +
                          ", so the extension was ignored.");
  }
  auto mesh = read(std::move(bytes).value(), found.kind, file, found, attributes);
  if (!mesh) return error(mesh.error().message);
  found.kind = capitals(found.kind);
  if (info != nullptr) *info = std::move(found);
  // Welding keeps the triangles and their corners in place.
  return weld_mesh(std::move(mesh).value());
}

}  // namespace

driver::Result<TriangleMesh> load_mesh(const std::filesystem::path& file, MeshFileInfo* info) {
  return load(file, info, nullptr);
}

driver::Result<TriangleMesh> load_mesh_with_attributes(const std::filesystem::path& file,
                                                       MeshAttributes& attributes,
                                                       MeshFileInfo* info) {
  attributes = {};
  return load(file, info, &attributes);
}

}  // namespace thimble::render
