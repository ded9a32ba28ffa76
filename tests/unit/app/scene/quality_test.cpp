#include "thimble/scene/quality.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "quality/quality_table.h"
#include "studies/accuracy/quality_points.h"
#include "studies/cost/cost_subjects.h"
#include "support/covered.h"
#include "support/scratch.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::scene {
namespace {

using render::BlendingChoice;
using render::TrackerChoice;

TEST(Quality, NormalChangesNothingAndOthersReportTheirChoices) {
  Scene scene;
  scene.objects.resize(2);
  scene.objects[0].name = "round";
  scene.objects[0].contact.tracker = TrackerChoice::kEdgePlanes;
  scene.objects[1].name = "soft";
  scene.objects[1].body.dent.emplace();
  EXPECT_TRUE(apply_quality(Quality::kNormal, scene).empty());
  EXPECT_FALSE(scene.objects[0].contact.blending);
  EXPECT_EQ(scene.objects[1].body.dent->rings, render::DentSettings{}.rings);

  const auto said = apply_quality(quality_named("reference").value(), scene);
  ASSERT_EQ(said.size(), 3U);
  EXPECT_NE(said[0].find("round: Phong"), std::string::npos);
  EXPECT_EQ(scene.objects[0].contact.blending, BlendingChoice::kPhong);
  EXPECT_TRUE(scene.objects[0].contact.curved_depth.value_or(false));
  EXPECT_EQ(scene.objects[1].body.dent->integrator, render::SpringScheme::kTrapezoid);
  EXPECT_GE(scene.objects[1].body.dent->substeps, 8);
  EXPECT_FALSE(quality_named("best"));

  // Settings that the scene names do not change.
  Scene named;
  named.objects.resize(2);
  named.objects[0].contact.blending = BlendingChoice::kFixedBand;
  named.objects[1].contact.tracker = TrackerChoice::kOffset;
  named.objects[1].tracker_named = true;
  apply_quality(Quality::kReference, named);
  EXPECT_EQ(named.objects[0].contact.blending, BlendingChoice::kFixedBand);
  apply_quality(Quality::kDraft, named);
  EXPECT_EQ(named.objects[1].contact.tracker, TrackerChoice::kOffset);
}

// Returns all settings that a quality may change, as text.
std::string resolved(const Scene& scene) {
  std::string text = fmt::format("{} Hz", scene.rate);
  for (const SceneObject& object : scene.objects) {
    const render::ContactChoice& c = object.contact;
    text += fmt::format("; {} {} {}", static_cast<int>(c.tracker),
                        c.blending ? static_cast<int>(*c.blending) : -1,
                        c.curved_depth ? static_cast<int>(*c.curved_depth) : -1);
    if (const auto& dent = object.body.dent) {
      text +=
          fmt::format(" {} rings {} {} {} {} s", dent->rings, static_cast<int>(dent->integrator),
                      dent->substeps, dent->remainder, dent->step);
    }
  }
  return text;
}

Scene at_quality(const std::filesystem::path& file, Quality quality) {
  auto scene = load_scene(file, {.mesh_folder = THIMBLE_MESHES,
                                 .rate_factor = rate_factor_of(quality),
                                 .several_arms = true});
  if (!scene) {
    ADD_FAILURE() << scene.error().message;
    return {};
  }
  apply_quality(quality, *scene);
  return std::move(scene).value();
}

TEST(Quality, DraftAndReferenceChangeSomethingInEveryShippedScene) {
  int scenes = 0;
  support::Covered covered("scenes");
  const bool has_meshes =
      std::filesystem::exists(std::filesystem::path(THIMBLE_MESHES) / "elephant.off");
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    if (entry.path().stem() == "elephant" && !has_meshes) continue;
    const Scene normal = at_quality(entry.path(), Quality::kNormal);
    const Scene draft = at_quality(entry.path(), Quality::kDraft);
    const Scene reference = at_quality(entry.path(), Quality::kReference);
    EXPECT_NE(resolved(draft), resolved(normal)) << entry.path();
    EXPECT_NE(resolved(reference), resolved(normal)) << entry.path();
    EXPECT_LE(draft.rate, normal.rate) << entry.path();
    // The step of moving bodies is the period of the loop at any rate.
    for (const Scene* scene : {&draft, &reference}) {
      for (const SceneObject& object : scene->objects) {
        if (object.body.dent) {
          EXPECT_DOUBLE_EQ(object.body.dent->step * scene->rate, 1) << entry.path();
        }
        if (object.body.motion) {
          EXPECT_DOUBLE_EQ(object.coupling.step * scene->rate, 1) << entry.path();
        }
      }
    }
    EXPECT_LE(
        1e-9 * static_cast<double>(reference.arms.front().arm.simulated.firmware.report_period_ns),
        1 / reference.rate + 1e-9);
    ++scenes;
    covered.add(entry.path().stem().string());
  }
  EXPECT_GE(scenes, 13);
}

constexpr const char* kScene = R"(name: ring
arm: {}
duration: 1
objects:
  - {{name: ring, mesh: ring.off, stiffness: {}{}}}
hand:
  path: [{{t: 0, at: [0, 0, 0.05]}}, {{t: 1, at: [0, 0, 0.05]}}]
)";

std::filesystem::path ring_scene(int across, double stiffness, const std::string& more = "") {
  const std::filesystem::path folder = support::scratch_folder() / "quality";
  std::filesystem::create_directories(folder);
  EXPECT_TRUE(
      render::save_mesh(studies::kCostRing.mesh(2 * across, across), folder / "ring.off").ok());
  std::ofstream(folder / "ring.yaml") << fmt::format(
      kScene,
      (std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml").string(),
      stiffness, more);
  return folder / "ring.yaml";
}

TEST(Quality, DraftKeepsTheRateOfStiffSurfaces) {
  // 4 N s/m of hand and surface over 2 ms are stable up to 2,000 N/m; half of that is allowed.
  const SceneReading slow{.rate_factor = 0.5};
  EXPECT_EQ(load_scene(ring_scene(8, 700), slow)->rate, 500);
  EXPECT_EQ(load_scene(ring_scene(8, 1500), slow)->rate, 1000);
  EXPECT_EQ(load_scene(ring_scene(8, 1500), slow)->rate_factor, 1);
  // Mistakes in the file are reported as usual.
  EXPECT_FALSE(load_scene(ring_scene(8, 700, ", colour: red"), slow).ok());
}

TEST(Quality, AutoChoosesTheCheapestImperceptiblePoint) {
  const QualityTable& table = quality_table();
  for (const int across : {24, 48}) {
    auto scene = load_scene(ring_scene(across, 800));
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const auto said = apply_quality(Quality::kAuto, *scene);
    ASSERT_EQ(said.size(), 2U);
    EXPECT_NE(said[0].find("ns per tick, error"), std::string::npos) << said[0];
    EXPECT_NE(said[1].find(std::string(table.measured)), std::string::npos) << said[1];
    // For a ring of the table the expected choice is a row of the table.
    const ContactPoint* best = nullptr;
    const double turn = typical_turn(
        render::ContactMesh::build(studies::kCostRing.mesh(2 * across, across)).value());
    for (const ContactPoint& point : table.contacts) {
      if (std::abs(point.turn / turn - 1) > 1e-3 || point.error > 1) continue;
      if (best == nullptr || point.ns < best->ns) best = &point;
    }
    ASSERT_NE(best, nullptr);
    const render::ContactChoice& chosen = scene->objects[0].contact;
    EXPECT_EQ(chosen.tracker, best->tracker);
    EXPECT_EQ(chosen.blending, best->blending);
    EXPECT_EQ(chosen.curved_depth, best->curved_depth);
  }
}

TEST(Quality, AutoKeepsTheBudgetOrReportsThatNothingFits) {
  const auto chosen = [](double budget) {
    auto scene = load_scene(ring_scene(32, 800)).value();
    return std::pair(apply_quality(Quality::kAuto, scene, budget), scene.objects[0].contact);
  };
  EXPECT_NE(chosen(1).first.back().find("Nothing fits into 1 ns"), std::string::npos);
  EXPECT_EQ(chosen(1).second.tracker, TrackerChoice::kEdgePlanes);
  EXPECT_EQ(chosen(1).second.blending, BlendingChoice::kFlat);
  EXPECT_EQ(chosen(40).second.blending, BlendingChoice::kFlat);  // compact takes more
  EXPECT_NE(chosen(40).first.back().find("of the 40 ns"), std::string::npos);
  EXPECT_EQ(chosen(1000).second.tracker, TrackerChoice::kPacked);
}

TEST(Quality, AutoLimitsTheStepOfADent) {
  const std::string dent = ", body: {dent: {rings: 6}}";
  auto scene = load_scene(ring_scene(16, 100, dent)).value();
  apply_quality(Quality::kAuto, scene);
  const render::DentSettings& settings = *scene.objects[0].body.dent;
  EXPECT_EQ(settings.integrator, render::SpringScheme::kTrapezoid);
  EXPECT_GT(settings.substeps, 1);
  EXPECT_EQ(settings.rings, 1);
  auto named = load_scene(ring_scene(16, 800, ", contact: {tracker: offset}")).value();
  apply_quality(Quality::kAuto, named);
  EXPECT_EQ(named.objects[0].contact.tracker, TrackerChoice::kOffset);
}

TEST(Quality, StoredErrorsMatchTheStudy) {
  const studies::AccuracyAxis axis = studies::contact_points_axis();
  const auto stored = quality_table().contacts;
  std::size_t next = 0;
  for (const studies::AccuracyLine& line : axis.lines) {
    for (const studies::AccuracyPoint& point : line.points) {
      ASSERT_LT(next, stored.size());
      const ContactPoint& one = stored[next++];
      EXPECT_NEAR(one.turn / point.knob, 1, 1e-4) << line.name << ' ' << point.name;
      // A new measurement may differ only in the last bits; the table has five digits.
      EXPECT_NEAR(one.error / point.error(), 1, 1e-3) << line.name << ' ' << point.name;
      EXPECT_GT(one.ns, 0);
    }
  }
  EXPECT_EQ(next, stored.size());
  EXPECT_GE(quality_table().version, 1);
  EXPECT_FALSE(quality_table().measured.empty());
}

}  // namespace
}  // namespace thimble::scene
