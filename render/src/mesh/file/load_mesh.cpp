#include "thimble/render/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "mesh/file/read_off.h"
#include "mesh/file/read_ply.h"
#include "mesh/file/read_with_assimp.h"
#include "mesh/file/stl_bytes.h"
#include "mesh/file/weld_mesh.h"
#include "system/regular_file.h"

namespace thimble::render {
namespace {

constexpr std::array<std::string_view, 10> kEndings{"off", "obj", "stl", "ply", "gltf",
                                                    "glb", "3mf", "dae", "amf", "3ds"};

// 80 million triangles of the tersest format (binary STL). [chosen: a file of this size takes four
// times as much memory as contact]
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30;

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

// Takes the byte order mark away that editors put before a text.
driver::Result<void> drop_mark(std::string& bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    return driver::Error{"this is a text of two bytes per letter (UTF-16): save it as UTF-8."};
  }
  return {};
}

driver::Result<TriangleMesh> read(std::string bytes, const std::string& ending,
                                  const std::filesystem::path& file, MeshFileInfo& info) {
  const bool is_text = ending == "off" || ending == "obj" || ending == "stl" || ending == "ply";
  if (is_text) {
    if (auto done = drop_mark(bytes); !done) return done.error();
  }
  if (ending == "off") return read_off(bytes, file.string());
  if (ending == "ply") return read_ply(bytes);
  if (ending == "stl") {
    if (auto done = put_stl_right(bytes, info.notes); !done) return done.error();
  }
  return read_with_assimp(bytes, ending, file.parent_path(), info);
}

}  // namespace

driver::Result<TriangleMesh> load_mesh(const std::filesystem::path& file, MeshFileInfo* info) {
  const auto error = [&file](const std::string& sentence) {
    return driver::Error{file.string() + ": " + sentence};
  };
  const std::string ending = ending_of(file);
  if (std::find(kEndings.begin(), kEndings.end(), ending) == kEndings.end()) {
    return error("the ending \"" + ending + "\" is not known; give an " + kMeshEndings + " file.");
  }
  auto bytes = driver::read_file(file, kMaxFileBytes);
  if (!bytes) return error(bytes.error().message);
  MeshFileInfo found;
  auto mesh = read(std::move(bytes).value(), ending, file, found);
  // What an OFF file is told of names file and line already.
  if (!mesh)
    return ending == "off" && mesh.error().message.starts_with(file.string())
               ? mesh.error()
               : error(mesh.error().message);
  if (info != nullptr) *info = std::move(found);
  return weld_mesh(std::move(mesh).value());
}

}  // namespace thimble::render
