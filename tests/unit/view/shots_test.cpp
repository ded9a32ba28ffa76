#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gl_or_skip.h"
#include "picture_difference.h"
#include "support/covered.h"
#include "view/gl/picture_file.h"
#include "view/shot.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;
using support::difference;
using support::PictureDifference;

// The stored pictures have 256 colours, and other releases of Mesa round differently. A visible
// change is much larger (see the controls below).
constexpr double kMeanMax = 2.5;         // of 255
constexpr double kBadBlocksMax = 0.004;  // 4 of 1200 blocks

bool alike(const PictureDifference& difference) {
  return difference.mean <= kMeanMax && difference.bad_blocks <= kBadBlocksMax;
}

ShotChoice small_choice() {
  ShotChoice choice;
  choice.width = 320;
  choice.height = 240;
  choice.caption = false;
  return choice;
}

/// Plays a scene up to a time and passes the moment on; returns false if the scene's mesh is not
/// available.
bool play(const fs::path& scene, double time,
          const std::function<void(const DrawnScene&, DrawnMoment&, const Plots&)>& look) {
  session::SessionOptions options;
  options.several_arms = true;
  options.mesh_folder = THIMBLE_MESHES;
  options.duration = time + 0.05;
  auto played = PlayedScene::open(scene, options);
  if (!played) {
    EXPECT_TRUE(played) << played.error().message;
    return false;
  }
  (*played)->play({time}, [&](DrawnMoment& moment, const Plots& plots) {
    look((*played)->drawn(), moment, plots);
  });
  return true;
}

ShotPainter painter_of(const DrawnScene& scene, const ShotChoice& choice) {
  return ShotPainter(scene, choice, ScenePrograms::make().value());
}

/// Returns the second at which a scene is drawn: in contact, if the default is not.
double second_of(const std::string& scene) {
  static const std::map<std::string, double> others = {
      {"clay", 3.008}, {"clay_tablet", 5.008}, {"tin_can", 4.208},   {"held_block", 2.4},
      {"box", 2.208},  {"charges", 3.008},     {"two_hands", 3.008}, {"cans", 5.0}};
  const auto found = others.find(scene);
  return found == others.end() ? 1.6 : found->second;
}

std::vector<fs::path> shipped_scenes() {
  std::vector<fs::path> scenes;
  for (const auto& entry : fs::directory_iterator(fs::path(THIMBLE_SOURCE_DIR) / "app/scenes")) {
    if (entry.path().extension() == ".yaml") scenes.push_back(entry.path());
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

TEST(Shots, EveryShippedSceneMatchesStoredShot) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  const fs::path stored_folder = fs::path(THIMBLE_TEST_DATA) / "shots";
  const bool write = std::getenv("THIMBLE_WRITE_SHOTS") != nullptr;
  support::Covered covered("scenes");
  for (const fs::path& scene : shipped_scenes()) {
    const std::string name = scene.stem();
    if (name == "elephant" && !fs::exists(fs::path(THIMBLE_MESHES) / "elephant.off")) {
      std::fprintf(stderr, "NOT TESTED: elephant, for want of its mesh.\n");
      continue;
    }
    covered.add(name);
    const fs::path stored_file = stored_folder / (name + ".png");
    play(scene, second_of(name),
         [&](const DrawnScene& drawn, DrawnMoment& moment, const Plots& plots) {
           ShotPainter painter = painter_of(drawn, small_choice());
           const Picture picture = painter.paint(moment, plots);
           if (write) {
             EXPECT_TRUE(write_png(picture, stored_file));
             return;
           }
           const auto stored = read_png(stored_file);
           ASSERT_TRUE(stored)
               << stored.error().message
               << " For a new scene, draw it with THIMBLE_WRITE_SHOTS=1 and check it.";
           const PictureDifference found = difference(*stored, picture);
           if (!alike(found)) {
             const fs::path drawn_file = fs::path(testing::TempDir()) / (name + "_drawn.png");
             EXPECT_TRUE(write_png(picture, drawn_file));
             ADD_FAILURE() << name << " looks different: mean " << found.mean
                           << " of 255, bad blocks " << found.bad_blocks << "; compare "
                           << stored_file << " with " << drawn_file
                           << ". If the change is intended, store it with THIMBLE_WRITE_SHOTS=1.";
           }
           // Controls: differences that this test must detect.
           ShotChoice armless = small_choice();
           armless.camera = painter.camera();
           armless.paint.marks.arm = false;
           EXPECT_FALSE(alike(difference(*stored, painter_of(drawn, armless).paint(moment, plots))))
               << name << " without its arm is not detected";
           if (std::any_of(moment.shapes.begin(), moment.shapes.end(),
                           [](const auto& shape) { return shape != nullptr; })) {
             DrawnMoment unshaped = moment;
             unshaped.shapes.clear();
             ShotChoice same_camera = small_choice();
             same_camera.camera = painter.camera();
             const Picture as_at_first = painter_of(drawn, same_camera).paint(unshaped, plots);
             EXPECT_GT(difference(picture, as_at_first).mean, 0)
                 << name << " without its shape is not detected";
           }
           // Of several bodies that moved, each is detected.
           const auto moved = [](const render::BodyPose& pose) {
             return std::abs(pose.p_WB[0]) + std::abs(pose.p_WB[1]) + std::abs(pose.p_WB[2]) >
                    0.004;
           };
           if (std::count_if(moment.poses.begin(), moment.poses.end(), moved) > 1) {
             ShotChoice one_body = small_choice();
             one_body.camera = painter.camera();
             DrawnMoment first_only = moment;
             bool first = true;
             for (render::BodyPose& pose : first_only.poses) {
               if (moved(pose) && !std::exchange(first, false)) pose = {};
             }
             EXPECT_FALSE(
                 alike(difference(*stored, painter_of(drawn, one_body).paint(first_only, plots))))
                 << name << " with one body only is not detected";
           }
           const bool solid =
               std::any_of(drawn.objects.begin(), drawn.objects.end(),
                           [](const auto& o) { return !o.mesh.triangles.empty() && !o.endless; });
           if (!solid) return;
           ShotChoice as_before = small_choice();
           as_before.camera = painter.camera();
           for (render::BodyPose& pose : moment.poses) pose.p_WB[1] += 0.004;
           EXPECT_FALSE(
               alike(difference(*stored, painter_of(drawn, as_before).paint(moment, plots))))
               << name << " moved by 4 mm is not detected";
         });
  }
}

/// A picture with marks, as it is stored.
struct MarkedShot {
  const char* name;
  const char* scene;  ///< In app/scenes, or in tests/data/scenes.
  double second;
  void (*choose)(PaintChoice& paint);
};

TEST(Shots, FieldsTrailTexturesAndCollidersMatchStoredShots) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  const MarkedShot shots[] = {
      {"charges_fields", "charges", 3.008,
       [](PaintChoice& paint) {
         paint.fields = true;
         paint.theme = Theme::kDark;
       }},
      {"charges_trail", "charges", 3.008, [](PaintChoice& paint) { paint.trail = true; }},
      {"sandpaper_surfaces", "sandpaper", 2.0,
       [](PaintChoice& paint) {
         paint.surfaces = true;
         paint.marks.contact = true;
       }},
      {"colliders", "colliders", 0.3, [](PaintChoice& paint) { paint.colliders = true; }},
      {"cans_colliders", "cans", 5.0, [](PaintChoice& paint) {
         paint.colliders = true;
         paint.theme = Theme::kDark;
       }}};
  for (const MarkedShot& shot : shots) {
    const fs::path stored_file =
        fs::path(THIMBLE_TEST_DATA) / "shots" / (std::string(shot.name) + ".png");
    const std::string file = std::string(shot.scene) + ".yaml";
    const fs::path shipped = fs::path(THIMBLE_SOURCE_DIR) / "app/scenes" / file;
    play(fs::exists(shipped) ? shipped : fs::path(THIMBLE_TEST_DATA) / "scenes" / file, shot.second,
         [&](const DrawnScene& drawn, DrawnMoment& moment, const Plots& plots) {
           ShotChoice choice = small_choice();
           choice.paint.marks.arm = false;
           ShotPainter without = painter_of(drawn, choice);
           const Picture bare = without.paint(moment, plots);
           choice.camera = without.camera();
           shot.choose(choice.paint);
           const Picture picture = painter_of(drawn, choice).paint(moment, plots);
           if (std::getenv("THIMBLE_WRITE_SHOTS") != nullptr) {
             EXPECT_TRUE(write_png(picture, stored_file));
             return;
           }
           const auto stored = read_png(stored_file);
           ASSERT_TRUE(stored) << stored.error().message;
           EXPECT_TRUE(alike(difference(*stored, picture))) << shot.name << " looks different";
           EXPECT_FALSE(alike(difference(*stored, bare))) << shot.name << " shows no marks";
         });
  }
}

TEST(Shots, AreDeterministic) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  std::vector<Picture> pictures;
  for (int i = 0; i < 2; ++i) {
    play(fs::path(THIMBLE_SOURCE_DIR) / "app/scenes/water_balloon.yaml", 1.0,
         [&](const DrawnScene& drawn, DrawnMoment& moment, const Plots& plots) {
           ShotChoice choice = small_choice();
           choice.plots = true;
           choice.paint.marks.edge_planes = true;
           pictures.push_back(painter_of(drawn, choice).paint(moment, plots));
         });
  }
  ASSERT_EQ(pictures.size(), 2U);
  EXPECT_EQ(pictures[0].rgb, pictures[1].rgb);
}

}  // namespace
}  // namespace thimble::view
