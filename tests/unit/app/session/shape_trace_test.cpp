// Prints in clay on a page: the pictures lead from the initial to the final mesh.
#include "report/html/shape_trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "setup.h"
#include "support/heap_guard.h"
#include "support/shipped_scene.h"

namespace thimble::report {
namespace {

// Applies a step as a page does.
void apply(const ShapeStep& step, render::TriangleMesh& mesh) {
  for (std::size_t i = 0; i < step.vertices.size(); ++i) {
    const std::size_t v = step.vertices[i];
    if (v >= mesh.vertices.size()) mesh.vertices.resize(v + 1);
    mesh.vertices[v] = {step.places[3 * i], step.places[3 * i + 1], step.places[3 * i + 2]};
  }
  for (std::size_t i = 0; i < step.triangles.size(); ++i) {
    const std::size_t t = step.triangles[i];
    if (t >= mesh.triangles.size()) mesh.triangles.resize(t + 1);
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.triangles[t][k] = static_cast<std::int32_t>(step.corners[3 * i + k]);
    }
  }
}

// Compares the pictures of a trace with the final mesh of a tablet.
void expect_left(ShapeTrace& trace, const render::TriangleMesh& first,
                 const render::TriangleMesh& left) {
  const auto steps = trace.steps({first}, 0);
  ASSERT_GT(steps.size(), 2U);
  EXPECT_LE(trace.frames(), ShapeTrace::kFramesMax);
  render::TriangleMesh mesh = first;
  double before = -1;
  for (const ShapeStep& step : steps) {
    EXPECT_GT(step.t, before);
    before = step.t;
    apply(step, mesh);
  }
  EXPECT_GT(left.triangles.size(), first.triangles.size());
  ASSERT_EQ(mesh.triangles, left.triangles);
  ASSERT_EQ(mesh.vertices.size(), left.vertices.size());
  for (std::size_t v = 0; v < left.vertices.size(); ++v) {
    ASSERT_NEAR((mesh.vertices[v] - left.vertices[v]).norm(), 0, 1e-8) << v;
  }
}

TEST(ShapeTrace, LeadsFromTheInitialToTheFinalMesh) {
  const auto session = support::open_shipped("clay_tablet");
  ASSERT_NE(session, nullptr);
  const scene::SceneObjects& objects = session->setup().objects();
  const render::TriangleMesh first = objects.mesh_W(0);
  ShapeTrace trace({{.object = 0,
                     .shape = objects.touch().object(0).shape(),
                     .vertices = first.vertices.size()}});
  ASSERT_TRUE(session->add_observer(trace));
  ASSERT_EQ(session->run(), driver::ServoEnd::kDone);
  expect_left(trace, first, objects.mesh_now(0));
}

TEST(ShapeTrace, LongRunFitsWithoutAllocation) {
  session::SessionOptions options;
  options.duration = 2;  // during a stroke
  const auto session = support::open_shipped("clay_tablet", options);
  ASSERT_NE(session, nullptr);
  const scene::SceneObjects& objects = session->setup().objects();
  const render::TriangleMesh first = objects.mesh_W(0);
  const render::BodyShape* shape = objects.touch().object(0).shape();
  ShapeTrace trace({{.object = 0, .shape = shape, .vertices = first.vertices.size()}});
  ASSERT_TRUE(session->add_observer(trace));
  ASSERT_EQ(session->run(), driver::ServoEnd::kDone);
  ASSERT_FALSE(shape->moves().empty());
  // Repeats the last tick until memory was full three times.
  EXPECT_EQ(support::heap_calls_of([&] {
              driver::TickRecord tick;
              for (std::int64_t i = 1; i < 30'000; ++i) {
                tick.time_ns = 2'000'000'000 + i * ShapeTrace::kStep_ns;
                trace.take(tick);
              }
            }),
            0);
  EXPECT_GT(trace.frames(), 1000U);
  expect_left(trace, first, objects.mesh_now(0));
}

}  // namespace
}  // namespace thimble::report
