#include "mesh/file/read_with_assimp.h"

#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <exception>
#include <new>
#include <sstream>
#include <string_view>
#include <vector>

#include "mesh/file/assimp_scene.h"
#include "mesh/file/file_unit.h"
#include "mesh/file/folder_files.h"
#include "mesh/file/package/xml_tags.h"
#include "mesh/file/package/zip_archive.h"
#include "mesh/file/read_in_child.h"

namespace thimble::render {
namespace {

using driver::Error;

// Returns the reason why Assimp refused a file, without Assimp's own names.
std::string reason_of(std::string reason) {
  if (const auto name = reason.find(" for mesh."); name != std::string::npos) reason.resize(name);
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  while (!reason.empty() && (reason.back() == ' ' || reason.back() == '.')) reason.pop_back();
  for (char& c : reason) {
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  }
  return reason.substr(0, 200);
}

// Keeps only the importers of one ending: a file's bytes cannot reach any others.
void keep_importers(Assimp::Importer& importer, const std::string& ending) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    std::istringstream endings(importer.GetImporterInfo(i)->mFileExtensions);
    bool reads = false;
    for (std::string word; endings >> word;) reads = reads || word == ending;
    if (!reads) importer.UnregisterLoader(importer.GetImporter(i));
  }
}

// Returns whether the text of a DAE file has a controller that morphs a mesh.
bool has_morph_controller(std::string_view text) {
  XmlTags tags(text);
  XmlTag tag;
  while (tags.next(tag)) {
    if (tag.opens && tag.name == "morph") return true;
  }
  return false;
}

// Returns the text of an AMF file, which may be packed.
driver::Result<std::string> unpacked_amf(const std::string& bytes) {
  const auto archive = ZipArchive::open(bytes);
  if (!archive) return unreadable("amf", "its archive " + archive.error().message);
  for (const std::string& name : archive->names()) {
    if (!name.ends_with(".amf") && !name.ends_with(".AMF")) continue;
    auto text = archive->read(name);
    if (!text) return unreadable("amf", "its archive " + text.error().message);
    if (text->starts_with("PK")) break;  // an archive in an archive
    return text;
  }
  return unreadable("amf", "its archive has no AMF file");
}

driver::Result<TriangleMesh> read_file(const std::string& bytes, const std::string& ending,
                                       MeshFileInfo& info) {
  if (ending == "amf" && bytes.starts_with("PK")) {
    const auto text = unpacked_amf(bytes);
    return text ? read_file(*text, ending, info) : text.error();
  }
  if (ending == "3ds") info.up = 'z';
  if (ending == "dae") {
    // Assimp 5.2.5 omits them, with the mesh that they move.
    if (has_morph_controller(bytes)) {
      return Error{
          "it has a morph controller, which is not supported in DAE. Export the mesh without it."};
    }
    info.unit = 1;
    info.up = up_axis_of_dae(bytes);
  } else if (ending == "amf") {
    info.unit = unit_of_model(bytes, "amf");
    if (!info.unit) return Error{"it uses an unknown length unit."};
  }
  return import_by_assimp(bytes, ending, "", info.notes);
}

}  // namespace

driver::Result<TriangleMesh> import_by_assimp(const std::string& bytes, const std::string& ending,
                                              const std::filesystem::path& folder,
                                              std::vector<std::string>& notes) {
  const std::string name = "mesh." + ending;
  const auto refused = [&ending](const std::string& reason) {
    return unreadable(ending, reason_of(reason));
  };
  try {
    Assimp::Importer importer;
    keep_importers(importer, ending);
    // Keeps the file's axes.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    // A file without a mesh must not become a mesh of its bones.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
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
      // Assimp turns y upwards; in the file z is up.
      const aiMatrix4x4 back(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
      scene->mRootNode->mTransformation = back * scene->mRootNode->mTransformation;
    }
    return mesh_of_scene(*scene, notes);
  } catch (const std::bad_alloc&) {
    throw;  // the process that set the limit reports lack of memory
  } catch (const std::exception& exception) {
    return refused(exception.what());
  }
}

driver::Result<TriangleMesh> read_with_assimp(const std::string& bytes, const std::string& ending,
                                              MeshFileInfo& info) {
  if (bytes.empty()) return Error{"the file is empty."};
  return read_in_child([&](MeshFileInfo& found) { return read_file(bytes, ending, found); }, ending,
                       limits_of(bytes.size()), info);
}

}  // namespace thimble::render
