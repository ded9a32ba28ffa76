// The maps of surfaces, as colours and in the legend.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

#include "support/meshes/shapes.h"
#include "view/maps/map_colour.h"
#include "view/maps/mapped_surfaces.h"
#include "view/overlays/legend.h"

namespace thimble::view {
namespace {

/// A box with a map of three parts along each side: 1 on its upper face, 0 elsewhere.
DrawnObject mapped_box() {
  DrawnObject object;
  object.name = "pad";
  object.mesh = support::box({0.01, 0.02, 0.03});
  object.map = {
      .quantity = "stiffness", .unit = "N/m", .min = 250, .max = 800, .parts = 3, .values = {}};
  for (const auto& triangle : object.mesh.triangles) {
    double low = 1;
    for (const auto v : triangle) {
      low = std::min(low, object.mesh.vertices[static_cast<std::size_t>(v)].z());
    }
    object.map.values.insert(object.map.values.end(), 10, low > 0 ? 1.0F : 0.0F);
  }
  return object;
}

double lightness(const Colour& colour) {
  return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
}

TEST(MapColours, GetDarkerWithTheValueForEveryObject) {
  for (std::size_t object = 0; object < 6; ++object) {
    double last = 2;
    for (int i = 0; i <= 20; ++i) {
      const double now =
          lightness(map_colour(object_colour(object), static_cast<float>(i) / 20.0F));
      EXPECT_LT(now, last - 0.01) << object << ", " << i;
      last = now;
    }
    EXPECT_LT(last, 0.3) << object;
  }
}

TEST(MapColours, EachPartHasTheColourOfItsValue) {
  const DrawnObject object = mapped_box();
  const ColouredMesh mesh = mapped_mesh(object, object_colour(0));
  ASSERT_EQ(mesh.vertices.size(), 12U * 10);
  ASSERT_EQ(mesh.triangles.size(), 12U * 9);
  int high = 0;
  for (const ColouredVertex& vertex : mesh.vertices) {
    const bool above = vertex.n.z() > 0.5F;
    const Colour want = map_colour(object_colour(0), above ? 1.0F : 0.0F);
    EXPECT_FLOAT_EQ(vertex.colour[0], want[0]);
    EXPECT_FLOAT_EQ(vertex.colour[2], want[2]);
    high += above ? 1 : 0;
  }
  EXPECT_EQ(high, 20);
}

TEST(MapColours, PartsAreOnTheSurfaceWithItsNormals) {
  DrawnObject object = mapped_box();
  object.mesh = support::icosphere(1, 0.02);
  object.map.parts = 4;
  object.map.values.assign(object.mesh.triangles.size() * 15, 0.5F);
  const ColouredMesh mesh = mapped_mesh(object, object_colour(0));
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f n =
        (mesh.vertices[b].p - mesh.vertices[a].p).cross(mesh.vertices[c].p - mesh.vertices[a].p);
    EXPECT_GT(n.dot(mesh.vertices[a].p), 0) << "it is turned inside out";
    area += 0.5 * static_cast<double>(n.norm());
  }
  double whole = 0;
  for (const auto& triangle : object.mesh.triangles) {
    const auto at = [&](std::size_t k) {
      return object.mesh.vertices[static_cast<std::size_t>(triangle[k])];
    };
    whole += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  EXPECT_NEAR(area, whole, 1e-5 * whole);
  for (const ColouredVertex& vertex : mesh.vertices) {
    // Shaded as a ball: the normals are not those of the flat triangles.
    EXPECT_GT(vertex.n.dot(vertex.p.normalized()), 0.999F);
  }
}

TEST(MapColours, LegendGivesRangeAndUnit) {
  DrawnScene scene;
  scene.objects = {mapped_box(), mapped_box()};
  scene.objects[1].map = {
      .quantity = "friction factor", .unit = "", .min = 0, .max = 1.5, .parts = 1, .values = {}};
  const Legend legend = legend_of(scene, {}, {});
  ASSERT_EQ(legend.maps.size(), 2U);
  EXPECT_EQ(legend.maps[0].text, "pad: stiffness");
  EXPECT_EQ(legend.maps[0].min, "250");
  EXPECT_EQ(legend.maps[0].max, "800 N/m");
  EXPECT_EQ(legend.maps[1].object, 1U);
  EXPECT_EQ(legend.maps[1].max, "1.5");
}

TEST(MapColours, AnObjectWithoutAMapHasNeitherPartsNorScale) {
  DrawnScene scene;
  scene.objects = {mapped_box()};
  scene.objects[0].map = {};
  EXPECT_TRUE(mapped_mesh(scene.objects[0], object_colour(0)).vertices.empty());
  EXPECT_TRUE(legend_of(scene, {}, {}).maps.empty());
}

}  // namespace
}  // namespace thimble::view
