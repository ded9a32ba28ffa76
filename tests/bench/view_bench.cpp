#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "support/meshes/shapes.h"
#include "view/gl/offscreen_context.h"
#include "view/scene_painter.h"

// Time of one picture of 960 x 640 by number of triangles: wall time, and time of all processors,
// because a software renderer uses all of them. `least`: minimum processor time of a picture, ms,
// which excludes other load. The renderer's name: see `renderer`. `all`: soft shadow edges and
// antialiasing; `turns`: the camera turns by a degree per picture.

namespace thimble::bench {
namespace {

using view::Canvas;
using view::DrawnMoment;
using view::PaintChoice;

/// Returns the time that this process has used on all processors, ms.
double processor_ms() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto ms = [](const timeval& time) {
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
  };
  return ms(used.ru_utime) + ms(used.ru_stime);
}

void paint(benchmark::State& state) {
  const auto context = view::OffscreenContext::open();
  if (!context) return state.SkipWithError("no OpenGL");
  state.SetLabel((*context)->renderer());
  view::DrawnScene scene;
  scene.objects.push_back(
      {.name = "ball",
       .mesh = support::bumpy_sphere(static_cast<int>(state.range(0)), 0.05, 0.002, 40)});
  auto programs = view::ScenePrograms::make();
  if (!programs) return state.SkipWithError(programs.error().message.c_str());
  view::ScenePainter painter(scene, std::move(programs).value());
  Canvas canvas(960, 640);
  const DrawnMoment moment{};
  auto camera = view::frame(scene, moment, canvas.aspect());
  PaintChoice choice;
  choice.fine = state.range(1) == 1;
  // The first pictures compile the shaders.
  for (int i = 0; i < 2; ++i) painter.paint(moment, camera, choice, canvas);
  glFinish();
  double least = 1e9;
  for (auto _ : state) {
    if (state.range(2) == 1) camera.orbit(0.0175, 0);
    const double before = processor_ms();
    painter.paint(moment, camera, choice, canvas);
    glFinish();
    least = std::min(least, processor_ms() - before);
  }
  state.counters["least"] = least;
  state.counters["triangles"] = static_cast<double>(scene.objects[0].mesh.triangles.size());
  state.counters["pictures/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(paint)
    ->ArgNames({"subdivisions", "all", "turns"})
    ->ArgsProduct({{4, 6, 8}, {0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace thimble::bench

BENCHMARK_MAIN();
