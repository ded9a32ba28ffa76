#include "studies/rate_bench.h"

#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include "thimble/session/servo_thread.h"
#include "thimble/session/session.h"

namespace thimble::studies {
namespace {

constexpr double kOften = 0.999;         // of all ticks
constexpr double kStiffnessFelt = 0.08;  // [PHYSICS 6: stiffness error]

// Changes the rate of a scene, including the parts that depend on the duration of a tick.
void change_rate(scene::Scene& scene, double rate) {
  scene.rate = rate;
  for (scene::SceneObject& object : scene.objects) {
    if (object.body.dent) object.body.dent->step = 1 / rate;
  }
  scene.arms.front().arm.simulated.firmware.report_period_ns = std::llround(1e9 / rate);
}

std::string sentence_of(const RateBench& bench, const RateVerdict& verdict) {
  const double period = 1e6 / bench.rate;
  if (!bench.trouble.empty()) return "Not enough: " + bench.trouble;
  if (verdict.enough) {
    return fmt::format(
        "Enough: 99.9 % of ticks wake up within {:.1f} us and compute for {:.1f} us of "
        "{:.0f} us; {:.0f} % is left. Uneven ticks cost {:.1f} % of the stable "
        "stiffness.",
        verdict.late_us, verdict.work_us, period, 100 * verdict.headroom,
        100 * verdict.stiffness_lost);
  }
  if (verdict.work_us >= period) {
    return fmt::format(
        "Not enough: in 0.1 % of ticks the computation takes {:.1f} us of {:.0f} us. "
        "Use a simpler scene or --quality draft.",
        verdict.work_us, period);
  }
  if (verdict.headroom < 0) {
    return fmt::format(
        "Not enough: 0.1 % of ticks wake up {:.0f} us late or later, with {:.1f} us of "
        "computation in a tick of {:.0f} us: {}.",
        verdict.late_us, verdict.work_us, period,
        bench.priority ? "other programs interfere, or the kernel is not a real-time kernel"
                       : "the loop has no real-time priority; run `thimble doctor`");
  }
  return fmt::format(
      "Not enough: uneven ticks (the longest {:.1f} ms) cost {:.0f} % of the stable "
      "stiffness, which can be felt: {}.",
      1e-6 * static_cast<double>(bench.period.max_ns()), 100 * verdict.stiffness_lost,
      bench.priority ? "close other programs"
                     : "give the loop real-time priority (see `thimble doctor`)");
}

}  // namespace

double stiffness_lost(const session::Histogram& period) {
  double count = 0, sum = 0, squares = 0;
  for (const session::Histogram::Bin& bin : period.bins()) {
    const double n = static_cast<double>(bin.count);
    const double t = 0.5 * static_cast<double>(bin.lower_ns + bin.upper_ns);
    count += n;
    sum += n * t;
    squares += n * t * t;
  }
  return squares > 0 ? 1 - sum * sum / (count * squares) : 0;
}

driver::Result<RateBench> bench_rate(const std::filesystem::path& scene, double rate,
                                     double seconds, scene::Quality quality,
                                     const std::function<void(double)>& passed) {
  session::SessionOptions options;
  options.clock = session::ClockKind::kWall;
  options.duration = seconds;
  options.adjust = [rate, quality](scene::Scene& changed) {
    scene::apply_quality(quality, changed);
    change_rate(changed, rate);
  };
  auto opened = session::Session::open(scene, options);
  if (!opened) return opened.error();
  session::Session& session = **opened;
  RateBench bench;
  bench.rate = rate;
  const std::atomic<bool> stop{false};
  session::ServoThread servo(true);
  const auto begin = std::chrono::steady_clock::now();
  servo.begin(session, stop);
  while (passed && !servo.ended()) {
    // Seldom, because it shares the processor with the loop that is measured [chosen].
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    passed(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  const driver::ServoEnd end = servo.join();
  bench.period = session.statistics().period();
  bench.lateness = session.statistics().lateness();
  bench.work = session.statistics().work();
  bench.priority = servo.grant().fifo;
  bench.advice = servo.grant().advice;
  if (end == driver::ServoEnd::kFault) {
    bench.trouble = "a fault ended the run, because ticks were too late to be safe for the arm.";
  }
  return bench;
}

RateVerdict verdict_of(const RateBench& bench) {
  RateVerdict verdict;
  verdict.late_us = 1e-3 * bench.lateness.percentile(kOften);
  verdict.work_us = 1e-3 * bench.work.percentile(kOften);
  const double period = 1e6 / bench.rate;
  verdict.headroom = 1 - (verdict.late_us + verdict.work_us) / period;
  verdict.stiffness_lost = stiffness_lost(bench.period);
  verdict.enough =
      bench.trouble.empty() && verdict.headroom >= 0 && verdict.stiffness_lost <= kStiffnessFelt;
  verdict.sentence = sentence_of(bench, verdict);
  return verdict;
}

std::vector<session::Figure> figures_of(const RateBench& bench, const RateVerdict& verdict) {
  const std::string rate = std::to_string(std::lround(bench.rate)) + " Hz, ";
  std::vector<session::Figure> figures;
  const auto add = [&](const std::string& name, double value, const std::string& unit) {
    figures.push_back({.name = rate + name, .value = value, .unit = unit, .goal = {}});
  };
  add("wake-up late, median", 1e-3 * bench.lateness.percentile(0.5), "us");
  add("wake-up late, 99 %", 1e-3 * bench.lateness.percentile(0.99), "us");
  add("wake-up late, 99.9 %", verdict.late_us, "us");
  add("wake-up late, longest", 1e-3 * static_cast<double>(bench.lateness.max_ns()), "us");
  add("work of a tick, median", 1e-3 * bench.work.percentile(0.5), "us");
  add("work of a tick, 99.9 %", verdict.work_us, "us");
  add("work of a tick, longest", 1e-3 * static_cast<double>(bench.work.max_ns()), "us");
  add("headroom", 100 * verdict.headroom, "%");
  add("stiffness lost to uneven ticks", 100 * verdict.stiffness_lost, "%");
  add("enough", verdict.enough ? 1 : 0, "");
  return figures;
}

}  // namespace thimble::studies
