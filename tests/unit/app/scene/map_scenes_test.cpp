// Scenes with maps: their keys, files, errors and forces.
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "files/kept_scene.h"
#include "files/scene_inputs.h"
#include "map_picture.h"
#include "support/scratch.h"
#include "text_file.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

const fs::path& folder() {
  static const fs::path made = [] {
    const fs::path path = support::scratch_folder() / "map_scenes";
    fs::create_directories(path);
    return path;
  }();
  return made;
}

fs::path write(const std::string& name, const std::string& bytes) {
  std::ofstream(folder() / name, std::ios::binary) << bytes;
  return folder() / name;
}

// Writes a PNG of one value; `format` is one of libpng's simplified formats.
void write_png(const std::string& name, std::uint32_t format, const void* pixels,
               std::uint32_t side, const void* colours = nullptr, std::uint32_t entries = 0) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = side;
  image.format = format;
  image.colormap_entries = entries;
  ASSERT_NE(png_image_write_to_file(&image, (folder() / name).c_str(), 0, pixels, 0, colours), 0);
}

// A cube of 40 mm, in mm. `corner` of each side: "" or "/1".
std::string cube(const std::string& corner, const std::string& colour = "") {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    for (const int bit : {i & 1, i >> 1 & 1, i >> 2}) {
      text = text.empty() || text.back() == '\n' ? text + "v" : text;
      text += bit != 0 ? " 20" : " -20";
    }
    text += colour + "\n";
  }
  text += "vt 0.5 0.5\n";
  for (const char* side : {"0231", "4576", "0154", "2673", "0462", "1375"}) {
    text += "f";
    for (const char* c = side; *c != 0; ++c) text += " " + std::to_string(*c - '0' + 1) + corner;
    text += "\n";
  }
  return text;
}

std::string scene_with(const std::string& object) {
  return "name: maps\narm: vintage_phantom\nduration: 1\nobjects:\n  - {name: cube, scale: "
         "0.001, " +
         object + "}\nhand: {path: [{t: 0, at: [0, 0, 0.04]}, {t: 1, at: [0, 0, 0.03]}]}\n";
}

// Returns the error of reading or building a scene; empty if there is none.
std::string error_of(const std::string& object) {
  const auto scene = load_scene(write("error.yaml", scene_with(object)));
  if (!scene) return scene.error().message;
  const auto objects = SceneObjects::build(*scene);
  return objects ? "" : objects.error().message;
}

// Returns the force at 1 mm below the upper side, straight from above.
Eigen::Vector3d force_of(const std::string& object) {
  const auto scene = load_scene(write("force.yaml", scene_with(object)));
  EXPECT_TRUE(scene) << scene.error().message;
  if (!scene) return Eigen::Vector3d::Zero();
  auto objects = SceneObjects::build(*scene);
  EXPECT_TRUE(objects) << objects.error().message;
  if (!objects) return Eigen::Vector3d::Zero();
  driver::DeviceState state;
  driver::ForceCommand command;
  for (const double z : {0.03, 0.0201, 0.019}) {
    state.p_WT = {0.004, 0.003, z};
    command = (*objects)->touch()(state);
  }
  return command.f_T_W;
}

class MapScenes : public testing::Test {
 protected:
  void SetUp() override {
    write("cube.obj", cube("/1"));
    write("bare.obj", cube(""));
    write("red.obj", cube("", " 0.5 0 1"));
    const std::vector<unsigned char> grey(64, 51);
    write_png("grey.png", PNG_FORMAT_GRAY, grey.data(), 8);
  }
};

TEST_F(MapScenes, PictureSetsTheStiffness) {
  // 51 of 255 in the gamma of grey pictures is read as it is: 0.2.
  EXPECT_NEAR(force_of("mesh: cube.obj, stiffness_map: {image: grey.png, min: 100, max: 600}").z(),
              0.2, 1e-6);
}

TEST_F(MapScenes, ColourSetsTheStiffness) {
  EXPECT_NEAR(
      force_of("mesh: red.obj, stiffness_map: {vertex_colour: red, min: 100, max: 600}").z(), 0.35,
      1e-6);
  // The value at black may be the larger one.
  EXPECT_NEAR(
      force_of("mesh: red.obj, stiffness_map: {vertex_colour: blue, min: 600, max: 100}").z(), 0.1,
      1e-6);
}

TEST_F(MapScenes, RepairKeepsTheMaps) {
  EXPECT_NEAR(force_of("mesh: red.obj, repair: true, rotate_degrees: [[x, 90]], "
                       "stiffness_map: {vertex_colour: red, min: 100, max: 600}")
                  .z(),
              0.35, 1e-6);
}

// Returns the drawn map of an object; its quantity is empty if it has none.
render::MapPicture drawn_map(const std::string& object) {
  const auto scene = load_scene(write("drawn.yaml", scene_with(object)));
  EXPECT_TRUE(scene) << scene.error().message;
  if (!scene) return {};
  const auto objects = SceneObjects::build(*scene);
  EXPECT_TRUE(objects) << objects.error().message;
  if (!objects) return {};
  return (*objects)->map_picture(*scene, 0).value_or(render::MapPicture{});
}

TEST_F(MapScenes, DrawnMapHasTheValuesThatAreFelt) {
  for (const char* repair : {"", "repair: true, "}) {
    const render::MapPicture red =
        drawn_map(std::string(repair) +
                  "mesh: red.obj, stiffness_map: {vertex_colour: red, min: 100, max: 600}");
    EXPECT_EQ(red.quantity, "stiffness");
    EXPECT_DOUBLE_EQ(red.min, 100);
    EXPECT_DOUBLE_EQ(red.max, 600);
    ASSERT_EQ(red.values.size(), 12U * 3);
    for (const float value : red.values) EXPECT_NEAR(value, 0.5, 1e-6);
  }
}

TEST_F(MapScenes, PicturesOfAllKindsAreRead) {
  const std::vector<std::uint16_t> deep(4, 0x8000);
  write_png("linear.png", PNG_FORMAT_LINEAR_Y, deep.data(), 2);
  const unsigned char one = 0;
  const unsigned char colours[] = {255, 255, 255};
  write_png("palette.png", PNG_FORMAT_RGB_COLORMAP, &one, 1, colours, 1);
  EXPECT_NEAR(
      force_of("mesh: cube.obj, stiffness_map: {image: linear.png, min: 100, max: 600}").z(),
      0.1 + 0.5 * 0x8000 / 0xffff, 1e-6);
  EXPECT_NEAR(
      force_of("mesh: cube.obj, stiffness_map: {image: palette.png, min: 100, max: 600}").z(), 0.6,
      1e-6);
}

TEST_F(MapScenes, MistakesNamePlaceAndRemedy) {
  write("broken.png", "not a picture");
  const std::vector<std::pair<const char*, const char*>> cases{
      {"mesh: bare.obj, stiffness_map: {image: grey.png, min: 1, max: 9}",
       "bare.obj: The file has no texture coordinates, which stiffness_map needs. Export"},
      {"mesh: cube.obj, stiffness_map: {vertex_colour: red, min: 1, max: 9}",
       "cube.obj: The file has no vertex colours, which stiffness_map needs. Export"},
      {"mesh: cube.obj, stiffness: 5, stiffness_map: {image: grey.png, min: 1, max: 9}",
       "error.yaml:5: stiffness: cannot be used with stiffness_map; keep one of them"},
      {"mesh: cube.obj, stiffness_map: {image: none.png, min: 1, max: 9}",
       "error.yaml:5: image: expected a file, found none at"},
      {"mesh: cube.obj, stiffness_map: {image: broken.png, min: 1, max: 9}",
       "broken.png: not a readable image ("},
      {"mesh: cube.obj, stiffness_map: {image: grey.png, vertex_colour: red, min: 1, max: 9}",
       "vertex_colour: cannot be used with image; keep one of them"},
      {"mesh: cube.obj, stiffness_map: {min: 1, max: 9}",
       "expected one of image and vertex_colour, found none"},
      {"mesh: cube.obj, stiffness_map: {image: grey.png, min: 0, max: 9}",
       "min: expected a number from 1"},
      {"mesh: cube.obj, stiffness: 5, friction_map: {image: grey.png, min: 0, max: 1}",
       "friction_map: scales a friction, and the object has none; add effects"},
      {"mesh: cube.obj, open: {thickness: 0.001}, stiffness_map: {image: grey.png, min: 1, max: 9}",
       "stiffness_map: cannot be used with open"},
      {"mesh: cube.obj, body: {dent: {}}, stiffness_map: {image: grey.png, min: 1, max: 9}",
       "stiffness_map: cannot be used on a body that deforms"},
      {"mesh: bare.obj, stiffness: 500, effects: [{texture: height_map, map: uv, image: grey.png, "
       "height: 0.0001}]",
       "bare.obj: The file has no texture coordinates, which the texture height_map with map: uv "
       "needs."},
      {"mesh: cube.obj, stiffness: 500, effects: [{texture: height_map, map: uv, image: grey.png, "
       "height: 0.0001, width: 0.01}]",
       "width: needs map: projected"},
      {"mesh: cube.obj, stiffness: 500, effects: [{texture: height_map, map: uv, image: grey.png, "
       "height: 0.0001}]",
       "cube.obj: The texture coordinates of no triangle have an area, which the texture "
       "height_map "
       "with map: uv needs. Unwrap the mesh"},
  };
  for (const auto& [object, expected] : cases) {
    const std::string error = error_of(object);
    EXPECT_NE(error.find(expected), std::string::npos) << object << "\n" << error;
  }
}

TEST_F(MapScenes, UnreadablePicturesNameTheReason) {
  const fs::path shut = write("shut.png", "");
  fs::permissions(shut, fs::perms::none);
  if (std::ifstream(shut)) GTEST_SKIP() << "this user may read every file";
  const std::string error =
      error_of("mesh: cube.obj, stiffness_map: {image: shut.png, min: 1, max: 9}");
  EXPECT_NE(error.find("shut.png: it cannot be opened (Permission denied); check its permissions."),
            std::string::npos)
      << error;
}

TEST_F(MapScenes, ShapesHaveNoMaps) {
  const auto scene = load_scene(write(
      "shape.yaml",
      "name: maps\narm: vintage_phantom\nduration: 1\nobjects:\n  - {name: ball, sphere: {radius: "
      "0.02}, stiffness: 500, effects: [{texture: height_map, map: uv, image: grey.png, height: "
      "0.0001}]}\nhand: {path: [{t: 0, at: [0, 0, 0.04]}, {t: 1, at: [0, 0, 0.03]}]}\n"));
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("shape.yaml:5: effects: with map: uv needs mesh"),
            std::string::npos)
      << scene.error().message;
}

TEST_F(MapScenes, PicturesAreInputs) {
  const fs::path file = write(
      "inputs.yaml",
      scene_with("mesh: cube.obj, stiffness_map: {image: grey.png, min: 1, max: 9}, friction_map: "
                 "{image: broken.png, min: 0, max: 1}"));
  write("broken.png", "");
  std::vector<std::string> names;
  for (const fs::path& input : scene_inputs(file)) names.push_back(input.filename().string());
  for (const char* name : {"cube.obj", "grey.png", "broken.png"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
  }
}

TEST_F(MapScenes, KeptSceneFindsItsPictures) {
  const auto kept =
      keep_scene(scene_with("mesh: cube.obj, stiffness_map: {image: grey.png, min: 1, max: 9}"), {},
                 folder(), folder() / "kept");
  ASSERT_TRUE(kept);
  EXPECT_NE(text_of(*kept).find((folder() / "grey.png").string()), std::string::npos);
  EXPECT_TRUE(load_scene(*kept));
}

}  // namespace
}  // namespace thimble::scene
