#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <memory>

#include "body/dent/bendable_polygon.h"
#include "gl_or_skip.h"
#include "mesh/surface_weights.h"
#include "picture_difference.h"
#include "support/meshes/shapes.h"
#include "view/scene_painter.h"

namespace thimble::view {
namespace {

using support::difference;

/// The coarsest ball (app/scenes/soft_coarse.yaml), a camera in front of one of its triangles, and
/// the patch of the slightest touch.
struct FirstTouch {
  FirstTouch() {
    scene.objects.push_back({.name = "ball", .mesh = support::icosphere(0, 0.04)});
    const auto& mesh = scene.objects[0].mesh;
    auto contact =
        std::make_shared<const render::ContactMesh>(render::ContactMesh::build(mesh).value());
    auto dent = render::BendablePolygon::build(contact, {}).value();
    camera.distance = 0.25;
    // Straight in front of it, where a change is largest in the picture.
    std::int32_t facing = 0;
    for (std::int32_t t = 0; t < contact->triangle_count(); ++t) {
      if (contact->cell(t).face.n.dot(camera.towards_eye()) >
          contact->cell(facing).face.n.dot(camera.towards_eye())) {
        facing = t;
      }
    }
    const Eigen::Vector3d w(0.5, 0.3, 0.2);
    dent.touch(facing, w,
               render::point_at(*contact, facing, w) - 1e-9 * contact->cell(facing).face.n);
    dent.draw(touched.patch);
    touched.patch.object = 0;
    choice.edges = Edges::kOff;
    choice.marks = {.arm = false, .tip = false, .force = false, .edge_planes = false};
  }

  DrawnScene scene;
  DrawnMoment before, touched;
  Camera camera;
  PaintChoice choice;
};

TEST(FirstTouch, ChangesNoShade) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  FirstTouch first;
  ScenePainter painter(first.scene, ScenePrograms::make().value());
  Canvas canvas(480, 480);
  ASSERT_GE(first.touched.patch.triangle_count, 12);
  for (const Shading shading : {Shading::kGouraud, Shading::kPhong}) {
    first.choice.shading = shading;
    const auto paint = [&](const DrawnMoment& moment, DentNormals normals) {
      first.choice.dent_normals = normals;
      painter.paint(moment, first.camera, first.choice, canvas);
      return canvas.read();
    };
    const Picture before = paint(first.before, DentNormals::kSplit);
    const auto cured = difference(before, paint(first.touched, DentNormals::kSplit));
    const auto naive = difference(before, paint(first.touched, DentNormals::kNaive));
    std::printf(
        "%s: at first touch the picture changes by up to %.0f of 255 (mean %.4f) with naive "
        "normals, %.0f (mean %.4f) with split ones\n",
        shading == Shading::kPhong ? "Phong" : "Gouraud", naive.max, naive.mean, cured.max,
        cured.mean);
    EXPECT_GT(naive.max, 5);  // the jump that the patch must not show
    // The rest is rounding, and samples on the new edges.
    EXPECT_LE(cured.mean, 0.002);
    EXPECT_LE(cured.mean, naive.mean / 50);
    EXPECT_EQ(cured.bad_blocks, 0);
  }
}

}  // namespace
}  // namespace thimble::view
