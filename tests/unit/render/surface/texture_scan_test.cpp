// Net work of textures around closed loops over scanned meshes, where closest points jump at
// creases, grooves and edges of flat faces: its size with every tracker and every texture.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/covered.h"
#include "support/long_form.h"
#include "support/random.h"
#include "support/tracker_names.h"
#include "surface/texture/height_map.h"
#include "surface/texture/sandpaper.h"
#include "surface/texture/sines.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "unit/render/surface/open_loop.h"

namespace thimble::render::texture_scan_test {
namespace {

using Eigen::Vector3d;

constexpr double kSize = 0.1;  // longest side of every scan, m
constexpr std::array kScans{"bunny00.off", "elephant.off", "hand.off", "camel.off"};
constexpr std::array kTextures{"sines", "sandpaper", "height_map", "height_map along z"};

// Bounds of the net work that a texture adds around a closed loop, as a fraction of the work in and
// out. [measured] With `offset` it is 1e-13 where the closest point moves continuously. Where cells
// do not share swept sides (creases, grooves, inverted cells) the closest point jumps by up to 3
// mm, and the height with it. `compact` stores weights in single precision: its closest point jumps
// slightly at each edge. The faces of the others never share swept sides.
struct Bounds {
  double median = 0, of_nine_in_ten = 0;
};

Bounds bounds(TrackerChoice tracker, std::size_t which) {
  constexpr double kOfNineInTen = 0.15;
  if (tracker != TrackerChoice::kOffset && tracker != TrackerChoice::kPacked) {
    return {0.04, kOfNineInTen};
  }
  // A height map along all axes omits the change of its parts (height_map.h).
  if (which == 2) return {1e-2, kOfNineInTen};
  return {tracker == TrackerChoice::kOffset ? 5e-9 : 1e-3, kOfNineInTen};
}

template <class Stage>
SurfaceChoice textured(const typename Stage::Settings& settings) {
  static constexpr EffectKind kKind = effect_kind<Stage>();
  return {.spring = {.stiffness = 800, .damping = 0},
          .effects = {{&kKind, [settings]() -> std::unique_ptr<AnyStage> {
                         return std::make_unique<AnyStageOf<Stage>>(Stage(settings, {}));
                       }}}};
}

std::shared_ptr<const HeightImage> bumps() {
  support::Random random(4);
  constexpr std::size_t kSide = 16;
  std::vector<float> values(kSide * kSide);
  for (float& value : values) value = static_cast<float>(random.uniform(0, 1));
  return std::make_shared<const HeightImage>(kSide, kSide, std::move(values));
}

/// About 0.1 mm high, over lengths of about 4 mm.
SurfaceChoice texture(std::size_t which, TextureForm form) {
  if (which == 0) {
    Sines::Settings settings;
    settings.form = form;
    settings.waves = {{.amplitude = 5e-5, .wavelength = 0.004, .direction = {1, 0.3, 0.2}},
                      {.amplitude = 5e-5, .wavelength = 0.005, .direction = {0.1, 1, 0.4}},
                      {.amplitude = 5e-5, .wavelength = 0.003, .direction = {-0.2, 0.3, 1}}};
    return textured<Sines>(settings);
  }
  if (which == 1) {
    Sandpaper::Settings settings;
    settings.form = form;
    settings.wavelength = 0.004;
    settings.roughness = 3e-5;
    return textured<Sandpaper>(settings);
  }
  HeightMap::Settings settings;
  settings.form = form;
  settings.image = bumps();
  settings.width = 0.02;
  settings.height = 1e-4;
  settings.along = which == 2 ? HeightMap::Along::kAll : HeightMap::Along::kZ;
  return textured<HeightMap>(settings);
}

TriangleMesh scan(const char* name) {
  TriangleMesh mesh = load_mesh(std::filesystem::path(THIMBLE_MESHES) / name).value();
  Vector3d low = mesh.vertices[0], high = low;
  for (const Vector3d& p : mesh.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double scale = kSize / (high - low).maxCoeff();
  for (Vector3d& p : mesh.vertices) p = scale * (p - (low + high) / 2);
  return mesh;
}

/// Returns the fractions that a texture adds over closed loops, in ascending order: only of loops
/// with both tips in contact all the way.
std::vector<double> shares(const TriangleMesh& mesh, TrackerChoice tracker, std::size_t which,
                           TextureForm form, std::size_t loops, std::uint64_t seed) {
  ContactChoice choice;
  choice.tracker = tracker;
  const SurfaceChoice plain{.spring = {.stiffness = 800, .damping = 0}, .effects = {}};
  const auto bare_object = build_object_touch(mesh, choice, plain).value();
  const auto rough_object = build_object_touch(mesh, choice, texture(which, form)).value();
  const auto bare = [&](const driver::DeviceState& state) { return bare_object->update(state); };
  const auto rough = [&](const driver::DeviceState& state) { return rough_object->update(state); };
  support::Random random(seed);
  std::vector<double> found;
  for (std::size_t attempt = 0; attempt < 10 * loops && found.size() < loops; ++attempt) {
    const auto& corners = mesh.triangles[random.bits() % mesh.triangles.size()];
    const auto corner = [&](std::size_t k) {
      return mesh.vertices[static_cast<std::size_t>(corners[k])];
    };
    const Vector3d n = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    const Vector3d x = (corner(1) - corner(0)).normalized(), y = n.cross(x);
    const Vector3d middle = (corner(0) + corner(1) + corner(2)) / 3;
    const double wide = random.uniform(0.0005, 0.002), narrow = random.uniform(0.0005, 0.002);
    const double depth = random.uniform(0.001, 0.002);
    const auto way = [&](double s) -> Vector3d {
      return middle + wide * std::cos(s) * x + narrow * std::sin(s) * y -
             (depth + 0.0003 * std::sin(s + 1)) * n;
    };
    const OpenLoop open = open_loop(bare, rough, middle + 0.005 * n, way, 400);
    if (open.felt && std::isfinite(open.added)) found.push_back(std::abs(open.added));
    // Out again, so that the next contact begins outside.
    driver::DeviceState away;
    away.dt = 1e-3;
    away.p_WT = {0, 0, 1e9};
    static_cast<void>(bare(away));
    static_cast<void>(rough(away));
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The same for all scans.
std::vector<double> all_shares(TrackerChoice tracker, std::size_t which, TextureForm form) {
  const std::size_t loops = support::long_form() ? 44 : 6;
  std::vector<double> all;
  for (const char* const name : kScans) {
    const auto found = shares(scan(name), tracker, which, form, loops, 3);
    EXPECT_GE(found.size(), loops / 2) << name;
    all.insert(all.end(), found.begin(), found.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

double median(const std::vector<double>& all) {
  return all[all.size() / 2];
}

bool scans_are_here() {
  return std::filesystem::exists(std::filesystem::path(THIMBLE_MESHES) / kScans[0]);
}
constexpr const char* kNoScans =
    "Needs the scanned meshes: run app/fetch_meshes.sh (it downloads them)";

class TextureOnScansBy : public testing::TestWithParam<TrackerChoice> {};

TEST_P(TextureOnScansBy, AddsLittleWorkAroundClosedWays) {
  if (!scans_are_here()) GTEST_SKIP() << kNoScans;
  for (std::size_t which = 0; which < kTextures.size(); ++which) {
    const auto all = all_shares(GetParam(), which, TextureForm::kConservative);
    const double nine_in_ten = all[all.size() * 9 / 10];
    std::printf("%s, %s: %zu ways, median %.1e, nine in ten below %.1e, worst %.1e\n",
                support::scene_name(GetParam()), kTextures[which], all.size(), median(all),
                nine_in_ten, all.back());
    const Bounds most = bounds(GetParam(), which);
    EXPECT_LT(median(all), most.median) << kTextures[which];
    EXPECT_LT(nine_in_ten, most.of_nine_in_ten) << kTextures[which];
  }
  support::Covered("trackers").add(support::scene_name(GetParam()));
}

// Shows that these bounds are tight: without the force along the slope, loops have more net work.
TEST(TextureOnScans, DepthOnlyTextureAddsFarMoreWork) {
  if (!scans_are_here()) GTEST_SKIP() << kNoScans;
  for (const TrackerChoice tracker : {TrackerChoice::kOffset, TrackerChoice::kPacked}) {
    const auto all = all_shares(tracker, 0, TextureForm::kDepthOnly);
    std::printf("%s, depth only: median %.1e\n", support::scene_name(tracker), median(all));
    EXPECT_GT(median(all), 10 * bounds(tracker, 0).median);
  }
}

INSTANTIATE_TEST_SUITE_P(Trackers, TextureOnScansBy, testing::ValuesIn(support::kTrackers),
                         [](const auto& tested) {
                           return std::string(support::scene_name(tested.param));
                         });

}  // namespace
}  // namespace thimble::render::texture_scan_test
