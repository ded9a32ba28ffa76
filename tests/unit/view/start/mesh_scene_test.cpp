#include "view/start/mesh_scene.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "support/scratch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

/// A folder of the user's files for one test.
fs::path folder_named(const std::string& name) {
  const fs::path folder = support::scratch_folder() / ("mesh_scene_" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  setenv("XDG_STATE_HOME", (folder / "state").c_str(), 1);
  setenv("XDG_DATA_HOME", (folder / "data").c_str(), 1);
  return folder;
}

/// A tetrahedron of this size; without the last triangle it is open.
fs::path tetrahedron(const fs::path& file, double size, bool open = false) {
  std::ofstream out(file);
  out << "OFF\n4 " << (open ? 3 : 4) << " 0\n"
      << "0 0 0\n"
      << size << " 0 0\n0 " << size << " 0\n0 0 " << size << '\n'
      << "3 0 2 1\n3 0 1 3\n3 0 3 2\n";
  if (!open) out << "3 1 2 3\n";
  return file;
}

std::string text_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(MeshScene, RunsForItsWholeDuration) {
  const fs::path folder = folder_named("runs");
  const fs::path mesh = tetrahedron(folder / "part.off", 3);
  const auto made = make_mesh_scene(mesh, {}, draft_of(mesh));
  ASSERT_TRUE(made) << made.error().message;
  auto session = session::Session::open(draft_of(mesh), {});
  ASSERT_TRUE(session) << session.error().message;
}

TEST(MeshScene, HasTheChosenSizeAndStiffness) {
  const fs::path folder = folder_named("values");
  const fs::path mesh = tetrahedron(folder / "part.off", 3);
  ASSERT_TRUE(make_mesh_scene(mesh, {.size = 0.05, .stiffness = 250}, draft_of(mesh)));
  const auto scene = scene::load_scene(draft_of(mesh));
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_TRUE(scene->objects.front().size);
  EXPECT_EQ(*scene->objects.front().size, 0.05);
  EXPECT_EQ(scene->objects.front().stiffness, 250);
}

TEST(MeshScene, TakesNamesWithQuotesAndBlanks) {
  const fs::path folder = folder_named("quotes");
  const fs::path mesh = tetrahedron(folder / "my \"best\" part: #1 \\ {x}.off", 3);
  const auto made = make_mesh_scene(mesh, {}, draft_of(mesh));
  ASSERT_TRUE(made) << made.error().message;
}

TEST(MeshScene, RepairsAMeshWithAHole) {
  const fs::path folder = folder_named("hole");
  const fs::path mesh = tetrahedron(folder / "hole.off", 3, true);
  const auto made = make_mesh_scene(mesh, {}, draft_of(mesh));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_NE(made->text.find("repair: true"), std::string::npos);
}

TEST(MeshScene, GivesOpenPartsAThickness) {
  const fs::path folder = folder_named("open");
  // A sheet, bent so that no hole can be closed.
  std::ofstream out(folder / "sheet.off");
  constexpr int kSide = 12;
  out << "OFF\n" << kSide * kSide << ' ' << 2 * (kSide - 1) * (kSide - 1) << " 0\n";
  for (int i = 0; i < kSide * kSide; ++i) {
    const int x = i % kSide, y = i / kSide;
    out << x << ' ' << y << ' ' << 0.05 * x * x << '\n';
  }
  for (int i = 0; i < kSide * (kSide - 1); ++i) {
    if (i % kSide == kSide - 1) continue;
    out << "3 " << i << ' ' << i + 1 << ' ' << i + kSide << "\n3 " << i + 1 << ' ' << i + kSide + 1
        << ' ' << i + kSide << '\n';
  }
  out.close();
  const fs::path mesh = folder / "sheet.off";
  const auto made = make_mesh_scene(mesh, {}, draft_of(mesh));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_NE(made->text.find("open: {thickness"), std::string::npos);
}

TEST(MeshScene, ErrorNamesABrokenMesh) {
  const fs::path folder = folder_named("broken");
  std::ofstream(folder / "broken.off") << "OFF\n1 1 0\n0 0 0\n3 0 1 2\n";
  const auto made = make_mesh_scene(folder / "broken.off", {}, draft_of(folder / "broken.off"));
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("broken.off"), std::string::npos);
  EXPECT_FALSE(suggest_touch(folder / "missing.off"));
}

TEST(MeshScene, SuggestsTheRealSizeIfTheArmReachesIt) {
  const fs::path folder = folder_named("size");
  // ASCII glTF is in m with y up.
  const auto gltf = [&folder](const char* size) {
    std::ofstream(folder / "part.gltf")
        << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[)"
        << size << ',' << size << ',' << size
        << R"(]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
        << R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)"
        << R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
        << R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
    return suggest_touch(folder / "part.gltf");
  };
  const auto fits = gltf("0.06");
  ASSERT_TRUE(fits) << fits.error().message;
  EXPECT_NEAR(fits->size, 0.06, 1e-6);
  EXPECT_EQ(fits->up, 'y');
  EXPECT_EQ(gltf("2")->size, MeshTouch().size);
}

TEST(MeshScene, IsSavedUnderItsNameInTheUsersScenes) {
  folder_named("saved");
  const auto saved = save_mesh_scene({"part", "name: part\n", {}}, "my part");
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(saved->filename(), "my_part.yaml");
  EXPECT_EQ(text_of(*saved), "name: part\n");
}

TEST(MeshScene, ReplacesNoFileWhenSaved) {
  folder_named("kept");
  const auto saved = save_mesh_scene({"part", "name: first\n", {}}, "part");
  ASSERT_TRUE(saved) << saved.error().message;
  const auto again = save_mesh_scene({"part", "name: second\n", {}}, "part");
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("another name"), std::string::npos);
  EXPECT_EQ(text_of(*saved), "name: first\n");
  EXPECT_FALSE(save_mesh_scene({"part", "name: third\n", {}}, "  "));
  // It would hide the scene of Thimble.
  const auto taken = save_mesh_scene({"part", "name: fourth\n", {}}, "blocks");
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().message.find("Thimble has a scene blocks"), std::string::npos);
}

}  // namespace
}  // namespace thimble::view
