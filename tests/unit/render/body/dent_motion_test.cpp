#include "body/dent/dent_motion.h"

#include <gtest/gtest.h>

#include <memory>

#include "body/dent/patch_drawing.h"
#include "support/meshes/shapes.h"
#include "support/variant_settings.h"
#include "thimble/render/body/dent_settings.h"
#include "thimble/render/body_patch.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

std::shared_ptr<const ContactMesh> ball(int subdivisions = 2) {
  return std::make_shared<const ContactMesh>(
      ContactMesh::build(support::icosphere(subdivisions, 0.05)).value());
}

DentMotion motion_of(const ContactMesh& mesh, const DentSettings& settings) {
  return DentMotion::build(std::make_shared<const VertexLinks>(mesh), settings).value();
}

TEST(DentSettings, ReadEachOfTheirNumbers) {
  DentSettings settings;
  support::VariantSettings reader({{"mass", 0.002},
                                   {"stiffness", 300.0},
                                   {"damping", 0.3},
                                   {"neighbour_stiffness", 60.0},
                                   {"neighbour_damping", 0.1},
                                   {"reach", 2.0},
                                   {"pull", 0.5},
                                   {"rings", 4.0},
                                   {"integrator", "implicit_euler"},
                                   {"substeps", 3.0},
                                   {"rounds", 7.0}});
  settings.read(reader, {.tick = 5e-4});
  EXPECT_EQ(reader.mistakes, "");
  EXPECT_EQ(settings.mass, 0.002);
  EXPECT_EQ(settings.stiffness, 300);
  EXPECT_EQ(settings.damping, 0.3);
  EXPECT_EQ(settings.neighbour_stiffness, 60);
  EXPECT_EQ(settings.neighbour_damping, 0.1);
  EXPECT_EQ(settings.reach, 2);
  EXPECT_EQ(settings.pull, 0.5);
  EXPECT_FALSE(settings.whole);
  EXPECT_EQ(settings.rings, 4);
  EXPECT_EQ(settings.integrator, SpringScheme::kImplicitEuler);
  EXPECT_EQ(settings.substeps, 3);
  EXPECT_EQ(settings.rounds, 7);
  EXPECT_EQ(settings.step, 5e-4);

  support::VariantSettings whole(support::VariantSettings::Values{{"region", "whole"}});
  settings.read(whole, {});
  EXPECT_TRUE(settings.whole);
  support::VariantSettings both(
      support::VariantSettings::Values{{"region", "whole"}, {"rings", 2.0}});
  settings.read(both, {});
  EXPECT_NE(both.mistakes.find("rings cannot be combined with region: whole"), std::string::npos);
}

TEST(DentMotion, RestingVertexIsNotMoved) {
  const auto mesh = ball();
  DentMotion motion = motion_of(*mesh, {});
  const std::array<std::int32_t, 1> first{0};
  motion.gather(first);
  motion.pull(0, 0, {.stiffness = 200, .damping = 0, .target = {0, 0, 0.001}, .rate = {0, 0, 0}});
  motion.step();
  EXPECT_GT(motion.u(0).norm(), 0);
  EXPECT_GT(motion.v(0).norm(), 0);
  int still = 0;
  for (std::int32_t v = 0; v < mesh->vertex_count(); ++v) {
    if (motion.moves(v)) continue;
    EXPECT_EQ(motion.u(v), Vector3d(0, 0, 0));
    EXPECT_EQ(motion.v(v), Vector3d(0, 0, 0));
    ++still;
  }
  EXPECT_GT(still, 50);
}

TEST(DentMotion, ReturnsTheForceThatMovedTheVertex) {
  const auto mesh = ball();
  for (const SpringScheme scheme :
       {SpringScheme::kSymplecticEuler, SpringScheme::kVerlet, SpringScheme::kImplicitEuler}) {
    DentSettings settings;
    settings.stiffness = 1e-6;  // only the cursor's spring
    settings.damping = settings.neighbour_stiffness = settings.neighbour_damping = 0;
    settings.integrator = scheme;
    DentMotion motion = motion_of(*mesh, settings);
    const std::array<std::int32_t, 1> first{0};
    motion.gather(first);
    for (int tick = 0; tick < 5; ++tick) {
      const Vector3d before = motion.v(0);
      motion.pull(
          0, 0,
          {.stiffness = 50, .damping = 0.01, .target = {1e-4, 2e-4, 3e-4}, .rate = {0, 0, 0}});
      motion.step();
      const Vector3d impulse = settings.mass * (motion.v(0) - before);
      ASSERT_GT(impulse.norm(), 1e-7);
      EXPECT_LT((motion.force(0) * settings.step - impulse).norm(), 1e-3 * impulse.norm())
          << name_of(scheme) << ' ' << tick;
    }
  }
}

TEST(PatchDrawing, ReturnsNothingIfThePatchDoesNotFit) {
  const auto mesh = ball(3);
  const DentMotion motion = motion_of(*mesh, {});
  PatchDrawing drawing(mesh);
  auto patch = std::make_unique<BodyPatch>();
  const Vector3d middle = Vector3d::Constant(1.0 / 3);
  drawing.begin();
  drawing.split(0, middle, {0, 0, 0}, {}, motion);
  drawing.finish(*patch);
  EXPECT_TRUE(patch->complete);
  EXPECT_GE(patch->triangle_count, 6);
  drawing.begin();
  for (std::int32_t t = 0; t < mesh->triangle_count(); t += 4) {
    drawing.split(t, middle, {0, 0, 0}, {}, motion);
  }
  drawing.finish(*patch);
  EXPECT_FALSE(patch->complete);
  EXPECT_EQ(patch->point_count, 0);
  EXPECT_EQ(patch->triangle_count, 0);
  EXPECT_EQ(patch->object, -1);
  EXPECT_EQ(patch->share, 1);
}

}  // namespace
}  // namespace thimble::render
