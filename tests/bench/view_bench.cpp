#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <memory>

#include "support/shapes.h"
#include "view/gl/offscreen_context.h"
#include "view/scene_painter.h"

// How long one picture of 960 x 640 takes, by triangles: wall time, and time of all processors
// together, for software draws with all of them. Name of what draws: see `renderer`.

namespace thimble::bench {
namespace {

using app::view::Canvas;
using app::view::DrawnMoment;
using app::view::PaintChoice;

void paint(benchmark::State& state) {
  const auto context = app::view::OffscreenContext::open();
  if (!context) return state.SkipWithError("no OpenGL");
  state.SetLabel((*context)->renderer());
  app::view::DrawnScene scene;
  scene.objects.push_back(
      {.name = "ball",
       .mesh = support::bumpy_sphere(static_cast<int>(state.range(0)), 0.05, 0.002, 40)});
  auto programs = app::view::ScenePrograms::make();
  if (!programs) return state.SkipWithError(programs.error().message.c_str());
  app::view::ScenePainter painter(scene, std::move(programs).value());
  Canvas canvas(960, 640, 0, state.range(2) == 1 ? Canvas::kSamples : 1);
  const DrawnMoment moment{};
  const auto camera = app::view::frame(scene, moment, canvas.aspect());
  PaintChoice choice;
  choice.shadows = state.range(1) == 1;
  choice.fine = state.range(2) == 1;
  // The first pictures translate the shaders.
  for (int i = 0; i < 2; ++i) painter.paint(moment, camera, choice, canvas);
  glFinish();
  for (auto _ : state) {
    painter.paint(moment, camera, choice, canvas);
    glFinish();
  }
  state.counters["triangles"] = static_cast<double>(scene.objects[0].mesh.triangles.size());
  state.counters["pictures/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(paint)
    ->ArgNames({"subdivisions", "shadows", "fine"})
    ->ArgsProduct({{4, 6, 8}, {0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace thimble::bench

BENCHMARK_MAIN();
