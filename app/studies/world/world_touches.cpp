#include "studies/world/world_touches.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "studies/added_forces.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/scene_touch.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;
using render::SceneTouch;

constexpr double kAside = 1e-3;    // m along y, so that the path meets no edge by symmetry [chosen]
constexpr double kStep = 0.02e-3;  // m of path per tick, 20 mm/s at 1 kHz [chosen: a slow stroke]

const render::SurfaceChoice kSpring{.spring = {.stiffness = kWorldStiffness}};

/// The boxes of a scene.
using Boxes = std::vector<render::EntryFaceBox>;

render::EntryFaceBox box(const Vector3d& low, const Vector3d& high) {
  render::EntryFaceBox box;
  box.p_WO = 0.5 * (low + high);
  box.half_sides = 0.5 * (high - low);
  return box;
}

SceneTouch scene_of(const Boxes& boxes) {
  std::vector<std::unique_ptr<render::ObjectTouch>> objects;
  for (const render::EntryFaceBox& one : boxes) {
    objects.push_back(render::build_primitive_touch(one, kSpring));
  }
  return SceneTouch(std::move(objects));
}

AddedForces added_scene_of(const Boxes& boxes) {
  AddedForces added;
  for (const render::EntryFaceBox& one : boxes) added.objects.push_back(scene_of({one}));
  return added;
}

template <class Law>
WorldTick tick_of(Law& law, const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  const driver::ForceCommand command = law(state);
  return {p_WT, command.touch.in_contact ? command.touch.p_WP : p_WT, command.f_T_W};
}

/// Returns the places of a straight path, kStep apart, with both ends.
std::vector<Vector3d> path_of(const std::vector<Vector3d>& corners) {
  std::vector<Vector3d> path{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Vector3d way = corners[i] - corners[i - 1];
    const int steps = static_cast<int>(std::ceil(way.norm() / kStep));
    for (int k = 1; k <= steps; ++k) path.emplace_back(corners[i - 1] + way * k / steps);
  }
  return path;
}

/// Returns the ticks of a tip that follows a path whatever the force.
template <class Law>
std::vector<WorldTick> led(Law law, const std::vector<Vector3d>& path) {
  std::vector<WorldTick> ticks;
  for (const Vector3d& p_WT : path) ticks.push_back(tick_of(law, p_WT));
  return ticks;
}

/// Returns the ticks of a tip that a spring pulls along a path through a viscous medium.
template <class Law>
std::vector<WorldTick> pulled(Law law, const std::vector<Vector3d>& path) {
  constexpr double kHandStiffness = 500;  // N/m [chosen: a firm grip]
  // m per N and tick: the slowest that is stable without overshoot on surface and hand [chosen].
  constexpr double kCreep = 0.5 / (kHandStiffness + kWorldStiffness);
  constexpr int kSettle = 200;  // ticks at the end of the path [chosen: until nothing moves]
  std::vector<WorldTick> ticks;
  Vector3d p_WT = path.front();
  for (std::size_t i = 0; i < path.size() + kSettle; ++i) {
    ticks.push_back(tick_of(law, p_WT));
    const Vector3d& target = path[std::min(i, path.size() - 1)];
    p_WT += kCreep * (kHandStiffness * (target - p_WT) + ticks.back().f_T_W);
  }
  return ticks;
}

/// A block with a groove along y in its top. The section is (x, z), counter-clockwise seen from -y.
render::TriangleMesh groove() {
  constexpr double kHalfWidth = 12e-3, kBottom = -6e-3, kHalfLength = 0.03;  // m
  const double rim = kGrooveDepth * std::tan(kGrooveHalfAngle);
  const double section[][2] = {
      {-kHalfWidth, kBottom}, {0, kBottom}, {kHalfWidth, kBottom}, {kHalfWidth, kGrooveDepth},
      {rim, kGrooveDepth},    {0, 0},       {-rim, kGrooveDepth},  {-kHalfWidth, kGrooveDepth}};
  constexpr int kCorners = 8;
  render::TriangleMesh mesh;
  for (const double y : {-kHalfLength, kHalfLength}) {
    for (const auto& [x, z] : section) mesh.vertices.emplace_back(x, y, z);
  }
  for (int i = 0; i < kCorners; ++i) {
    const int next = (i + 1) % kCorners;
    mesh.triangles.push_back({i, next, next + kCorners});
    mesh.triangles.push_back({i, next + kCorners, i + kCorners});
  }
  // Each half of the section is a fan around the bottom of the groove.
  constexpr int kFan = 5;
  for (int i = 0; i < kCorners; ++i) {
    const int next = (i + 1) % kCorners;
    if (i == kFan || next == kFan) continue;
    mesh.triangles.push_back({kFan, next, i});
    mesh.triangles.push_back({kFan + kCorners, i + kCorners, next + kCorners});
  }
  return mesh;
}

}  // namespace

ComparedTouch slide_over_seam() {
  const Boxes boxes{box({-0.03, -0.03, -0.02}, {0, 0.03, 0}),
                    box({0, -0.03, -0.02}, {0.03, 0.03, 0})};
  // The ticks are at odd multiples of half a step: none is exactly in the plane of the seam, which
  // is the outline of both boxes and inside neither.
  const double half_way = kSeamHalfWay + kStep / 2;
  const Vector3d start(-half_way, kAside, -kSeamDepth);
  const std::vector<Vector3d> path =
      path_of({start + Vector3d(0, 0, 2 * kSeamDepth), start, {half_way, kAside, -kSeamDepth}});
  ComparedTouch touch{led(added_scene_of(boxes), path), led(scene_of(boxes), path)};
  for (auto* ticks : {&touch.alone, &touch.together}) {
    std::erase_if(*ticks, [](const WorldTick& tick) { return tick.p_WT.z() > -kSeamDepth; });
  }
  return touch;
}

ComparedTouch slide_against_block() {
  const Boxes boxes{box({-0.03, -0.03, -0.02}, {0.03, 0.03, 0}),
                    box({0, -0.03, 0}, {0.03, 0.03, kBlockHeight})};
  const std::vector<Vector3d> path =
      path_of({{-8e-3, kAside, 3e-3}, {-8e-3, kAside, -3e-3}, {8e-3, kAside, -3e-3}});
  return {pulled(added_scene_of(boxes), path), pulled(scene_of(boxes), path)};
}

std::vector<WorldTick> press_into_groove(double tip_radius) {
  // The mesh is closed, so this cannot fail.
  std::vector<std::unique_ptr<render::ObjectTouch>> objects;
  objects.push_back(render::build_object_touch(
                        groove(),
                        {.tracker = render::TrackerChoice::kGodObject, .tip_radius = tip_radius},
                        kSpring)
                        .value());
  const double rest = tip_radius / std::sin(kGrooveHalfAngle);
  return led(SceneTouch(std::move(objects)),
             path_of({{2e-3, kAside, rest + kGrooveDepth}, {0.6e-3, kAside, rest - kGroovePress}}));
}

}  // namespace thimble::studies
