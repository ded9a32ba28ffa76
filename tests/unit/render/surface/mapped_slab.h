#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "surface/height_image.h"
#include "surface/texture/height_map.h"
#include "thimble/render/build_object_touch.h"

/// A slab with maps, pictures for it, and ways to touch it: for tests.
namespace thimble::render::mapped_slab {

using Eigen::Vector2d;
using Eigen::Vector3d;

inline constexpr double kTurn = 2 * std::numbers::pi;
inline constexpr double kStiffness = 800;
inline constexpr double kHalf = 0.02;    // m, half the side of the slab
inline constexpr double kThick = 0.02;   // m
inline constexpr double kHeight = 3e-4;  // m, of the texture
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline driver::DeviceState at(const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  state.dt = 1e-3;
  return state;
}

struct Slab {
  TriangleMesh mesh;
  MeshAttributes attributes;
};

// Returns a slab with its upper face at z = 0, of squares of 5 mm: away from its sides the point of
// the surface is straight above the tip with every tracker. `value(side, p)` gives the uv of the
// corners of the upper face, with side 0 on the left of x = 0, 1 on the right; elsewhere they have
// no area.
template <class Value>
Slab slab(const Value& value) {
  Slab done;
  auto& [mesh, attributes] = done;
  constexpr int kCells = 8, kCorners = kCells + 1;
  for (const double z : {-kThick, 0.0}) {
    for (int row = 0; row < kCorners; ++row) {
      for (int column = 0; column < kCorners; ++column) {
        mesh.vertices.emplace_back(kHalf * (2.0 * column / kCells - 1),
                                   kHalf * (2.0 * row / kCells - 1), z);
      }
    }
  }
  const auto number = [](int column, int row, bool top) {
    return (top ? kCorners * kCorners : 0) + row * kCorners + column;
  };
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (const bool top : {true, false}) {
    for (int row = 0; row < kCells; ++row) {
      for (int column = 0; column < kCells; ++column) {
        const int a = number(column, row, top), b = number(column + 1, row, top);
        const int c = number(column + 1, row + 1, top), d = number(column, row + 1, top);
        top ? quad(a, b, c, d) : quad(d, c, b, a);
      }
    }
  }
  const std::size_t top_triangles = 2 * kCells * kCells;
  for (int i = 0; i < kCells; ++i) {
    quad(number(i, 0, false), number(i + 1, 0, false), number(i + 1, 0, true), number(i, 0, true));
    quad(number(i + 1, kCells, false), number(i, kCells, false), number(i, kCells, true),
         number(i + 1, kCells, true));
    quad(number(0, i + 1, false), number(0, i, false), number(0, i, true), number(0, i + 1, true));
    quad(number(kCells, i, false), number(kCells, i + 1, false), number(kCells, i + 1, true),
         number(kCells, i, true));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    attributes.uv.emplace_back();
    attributes.colours.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& p = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
      attributes.uv[t][k] =
          t < top_triangles ? value(t / 2 % kCells < kCells / 2 ? 0 : 1, p) : Vector2d(0, 0);
      // From 0 on the left to 1 on the right.
      attributes.colours[t][k] = {(p.x() + kHalf) / (2 * kHalf), 0, 0.5};
    }
  }
  return done;
}

// The picture covers the upper face once.
inline Vector2d once(std::size_t, const Vector3d& p) {
  return {(p.x() + kHalf) / (2 * kHalf), (p.y() + kHalf) / (2 * kHalf)};
}

// A ramp to the right, which is 1/32 per pixel. A cubic spline reproduces it exactly, but for the
// two pixels next to its step.
inline std::shared_ptr<const HeightImage> ramp() {
  std::vector<float> values;
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 32; ++column) values.push_back(static_cast<float>(column) / 32);
  }
  return std::make_shared<const HeightImage>(32, 32, values);
}

inline std::shared_ptr<const HeightImage> sine(int side) {
  std::vector<float> values;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      values.push_back(static_cast<float>(0.5 + 0.4 * std::sin(kTurn * column / side)));
    }
  }
  return std::make_shared<const HeightImage>(side, side, values);
}

// Black on the left, white on the right.
inline std::shared_ptr<const HeightImage> halves() {
  std::vector<float> values;
  for (int i = 0; i < 32 * 32; ++i) values.push_back(i % 32 < 16 ? 0.0F : 1.0F);
  return std::make_shared<const HeightImage>(32, 32, values);
}

inline EffectContext context() {
  EffectContext known;
  known.force_max = 5;
  known.surface_stiffness = kStiffness;
  return known;
}

inline SurfaceChoice plain() {
  return {.spring = {.stiffness = kStiffness, .damping = 0}};
}

template <class Stage>
EffectPlan effect(const typename Stage::Settings& settings) {
  static constexpr EffectKind kKind = effect_kind<Stage>();
  if constexpr (requires { Stage::builder(settings, context()); }) {
    return {&kKind, Stage::builder(settings, context())};
  } else {
    return {&kKind, [settings]() -> std::unique_ptr<AnyStage> {
              return std::make_unique<AnyStageOf<Stage>>(Stage(settings, context()));
            }};
  }
}

inline SurfaceChoice textured(const Slab& on, const std::shared_ptr<const HeightImage>& image,
                              double height = kHeight) {
  HeightMap::Settings settings;
  settings.image = image;
  settings.height = height;
  settings.map = HeightMap::Mapping::kUv;
  SurfaceChoice surface = plain();
  surface.effects.push_back(effect<HeightMap>(settings));
  surface.maps = make_surface_maps(on.mesh, on.attributes).value();
  return surface;
}

inline std::unique_ptr<ObjectTouch> build(const Slab& on, const SurfaceChoice& surface,
                                          const ContactChoice& contact = {}) {
  auto touch = build_object_touch(on.mesh, contact, surface);
  EXPECT_TRUE(touch) << (touch ? "" : touch.error().message);
  return touch ? std::move(touch).value() : nullptr;
}

inline std::string error_of(const Slab& on, const SurfaceChoice& surface) {
  const auto touch = build_object_touch(on.mesh, {}, surface);
  return touch ? "built" : touch.error().message;
}

// Returns the force at a place of the upper face and a depth, straight from above.
inline Vector3d press(ObjectTouch& touch, double x, double y, double depth) {
  touch.update(at({x, y, 0.01}));
  touch.update(at({x, y, 1e-5}));
  return touch.update(at({x, y, -depth})).f_T_W;
}

inline std::vector<ContactChoice> all_contacts() {
  std::vector<ContactChoice> all;
  for (const TrackerChoice tracker :
       {TrackerChoice::kEdgePlanes, TrackerChoice::kOffset, TrackerChoice::kPacked,
        TrackerChoice::kNormalProjection, TrackerChoice::kGodObject}) {
    ContactChoice choice;
    choice.tracker = tracker;
    all.push_back(choice);
  }
  ContactChoice ball;
  ball.tip_radius = 0.002;
  all.push_back(ball);
  return all;
}

// Presses by the radius of the tip above the surface.
inline Vector3d press(ObjectTouch& touch, const ContactChoice& contact, double x, double y,
                      double depth) {
  return press(touch, x, y, depth - contact.tip_radius);
}

// The picture does not match at x = 0: the height steps by half of it there.
inline Vector2d torn(std::size_t side, const Vector3d& p) {
  return {(p.x() + kHalf) / (4 * kHalf) + (side == 0 ? 0.1 : 0.4), (p.y() + kHalf) / (2 * kHalf)};
}

inline SurfaceChoice stiff_by_colour(const Slab& on, double black) {
  SurfaceChoice surface = plain();
  surface.maps = make_surface_maps(on.mesh, on.attributes).value();
  surface.stiffness_map = MapChoice{.channel = 0, .black = black, .white = 1};
  return surface;
}

struct Work {
  double net = 0, gross = 0;
};

// Returns the work along a path with the mean of the forces at both ends of each step.
template <class Way>
Work work_along(ObjectTouch& touch, const Way& way, int steps) {
  Work work;
  Vector3d before = touch.update(at(way(0.0))).f_T_W;
  for (int i = 1; i <= steps; ++i) {
    const Vector3d step = way(double(i) / steps) - way(double(i - 1) / steps);
    const Vector3d f_W = touch.update(at(way(double(i) / steps))).f_T_W;
    const double power = (f_W + before).dot(step) / 2;
    work.net += power;
    work.gross += std::abs(power);
    before = f_W;
  }
  return work;
}

}  // namespace thimble::render::mapped_slab
