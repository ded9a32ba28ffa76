#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "load_text.h"
#include "mesh/file/package/zip_archive.h"
#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {
namespace {

// A tetrahedron whose positions and more are in base64, described by `accessors` and `views`.
std::string gltf_text(const std::string& node, const std::string& mesh,
                      const std::string& accessors, const std::string& views,
                      const std::string& data, std::size_t length, const std::string& more = "") {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0)" +
         node + R"(}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1)" +
         mesh + R"(}], "accessors": [)" + accessors + R"(], "bufferViews": [)" + views +
         R"(], "buffers": [{"byteLength": )" + std::to_string(length) +
         R"(, "uri": "data:application/octet-stream;base64,)" + data + R"("}])" + more + "}";
}

const std::string kIndices =
    R"({"bufferView": 1, "componentType": 5121, "count": 12, "type": "SCALAR"})";

// Positions (0, 0, 0), (127, 0, 0), (0, 127, 0), (0, 0, 127) as bytes with a stride of 4, and the
// corners of the four faces.
std::string quantized_text(const std::string& node, const std::string& normalized) {
  return gltf_text(node, R"(}])",
                   R"({"bufferView": 0, "componentType": 5120, )" + normalized +
                       R"("count": 4, "type": "VEC3"}, )" + kIndices,
                   R"({"buffer": 0, "byteLength": 16, "byteStride": 4}, )"
                   R"({"buffer": 0, "byteOffset": 16, "byteLength": 12})",
                   "AAAAAH8AAAAAfwAAAAB/AAACAQABAwECAwADAg==", 28,
                   R"(, "extensionsRequired": ["KHR_mesh_quantization"])");
}

TEST(ReadGltf, RefusesRequiredExtensionsByName) {
  const auto mesh = load_mesh(kMeshFolder / "unknown_required.gltf");
  ASSERT_FALSE(mesh.ok());
  EXPECT_NE(mesh.error().message.find("it requires the glTF extension \"FOO_bar\", which is not "
                                      "supported. Export the mesh without it."),
            std::string::npos)
      << mesh.error().message;
}

TEST(ReadGltf, PlacesInstances) {
  const auto mesh = load_mesh(kMeshFolder / "instancing.gltf");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const MeshFindings found = check_mesh(*mesh);
  EXPECT_EQ(found.components, 2U);
  EXPECT_DOUBLE_EQ(found.volume, 2);
  EXPECT_DOUBLE_EQ(found.box_max.x(), 4);
}

TEST(ReadGltf, ReadsQuantizedPositions) {
  const auto plain = load_text("bytes.gltf", quantized_text("", ""));
  ASSERT_TRUE(plain.ok()) << plain.error().message;
  EXPECT_DOUBLE_EQ(check_mesh(*plain).volume, 127. * 127 * 127 / 6);
  const auto scaled = load_text(
      "scaled.gltf", quantized_text(R"(, "scale": [2, 2, 2])", R"("normalized": true, )"));
  ASSERT_TRUE(scaled.ok()) << scaled.error().message;
  EXPECT_DOUBLE_EQ(check_mesh(*scaled).volume, 8. / 6);
}

TEST(ReadGltf, AppliesMorphWeights) {
  // The target moves each vertex by (127, 0, 0); half of it is applied.
  const std::string accessors =
      R"({"bufferView": 0, "componentType": 5120, "count": 4, "type": "VEC3"}, )" + kIndices +
      R"(, {"bufferView": 2, "componentType": 5120, "count": 4, "type": "VEC3"})";
  const std::string views = R"({"buffer": 0, "byteLength": 16, "byteStride": 4}, )"
                            R"({"buffer": 0, "byteOffset": 16, "byteLength": 12}, )"
                            R"({"buffer": 0, "byteOffset": 28, "byteLength": 16, "byteStride": 4})";
  const std::string data = "AAAAAH8AAAAAfwAAAAB/AAACAQABAwECAwADAn8AAAB/AAAAfwAAAH8AAAA=";
  MeshFileInfo info;
  const auto mesh = load_text("morph.gltf",
                              gltf_text("", R"(, "targets": [{"POSITION": 2}]}], "weights": [0.5])",
                                        accessors, views, data, 44),
                              &info);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_DOUBLE_EQ(check_mesh(*mesh).box_min.x(), 63.5);
  EXPECT_DOUBLE_EQ(check_mesh(*mesh).box_max.x(), 190.5);
  ASSERT_EQ(info.notes.size(), 1U);
  EXPECT_EQ(info.notes[0], "Morph targets were applied with the weights of the file.");
  // The node's own weights take precedence over the mesh's.
  const auto own =
      load_text("own.gltf", gltf_text(R"(, "weights": [1])",
                                      R"(, "targets": [{"POSITION": 2}]}], "weights": [0.5])",
                                      accessors, views, data, 44));
  ASSERT_TRUE(own.ok()) << own.error().message;
  EXPECT_DOUBLE_EQ(check_mesh(*own).box_min.x(), 127);
}

TEST(ReadGltf, AppliesSparsePositions) {
  // Vertex 1 becomes (0, 0, 0) + (127, 0, 0) of the sparse values.
  const auto mesh = load_text(
      "sparse.gltf",
      gltf_text(
          "", "}]",
          R"({"bufferView": 0, "componentType": 5120, "count": 4, "type": "VEC3", "sparse": )"
          R"({"count": 1, "indices": {"bufferView": 1, "byteOffset": 2, "componentType": 5121},)"
          R"( "values": {"bufferView": 0, "byteOffset": 4, "componentType": 5120}}}, )" +
              kIndices,
          R"({"buffer": 0, "byteLength": 16, "byteStride": 4}, )"
          R"({"buffer": 0, "byteOffset": 16, "byteLength": 12})",
          "AAAAAH8AAAAAfwAAAAB/AAACAQABAwECAwADAg==", 28));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_DOUBLE_EQ(check_mesh(*mesh).volume, 127. * 127 * 127 / 6);
}

TEST(ReadGltf, OpensPercentEncodedNames) {
  std::string text = bytes_of_file(kMeshFolder / "placed_box.gltf");
  text.replace(text.find("placed_box.bin"), 14, "my%20buf%66er.bin");
  write_mesh_file("my buffer.bin", bytes_of_file(kMeshFolder / "placed_box.bin"));
  const auto mesh = load_text("percent.gltf", text);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_DOUBLE_EQ(check_mesh(*mesh).volume, 12);
  text.replace(text.find("my%20"), 5, "%2e%2e/my%20");
  EXPECT_NE(refusal("below/percent.gltf", text).find("a file outside its folder"),
            std::string::npos);
}

TEST(ReadGltf, RefusesDracoWithoutOtherPositions) {
  const std::string text =
      R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": )"
      R"([{"primitives": [{"attributes": {"POSITION": 0}, "extensions": )"
      R"({"KHR_draco_mesh_compression": {"bufferView": 0}}}]}], "accessors": )"
      R"([{"componentType": 5126, "count": 3, "type": "VEC3"}], )"
      R"("extensionsRequired": ["KHR_draco_mesh_compression"]})";
  EXPECT_EQ(
      refusal("draco.gltf", text),
      "draco.gltf: it is compressed with the glTF extension KHR_draco_mesh_compression, which "
      "is not supported. Export the mesh without it.");
}

TEST(ReadGltf, ReadsStripsAndFans) {
  for (const char* mode : {"5", "6"}) {
    const auto mesh = load_text(
        "strip.gltf",
        gltf_text("", R"(, "mode": )" + std::string(mode) + "}]",
                  R"({"bufferView": 0, "componentType": 5120, "count": 4, "type": "VEC3"}, )"
                  R"({"bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR"})",
                  R"({"buffer": 0, "byteLength": 16, "byteStride": 4}, )"
                  R"({"buffer": 0, "byteOffset": 16, "byteLength": 12})",
                  "AAAAAH8AAAAAfwAAAAB/AAABAgMBAwECAwADAg==", 28));
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    EXPECT_EQ(mesh->triangles.size(), 2U) << mode;
  }
}

TEST(ReadGltf, RefusesNodesThatAreTheirOwnChildren) {
  EXPECT_NE(refusal("loop.gltf", quantized_text(R"(, "children": [0])", ""))
                .find("node 0 is a child of two nodes"),
            std::string::npos);
}

TEST(ReadGltf, RefusesNumbersBeyondTheBuffer) {
  std::string text = quantized_text("", "");
  text.replace(text.find(R"("count": 4)"), 10, R"("count": 9)");
  EXPECT_NE(refusal("beyond.gltf", text).find("an accessor is not within buffer view 0"),
            std::string::npos);
}

TEST(Read3mf, PlacesObjectsOfASecondModel) {
  MeshFileInfo info;
  const auto mesh = load_mesh(kMeshFolder / "production.3mf", &info);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  const MeshFindings found = check_mesh(*mesh);
  EXPECT_EQ(found.components, 2U);
  EXPECT_DOUBLE_EQ(found.volume, 2);
  EXPECT_EQ(info.unit, 0.001);
}

TEST(ReadGltf, AcceptsItsVersionAsANumber) {
  std::string text = quantized_text("", "");
  const std::string version = R"("2.0")";
  text.replace(text.find(version), version.size(), "2");
  const auto mesh = load_text("number.gltf", text);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 4U);
}

// An archive of one stored file, 3D/3dmodel.model.
std::string archive_of(const std::string& model) {
  const auto number = [](std::size_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i, value >>= 8) text += static_cast<char>(value & 0xff);
    return text;
  };
  const std::string name = "3D/3dmodel.model";
  const std::string sizes = number(model.size(), 4) + number(model.size(), 4);
  const std::string local =
      "PK\3\4" + number(0, 14) + sizes + number(name.size(), 2) + number(0, 2) + name + model;
  const std::string central = "PK\1\2" + number(0, 16) + sizes + number(name.size(), 2) +
                              number(0, 12) + number(0, 4) + name;
  return local + central + "PK\5\6" + number(0, 4) + number(1, 2) + number(1, 2) +
         number(central.size(), 4) + number(local.size(), 4) + number(0, 2);
}

std::string model_text(const std::string& attributes, const std::string& build) {
  return R"(<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/)"
         R"(3dmanufacturing/core/2015/02" )" +
         attributes +
         R"(><resources><object id="1"><mesh><vertices><vertex x="500000.123456789" y="0" z="0"/>)"
         R"(<vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices><triangles>)"
         R"(<triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources><build>)" +
         build + "</build></model>";
}

TEST(Read3mf, KeepsDoublePrecision) {
  const auto mesh = load_text("double.3mf", archive_of(model_text("", R"(<item objectid="1"/>)")));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->vertices[0].x(), 500000.123456789);
}

TEST(Read3mf, RefusesRequiredExtensionsByName) {
  EXPECT_EQ(
      refusal("beams.3mf", archive_of(model_text(
                               R"(requiredextensions="b" xmlns:b="http://schemas.microsoft.com/)"
                               R"(3dmanufacturing/beamlattice/2017/02")",
                               R"(<item objectid="1"/>)"))),
      "beams.3mf: it requires the extension \"b\" of 3MF "
      "(http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02), which is not "
      "supported. Export the mesh without it.");
}

TEST(Read3mf, RefusesCyclicComponents) {
  std::string text = model_text("", R"(<item objectid="2"/>)");
  text.insert(text.find("</resources>"),
              R"(<object id="2"><components><component objectid="2"/></components></object>)");
  EXPECT_NE(refusal("nested.3mf", archive_of(text)).find("nested too deeply"), std::string::npos);
}

TEST(Read3mf, RefusesMissingObjects) {
  EXPECT_NE(refusal("gone.3mf", archive_of(model_text("", R"(<item objectid="7"/>)")))
                .find("it refers to object 7 of 3D/3dmodel.model, which does not exist"),
            std::string::npos);
  EXPECT_NE(refusal("none.3mf", archive_of(model_text("", ""))).find("its build has no item"),
            std::string::npos);
}

// The production extension gives each part its own path; its other attributes are none.
TEST(Read3mf, OnlyTheAttributeNamedPathIsAPath) {
  const std::string model =
      R"(<?xml version="1.0"?><model unit="millimeter" )"
      R"(xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" )"
      R"(xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06">)"
      R"(<resources><object id="1"><mesh><vertices><vertex x="0" y="0" z="0"/>)"
      R"(<vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices><triangles>)"
      R"(<triangle v1="0" v2="1" v3="2"/></triangles></mesh></object><object id="2"><components>)"
      R"(<component objectid="1" p:UUID="a4c5"/></components></object></resources>)"
      R"(<build><item objectid="2"/></build></model>)";
  const auto mesh = load_text("uuid.3mf", archive_of(model));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 1U);
}

// A ZIP64 field holds the numbers that are 0xffffffff in the directory [PKWARE, APPNOTE 4.5.3].
TEST(Read3mf, ReadsSizesOfZip64) {
  const auto number = [](std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i, value >>= 8) text += static_cast<char>(value & 0xff);
    return text;
  };
  const std::string name = "a", content = "stored";
  const std::string local = "PK\3\4" + number(0, 14) + number(content.size(), 4) +
                            number(content.size(), 4) + number(name.size(), 2) + number(0, 2) +
                            name + content;
  const std::string extra =
      number(1, 2) + number(16, 2) + number(content.size(), 8) + number(content.size(), 8);
  const std::string central = "PK\1\2" + number(0, 16) + number(0xffffffff, 4) +
                              number(0xffffffff, 4) + number(name.size(), 2) +
                              number(extra.size(), 2) + number(0, 10) + number(0, 4) + name + extra;
  const std::string bytes = local + central + "PK\5\6" + number(0, 4) + number(1, 2) +
                            number(1, 2) + number(central.size(), 4) + number(local.size(), 4) +
                            number(0, 2);
  const auto archive = ZipArchive::open(bytes);
  ASSERT_TRUE(archive.ok()) << archive.error().message;
  const auto read = archive->read("a");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(*read, content);
}

}  // namespace
}  // namespace thimble::render
