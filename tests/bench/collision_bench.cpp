#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "collision/collide_objects.h"
#include "collision/collision_world.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/render/build_object_touch.h"

// Cost of one step of many bodies that meet, with the number of their contacts: towers of blocks
// at rest, and blocks and balls that fall into a tray. Bodies only, without a hand.

namespace thimble::bench {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 1e-3;
constexpr double kBodySide = 0.02;  // m

/// Bodies and the shapes that they were built from.
class Bodies {
 public:
  void add_block(const Vector3d& p_W) {
    render::WedgeBox box;
    box.half_sides = Vector3d::Constant(kBodySide / 2);
    box.p_WO = p_W;
    add(box, support::box(box.half_sides), p_W);
  }
  void add_ball(const Vector3d& p_W) {
    add(render::Sphere{p_W, kBodySide / 2}, support::icosphere(2, kBodySide / 2), p_W);
  }
  void add_wall(const Vector3d& n_W, const Vector3d& p_W) {
    shapes_.push_back(std::make_unique<Shape>(Shape{render::HalfSpace{n_W, p_W}, {}}));
    render::CollidingObject& object = objects_.emplace_back();
    object.name = "wall";
    object.solid = {nullptr, &shapes_.back()->shape_W};
  }
  std::shared_ptr<render::CollisionWorld> build(std::size_t every) {
    auto made = render::collide_objects(std::move(objects_), {}, {.every = every}, 1).value();
    touches_ = std::move(made.touches);
    return std::dynamic_pointer_cast<render::CollisionWorld>(made.bodies);
  }

 private:
  struct Shape {
    render::Primitive shape_W;
    render::TriangleMesh mesh_W;
  };
  void add(const render::Primitive& shape_W, render::TriangleMesh mesh, const Vector3d& p_W) {
    for (Vector3d& p : mesh.vertices) p += p_W;
    shapes_.push_back(std::make_unique<Shape>(Shape{shape_W, std::move(mesh)}));
    render::CollidingObject& object = objects_.emplace_back();
    object.name = "body";
    object.solid = {&shapes_.back()->mesh_W, &shapes_.back()->shape_W};
    render::MotionChoice motion{.kind = render::MotionKind::kRigid, .mass = 0.02};
    motion.gravity_W = {0, 0, -9.81};
    object.motion = motion;
    object.coupling.step = kStep;
    object.surfaces.push_back(render::build_object_touch(shapes_.back()->mesh_W, {}, {}).value());
  }
  std::vector<std::unique_ptr<Shape>> shapes_;
  std::vector<render::CollidingObject> objects_;
  std::vector<std::vector<std::unique_ptr<render::ObjectTouch>>> touches_;
};

/// Measures 0.5 s after 1 s.
void measure(benchmark::State& state, Bodies& bodies, std::size_t every) {
  const auto world = bodies.build(every);
  for (int i = 0; i < 1000; ++i) world->step(kStep);
  const auto before = world->solver().counters();
  constexpr int kTicks = 500;
  for (auto _ : state) {
    std::vector<double> times;
    double sum = 0;
    for (int i = 0; i < kTicks; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      world->step(kStep);
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
      times.push_back(time.count());
      sum += time.count();
    }
    std::sort(times.begin(), times.end());
    state.SetIterationTime(sum / kTicks);
    state.counters["p99_us"] = 1e6 * times[kTicks * 99 / 100];
  }
  const auto after = world->solver().counters();
  state.counters["contacts"] = static_cast<double>(after.contacts - before.contacts) /
                               static_cast<double>(after.steps - before.steps);
}

void towers(benchmark::State& state) {
  const auto count = state.range(0), height = std::min<std::int64_t>(count, 8);
  Bodies bodies;
  bodies.add_wall({0, 0, 1}, {0, 0, 0});
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t tower = i / height;
    bodies.add_block({0.05 * static_cast<double>(tower % 5), 0.05 * static_cast<double>(tower / 5),
                      kBodySide * (static_cast<double>(i % height) + 0.5)});
  }
  measure(state, bodies, static_cast<std::size_t>(state.range(1)));
}

void heap(benchmark::State& state) {
  Bodies bodies;
  support::Random random(std::uint64_t{7});
  bodies.add_wall({0, 0, 1}, {0, 0, 0});
  const double half = 0.011 * std::sqrt(static_cast<double>(state.range(0)));
  for (const Vector3d& n :
       {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
    bodies.add_wall(n, -half * n);
  }
  const int side = std::max(static_cast<int>(2 * half / (1.4 * kBodySide)), 1);
  for (int i = 0; i < state.range(0); ++i) {
    const int layer = i / (side * side), place = i % (side * side);
    const Vector3d p_W((place % side - (side - 1) / 2.0) * 1.4 * kBodySide,
                       (place / side - (side - 1) / 2.0) * 1.4 * kBodySide,
                       (layer + 1) * 1.4 * kBodySide);
    const Vector3d off = random.in_box(0.15 * kBodySide);
    if (i % 2 == 0) {
      bodies.add_block(p_W + off);
    } else {
      bodies.add_ball(p_W + off);
    }
  }
  measure(state, bodies, static_cast<std::size_t>(state.range(1)));
}

#define THIMBLE_BODIES(name) \
  BENCHMARK(name)->UseManualTime()->Iterations(1)->Unit(benchmark::kMicrosecond)
THIMBLE_BODIES(towers)->ArgsProduct({{10, 50, 100, 200}, {1, 4}});
THIMBLE_BODIES(heap)->ArgsProduct({{10, 50, 100, 200}, {1, 4}});

}  // namespace
}  // namespace thimble::bench
