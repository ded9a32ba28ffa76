#include "files/file_hashes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "compact_mesh/packed_surface.h"
#include "disk_paging/page_file.h"
#include "mesh/contact_mesh.h"
#include "support/meshes/shapes.h"
#include "support/scratch.h"
#include "thimble/scene/scene_file.h"

// Hashes of the files that a scene reads.

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

class FileHashesTest : public ::testing::Test {
 protected:
  FileHashesTest() : folder_(support::scratch_folder() / "hashes") {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// Returns the error of a check against `recorded`; empty if there is none.
  static std::string error_of(const std::string& recorded, const std::vector<fs::path>& inputs) {
    const auto same = check_file_hashes(recorded, inputs);
    return same ? "" : same.error().message;
  }
  static bool names(const std::string& message, const fs::path& file) {
    return message.find(file.string()) != std::string::npos;
  }

  fs::path folder_;
};

TEST_F(FileHashesTest, NameTheChangedFile) {
  const std::vector<fs::path> files{write("a.obj", "a"), write("b.png", std::string(3 << 20, 'b'))};
  const std::string text = FileHashes(files).text();
  EXPECT_EQ(error_of(text, files), "");
  write("b.png", std::string(3 << 20, 'b') + "c");
  EXPECT_TRUE(names(error_of(text, files), files[1]));
  std::string other(3 << 20, 'b');
  other[(2 << 20) + 5] = 'x';
  write("b.png", other);
  EXPECT_TRUE(names(error_of(text, files), files[1]));
  fs::remove(files[0]);
  EXPECT_TRUE(names(error_of(text, files), files[0]));
}

TEST_F(FileHashesTest, DoNotDependOnTheFolder) {
  const std::string text = FileHashes({write("a.obj", "a")}).text();
  EXPECT_EQ(error_of(text, {write("other/a.obj", "a")}), "");
}

TEST_F(FileHashesTest, FileWrittenSinceTheSceneWasReadHasNoHash) {
  const fs::path file = write("a.obj", "a");
  FileHashes hashes({file});
  write("a.obj", "other");
  EXPECT_TRUE(names(error_of(hashes.text(), {file}), file));
}

TEST_F(FileHashesTest, IncludeBuffersOfGltf) {
  const fs::path file =
      write("a.gltf", R"({"buffers": [{"uri": "data:,x"}, {"uri": "part%201.bin"}]})");
  const fs::path buffer = write("part 1.bin", "1");
  const std::string text = FileHashes({file}).text();
  EXPECT_EQ(error_of(text, {file}), "");
  write("part 1.bin", "2");
  EXPECT_TRUE(names(error_of(text, {file}), buffer));
}

TEST_F(FileHashesTest, IncludeTheFilesOfABag) {
  const fs::path part = write("bag/bag_0.db3", "1");
  const std::string text = FileHashes({folder_ / "bag"}).text();
  EXPECT_EQ(error_of(text, {folder_ / "bag"}), "");
  write("bag/bag_0.db3", "2");
  EXPECT_TRUE(names(error_of(text, {folder_ / "bag"}), part));
}

TEST_F(FileHashesTest, ReportAnotherNumberOfFiles) {
  const std::vector<fs::path> files{write("a.obj", "a"), write("b.obj", "b")};
  EXPECT_NE(error_of(FileHashes(files).text(), {files[0]}), "");
  EXPECT_TRUE(names(error_of(FileHashes({files[0]}).text(), files), files[1]));
}

TEST_F(FileHashesTest, DamagedTextIsAnError) {
  const fs::path file = write("a.obj", "a");
  for (const char* text : {"", "md5\n", "checksum64-1\n", "checksum64-1\nx", "checksum64-1\n\n"}) {
    EXPECT_NE(error_of(text, {file}), "") << text;
  }
}

TEST_F(FileHashesTest, PageFilesDifferByTheirChecksums) {
  const auto write_pages = [this](double side) {
    const auto mesh = render::ContactMesh::build(support::icosphere(5, side));
    const auto surface = render::PackedSurface::build(*mesh);
    const fs::path file = folder_ / "ball.pages";
    fs::remove(file);
    EXPECT_TRUE(render::write_page_file(*surface, file));
    return file;
  };
  const fs::path file = write_pages(0.02);
  const std::string text = FileHashes({file}).text();
  ASSERT_GT(fs::file_size(file), 1U << 20);
  EXPECT_EQ(error_of(text, {file}), "");
  write_pages(0.021);
  EXPECT_TRUE(names(error_of(text, {file}), file));
}

TEST(SceneInputs, AreMeshesAndPicturesEachOnce) {
  const auto scene = load_scene(fs::path(THIMBLE_SOURCE_DIR) / "app/scenes/tissue.yaml");
  ASSERT_TRUE(scene) << scene.error().message;
  std::vector<std::string> names;
  for (const fs::path& input : scene->inputs) names.push_back(input.filename().string());
  EXPECT_EQ(names, (std::vector<std::string>{"tissue.obj", "tissue_lumps.png", "tissue_ribs.png"}));
}

}  // namespace
}  // namespace thimble::scene
