#include <gtest/gtest.h>

#include <string>

#include "load_text.h"
#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {
namespace {

const std::string kCornersOfBox =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
const std::string kFacesOfBox =
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

// Returns the volume of a closed mesh; adds a failure and returns -1 for any other.
double closed_volume(const driver::Result<TriangleMesh>& mesh) {
  EXPECT_TRUE(mesh.ok()) << mesh.error().message;
  if (!mesh) return -1;
  const MeshFindings found = check_mesh(*mesh);
  EXPECT_TRUE(found.touchable());
  return found.volume;
}

TEST(ReadObj, KeepsDoublePrecision) {
  const auto mesh = load_text(
      "double.obj", "v 500000.1234567891 4000000.123456789 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->vertices[0], Eigen::Vector3d(500000.1234567891, 4000000.123456789, 0));
}

TEST(ReadObj, ReadsExponentsWrittenByFortran) {
  const auto mesh = load_mesh(kMeshFolder / "dexp_box.obj");
  EXPECT_NEAR(closed_volume(mesh), 0.01 * 0.009 * 0.009, 1e-18);
}

TEST(ReadObj, RefusesNumbersWithTrailingText) {
  for (const char* word : {"1,250.5", "1mm", "1_000", "0x10", "1e", "--1", "+-1", "1.0.0", "nan",
                           "inf", "1e300", "1e999", "1D", "e5"}) {
    const std::string text = std::string("v 0 0 0\nv ") + word + " 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_EQ(refusal("number.obj", text),
              std::string("number.obj:2: \"") + word +
                  "\" in vertex 2 is not a number between -1e15 and 1e15.");
  }
}

TEST(ReadObj, ReadsNumbersInEveryLegalForm) {
  const auto mesh =
      load_text("forms.obj", "v +1. .5 -5.e-1\nv 1E+0 1d0 1e-999\nv 0 01 -0\nf 1 2 3\n");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->vertices[0], Eigen::Vector3d(1, 0.5, -0.5));
  EXPECT_EQ(mesh->vertices[1], Eigen::Vector3d(1, 1, 0));
  EXPECT_EQ(mesh->vertices[2], Eigen::Vector3d(0, 1, 0));
}

TEST(ReadObj, TakesCommentsBehindFaces) {
  EXPECT_DOUBLE_EQ(closed_volume(load_mesh(kMeshFolder / "comment_f.obj")), 1);
}

TEST(ReadObj, IgnoresColoursAndOpacity) {
  EXPECT_DOUBLE_EQ(closed_volume(load_mesh(kMeshFolder / "rgba.obj")), 1);
  EXPECT_TRUE(load_text("rgb.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 1 1\nv 0 1 0 0 0 0\nf 1 2 3\n").ok());
}

TEST(ReadObj, RefusesVerticesWithAWrongCountOfNumbers) {
  const std::string rest = "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(refusal("two.obj", "v 0 0" + rest),
            "two.obj:1: a vertex has 2 numbers; it needs 3, 4, 6 or 7.");
  EXPECT_EQ(refusal("five.obj", "v 0 0 0 1 1" + rest),
            "five.obj:1: a vertex has 5 numbers; it needs 3, 4, 6 or 7.");
  EXPECT_EQ(refusal("eight.obj", "v 0 0 0 1 1 1 1 1" + rest),
            "eight.obj:1: a vertex has at most 7 numbers.");
  EXPECT_TRUE(load_text("weight.obj", "v 0 0 0 1" + rest).ok());
  EXPECT_EQ(refusal("weight.obj", "v 0 0 0 2" + rest),
            "weight.obj:1: vertex weights other than 1 are not supported.");
}

TEST(ReadObj, CountsNegativeCornersFromTheEnd) {
  const std::string text = "vn -nan(ind) -nan(ind) 1\n" + kCornersOfBox +
                           "f -8//-1 -6//-1 -5//-1 -7//-1\nf -4 -3 -1 -2\nf -8 -7 -3 -4\n"
                           "f -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3\n";
  EXPECT_DOUBLE_EQ(closed_volume(load_text("negative.obj", text)), 1);
}

TEST(ReadObj, ReadsFacesBeforeTheirVertices) {
  EXPECT_DOUBLE_EQ(closed_volume(load_text("early.obj", kFacesOfBox + kCornersOfBox)), 1);
  EXPECT_EQ(refusal("early.obj", "\n" + kFacesOfBox + "v 0 0 0\n"),
            "early.obj:2: the face refers to vertex 3; the file has 1.");
}

TEST(ReadObj, NamesTheLineOfAnInvalidCorner) {
  for (const char* corner : {"0", "x", "1/2/3/4", "1.5", "1/x", "/1", "1/0", "4294967297", "1,"}) {
    const std::string text = "# c\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 " + std::string(corner) + "\n";
    EXPECT_EQ(refusal("corner.obj", text).substr(0, 23), "corner.obj:5: the face ") << corner;
  }
  EXPECT_EQ(refusal("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 2 3\n"),
            "far.obj:4: the face refers to vertex -4; so far there are 3.");
}

TEST(ReadObj, JoinsLinesThatEndInABackslash) {
  EXPECT_DOUBLE_EQ(
      closed_volume(load_text("joined.obj", kCornersOfBox + "f 1 3 \\\n4 2\nf 5 6 8\\\r\n 7\n"
                                                            "f 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n"
                                                            "f 2 4 8 6")),
      1);
}

TEST(ReadObj, ReadsLineEndsOfEverySystem) {
  for (const char* end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : kCornersOfBox + kFacesOfBox)
      text += c == '\n' ? std::string(end) : std::string(1, c);
    EXPECT_DOUBLE_EQ(closed_volume(load_text("ends.obj", text)), 1);
  }
}

TEST(ReadObj, SplitsConcaveFacesWithoutChangingTheirArea) {
  const auto mesh = load_text("arrow.obj", "v 2 -1 0\nv 1 0 0\nv 2 1 0\nv 0 0 0\nf 1 2 3 4\n");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_DOUBLE_EQ(check_mesh(*mesh).area, 1);
}

// A saw with this many corners at the top, above a straight edge: one face, with an area of 1.5 for
// each corner except the last.
std::string saw(int corners) {
  std::string text, face = "f";
  for (int i = 0; i < corners; ++i) {
    text += "v " + std::to_string(i) + (i % 2 == 0 ? " 1 0\n" : " 2 0\n");
    face += " " + std::to_string(i + 1);
  }
  text += "v " + std::to_string(corners - 1) + " 0 0\nv 0 0 0\n";
  return text + face + " " + std::to_string(corners + 1) + " " + std::to_string(corners + 2) + "\n";
}

TEST(ReadObj, SplitsConcaveFacesOfThousandsOfCorners) {
  const auto mesh = load_text("saw.obj", saw(1998));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 1998U);
  EXPECT_NEAR(check_mesh(*mesh).area, 1.5 * 1997, 1e-9);
}

TEST(ReadObj, RefusesTooLargeConcaveFaces) {
  EXPECT_EQ(refusal("saw.obj", saw(3002)),
            "saw.obj:3005: the face is concave and has 3004 corners; at most 2000 are supported. "
            "Save the mesh as triangles.");
}

TEST(ReadObj, ReportsLinesAndPoints) {
  MeshFileInfo info;
  ASSERT_TRUE(load_text("lines.obj", kCornersOfBox + kFacesOfBox + "l 1 2\np 3\n", &info).ok());
  ASSERT_EQ(info.notes.size(), 1U);
  EXPECT_EQ(info.notes[0], "Lines and points were ignored: only faces can be touched.");
}

TEST(ReadObj, RefusesUnsupportedShapes) {
  EXPECT_EQ(
      refusal("nurbs.obj", kCornersOfBox + "cstype bspline\nsurf 0 1 0 1 1 2 3\n"),
      "nurbs.obj:10: \"surf\": free-form surfaces are not supported. Save the mesh as polygons in "
      "one file.");
  EXPECT_EQ(refusal("call.obj", "call other.obj\n").substr(0, 30),
            "call.obj:1: \"call\": included f");
}

TEST(ReadObj, RefusesStatementsThatAreUnknown) {
  EXPECT_EQ(refusal("word.obj", kCornersOfBox + "face 1 2 3\n"),
            "word.obj:9: \"face\" is not a statement of an OBJ file.");
}

}  // namespace
}  // namespace thimble::render
