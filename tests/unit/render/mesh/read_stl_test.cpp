#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "load_text.h"
#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {
namespace {

std::string facet_text(const std::string& corners, const std::string& normal = "normal 0 0 1") {
  return "solid a\nfacet " + normal + "\nouter loop\n" + corners +
         "endloop\nendfacet\nendsolid a\n";
}

// A binary file of one triangle; `first` is its first coordinate.
std::string binary_triangle(float first) {
  std::string bytes(84 + 50, '\0');
  const std::uint32_t count = 1;
  std::memcpy(bytes.data() + 80, &count, sizeof count);
  const float corners[9]{first, 0, 0, first + 1, 0, 0, first, 1, 0};
  std::memcpy(bytes.data() + 84 + 12, corners, sizeof corners);
  return bytes;
}

const std::string kTriangle = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";

TEST(ReadStl, KeepsDoublePrecisionOfText) {
  const auto mesh = load_text(
      "double.stl", facet_text("vertex 500000.1234567891 0 0\nvertex 1 0 0\nvertex 0 1 0\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->vertices[0].x(), 500000.1234567891);
}

TEST(ReadStl, IgnoresNormals) {
  const auto mesh = load_mesh(kMeshFolder / "nanind_normal.stl");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_TRUE(check_mesh(*mesh).touchable());
  for (const char* normal : {"", "normal", "normal 1.#IND 1.#IND 1.#IND", "normal 0 0"}) {
    EXPECT_TRUE(load_text("normal.stl", facet_text(kTriangle, normal)).ok()) << normal;
  }
}

TEST(ReadStl, ReadsFacetsOfFourCornersWhole) {
  const auto mesh = load_text("four.stl", facet_text("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
                                                     "vertex 0 1 0\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 2U);
  EXPECT_DOUBLE_EQ(check_mesh(*mesh).area, 1);
}

TEST(ReadStl, RefusesNumbersWithTrailingText) {
  for (const char* word : {"1,250.5", "1mm", "nan", "1e999"}) {
    EXPECT_EQ(refusal("number.stl", facet_text("vertex 0 0 0\nvertex " + std::string(word) +
                                               " 0 0\nvertex 0 1 0\n")),
              "number.stl:5: \"" + std::string(word) +
                  "\" in a corner is not a number between -1e15 and 1e15.");
  }
  EXPECT_EQ(refusal("four.stl", facet_text("vertex 0 0 0 7\nvertex 1 0 0\nvertex 0 1 0\n")),
            "four.stl:4: expected endloop, found \"7\".");
}

TEST(ReadStl, ReadsExponentsWrittenByFortran) {
  const auto mesh =
      load_text("fortran.stl", facet_text("vertex 0 0 0\nvertex 2.5D-03 0 0\nvertex 0 1 0\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->vertices[1].x(), 2.5e-3);
}

TEST(ReadStl, NamesTheLineWhereATextIsCut) {
  const std::string whole = facet_text(kTriangle);
  EXPECT_EQ(refusal("cut.stl", whole.substr(0, whole.find("endloop"))).substr(0, 10), "cut.stl:7:");
  EXPECT_EQ(refusal("few.stl", facet_text("vertex 0 0 0\nvertex 1 0 0\n")),
            "few.stl:6: a facet has fewer than three corners.");
  MeshFileInfo info;
  ASSERT_TRUE(load_text("end.stl", whole.substr(0, whole.find("endsolid")), &info).ok());
  ASSERT_EQ(info.notes.size(), 1U);
  EXPECT_EQ(info.notes[0], "It has no endsolid: it may be truncated.");
}

TEST(ReadStl, JoinsSolidsOfOneText) {
  const auto mesh = load_text(
      "two.stl", facet_text(kTriangle) + facet_text("vertex 0 0 1\nvertex 1 0 1\nvertex 0 1 1\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 2U);
}

TEST(ReadStl, ReadsATextOnOneLine) {
  std::string text = facet_text(kTriangle);
  for (char& c : text) c = c == '\n' ? ' ' : c;
  EXPECT_TRUE(load_text("line.stl", text).ok());
}

TEST(ReadStl, ReadsEverySolidOnOneLine) {
  std::string text =
      facet_text(kTriangle) + facet_text("vertex 0 0 1\nvertex 1 0 1\nvertex 0 1 1\n");
  for (char& c : text) c = c == '\n' ? ' ' : c;
  MeshFileInfo info;
  const auto mesh = load_text("solids.stl", text, &info);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 2U);
  EXPECT_TRUE(info.notes.empty());
}

TEST(ReadStl, TakesEveryWordInANameOfASolid) {
  std::string text = facet_text(kTriangle);
  text.replace(text.find("solid a"), 7, "solid outer facet of a solid");
  EXPECT_TRUE(load_text("name.stl", text).ok());
}

TEST(ReadStl, RefusesBinaryCornersThatAreNotFinite) {
  EXPECT_TRUE(load_text("binary.stl", binary_triangle(0)).ok());
  EXPECT_EQ(refusal("binary.stl", binary_triangle(std::numeric_limits<float>::quiet_NaN())),
            "binary.stl: triangle 0 has a coordinate that is not a number between -1e15 and 1e15.");
}

TEST(ReadStl, ReportsCoarseStepsOfABinaryFile) {
  MeshFileInfo info;
  ASSERT_TRUE(load_text("far.stl", binary_triangle(1000), &info).ok());
  ASSERT_EQ(info.notes.size(), 1U);
  EXPECT_EQ(info.notes[0],
            "The coordinates are in single precision and reach 1e+03, where one step is "
            "6.1e-05: 4.3e-05 of the size of the mesh. Move the mesh to the origin in its program "
            "or export it as OBJ.");
}

TEST(ReadStl, RefusesABinaryFileWithTooCoarseSteps) {
  EXPECT_EQ(refusal("farther.stl", binary_triangle(4e6)).substr(0, 84),
            "farther.stl: The coordinates are in single precision and reach 4e+06, where one step");
}

TEST(LoadMesh, ReadsAFileByItsContents) {
  const struct {
    const char* name;
    const char* source;
    const char* kind;
  } cases[]{{"a.obj", "box_ascii.stl", "STL"}, {"b.obj", "box_binary.stl", "STL"},
            {"c.stl", "box.ply", "PLY"},       {"d.stl", "box.off", "OFF"},
            {"e.gltf", "box.glb", "GLB"},      {"f.obj", "box.3mf", "3MF"},
            {"g.stl", "box.dae", "DAE"},       {"h.off", "box.amf", "AMF"},
            {"i.obj", "box.3ds", "3DS"},       {"k.glb", "box.gltf", "GLTF"}};
  // The comment of a binary STL file may begin like any other format.
  std::string comment = binary_triangle(0);
  comment.replace(0, 6, "OFF {<");
  EXPECT_TRUE(load_text("comment.stl", comment).ok());
  for (const auto& now : cases) {
    MeshFileInfo info;
    const auto mesh = load_text(now.name, bytes_of_file(kMeshFolder / now.source), &info);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    EXPECT_EQ(info.kind, now.kind);
    EXPECT_EQ(info.notes.at(0),
              std::string("Its contents are ") + now.kind + ", so the extension was ignored.");
  }
}

TEST(LoadMesh, RefusesPlyFilesWithShapesThatAreNotRead) {
  const std::string vertices = "element vertex 3\nproperty float x\nproperty float y\n";
  const std::string corners = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_NE(
      refusal("strips.ply", "ply\nformat ascii 1.0\n" + vertices +
                                "property float z\nelement tristrips 1\nproperty list int int "
                                "vertex_indices\n" +
                                corners + "3 0 1 2\n")
          .find("triangle strips (tristrips), which are not supported"),
      std::string::npos);
  EXPECT_NE(refusal("flat.ply", "ply\nformat ascii 1.0\n" + vertices +
                                    "element face 1\nproperty list int int vertex_indices\n"
                                    "end_header\n0 0\n1 0\n0 1\n3 0 1 2\n")
                .find("do not have exactly one number z"),
            std::string::npos);
}

}  // namespace
}  // namespace thimble::render
