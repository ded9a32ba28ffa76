#include "thimble/render/mesh/load_mesh.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "mesh/file/read_off.h"
#include "mesh/file/read_ply.h"
#include "mesh/file/read_with_assimp.h"
#include "mesh/file/weld_mesh.h"

namespace thimble::render {
namespace {

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

driver::Result<TriangleMesh> load_mesh(const std::filesystem::path& file) {
  const auto error = [&file](const std::string& sentence) {
    return driver::Error{file.string() + ": " + sentence};
  };
  const std::string ending = ending_of(file);
  if (ending != "off" && ending != "obj" && ending != "stl" && ending != "ply") {
    return error("the ending \"" + ending + "\" is not known; give an OFF, OBJ, STL or PLY file.");
  }
  std::error_code status;
  if (!std::filesystem::exists(file, status)) return error("there is no such file.");
  if (!std::filesystem::is_regular_file(file, status)) {
    return error("this is not a file; give the mesh file itself.");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return error("the file cannot be opened; check its permissions.");
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) return error("reading the file failed.");

  if (ending == "off") {
    const auto mesh = read_off(bytes, file.string());
    if (!mesh) return mesh.error();
    return weld_mesh(*mesh);
  }
  const auto mesh = ending == "ply" ? read_ply(bytes) : read_with_assimp(bytes, ending);
  if (!mesh) return error(mesh.error().message);
  return weld_mesh(*mesh);
}

}  // namespace thimble::render
