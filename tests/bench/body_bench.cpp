#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "bench/figures_reporter.h"
#include "body/dent/bendable_polygon.h"
#include "body/motion/rigid_body.h"
#include "body/shape/snap_base.h"
#include "body/spring/mesh_springs.h"
#include "body/spring/modal_motion.h"
#include "body/spring/spring_motion.h"
#include "mesh/surface_weights.h"
#include "report/figure_output.h"
#include "support/meshes/body_meshes.h"
#include "support/meshes/shapes.h"
#include "thimble/render/build_object_touch.h"

// Cost of the dynamics of bodies: per node and step, or per step of one body.

namespace thimble::bench {
namespace {

using render::SpringScheme;

constexpr double kTick = 1e-3;

// A ball of 2,562 vertices with soft springs, so that every scheme is stable at a tick.
render::SpringNetwork<3> ball() {
  return render::join_vertices(support::icosphere(4, 0.05), {1e-3, 20, 0.002, 100, 0.01, true})
      .value();
}

void step_nodes(benchmark::State& state, SpringScheme scheme) {
  render::SpringMotionOptions options;
  options.scheme = scheme;
  options.step = scheme == SpringScheme::kExplicitEuler ? 2e-5 : kTick;
  auto motion = render::SpringMotion<3>::build(ball(), options).value();
  for (auto _ : state) {
    motion.push(7, {0, 0, 0.1});
    motion.step();
    benchmark::DoNotOptimize(motion.u().data());
  }
  state.counters["ns_per_node"] = benchmark::Counter(
      static_cast<double>(motion.network().node_count()) * 1e-9,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(step_nodes, explicit_euler, SpringScheme::kExplicitEuler);
BENCHMARK_CAPTURE(step_nodes, symplectic_euler, SpringScheme::kSymplecticEuler);
BENCHMARK_CAPTURE(step_nodes, verlet, SpringScheme::kVerlet);
BENCHMARK_CAPTURE(step_nodes, implicit_euler, SpringScheme::kImplicitEuler);
BENCHMARK_CAPTURE(step_nodes, trapezoid, SpringScheme::kTrapezoid);

// One tick of touch on a torus of `range(0)` triangles, with or without a dent of 3 rings: the tip
// strokes along at `range(1)` um per tick, 0.5 mm deep.
void touch_torus(benchmark::State& state, bool dented) {
  const int across =
      static_cast<int>(std::lround(std::sqrt(static_cast<double>(state.range(0)) / 4)));
  const auto mesh = support::torus(0.05, 0.02, 2 * across, across);
  render::SurfaceChoice surface{.spring = {.stiffness = 500, .damping = 0}, .effects = {}};
  if (dented) surface.dent.emplace().pull = 0.2;
  render::ContactChoice choice;
  choice.tracker = render::TrackerChoice::kPacked;
  auto touch = render::build_object_touch(mesh, choice, surface).value();
  // Back and forth over 60 mm, so that the path is closed.
  const double step = static_cast<double>(state.range(1)) * 1e-6;
  const int half = static_cast<int>(0.06 / step);
  std::vector<driver::DeviceState> ways(static_cast<std::size_t>(2 * half));
  for (int i = 0; i < 2 * half; ++i) {
    const double way = step * (i < half ? i : 2 * half - i);
    const double theta = way / 0.07;
    const double phi = 0.1 + 4 * way;
    const double out = 0.05 + 0.0195 * std::cos(phi);
    auto& at = ways[static_cast<std::size_t>(i)];
    at.p_WT = {out * std::cos(theta), out * std::sin(theta), 0.0195 * std::sin(phi)};
  }
  driver::DeviceState outside;
  outside.p_WT = {0.08, 0, 0.003};
  touch->update(outside);
  std::size_t i = 0;
  int touching = 0;
  for (std::size_t k = 0; k < ways.size(); ++k) touching += touch->update(ways[k]).touch.in_contact;
  if (touching == 0) state.SkipWithError("never touched");
  for (auto _ : state) {
    benchmark::DoNotOptimize(touch->update(ways[i]));
    i = i + 1 == ways.size() ? 0 : i + 1;
  }
}
BENCHMARK_CAPTURE(touch_torus, stiff, false)->ArgsProduct({{10000, 1000000}, {30, 300}});
BENCHMARK_CAPTURE(touch_torus, dented, true)->ArgsProduct({{10000, 1000000}, {30, 300}});

// Cost of drawing a dent of 3 rings.
void draw_dent(benchmark::State& state) {
  auto contact = std::make_shared<const render::ContactMesh>(
      render::ContactMesh::build(support::torus(0.05, 0.02, 100, 50)).value());
  auto dent = render::BendablePolygon::build(contact, {}).value();
  auto patch = std::make_unique<render::BodyPatch>();
  const Eigen::Vector3d w(0.5, 0.3, 0.2);
  for (int i = 0; i < 20; ++i) {
    dent.touch(7, w, render::point_at(*contact, 7, w) - 5e-4 * contact->cell(7).face.n);
  }
  for (auto _ : state) {
    dent.draw(*patch);
    benchmark::DoNotOptimize(patch->point_count);
  }
}
BENCHMARK(draw_dent);

void step_modal(benchmark::State& state) {
  const auto network =
      render::join_vertices(support::icosphere(2, 0.05), {1e-3, 20, 0.002, 100, 0.01, true});
  auto motion = render::ModalMotion<3>::build(*network, kTick).value();
  for (auto _ : state) {
    motion.push(7, {0, 0, 0.1});
    motion.step();
    benchmark::DoNotOptimize(motion.u(7));
  }
}
BENCHMARK(step_modal);

void step_exponential_node(benchmark::State& state) {
  const auto flow = render::OscillatorStep::of(1e-3, 1000, 0.1, kTick);
  Eigen::Vector3d u(1e-3, 0, 0);
  Eigen::Vector3d v(0, 0, 0);
  const Eigen::Vector3d f(0, 0, 0.1);
  for (auto _ : state) {
    flow.apply(u, v, f);
    benchmark::DoNotOptimize(u);
  }
}
BENCHMARK(step_exponential_node);

void find_exponential(benchmark::State& state) {
  double stiffness = 1000;
  for (auto _ : state) {
    benchmark::DoNotOptimize(render::OscillatorStep::of(1e-3, stiffness, 0.1, kTick));
    stiffness = 2001 - stiffness;
  }
}
BENCHMARK(find_exponential);

void press_snap(benchmark::State& state) {
  render::SnapBase base({}, {0, 0, -1});
  double way = 0;
  for (auto _ : state) {
    way = way > 20e-3 ? -10e-3 : way + 1e-5;
    base.pull_by_spring(way, 300, kTick);
    benchmark::DoNotOptimize(base.way());
  }
}
BENCHMARK(press_snap);

void step_rigid(benchmark::State& state) {
  const auto mesh = support::icosphere(1, 0.05);
  render::RigidBodySettings settings;
  settings.mass = render::mass_properties(mesh, 0.2).value();
  settings.gravity_W = {0, 0, -9.81};
  if (state.range(0) > 0) {
    settings.floor = render::Floor{.height = -0.06};
    settings.support_B.assign(mesh.vertices.begin(), mesh.vertices.end());
    settings.support_B.resize(static_cast<std::size_t>(state.range(0)));
  }
  auto body = render::RigidBody::build(settings).value();
  body.set_momentum({0, 0, 0}, {1e-3, 2e-3, 3e-3});
  for (auto _ : state) {
    body.push({0, 0, 0.8}, {0, 0, 0});
    body.step(kTick);
    benchmark::DoNotOptimize(body.p_WC());
  }
}
BENCHMARK(step_rigid)->Arg(0)->Arg(8)->Arg(42);

}  // namespace
}  // namespace thimble::bench

int main(int argc, char** argv) {
  // Parses --figures=FILE; all other options are Google Benchmark's.
  std::string figures_file;
  std::vector<char*> rest;
  for (int i = 0; i < argc; ++i) {
    constexpr const char* kOption = "--figures=";
    if (std::strncmp(argv[i], kOption, std::strlen(kOption)) == 0) {
      figures_file = argv[i] + std::strlen(kOption);
    } else {
      rest.push_back(argv[i]);
    }
  }
  int count = static_cast<int>(rest.size());
  benchmark::Initialize(&count, rest.data());
  if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 2;
  thimble::bench::FiguresReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  if (figures_file.empty()) return 0;
  const auto written = thimble::report::write_figures(reporter.figures(), figures_file);
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return written ? 0 : 1;
}
