#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "arms/hfab/hfab_report.h"
#include "bench/figures_reporter.h"
#include "events/event_log.h"
#include "run_records.h"
#include "setup.h"
#include "simulated_arm.h"
#include "support/random.h"
#include "support/vintage_arm.h"
#include "thimble/driver/snapshot.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"
#include "track/mesh_contact.h"
#include "velocity_estimator.h"

// One whole tick on the virtual clock in contact with elephant.off, and each part of it separately.

namespace thimble {
namespace {

using MeshTouch = render::ContactForceLaw<render::MeshContact, render::SpringDamper>;

std::vector<render::EffectPlan> effects_of(const std::string& scene) {
  const auto read =
      scene::load_scene(std::string(THIMBLE_SOURCE_DIR) + "/app/scenes/" + scene + ".yaml");
  return read ? read->objects.front().effects : std::vector<render::EffectPlan>();
}

// `rough`: with rubber's friction and sandpaper's texture.
std::unique_ptr<session::Session> open_stroke(bool rough = false) {
  session::SessionOptions options;
  options.mesh_folder = THIMBLE_MESHES;
  if (rough) {
    options.adjust = [](scene::Scene& scene) {
      auto& effects = scene.objects.front().effects;
      for (const char* other : {"sandpaper", "rubber"}) {
        for (auto& effect : effects_of(other)) effects.push_back(std::move(effect));
      }
    };
  }
  auto session = session::Session::open(
      std::string(THIMBLE_SOURCE_DIR) + "/tests/data/scenes/stroke.yaml", options);
  if (!session) {
    std::fprintf(stderr, "%s\n", session.error().message.c_str());
    return nullptr;
  }
  return std::move(session).value();
}

/// The servo loop itself: hand, plant, firmware, codec both ways, kinematics, contact, gate,
/// snapshot, statistics and trace. The scene strokes the elephant without lifting off.
void run_whole_ticks(benchmark::State& state, bool rough) {
  const std::atomic<bool> stop{false};
  double ticks = 0, contact = 0;
  for (auto _ : state) {
    const auto session = open_stroke(rough);
    if (!session) return state.SkipWithError("the scene could not be opened");
    const auto begin = std::chrono::steady_clock::now();
    session->run(stop);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    const auto& statistics = session->statistics();
    state.SetIterationTime(time.count() / static_cast<double>(statistics.ticks()));
    ticks += static_cast<double>(statistics.ticks());
    contact += statistics.contact_time() / statistics.duration();
  }
  state.counters["ticks"] = benchmark::Counter(ticks, benchmark::Counter::kAvgIterations);
  state.counters["in_contact"] = benchmark::Counter(contact, benchmark::Counter::kAvgIterations);
}
void whole_tick(benchmark::State& state) {
  run_whole_ticks(state, false);
}
BENCHMARK(whole_tick)->UseManualTime()->Iterations(20)->Unit(benchmark::kNanosecond);

/// The same with friction and a texture.
void whole_rough_tick(benchmark::State& state) {
  run_whole_ticks(state, true);
}
BENCHMARK(whole_rough_tick)->UseManualTime()->Iterations(20)->Unit(benchmark::kNanosecond);

/// Returns the records of the same run, as input for the parts.
const std::vector<driver::TickRecord>& stroke_records() {
  static const std::vector<driver::TickRecord> records = [] {
    const auto session = open_stroke();
    if (!session) return std::vector<driver::TickRecord>();
    session->run(std::atomic<bool>{false});
    const auto rows = session->ticks();
    return std::vector<driver::TickRecord>(rows.begin(), rows.end());
  }();
  return records;
}

driver::DeviceState state_of(const driver::TickRecord& record) {
  driver::DeviceState state;
  state.tick = record.tick;
  state.time_ns = record.time_ns;
  state.dt = 1e-3;
  state.p_WT = Eigen::Map<const Eigen::Vector3d>(record.p_WT.data());
  state.v_WT = Eigen::Map<const Eigen::Vector3d>(record.v_WT.data());
  return state;
}

/// Returns the force law of the session's only object, as a copy that may be called.
MeshTouch mesh_touch(const session::Session& session) {
  const auto& object = session.scene().objects.front();
  return {render::MeshContact::build(session.setup().objects().mesh_W()).value(),
          {.stiffness = object.stiffness, .damping = object.damping}};
}

void touch(benchmark::State& state) {
  const auto session = open_stroke();
  if (!session || stroke_records().empty()) return state.SkipWithError("no scene");
  std::vector<driver::DeviceState> states;
  for (const auto& record : stroke_records()) states.push_back(state_of(record));
  MeshTouch law = mesh_touch(*session);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(law(states[i]));
    if (++i == states.size()) i = states.size() / 2;  // stays in contact
  }
}
BENCHMARK(touch);

void simulated_arm(benchmark::State& state) {
  const auto session = open_stroke();
  if (!session) return state.SkipWithError("no scene");
  // Only the arm: hand, plant, encoders, firmware and both ends of the wire, 1 ms per iteration.
  device_sim::SimulatedArm arm = *session->simulation()->board_arm();
  std::array<std::byte, 64> buffer;
  std::uint32_t skipped = 0;
  std::int64_t now_ns = 0;
  const auto message = driver::hfab::encode_output({.current_mA = {10, -20, 30}});
  for (auto _ : state) {
    arm.advance_to(now_ns += 1'000'000);
    benchmark::DoNotOptimize(arm.take_report(buffer, skipped));
    arm.put_message(message);
  }
}
BENCHMARK(simulated_arm);

void decode_and_pose(benchmark::State& state) {
  const driver::hfab::HfabArm arm(support::vintage_model());
  std::vector<std::array<std::byte, driver::hfab::kReportSize>> reports;
  for (const auto& record : stroke_records()) {
    driver::hfab::InputReport report;
    for (std::size_t j = 0; j < 3; ++j) {
      report.counts[j] = static_cast<std::int16_t>(record.counts[j]);
    }
    reports.push_back(driver::hfab::encode_input(report));
  }
  if (reports.empty()) return state.SkipWithError("no scene");
  std::size_t i = 0;
  for (auto _ : state) {
    driver::ArmReading reading;
    arm.decode(reports[i], reading);
    benchmark::DoNotOptimize(arm.pose(reading));
    if (++i == reports.size()) i = 0;
  }
}
BENCHMARK(decode_and_pose);

/// Cost of a run's log for the servo loop: it compares the device's counters in each tick and puts
/// events into the ring. Another thread writes them.
void event_watch(benchmark::State& state) {
  const auto session = open_stroke();
  if (!session || stroke_records().empty()) return state.SkipWithError("no scene");
  const session::DeviceCounters counters(session->device());
  session::SpscRing<session::TickEvent> ring(session::EventLog::kRingEvents);
  session::EventWatch watch(counters, session->setup().period_ns(), ring);
  std::size_t i = 0;
  for (auto _ : state) {
    watch.take(stroke_records()[i]);
    if (++i == stroke_records().size()) i = 0;
    ring.drop(ring.waiting());
  }
}
BENCHMARK(event_watch);

void velocity(benchmark::State& state) {
  driver::VelocityEstimator estimator(100);
  const auto& records = stroke_records();
  if (records.empty()) return state.SkipWithError("no scene");
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        estimator.update(Eigen::Map<const Eigen::Vector3d>(records[i].p_WT.data()), 1e-3));
    if (++i == records.size()) i = 0;
  }
}
BENCHMARK(velocity);

void gate_and_encode(benchmark::State& state) {
  const driver::hfab::HfabArm arm(support::vintage_model());
  driver::SafetyGate gate(support::vintage_settings().limits);
  const Eigen::Matrix3d J_BT = arm.pose({}).J_BT;
  const Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  const auto& records = stroke_records();
  if (records.empty()) return state.SkipWithError("no scene");
  std::array<std::byte, driver::kReportCapacity> report;
  std::size_t i = 0;
  for (auto _ : state) {
    const auto force = gate.pass(Eigen::Map<const Eigen::Vector3d>(records[i].f_wanted_W.data()),
                                 Eigen::Map<const Eigen::Vector3d>(records[i].v_WT.data()), 1e-3);
    const driver::MotorCurrents currents(force, R_WB, J_BT, arm.drives());
    benchmark::DoNotOptimize(arm.encode(currents, report));
    benchmark::ClobberMemory();
    if (++i == records.size()) i = 0;
  }
}
BENCHMARK(gate_and_encode);

void snapshot(benchmark::State& state) {
  driver::Snapshot<driver::TickRecord> snapshot;
  const auto& records = stroke_records();
  if (records.empty()) return state.SkipWithError("no scene");
  std::size_t i = 0;
  for (auto _ : state) {
    snapshot.store(records[i]);
    if (++i == records.size()) i = 0;
  }
}
BENCHMARK(snapshot);

void statistics_and_trace(benchmark::State& state) {
  const auto& records = stroke_records();
  if (records.empty()) return state.SkipWithError("no scene");
  session::RunStatistics statistics;
  session::Trace trace(20'000);
  std::size_t i = 0;
  for (auto _ : state) {
    statistics.take(records[i]);
    trace.take(records[i]);
    if (++i == records.size()) i = 0;
  }
}
BENCHMARK(statistics_and_trace);

void free_tick(benchmark::State& state) {
  // Nothing near: the contact keeps a ball without triangles around the tip, so there is no search.
  const auto session = open_stroke();
  if (!session) return state.SkipWithError("no scene");
  MeshTouch law = mesh_touch(*session);
  support::Random random(1);
  driver::DeviceState at;
  at.p_WT = {0, 0, 0.2};
  law(at);
  for (auto _ : state) {
    at.p_WT = Eigen::Vector3d(0, 0, 0.2) + random.in_box(1e-4);
    benchmark::DoNotOptimize(law(at));
  }
}
BENCHMARK(free_tick);

}  // namespace
}  // namespace thimble

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
  for (auto& figure : reporter.figures()) {
    if (figure.name == "whole_tick") figure.goal = "<= 400";
    if (figure.name == "whole_rough_tick") figure.goal = "<= 550";
    if (figure.name.starts_with("duty_")) {  // only the driver, of a tick of 1000 us
      figure.value /= 1000;
      figure.unit = "us";
    }
  }
  std::printf("\n%s", thimble::report::figure_table(reporter.figures()).c_str());
  if (!figures_file.empty()) {
    const auto written = thimble::report::write_figures(reporter.figures(), figures_file);
    if (!written) {
      std::fprintf(stderr, "%s\n", written.error().message.c_str());
      return 1;
    }
  }
  return 0;
}
