// Texture coordinates and vertex colours of mesh files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "support/random.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/repair_mesh.h"
#include "unit/render/mesh/load_text.h"

namespace thimble::render {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Loaded {
  TriangleMesh mesh;
  MeshAttributes attributes;
};

Loaded load(const std::string& name, const std::string& bytes) {
  Loaded done;
  auto mesh = load_mesh_with_attributes(write_mesh_file(name, bytes), done.attributes);
  EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error().message);
  if (mesh) done.mesh = std::move(mesh).value();
  return done;
}

// Returns the error without the folder; "read" if the file is accepted.
std::string refused(const std::string& name, const std::string& bytes) {
  MeshAttributes attributes;
  const auto mesh = load_mesh_with_attributes(write_mesh_file(name, bytes), attributes);
  if (mesh) return "read";
  const std::string& message = mesh.error().message;
  return message.substr(message.find(name));
}

// A square of which each corner of the file has its own texture coordinate.
const char* const kSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0.1 0.2\nvt 0.9 0.2\nvt 0.9 0.8\nvt 0.1 0.8 0\n"
    "f 1/4 2/3 3/2 4/1\n";

TEST(MeshAttributes, ObjCornersHaveTheirCoordinates) {
  const auto [mesh, attributes] = load("square.obj", kSquare);
  ASSERT_EQ(attributes.uv.size(), 2U);
  EXPECT_TRUE(attributes.colours.empty());
  const std::vector<Vector2d> of{{0.1, 0.8}, {0.9, 0.8}, {0.9, 0.2}, {0.1, 0.2}};
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(attributes.uv[t][k], of[static_cast<std::size_t>(mesh.triangles[t][k])]);
    }
  }
}

TEST(MeshAttributes, ObjNumbersMayBeNegativeOrEarly) {
  const auto negative = load("negative.obj",
                             "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 0.5 0\nvt 0.5 1\n"
                             "f -3/-3 -2/-2 -1/-1\n");
  const auto early =
      load("early.obj", "f 1/1 2/2 3/3\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 0.5 0\nvt 0.5 1\n");
  ASSERT_EQ(negative.attributes.uv.size(), 1U);
  EXPECT_EQ(negative.attributes.uv[0][2], Vector2d(0.5, 1));
  EXPECT_EQ(early.attributes.uv, negative.attributes.uv);
}

TEST(MeshAttributes, ObjCornersWithoutCoordinatesHaveNone) {
  const auto [mesh, attributes] = load("half.obj",
                                       "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.5 0.5\n"
                                       "f 1 2 3\nf 1/1 3/1 4\n");
  ASSERT_EQ(attributes.uv.size(), 2U);
  EXPECT_TRUE(attributes.uv[0][0].hasNaN());
  EXPECT_EQ(attributes.uv[1][0], Vector2d(0.5, 0.5));
  EXPECT_TRUE(attributes.uv[1][2].hasNaN());
}

TEST(MeshAttributes, ObjColoursFollowTheCoordinates) {
  const auto [mesh, attributes] =
      load("red.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 0.5\nf 1 2 3\n");
  ASSERT_EQ(attributes.colours.size(), 1U);
  EXPECT_EQ(attributes.colours[0][2], Vector3d(0, 0, 0.5));
}

TEST(MeshAttributes, ObjErrorsNameTheLine) {
  const std::string face = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
  EXPECT_EQ(
      refused("nan.obj", face + "vt nan 0\nf 1/1 2/1 3/1\n"),
      "nan.obj:4: \"nan\" in texture coordinate 1 is not one of at most 3 numbers between -1e6 "
      "and 1e6.");
  EXPECT_EQ(refused("empty.obj", face + "vt\nf 1 2 3\n"),
            "empty.obj:4: a texture coordinate has no number.");
  EXPECT_EQ(refused("beyond.obj", face + "vt 0 0\nf 1/1 2/1 3/7\n"),
            "beyond.obj:5: the face refers to texture coordinate 7; the file has 1.");
  EXPECT_EQ(refused("before.obj", face + "vt 0 0\nf 1/-2 2/1 3/1\n"),
            "before.obj:5: the face refers to texture coordinate -2; so far there are 1.");
  EXPECT_EQ(
      refused("white.obj", "v 0 0 0 255 0 0\n"),
      "white.obj:1: the colour of vertex 1 is not three numbers from 0 to 1. If the colours of "
      "the file are from 0 to 255, divide them by 255, or export the mesh as PLY.");
}

std::string with_sevens(const std::string& a, const std::string& b, const std::string& c) {
  return "v 0 0 0 " + a + "\nv 1 0 0 " + b + "\nv 1 1 0 " + c + "\nf 1 2 3\n";
}

TEST(MeshAttributes, ObjColoursMayHaveAnOpacityOrAWeight) {
  const auto opacity = load("opacity.obj", with_sevens("0.25 0 0.5 1", "1 0 0 1", "0 1 0 1"));
  ASSERT_EQ(opacity.attributes.colours.size(), 1U);
  EXPECT_EQ(opacity.attributes.colours[0][0], Vector3d(0.25, 0, 0.5));
  const auto weight = load("weight.obj", with_sevens("1 0.25 0 0.5", "1 1 0 0", "1 0 1 0"));
  ASSERT_EQ(weight.attributes.colours.size(), 1U);
  EXPECT_EQ(weight.attributes.colours[0][0], Vector3d(0.25, 0, 0.5));
}

TEST(MeshAttributes, ObjColoursWithTwoMeaningsAreRefused) {
  const std::string both = refused("both.obj", with_sevens("1 0 0 1", "1 1 0 1", "1 0 0.5 1"));
  EXPECT_EQ(
      both,
      "both.obj:1: vertices with 7 numbers may be x y z w r g b (w = 1) or x y z r g b a (a = "
      "1), and here both fit. Write the colours as v x y z r g b, or export the mesh as PLY.");
  EXPECT_NE(refused("neither.obj", with_sevens("0 0 0 0.5", "1 1 0 1", "1 0 1 1"))
                .find("and here neither fits"),
            std::string::npos);
}

TEST(MeshAttributes, BadAttributesDoNotMatterIfNotRead) {
  EXPECT_TRUE(load_text("unread.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt nan\nf 1/9 2/9 3/9\n"));
}

std::string ply(const std::string& properties, const std::string& rows) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
         "property double z\n" +
         properties + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         rows + "3 0 1 2\n";
}

TEST(MeshAttributes, PlyNamesOfCoordinatesAreEqual) {
  const std::string rows = "0 0 0 0.25 0.5\n1 0 0 1.25 0.5\n1 1 0 1.25 -1\n";
  for (const auto& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
    const auto [mesh, attributes] = load(
        "uv.ply", ply(std::string("property float ") + u + "\nproperty float " + v + "\n", rows));
    ASSERT_EQ(attributes.uv.size(), 1U) << u;
    EXPECT_EQ(attributes.uv[0][2], Vector2d(1.25, -1)) << u;
  }
}

TEST(MeshAttributes, PlyColoursAreSharesOfTheirType) {
  const auto bytes = load("bytes.ply", ply("property uchar red\nproperty uchar green\n"
                                           "property uchar blue\n",
                                           "0 0 0 255 0 0\n1 0 0 0 51 0\n1 1 0 0 0 0\n"));
  ASSERT_EQ(bytes.attributes.colours.size(), 1U);
  EXPECT_EQ(bytes.attributes.colours[0][0], Vector3d(1, 0, 0));
  EXPECT_DOUBLE_EQ(bytes.attributes.colours[0][1].y(), 0.2);
  const auto words = load("words.ply", ply("property ushort red\nproperty ushort green\n"
                                           "property float blue\n",
                                           "0 0 0 65535 0 0.5\n1 0 0 0 0 0\n1 1 0 0 0 0\n"));
  EXPECT_EQ(words.attributes.colours[0][0], Vector3d(1, 0, 0.5));
}

TEST(MeshAttributes, PlyErrorsNameTheVertex) {
  EXPECT_EQ(
      refused("nan.ply",
              ply("property float s\nproperty float t\n", "0 0 0 0 0\n1 0 0 nan 0\n1 1 0 0 0\n")),
      "nan.ply: vertex 1 has a texture coordinate that is not a number between -1e6 and 1e6.");
  EXPECT_EQ(
      refused("dark.ply", ply("property float red\nproperty float green\n"
                              "property float blue\n",
                              "0 0 0 -1 0 0\n1 0 0 0 0 0\n1 1 0 0 0 0\n")),
      "dark.ply: vertex 0 has a colour that is not three numbers from 0 to 1. Write colours as "
      "uchar from 0 to 255, or as float from 0 to 1.");
}

// As MeshLab writes coordinates of corners: a list in each face.
std::string ply_with_face_list(const std::string& faces) {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
         "property double z\nelement face 2\nproperty list uchar int vertex_indices\n"
         "property list uchar float texcoord\nproperty int texnumber\nend_header\n"
         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" +
         faces;
}

TEST(MeshAttributes, PlyFacesMayHaveCoordinatesOfTheirOwn) {
  const auto [mesh, attributes] =
      load("wedge.ply", ply_with_face_list("3 0 1 2 6 0 0 0.5 0 0.5 0.25 0\n"
                                           "3 0 2 3 6 0.75 0 1 0.5 0.75 1 0\n"));
  ASSERT_EQ(attributes.uv.size(), 2U);
  EXPECT_EQ(attributes.uv[0][2], Vector2d(0.5, 0.25));
  EXPECT_EQ(attributes.uv[1][0], Vector2d(0.75, 0));
  EXPECT_EQ(attributes.uv[1][2], Vector2d(0.75, 1));
}

TEST(MeshAttributes, PlyFacesWithoutCoordinatesHaveNone) {
  const auto [mesh, attributes] =
      load("some.ply", ply_with_face_list("3 0 1 2 6 0 0 0.5 0 0.5 0.25 0\n3 0 2 3 0 0\n"));
  ASSERT_EQ(attributes.uv.size(), 2U);
  EXPECT_TRUE(attributes.uv[1][0].hasNaN());
}

TEST(MeshAttributes, PlyErrorsNameTheFaceOfCoordinates) {
  EXPECT_EQ(refused("short.ply", ply_with_face_list("3 0 1 2 6 0 0 0.5 0 0.5 0.25 0\n"
                                                    "3 0 2 3 4 0 0 1 1 0\n")),
            "short.ply: face 1 has 4 texture coordinates for 3 corners; texcoord needs two for "
            "each. Export the mesh again, or as OBJ.");
  EXPECT_EQ(refused("far.ply", ply_with_face_list("3 0 1 2 6 0 0 1e9 0 0.5 0.25 0\n"
                                                  "3 0 2 3 0 0\n")),
            "far.ply: face 0 has a texture coordinate that is not a number between -1e6 and 1e6.");
}

template <class Number>
void append(std::string& bytes, const std::vector<Number>& numbers) {
  const std::size_t size = bytes.size();
  bytes.resize(size + numbers.size() * sizeof(Number));
  std::memcpy(bytes.data() + size, numbers.data(), numbers.size() * sizeof(Number));
}

// Returns a glTF file with one triangle, coordinates and colours, whose node has a `matrix`.
std::string gltf(const std::string& node, float u = 0.25F) {
  std::string bytes;
  append<float>(bytes, {0, 0, 0, 1, 0, 0, 1, 1, 0});
  append<float>(bytes, {u, 0.25F, 1, 0, 1, 1});
  append<unsigned char>(bytes, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 0});
  write_mesh_file("triangle.bin", bytes);
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" +
         node +
         R"(}],"buffers":[{"uri":"triangle.bin","byteLength":72}],"bufferViews":[
{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
{"buffer":0,"byteOffset":60,"byteLength":12}],"accessors":[
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
{"bufferView":2,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}],"meshes":[
{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"COLOR_0":2}}]}]})";
}

TEST(MeshAttributes, GltfRowsCountFromTheTop) {
  const auto [mesh, attributes] = load("triangle.gltf", gltf(""));
  ASSERT_EQ(attributes.uv.size(), 1U);
  EXPECT_EQ(attributes.uv[0][0], Vector2d(0.25, 0.75));
  EXPECT_EQ(attributes.uv[0][2], Vector2d(1, 0));
  ASSERT_EQ(attributes.colours.size(), 1U);
  EXPECT_EQ(attributes.colours[0][1], Vector3d(0, 1, 0));
}

TEST(MeshAttributes, GltfMirroredPartsKeepTheirCorners) {
  const auto [mesh, attributes] = load("mirrored.gltf", gltf(R"(,"scale":[-1,1,1])"));
  ASSERT_EQ(attributes.uv.size(), 1U);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& p = mesh.vertices[static_cast<std::size_t>(mesh.triangles[0][k])];
    const Vector2d expected = p.x() == 0 ? Vector2d(0.25, 0.75) : Vector2d(1, 1 - p.y());
    EXPECT_EQ(attributes.uv[0][k], expected) << k;
  }
}

TEST(MeshAttributes, GltfErrorNamesTheVertex) {
  EXPECT_EQ(refused("nan.gltf", gltf("", std::nanf(""))),
            "nan.gltf: TEXCOORD_0 of vertex 0 of a primitive has a value that is not a number "
            "between -1e6 and 1e6. Unwrap the mesh again and export it.");
  std::string bright = gltf("");
  const std::string byte = R"("componentType":5121,"normalized":true)";
  bright.replace(bright.find(byte), byte.size(), R"("componentType":5121)");
  EXPECT_EQ(
      refused("bright.gltf", bright),
      "bright.gltf: COLOR_0 of vertex 0 of a primitive has a value that is not a number from 0 "
      "to 1. Export colours as floats from 0 to 1, or as normalized integers.");
}

TEST(MeshAttributes, GltfRequiredTransformOfPicturesIsRefused) {
  std::string bytes = gltf("");
  bytes.insert(1, R"("extensionsRequired":["KHR_texture_transform"],)");
  EXPECT_EQ(
      refused("moved.gltf", bytes),
      "moved.gltf: it requires the glTF extension KHR_texture_transform, which is not applied "
      "to texture coordinates. Apply it in the program that made the file, and export the "
      "mesh without it.");
  // Without texture coordinates it does not matter.
  EXPECT_TRUE(load_text("moved.gltf", bytes));
}

TEST(MeshAttributes, MeshIsThatOfTheOtherReader) {
  for (const auto& [name, bytes] :
       {std::pair<std::string, std::string>{"same.obj", kSquare}, {"same.gltf", gltf("")}}) {
    const auto plain = load_text(name, bytes);
    ASSERT_TRUE(plain) << name;
    const auto [mesh, attributes] = load(name, bytes);
    EXPECT_EQ(mesh.vertices, plain->vertices) << name;
    EXPECT_EQ(mesh.triangles, plain->triangles) << name;
  }
}

TEST(MeshAttributes, OtherFormatsHaveNone) {
  const auto [mesh, attributes] = load("plain.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n");
  EXPECT_EQ(mesh.triangles.size(), 1U);
  EXPECT_TRUE(attributes.uv.empty() && attributes.colours.empty());
}

// Changes of a text at random places must neither crash nor give a list of another length.
TEST(MeshAttributes, DamagedFilesAreReadOrRefused) {
  support::Random random(300);
  const std::string texts[] = {kSquare,
                               ply("property float s\nproperty float t\nproperty uchar red\n"
                                   "property uchar green\nproperty uchar blue\n",
                                   "0 0 0 0 0 1 2 3\n1 0 0 0 0 1 2 3\n1 1 0 0 0 1 2 3\n")};
  constexpr std::string_view kWritten = "0129-./nve \n";
  int read = 0;
  for (int i = 0; i < 300; ++i) {
    std::string text = texts[i % 2];
    for (int change = 0; change < 1 + i % 3; ++change) {
      const auto at = static_cast<std::size_t>(random.uniform(0, double(text.size()) - 0.001));
      text[at] =
          kWritten[static_cast<std::size_t>(random.uniform(0, double(kWritten.size()) - 0.001))];
    }
    MeshAttributes attributes;
    const auto mesh = load_mesh_with_attributes(
        write_mesh_file(i % 2 == 0 ? "damaged.obj" : "damaged.ply", text), attributes);
    if (!mesh) {
      EXPECT_FALSE(mesh.error().message.empty());
      continue;
    }
    ++read;
    EXPECT_TRUE(attributes.uv.empty() || attributes.uv.size() == mesh->triangles.size()) << text;
    EXPECT_TRUE(attributes.colours.empty() || attributes.colours.size() == mesh->triangles.size());
  }
  EXPECT_GT(read, 10);
}

TEST(MeshAttributes, RepairNamesTheOriginOfTriangles) {
  // A box without its last two triangles, with one twice.
  TriangleMesh box;
  for (int i = 0; i < 8; ++i) box.vertices.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {0, 2, 1}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4},
                   {1, 5, 4}, {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}};
  const RepairedMesh repaired = repair_mesh(box);
  ASSERT_EQ(repaired.mesh.triangles.size(), 12U);
  EXPECT_EQ(repaired.origins, (std::vector<std::int32_t>{0, 1, 3, 4, 5, 6, 7, 8, 9, 10, -1, -1}));
}

}  // namespace
}  // namespace thimble::render
