#include "view/start/opened_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <system_error>

#include "thimble/render/mesh/mesh_file.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

/// Replaces %XX by the byte [RFC 3986].
std::string without_percents(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool code = text[i] == '%' && i + 2 < text.size() &&
                      std::isxdigit(static_cast<unsigned char>(text[i + 1])) != 0 &&
                      std::isxdigit(static_cast<unsigned char>(text[i + 2])) != 0;
    if (!code) {
      plain += text[i];
      continue;
    }
    plain += static_cast<char>(std::stoi(std::string(text.substr(i + 1, 2)), nullptr, 16));
    i += 2;
  }
  return plain;
}

std::optional<FileKind> kind_of(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (ending == ".yaml" || ending == ".yml") return FileKind::kScene;
  if (ending == ".h5" || ending == ".hdf5") return FileKind::kRecording;
  // As kMeshEndings.
  constexpr std::array kMeshes = {".off", ".obj", ".stl", ".ply", ".gltf",
                                  ".glb", ".3mf", ".dae", ".amf", ".3ds"};
  if (std::find(kMeshes.begin(), kMeshes.end(), ending) != kMeshes.end()) return FileKind::kMesh;
  return {};
}

}  // namespace

fs::path path_in(const std::string& text) {
  constexpr const char* kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return {};
  std::string path = text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
  if (path.size() > 1 && path.front() == path.back() &&
      (path.front() == '"' || path.front() == '\'')) {
    path = path.substr(1, path.size() - 2);
  }
  constexpr std::string_view kScheme = "file://";
  if (path.starts_with(kScheme)) {
    // A host may precede the path.
    const std::size_t slash = path.find('/', kScheme.size());
    path = slash == std::string::npos ? "" : without_percents(path.substr(slash));
  }
  const char* home = std::getenv("HOME");
  if (home != nullptr && (path == "~" || path.starts_with("~/"))) path = home + path.substr(1);
  return path;
}

driver::Result<OpenedFile> open_text(const std::string& text) {
  const fs::path named = path_in(text);
  if (named.empty()) {
    return driver::Error{"The path is empty. Type the path of a scene, a mesh or a recording."};
  }
  std::error_code status;
  if (fs::is_directory(named, status)) {
    return driver::Error{named.string() + " is a folder. Choose a file in it."};
  }
  if (!fs::exists(named, status)) {
    // A word may be the name of a scene.
    if (named.string().find('/') == std::string::npos) {
      if (const auto scene = scene::find_scene(named.string())) {
        return OpenedFile{fs::absolute(*scene).lexically_normal(), FileKind::kScene};
      }
    }
    return driver::Error{"There is no file " + named.string() + ". Check the path."};
  }
  const auto kind = kind_of(named);
  if (!kind) {
    return driver::Error{named.filename().string() +
                         ": this kind of file is unknown. Open a scene (.yaml), a recording (.h5) "
                         "or a mesh (" +
                         render::kMeshEndings + ")."};
  }
  return OpenedFile{fs::absolute(named).lexically_normal(), *kind};
}

}  // namespace thimble::view
