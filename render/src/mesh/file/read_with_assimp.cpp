#include "mesh/file/read_with_assimp.h"

#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <sstream>
#include <utility>
#include <vector>

#include "mesh/file/assimp_scene.h"
#include "mesh/file/file_unit.h"
#include "mesh/file/folder_files.h"
#include "mesh/file/zip_entry.h"
#include "system/run_apart.h"

namespace thimble::render {
namespace {

using driver::Error;

// What reading may use: twenty times what the slowest format (OBJ) took of time per byte, and four
// times what the hungriest (AMF) took of memory; files that need more are not what they seem.
constexpr int kSecondsLeast = 2;
constexpr std::size_t kBytesPerSecond = 500'000;
constexpr std::size_t kMemoryLeast = std::size_t{1} << 30;
constexpr std::size_t kMemoryPerByte = 200;

// What the root element of a 3MF model fits in, comments before it included.
constexpr std::size_t kModelHead = 16'384;

std::string capitals(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

// Returns why Assimp refused a file, without what it says about itself.
std::string reason_of(std::string reason) {
  if (const auto name = reason.find(" for mesh."); name != std::string::npos) reason.resize(name);
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  while (!reason.empty() && (reason.back() == ' ' || reason.back() == '.')) reason.pop_back();
  for (char& c : reason) {
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  }
  return reason.substr(0, 200);
}

// Leaves the importers of one ending: all others stay out of reach of a file's bytes.
void keep_importers(Assimp::Importer& importer, const std::string& ending) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    std::istringstream endings(importer.GetImporterInfo(i)->mFileExtensions);
    bool reads = false;
    for (std::string word; endings >> word;) reads = reads || word == ending;
    if (!reads) importer.UnregisterLoader(importer.GetImporter(i));
  }
}

driver::Result<TriangleMesh> import_mesh(const std::string& bytes, const std::string& ending,
                                         const std::filesystem::path& folder,
                                         std::vector<std::string>& notes) {
  const std::string name = "mesh." + ending;
  const auto refused = [&ending](const std::string& reason) {
    return Error{"this is no " + capitals(ending) + " file that can be read (" + reason_of(reason) +
                 ")."};
  };
  try {
    Assimp::Importer importer;
    keep_importers(importer, ending);
    // Axes stay the file's own.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    const bool beside = ending == "gltf" || ending == "glb";
    importer.SetIOHandler(new FolderFiles(bytes, name, beside ? folder : ""));
    const aiScene* const scene = importer.ReadFile(name, 0);
    if (scene == nullptr) {
      const std::string reason = importer.GetErrorString();
      if (reason.find("bad_alloc") != std::string::npos)
        throw std::bad_alloc();  // Assimp caught it
      return refused(reason);
    }
    if (ending == "3ds" && scene->mRootNode != nullptr) {
      // Assimp lays y upwards; in the file z points there.
      const aiMatrix4x4 back(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
      scene->mRootNode->mTransformation = back * scene->mRootNode->mTransformation;
    }
    return mesh_of_scene(*scene, notes);
  } catch (const std::bad_alloc&) {
    throw;  // too little memory is told by who set the limit
  } catch (const std::exception& exception) {
    return refused(exception.what());
  }
}

// What the reading process hands over: a sentence that says why not, or notes and a mesh.
class Parcel {
 public:
  explicit Parcel(std::string bytes = {}) : bytes_(std::move(bytes)) {}

  template <class Item>
  void put(const Item* items, std::size_t count) {
    const std::uint64_t size = count;
    bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes_.append(reinterpret_cast<const char*>(items), count * sizeof(Item));
  }
  void put(const std::string& text) { put(text.data(), text.size()); }

  template <class Item>
  std::vector<Item> take() {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes_.data() + at_, sizeof size);
    at_ += sizeof size;
    std::vector<Item> items(size);
    if (size > 0)
      std::memcpy(static_cast<void*>(items.data()), bytes_.data() + at_, size * sizeof(Item));
    at_ += size * sizeof(Item);
    return items;
  }
  std::string take_text() {
    const std::vector<char> text = take<char>();
    return {text.begin(), text.end()};
  }

  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

std::string parcel_of(const driver::Result<TriangleMesh>& mesh,
                      const std::vector<std::string>& notes) {
  Parcel parcel;
  parcel.put(mesh ? std::string() : mesh.error().message);
  if (!mesh) return parcel.bytes();
  std::string lines;
  for (const std::string& note : notes) lines += note + '\n';
  parcel.put(lines);
  parcel.put(mesh->vertices.data(), mesh->vertices.size());
  parcel.put(mesh->triangles.data(), mesh->triangles.size());
  return std::move(parcel.bytes());
}

driver::Result<void> read_unit(const std::string& bytes, const std::string& ending,
                               MeshFileInfo& info) {
  if (ending == "3ds") info.up = 'z';
  if (ending == "gltf" || ending == "glb" || ending == "dae") {
    info.unit = 1;
    info.up = ending == "dae" ? up_axis_of_dae(bytes) : 'y';
  } else if (ending == "3mf" || ending == "amf") {
    info.unit = ending == "amf"
                    ? unit_of_model(bytes, "amf")
                    : unit_of_model(begin_of_zip_entry(bytes, ".model", kModelHead), "model");
    if (!info.unit) return Error{"it counts in a unit that its format does not know."};
  }
  return {};
}

}  // namespace

driver::Result<TriangleMesh> read_with_assimp(const std::string& bytes, const std::string& ending,
                                              const std::filesystem::path& folder,
                                              MeshFileInfo& info) {
  if (bytes.empty()) return Error{"the file is empty."};
  if (auto unit = read_unit(bytes, ending, info); !unit) return unit.error();
  const driver::ApartLimits limits{
      .seconds = kSecondsLeast + static_cast<int>(bytes.size() / kBytesPerSecond),
      .bytes = kMemoryLeast + kMemoryPerByte * bytes.size()};
  const auto read = driver::run_apart(
      [&] {
        std::vector<std::string> notes;
        const auto mesh = import_mesh(bytes, ending, folder, notes);
        return parcel_of(mesh, notes);
      },
      limits);
  if (!read) {
    return Error{"this is no " + capitals(ending) + " file that can be read (it " +
                 read.error().message + ")."};
  }
  Parcel parcel(std::move(read).value());
  if (const std::string error = parcel.take_text(); !error.empty()) return Error{error};
  std::istringstream lines(parcel.take_text());
  for (std::string line; std::getline(lines, line);) info.notes.push_back(line);
  TriangleMesh mesh;
  mesh.vertices = parcel.take<Eigen::Vector3d>();
  mesh.triangles = parcel.take<std::array<std::int32_t, 3>>();
  return mesh;
}

}  // namespace thimble::render
