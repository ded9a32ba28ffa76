#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "support/scratch.h"
#include "support/seed.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {
namespace {

namespace fs = std::filesystem;

const fs::path kMeshes = fs::path(THIMBLE_TEST_DATA) / "meshes";

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

driver::Result<TriangleMesh> load_bytes(const std::string& name, const std::string& bytes,
                                        MeshFileInfo* info = nullptr) {
  const fs::path folder = support::scratch_folder() / "mesh_formats";
  fs::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary) << bytes;
  return load_mesh(folder / name, info);
}

TEST(MeshFormats, ReadTheSameBoxFromEach) {
  struct Case {
    const char* name;
    double scale;  // of lengths: the unit of a DAE file is applied
    std::optional<double> unit;
    char up;
  };
  for (const Case& now :
       {Case{"box.gltf", 1, 1, 'y'}, Case{"box.glb", 1, 1, 'y'}, Case{"box.3mf", 1, 0.0254, 0},
        Case{"box.amf", 1, 1, 0}, Case{"box.dae", 0.01, 1, 'z'}, Case{"box.3ds", 1, {}, 'z'},
        Case{"box.off", 1, {}, 0}, Case{"box_binary.stl", 1, {}, 0}}) {
    MeshFileInfo info;
    const auto mesh = load_mesh(kMeshes / now.name, &info);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    const MeshFindings found = check_mesh(*mesh);
    EXPECT_TRUE(found.touchable()) << now.name;
    EXPECT_EQ(found.triangles, 12u) << now.name;
    EXPECT_EQ(found.vertices, 8u) << now.name;
    const Eigen::Vector3d sides = (found.box_max - found.box_min) / now.scale;
    EXPECT_LT((sides - Eigen::Vector3d(1, 2, 3)).norm(), 1e-6) << now.name << ": its axes";
    EXPECT_EQ(info.unit, now.unit) << now.name;
    EXPECT_EQ(info.up, now.up) << now.name;
  }
}

TEST(MeshFormats, ApplyTheNodesOfTheFile) {
  MeshFileInfo info;
  const auto placed = load_mesh(kMeshes / "placed_box.gltf", &info);
  ASSERT_TRUE(placed.ok()) << placed.error().message;
  EXPECT_LT((check_mesh(*placed).box_min - Eigen::Vector3d(10, 0, 0)).norm(), 1e-6);
  EXPECT_LT((check_mesh(*placed).box_max - Eigen::Vector3d(12, 2, 3)).norm(), 1e-6);
  ASSERT_EQ(info.notes.size(), 1u);
  EXPECT_EQ(info.notes[0], "1 of 1 part was placed by the file's nodes.");

  const auto two = load_mesh(kMeshes / "two_boxes.3mf", &info);
  ASSERT_TRUE(two.ok()) << two.error().message;
  EXPECT_EQ(check_mesh(*two).components, 2u);
  EXPECT_LT((check_mesh(*two).box_max - Eigen::Vector3d(21, 2, 3)).norm(), 1e-6);
  EXPECT_EQ(info.unit, 0.001);  // the unit of 3MF is mm if the file names no other
}

TEST(MeshFormats, MirroredPartKeepsItsOutside) {
  std::string text = bytes_of(kMeshes / "placed_box.gltf");
  const std::size_t scale = text.find("2,\n    1,\n    1");
  ASSERT_NE(scale, std::string::npos);
  text.replace(scale, 1, "-2");
  fs::create_directories(support::scratch_folder() / "mesh_formats");
  fs::copy_file(kMeshes / "placed_box.bin",
                support::scratch_folder() / "mesh_formats/placed_box.bin",
                fs::copy_options::overwrite_existing);
  const auto mesh = load_bytes("mirrored.gltf", text);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_TRUE(check_mesh(*mesh).touchable());
  EXPECT_NEAR(check_mesh(*mesh).volume, 12, 1e-6);
}

TEST(MeshFormats, ReadNoFileOutsideTheMeshsFolder) {
  const fs::path folder = support::scratch_folder() / "mesh_formats";
  fs::create_directories(folder / "below");
  fs::copy_file(kMeshes / "placed_box.bin", folder / "placed_box.bin",
                fs::copy_options::overwrite_existing);
  const std::string text = bytes_of(kMeshes / "placed_box.gltf");
  ASSERT_TRUE(load_bytes("beside.gltf", text).ok());
  for (const std::string& name :
       {std::string("../placed_box.bin"), fs::absolute(folder / "placed_box.bin").string()}) {
    std::string other = text;
    other.replace(other.find("placed_box.bin"), 14, name);
    const auto mesh = load_bytes("below/outside.gltf", other);
    ASSERT_FALSE(mesh.ok()) << name;
    EXPECT_NE(mesh.error().message.find("the GLTF file could not be read"), std::string::npos);
  }
}

TEST(MeshFormats, AcceptStlWithTrailingBytesAndInCapitals) {
  MeshFileInfo info;
  const std::string binary = bytes_of(kMeshes / "box_binary.stl");
  ASSERT_TRUE(load_bytes("longer.stl", binary + "some program's own", &info).ok());
  ASSERT_EQ(info.notes.size(), 1u);
  EXPECT_EQ(info.notes[0], "18 bytes after the last triangle were ignored.");
  // A binary file may begin with "solid".
  std::string solid = binary;
  solid.replace(0, 6, "solid ");
  EXPECT_TRUE(load_bytes("solid.stl", solid + "more").ok());
  std::string text = bytes_of(kMeshes / "box_ascii.stl");
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto mesh = load_bytes("capitals.stl", text);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_DOUBLE_EQ(check_mesh(*mesh).volume, 6);

  const auto cut = load_bytes("cut.stl", binary.substr(0, binary.size() - 1));
  ASSERT_FALSE(cut.ok());
  EXPECT_NE(cut.error().message.find("declares 12 triangles, but it has bytes for only 11"),
            std::string::npos)
      << cut.error().message;
}

TEST(MeshFormats, AcceptUtf8MarksAndRefuseUtf16) {
  for (const char* name : {"box.off", "box.obj", "box.ply", "box_ascii.stl"}) {
    const std::string bytes = bytes_of(kMeshes / name);
    const auto mesh = load_bytes(std::string("mark_") + name, "\xEF\xBB\xBF" + bytes);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    EXPECT_DOUBLE_EQ(check_mesh(*mesh).volume, 6) << name;
    const auto wide = load_bytes(std::string("wide_") + name, "\xFF\xFE" + bytes);
    ASSERT_FALSE(wide.ok());
    EXPECT_NE(wide.error().message.find("UTF-16"), std::string::npos) << wide.error().message;
  }
}

TEST(MeshFormats, RefuseAnUnknownUnit) {
  std::string text = bytes_of(kMeshes / "box.amf");
  text.replace(text.find("\"meter\""), 7, "\"league\"");
  const auto mesh = load_bytes("league.amf", text);
  ASSERT_FALSE(mesh.ok());
  EXPECT_NE(mesh.error().message.find("an unknown length unit"), std::string::npos);
}

TEST(MeshFormats, RefuseMorphControllersOfDae) {
  std::string text = bytes_of(kMeshes / "box.dae");
  const std::size_t scenes = text.find(" <library_visual_scenes>");
  ASSERT_NE(scenes, std::string::npos);
  text.insert(scenes,
              R"( <library_controllers><controller id="m"><morph source="#box" method="NORMALIZED">
  <source id="t"><IDREF_array id="ta" count="1">box</IDREF_array><technique_common><accessor source="#ta" count="1" stride="1"><param name="MORPH_TARGET" type="IDREF"/></accessor></technique_common></source>
  <source id="w"><float_array id="wa" count="1">0.5</float_array><technique_common><accessor source="#wa" count="1" stride="1"><param name="MORPH_WEIGHT" type="float"/></accessor></technique_common></source>
  <targets><input semantic="MORPH_TARGET" source="#t"/><input semantic="MORPH_WEIGHT" source="#w"/></targets>
 </morph></controller></library_controllers>
)");
  const std::string plain = R"(<instance_geometry url="#box"/>)";
  text.replace(text.find(plain), plain.size(), R"(<instance_controller url="#m"/>)");
  const auto mesh = load_bytes("morph.dae", text);
  ASSERT_FALSE(mesh.ok());
  EXPECT_NE(mesh.error().message.find("it has a morph controller, which is not supported in DAE"),
            std::string::npos)
      << mesh.error().message;
}

TEST(MeshFormats, RefuseDaeWithoutAMesh) {
  std::string text = bytes_of(kMeshes / "box.dae");
  const std::string used = R"(<instance_geometry url="#box"/>)";
  text.erase(text.find(used), used.size());
  const std::size_t geometries = text.find(" <library_geometries>");
  text.erase(geometries, text.find(" <library_visual_scenes>") - geometries);
  EXPECT_FALSE(load_bytes("bones.dae", text).ok()) << "its bones are no mesh";
}

TEST(MeshFormats, AnswerGarbageWithASentence) {
  std::string garbage;
  auto seed = static_cast<std::uint32_t>(support::seed_of(7));
  for (int i = 0; i < 4000; ++i) {
    garbage += static_cast<char>((seed = seed * 1664525u + 1013904223u) >> 24);
  }
  for (const char* ending : {"gltf", "glb", "3mf", "dae", "amf", "3ds"}) {
    const std::string name = std::string("garbage.") + ending;
    for (const std::string& bytes :
         {garbage, std::string(),
          bytes_of(kMeshes / (std::string("box.") + ending)).substr(0, 60)}) {
      const auto mesh = load_bytes(name, bytes);
      ASSERT_FALSE(mesh.ok()) << name;
      EXPECT_NE(mesh.error().message.find(name + ": "), std::string::npos) << mesh.error().message;
    }
  }
}

// Assimp never passes a letter among the corners, and allocates memory meanwhile.
TEST(MeshFormats, EndlessReadersAreAborted) {
  std::string bytes = bytes_of(kMeshes / "box.dae");
  const std::size_t corners = bytes.find("<p>");
  ASSERT_NE(corners, std::string::npos);
  bytes.replace(corners + 3, 1, "x");
  const auto mesh = load_bytes("endless.dae", bytes);
  ASSERT_FALSE(mesh.ok());
  const std::string& reported = mesh.error().message;
  EXPECT_TRUE(reported.find("needs more memory than its size allows") != std::string::npos ||
              reported.find("takes more than 2 s") != std::string::npos)
      << reported;
}

}  // namespace
}  // namespace thimble::render
