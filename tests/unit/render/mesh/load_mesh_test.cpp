#include "thimble/render/mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "mesh/file/text_words.h"
#include "support/random.h"
#include "support/scratch.h"
#include "support/seed.h"
#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {
namespace {

const std::filesystem::path kMeshes = std::filesystem::path(THIMBLE_TEST_DATA) / "meshes";

// File that exists for the duration of the test.
class MeshFile {
 public:
  MeshFile(const std::string& ending, const std::string& bytes)
      : path_(support::scratch_folder() /
              ("load_mesh_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "." +
               ending)) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~MeshFile() { std::filesystem::remove(path_); }
  MeshFile(const MeshFile&) = delete;
  MeshFile& operator=(const MeshFile&) = delete;

  driver::Result<TriangleMesh> load() const { return load_mesh(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void expect_error(const std::string& ending, const std::string& bytes, const std::string& part) {
  const MeshFile file(ending, bytes);
  const auto mesh = file.load();
  ASSERT_FALSE(mesh.ok()) << bytes.substr(0, 80);
  EXPECT_EQ(mesh.error().message.find(file.path().string()), 0u) << mesh.error().message;
  EXPECT_NE(mesh.error().message.find(part), std::string::npos) << mesh.error().message;
}

std::size_t triangles_in(const std::string& ending, const std::string& bytes) {
  const MeshFile file(ending, bytes);
  const auto mesh = file.load();
  EXPECT_TRUE(mesh.ok()) << (mesh.ok() ? "" : mesh.error().message);
  return mesh.ok() ? mesh->triangles.size() : 0;
}

const char* const kTetrahedron = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

TEST(LoadMesh, ReadsTheSameMeshFromEveryFormat) {
  for (const char* name : {"box.off", "box.obj", "box.ply", "box_ascii.stl", "box_binary.stl"}) {
    const auto mesh = load_mesh(kMeshes / name);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    const MeshFindings findings = check_mesh(*mesh);
    EXPECT_TRUE(findings.touchable()) << name;
    EXPECT_EQ(findings.vertices, 8u) << name;
    EXPECT_EQ(findings.triangles, 12u) << name;
    EXPECT_DOUBLE_EQ(findings.volume, 6) << name;
  }
}

TEST(LoadMesh, KeepsDoublePrecisionOfOff) {
  const MeshFile file("off", "OFF 3 1 0\n0.1234567890123456 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const auto mesh = file.load();
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh->vertices[0].x(), 0.1234567890123456);
}

TEST(LoadMesh, ReadsEveryDialectOfOffText) {
  EXPECT_EQ(triangles_in("off", std::string("OFF\n4 4 6\n") + kTetrahedron), 4u);
  EXPECT_EQ(triangles_in("off", std::string("OFF 4 4 6\n") + kTetrahedron), 4u);
  EXPECT_EQ(triangles_in("OFF", std::string("# c\n\nOFF # c\n# c\n4 4\n\n") + kTetrahedron), 4u);
  EXPECT_EQ(triangles_in("off", std::string("OFF\n4 4 6\n") + kTetrahedron + "text after"), 4u);
  EXPECT_EQ(triangles_in("off", "OFF\r\n3 1 0\r\n0 0 0\r\n+1 0 0\r\n0 1 0\r\n3 0 1 2\r\n"), 1u);
  EXPECT_EQ(triangles_in("off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2  255 0 0\n"), 1u);
  EXPECT_EQ(triangles_in("off", "COFF 3 1 0\n0 0 0 1 2 3 4\n1 0 0 1 2 3\n0 1 0\n3 0 1 2\n"), 1u);
  EXPECT_EQ(triangles_in("off", "NOFF 3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2"), 1u);
  EXPECT_EQ(triangles_in("off", "STOFF 3 1 0\n0 0 0 0 0\n1 0 0 0 1\n0 1 0 1 0\n3 0 1 2"), 1u);
}

// Faces of three corners in plain digits are read by a shorter way.
TEST(LoadMesh, PlainAndOrdinaryFacesOfOffAreEqual) {
  const std::string vertices = "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n";
  const MeshFile plain("off", vertices + "3 0 1 2\n3 1 3 2\n3 4 1 0\n");
  const auto expected = plain.load();
  ASSERT_TRUE(expected.ok());
  for (const char* faces :
       {"3 0 1 2\r\n3 1 3 2\r\n3 4 1 0\r\n", "3  0 1 2\n3 1 3 2 # c\n\n3 4 1 0",
        "+3 0 1 2\n3 +1 3 2\n3 4 1 0 9 9 9\n", "3 0 1 2 1 1 1\n3\t1\t3\t2\n3 000000000004 1 0\n",
        "3 0 1\n2\n3 1 3 2\n\n\n3 4 1 0\n"}) {
    const MeshFile file("off", vertices + faces);
    const auto mesh = file.load();
    ASSERT_TRUE(mesh.ok()) << faces << mesh.error().message;
    EXPECT_EQ(mesh->triangles, expected->triangles) << faces;
  }
}

TEST(LoadMesh, PolygonsAreNoPlainFaces) {
  const std::string vertices = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  EXPECT_EQ(triangles_in("off", vertices + "4 0 1 3\n2\n3 0 1 2\n"), 3u);
}

TEST(LoadMesh, OtherWordsAreNoPlainNumbers) {
  const std::string start = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  expect_error("off", start + "3 0 1 2x\n", ":6: face 0 refers to vertex \"2x\"");
  expect_error("off", start + "3 0 1 4294967298\n", ":6: face 0 refers to vertex");
}

TEST(LoadMesh, LinesAfterPlainFacesAreCounted) {
  const std::string start = "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n";
  expect_error("off", start + "3 0 1 3\n", ":8: face 2 refers to vertex \"3\"");
  expect_error("off", start + "3 0 1 x\n", ":8: face 2 refers to vertex \"x\"");
}

TEST(LoadMesh, PlainNumbersAreTheNearestDoubles) {
  support::Random random(20'000);
  std::string word(64, '\0');
  for (int round = 0; round < 20'000; ++round) {
    const double exponent = random.uniform(-15, 15);
    const double value = (random.uniform(-0.5, 0.5)) * std::pow(10, exponent);
    const int size = std::snprintf(word.data(), word.size(), "%.*f",
                                   static_cast<int>(random.bits() % 18), value);
    const std::string text = word.substr(0, static_cast<std::size_t>(size));
    const auto read = real_number(text);
    ASSERT_TRUE(read) << text;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(*read),
              std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)))
        << text;
  }
  EXPECT_TRUE(std::signbit(real_number("-0").value_or(1)));
  for (const char* wrong : {"", "-", ".", "-.", "1.2.3", "--1", "1-"}) {
    EXPECT_FALSE(real_number(wrong)) << wrong;
  }
  EXPECT_EQ(real_number(".5"), 0.5);
  EXPECT_EQ(real_number("5."), 5);
}

TEST(LoadMesh, SplittingPolygonsKeepsTheirArea) {
  EXPECT_EQ(triangles_in("off", "OFF 4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"), 2u);
  // An arrowhead: a fan from its first corner would cover the notch and count it twice.
  const MeshFile file("off", "OFF 4 1 0\n0 0 0\n2 -1 0\n1 0 0\n2 1 0\n4 1 2 3 0\n");
  const auto mesh = file.load();
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh->triangles.size(), 2u);
  EXPECT_DOUBLE_EQ(check_mesh(*mesh).area, 1);
}

TEST(LoadMesh, NamesFileAndLineOfEveryFaultInOffText) {
  expect_error("off", "", ":1: the file is empty");
  expect_error("off", "PLY 1 2 3", ":1: an OFF file begins with OFF, not with \"PLY\"");
  expect_error("off", "4OFF 1 1 0\n", ":1: 4OFF has vertices that are not three numbers");
  expect_error("off", "OFF BINARY\n", ":1: binary OFF is not supported");
  expect_error("off", "OFF\nx 1 0\n", ":2: expected a count, found \"x\"");
  expect_error("off", "OFF\n-3 1 0\n", ":2: the count \"-3\" is negative");
  expect_error("off", "OFF\n1000000000000 1000000000000 0\n", "declares 1000000000000 vertices");
  expect_error("off", "OFF\n3 1000000000000 0\n0 0 0\n1 0 0\n0 1 0\n", "000000000000 faces");
  expect_error("off", "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", ":4: \"nan\" in vertex 1");
  expect_error("off", "OFF\n3 1 0\n0 0 0\n1 0 1e300\n0 1 0\n3 0 1 2\n", ":4: \"1e300\"");
  expect_error("off", "OFF\n3 1 0\n0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n", ":4: \"1e999\"");
  expect_error("off", "OFF\n3 1 0\n0.00 0.00 0.00\n1.00 0.00\n", "ends in vertex 1 of 3");
  expect_error("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
               ":6: face 0 refers to vertex \"3\"; the vertices are 0 to 2");
  expect_error("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n", "refers to vertex \"-1\"");
  expect_error("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
               "ends in face 0: it is truncated");
  expect_error("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n1000000000000 0 1 2\n", "ends in face 0");
  expect_error("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n0    \n", "number of corners of face 0");
  expect_error("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "no face with three corners");
  expect_error("off", "OFF\n0 0 0\n", "no face with three corners");
}

TEST(LoadMesh, RefusesOtherFiles) {
  EXPECT_NE(load_mesh("no_such_file.off").error().message.find("no such file"), std::string::npos);
  EXPECT_NE(load_mesh(".").error().message.find(".: this is not a file but a folder; "),
            std::string::npos);
  EXPECT_NE(load_mesh("mesh.xyz").error().message.find("unknown file extension \"xyz\""),
            std::string::npos);
  const auto folder = support::scratch_folder() / "load_mesh_folder.off";
  std::filesystem::create_directories(folder);
  EXPECT_NE(load_mesh(folder).error().message.find("this is not a file"), std::string::npos);
  std::filesystem::remove(folder);
}

TEST(LoadMesh, AnswersGarbageInEveryFormatWithAnError) {
  std::string garbage;
  auto seed = static_cast<std::uint32_t>(support::seed_of(7));
  for (int i = 0; i < 4000; ++i)
    garbage += static_cast<char>((seed = seed * 1664525u + 1013904223u) >> 24);
  for (const char* ending : {"off", "obj", "stl", "ply"}) {
    expect_error(ending, garbage, ": ");
    expect_error(ending, "", "the file is empty");
  }
}

TEST(LoadMesh, RefusesImpossibleCounts) {
  expect_error("ply",
               "ply\nformat ascii 1.0\nelement vertex 1000000000000\nproperty float x\n"
               "property float y\nproperty float z\nend_header\n0 0 0\n",
               "declares 1000000000000 of \"vertex\"");
  std::string stl(84, '\0');
  const std::uint32_t promised = 1000000000;
  std::memcpy(stl.data() + 80, &promised, sizeof promised);
  expect_error("stl", stl + std::string(100, '\1'), "not a readable STL file");
}

TEST(LoadMesh, ReadsPlyOfEitherByteOrder) {
  const std::array<std::array<double, 3>, 4> vertices{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const std::array<std::array<std::int16_t, 3>, 4> faces{
      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  for (const bool big : {false, true}) {
    std::string text = std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
                       "_endian 1.0\ncomment by hand\nelement marker 2\nproperty uchar colour\n"
                       "element vertex 4\nproperty float64 x\nproperty double y\nproperty char "
                       "quality\nproperty double z\nelement face 4\nproperty list uint8 int16 "
                       "vertex_index\nproperty list uchar float32 texture\nend_header\n";
    const auto put = [&](const auto& number) {
      std::string bytes(sizeof number, 0);
      std::memcpy(bytes.data(), &number, sizeof number);
      if (big) std::reverse(bytes.begin(), bytes.end());
      text += bytes;
    };
    text += "\1\2";
    for (const auto& vertex : vertices) {
      put(vertex[0]);
      put(vertex[1]);
      put(std::int8_t{-1});
      put(vertex[2]);
    }
    for (const auto& face : faces) {
      put(std::uint8_t{3});
      for (const std::int16_t corner : face) put(corner);
      put(std::uint8_t{1});
      put(0.5F);
    }
    const MeshFile file("ply", text);
    const auto mesh = file.load();
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    EXPECT_EQ(mesh->vertices.size(), 4U);
    ASSERT_EQ(mesh->triangles.size(), 4U);
    EXPECT_EQ(mesh->triangles[1], (std::array<std::int32_t, 3>{0, 1, 3}));
    EXPECT_EQ(mesh->vertices[3], Eigen::Vector3d(0, 0, 1));
  }
}

TEST(LoadMesh, ReportsTheFaultOfAPlyFile) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
  expect_error("ply", head + corners + "3 0 1 3\n",
               "face 0 refers to a vertex that does not exist");
  expect_error("ply", head + corners + "3 0 1 -1\n",
               "face 0 refers to a vertex that does not exist");
  expect_error("ply", head + corners + "300 0 1 2\n", "in face 0 of 1");
  expect_error("ply", head + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "vertex 0 has a coordinate");
  expect_error("ply", head + "0 0\n", "in vertex 0 of 3");
  expect_error("ply", head + corners + "2 0 1\n", "no face with three corners");
  expect_error("ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float {\nquatsch\n",
               "quatsch");
}

TEST(LoadMesh, AnswersEveryTruncationOfEveryFormat) {
  for (const char* name : {"box.off", "box.obj", "box.ply", "box_ascii.stl", "box_binary.stl"}) {
    std::ifstream stream(kMeshes / name, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(stream), {}};
    ASSERT_FALSE(whole.empty()) << name;
    for (std::size_t size = 0; size < whole.size(); size += 7) {
      const MeshFile file(std::string(name).substr(std::string(name).size() - 3),
                          whole.substr(0, size));
      const auto mesh = file.load();
      // A cut between two faces of a format without counts gives a smaller mesh, not an error.
      if (mesh.ok()) {
        EXPECT_LE(mesh->triangles.size(), 12u) << name << " cut at " << size;
      } else {
        EXPECT_FALSE(mesh.error().message.empty());
      }
    }
  }
}

}  // namespace
}  // namespace thimble::render
