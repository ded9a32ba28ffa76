#include "mesh/file/mesh_kind.h"

#include <algorithm>

#include "mesh/file/package/zip_archive.h"
#include "mesh/file/read_stl.h"

namespace thimble::render {
namespace {

// Bytes searched for the first element of an XML file, behind comments.
constexpr std::size_t kXmlHead = 4096;

std::string kind_of_archive(std::string_view bytes) {
  const auto archive = ZipArchive::open(bytes);
  if (!archive) return "3mf";
  const auto names = archive->names();
  const bool amf = std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return name.ends_with(".amf") || name.ends_with(".AMF");
  });
  return amf ? "amf" : "3mf";
}

bool is_off(std::string_view word) {
  const std::string_view letters =
      word.substr(0, word.size() - std::min<std::size_t>(3, word.size()));
  return word.ends_with("OFF") && letters.find_first_not_of("STCN4n") == std::string_view::npos;
}

}  // namespace

std::string mesh_kind_of(std::string_view bytes, const std::string& ending) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  if (bytes.starts_with("glTF")) return "glb";
  if (bytes.starts_with("PK\3\4")) return kind_of_archive(bytes);
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return "ply";
  if (is_stl_binary(bytes) || is_stl_text(bytes)) return "stl";
  const std::string_view head = bytes.substr(0, kXmlHead);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return ending;
  const std::string_view begin = head.substr(first);
  if (begin[0] == '{') return "gltf";
  if (begin[0] == '<') {
    if (head.find("<COLLADA") != std::string_view::npos) return "dae";
    if (head.find("<amf") != std::string_view::npos) return "amf";
  }
  if (is_off(begin.substr(0, begin.find_first_of(" \t\r\n#")))) return "off";
  // A chunk that spans the whole file identifies 3DS.
  if (bytes.size() > 6 && bytes.starts_with("MM")) {
    std::size_t length = 0;
    for (std::size_t i = 6; i-- > 2;) length = length << 8 | static_cast<unsigned char>(bytes[i]);
    if (length == bytes.size()) return "3ds";
  }
  return ending;
}

}  // namespace thimble::render
