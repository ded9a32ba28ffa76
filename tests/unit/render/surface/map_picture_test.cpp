// The map of a surface that viewers draw.
#include "map_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>
#include <vector>

#include "surface/map/surface_maps.h"
#include "surface/map/triangle_grid.h"
#include "surface/texture/height_map.h"
#include "surface/texture/uv_height_map.h"

namespace thimble::render {
namespace {

// Two triangles of a square of 10 mm, with one picture over both. Red grows to the right.
TriangleMesh square() {
  return {{{0, 0, 0}, {0.01, 0, 0}, {0.01, 0.01, 0}, {0, 0.01, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

std::shared_ptr<const SurfaceMaps> maps_of(const TriangleMesh& mesh) {
  MeshAttributes attributes;
  for (const auto& triangle : mesh.triangles) {
    auto& uv = attributes.uv.emplace_back();
    auto& colours = attributes.colours.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d p = mesh.vertices[static_cast<std::size_t>(triangle[k])] / 0.01;
      uv[k] = p.head<2>();
      colours[k] = {p.x(), 0, 0};
    }
  }
  return make_surface_maps(mesh, attributes).value();
}

std::shared_ptr<const HeightImage> halves() {  // black on the left, white on the right
  std::vector<float> values;
  for (int i = 0; i < 32 * 32; ++i) values.push_back(i % 32 < 16 ? 0.0F : 1.0F);
  return std::make_shared<const HeightImage>(32, 32, values);
}

EffectPlan height_effect() {
  static const EffectKind kind = effect_kind<HeightMap>();
  return {&kind, StageBuilder::on_maps([](const std::shared_ptr<const SurfaceMaps>& maps) {
            HeightMap::Settings settings;
            settings.image = halves();
            settings.height = 1e-5;
            EffectContext context;
            context.force_max = 5;
            context.surface_stiffness = 800;
            return UvHeightMap::on(maps, settings, context);
          })};
}

SurfaceChoice all_maps() {
  SurfaceChoice surface;
  surface.spring.stiffness = 800;
  surface.maps = maps_of(square());
  surface.stiffness_map = MapChoice{.image = halves(), .black = 0.25, .white = 1};
  surface.friction_map = MapChoice{.channel = 0, .black = 0.5, .white = 2};
  surface.effects = {height_effect()};
  return surface;
}

TEST(MapPicture, ShowsStiffnessThenFrictionThenHeight) {
  SurfaceChoice surface = all_maps();
  const auto stiffness = map_picture(surface, square());
  ASSERT_TRUE(stiffness);
  EXPECT_EQ(stiffness->quantity, "stiffness");
  EXPECT_EQ(stiffness->unit, "N/m");
  EXPECT_EQ(stiffness->min, 200);
  EXPECT_EQ(stiffness->max, 800);
  surface.stiffness_map.reset();
  const auto friction = map_picture(surface, square());
  ASSERT_TRUE(friction);
  EXPECT_EQ(friction->quantity, "friction factor");
  EXPECT_EQ(friction->min, 0.5);
  EXPECT_EQ(friction->max, 2);
  surface.friction_map.reset();
  const auto height = map_picture(surface, square());
  ASSERT_TRUE(height);
  EXPECT_EQ(height->quantity, "height");
  EXPECT_EQ(height->unit, "mm");
  EXPECT_DOUBLE_EQ(height->min, -0.01);
  EXPECT_EQ(height->max, 0);
  surface.effects.clear();
  EXPECT_FALSE(map_picture(surface, square()));
}

TEST(MapPicture, HasTheValueOfThePictureAtEachGridPoint) {
  const TriangleMesh mesh = square();
  const auto picture = map_picture(all_maps(), mesh);
  ASSERT_TRUE(picture);
  EXPECT_GE(picture->parts, 32U);  // a pixel is 1/32 of the side
  const std::size_t points = grid_points(picture->parts);
  ASSERT_EQ(picture->values.size(), 2 * points);
  int compared = 0;
  for (std::size_t t = 0; t < 2; ++t) {
    const auto at = [&](std::size_t k) {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
    };
    for (std::size_t i = 0; i <= picture->parts; ++i) {
      for (std::size_t k = 0; i + k <= picture->parts; ++k) {
        const double u = static_cast<double>(i) / picture->parts;
        const double v = static_cast<double>(k) / picture->parts;
        const double x = (at(0) + u * (at(1) - at(0)) + v * (at(2) - at(0))).x() / 0.01;
        // The spline blurs some pixels at the borders of the halves.
        if (std::abs(x - 0.5) < 0.15 || x < 0.15 || x > 0.85) continue;
        const float value = picture->values[t * points + grid_point(picture->parts, i, k)];
        ASSERT_NEAR(value, x < 0.5 ? 0 : 1, 0.02) << x;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(MapPicture, AVertexColourNeedsNoMorePointsThanTheCorners) {
  SurfaceChoice surface = all_maps();
  surface.stiffness_map.reset();
  const auto picture = map_picture(surface, square());
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->parts, 1U);
  // By i, then by k: the corners a, c, b of each triangle.
  EXPECT_EQ(picture->values, (std::vector<float>{0, 1, 1, 0, 0, 1}));
}

TEST(MapPicture, ARangeUpsideDownIsStillFromLowToHigh) {
  SurfaceChoice surface = all_maps();
  surface.stiffness_map.reset();
  surface.friction_map = MapChoice{.channel = 0, .black = 2, .white = 0.5};
  const auto picture = map_picture(surface, square());
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->min, 0.5);
  EXPECT_EQ(picture->max, 2);
  EXPECT_EQ(picture->values[0], 1);
  EXPECT_EQ(picture->values[1], 0);
}

TEST(MapPicture, StaysWithinItsNumberOfParts) {
  const auto picture = map_picture(all_maps(), square(), 50);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->parts, 5U);  // 25 parts of each of two triangles
}

TEST(TriangleGrid, PartsCoverTheTriangleOnce) {
  for (const std::size_t parts : {std::size_t{1}, std::size_t{2}, std::size_t{7}}) {
    std::set<std::size_t> points;
    std::vector<Eigen::Vector2d> place(grid_points(parts));
    for (std::size_t i = 0; i <= parts; ++i) {
      for (std::size_t k = 0; i + k <= parts; ++k) {
        points.insert(grid_point(parts, i, k));
        place[grid_point(parts, i, k)] = {static_cast<double>(i), static_cast<double>(k)};
      }
    }
    EXPECT_EQ(points.size(), grid_points(parts));
    EXPECT_EQ(*points.rbegin(), grid_points(parts) - 1);
    double area = 0;
    for_each_part(parts, [&](const std::array<std::size_t, 3>& part) {
      const Eigen::Vector2d ab = place[part[1]] - place[part[0]];
      const Eigen::Vector2d ac = place[part[2]] - place[part[0]];
      const double twice = ab.x() * ac.y() - ab.y() * ac.x();
      EXPECT_EQ(twice, 1);  // the orientation of the triangle
      area += twice;
    });
    EXPECT_EQ(area, static_cast<double>(parts * parts));
  }
}

}  // namespace
}  // namespace thimble::render
