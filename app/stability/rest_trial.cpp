#include "stability/rest_trial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "stability/signal.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/shared_meshes.h"
#include "thimble/session/session.h"

namespace thimble::stability {
namespace {

constexpr double kHeld = 0.3;      // s; a shorter hold of the path is the turn of a stroke [chosen]
constexpr double kSettling = 1.6;  // s; creep time of the softest hand (random_scene.cpp)
constexpr double kWatched = 0.25;  // s, measured part at its end
constexpr double kCorner = 50;     // Hz [PHYSICS 2.5]

/// A stretch of a run in which the hand rests, s.
struct Stretch {
  double start = 0;  // beginning in the scene's own time
  double until = 0;  // end in the run
};

bool same_place(const scene::HandWaypoint& a, const scene::HandWaypoint& b) {
  return a.on == b.on && a.p_W == b.p_W && a.press == b.press;
}

/// Extends every hold of the hand's path until the hand has settled; lists the holds.
std::vector<Stretch> prolong_rests(scene::Scene& scene) {
  std::vector<Stretch> rests;
  std::vector<scene::HandWaypoint>& path = scene.arms.front().hand;
  double later = 0;
  for (std::size_t i = 0; i < path.size();) {
    std::size_t end = i;
    while (end + 1 < path.size() && same_place(path[end + 1], path[i])) ++end;
    const bool last = end + 1 == path.size();
    const double start = path[i].time;
    double held = path[end].time - start;
    if (last) held = std::max(held, scene.duration - start);
    for (std::size_t k = i; k <= end; ++k) path[k].time += later;
    if (last || held >= kHeld) {
      const double more = std::max(0.0, kSettling - held);
      if (last && end == i) {
        path.push_back(path[i]);
        ++end;
      }
      if (more > 0 || last) path[end].time = start + later + held + more;
      path[end].stop = path[end].stop || last;
      later += more;
      rests.push_back({.start = start, .until = path[end].time});
    }
    i = end + 1;
  }
  if (!rests.empty()) scene.duration = std::max(scene.duration + later, rests.back().until);
  return rests;
}

/// One run of a scene, tick by tick.
class Run {
 public:
  /// Runs the scene; the hand is held still for kSettling at each of `stops` (ticks, increasing).
  static driver::Result<Run> make(const scene::Scene& scene, const std::vector<std::size_t>& stops,
                                  const std::shared_ptr<scene::SharedMeshes>& meshes) {
    session::SessionOptions options{.adjust = [&](scene::Scene& read) { read = scene; },
                                    .meshes = meshes};
    options.duration = scene.duration + kSettling * static_cast<double>(stops.size());
    options.arm_file = scene.arms.front().arm_file;
    auto opened = session::Session::open(scene.file, options);
    if (!opened) return opened.error();
    session::Session& session = **opened;
    const auto settling = static_cast<std::size_t>(kSettling * scene.rate);
    std::size_t next = 0, held_until = 0;
    bool held = false;
    for (std::size_t tick = 0;; ++tick) {
      if (held && tick >= held_until) session.simulation()->hold(held = false);
      if (next < stops.size() && tick >= stops[next] + next * settling) {
        session.simulation()->hold(held = true);
        held_until = tick + settling;
        ++next;
      }
      if (session.step()) break;
    }
    if (session.stride() != 1) {
      return driver::Error{
          scene.name +
          ": the run is too long to check for limit cycles at rest. Reduce duration to "
          "less than a million ticks."};
    }
    Run run(scene);
    run.fault_ = session.device().fault();
    const auto rows = session.ticks();
    run.rows_.assign(rows.begin(), rows.end());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double> force;
      force.reserve(rows.size());
      for (const driver::TickRecord& row : rows) force.push_back(row.f_sent_W[axis]);
      run.fast_[axis] = high_passed(force, scene.rate, kCorner);
    }
    return run;
  }

  driver::Fault fault() const { return fault_; }
  std::span<const driver::TickRecord> rows() const { return rows_; }

  /// Returns the statistics of the force in the last kWatched before tick `end`.
  Rest watch(double start, std::size_t end) const {
    const auto count = static_cast<std::size_t>(kWatched * scene_->rate);
    const std::size_t begin = end - std::min(end, count);
    Rest rest{.time = start, .on = {}};
    const driver::TickRecord& last = rows_[end - 1];
    if (last.in_contact && last.object >= 0) {
      rest.on = scene_->objects[static_cast<std::size_t>(last.object)].name;
    }
    Eigen::Vector3d sum(0, 0, 0);
    for (std::size_t i = begin; i < end; ++i) {
      sum += Eigen::Vector3d(rows_[i].f_sent_W[0], rows_[i].f_sent_W[1], rows_[i].f_sent_W[2]);
    }
    rest.force = sum.norm() / static_cast<double>(end - begin);
    double squares = 0, max = 0;
    for (const std::vector<double>& axis : fast_) {
      const auto watched = std::span(axis).subspan(begin, end - begin);
      const double rms = root_mean_square(watched);
      squares += rms * rms;
      if (!(rms > max)) continue;
      max = rms;
      const auto lines = spectrum(watched, scene_->rate);
      const auto strongest = std::max_element(
          lines.begin(), lines.end(),
          [](const SpectralLine& a, const SpectralLine& b) { return a.amplitude < b.amplitude; });
      if (strongest != lines.end()) rest.frequency = strongest->frequency;
    }
    rest.oscillation = std::sqrt(squares);
    return rest;
  }

 private:
  explicit Run(const scene::Scene& scene) : scene_(&scene) {}

  const scene::Scene* scene_;
  driver::Fault fault_ = driver::Fault::kNone;
  std::vector<driver::TickRecord> rows_;
  std::array<std::vector<double>, 3> fast_;
};

/// Returns the ticks at which the tip was deepest in each object, in order.
std::vector<std::size_t> deepest_ticks(const scene::Scene& scene,
                                       std::span<const driver::TickRecord> rows) {
  std::vector<std::size_t> deepest(scene.objects.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].in_contact || rows[i].object < 0) continue;
    std::size_t& max = deepest[static_cast<std::size_t>(rows[i].object)];
    if (max == rows.size() || rows[i].depth > rows[max].depth) max = i;
  }
  std::erase(deepest, rows.size());
  std::sort(deepest.begin(), deepest.end());
  return deepest;
}

}  // namespace

const Rest* RestTrial::worst() const {
  const auto max = std::max_element(rests.begin(), rests.end(), [](const Rest& a, const Rest& b) {
    return a.oscillation < b.oscillation;
  });
  return max == rests.end() ? nullptr : &*max;
}

driver::Result<RestTrial> try_rests(const scene::Scene& scene, const device_sim::HandSettings& hand,
                                    const std::shared_ptr<scene::SharedMeshes>& meshes) {
  scene::Scene resting = scene;
  resting.arms.front().arm.simulated.hand = hand;
  scene::Scene stopped = resting;
  const std::vector<Stretch> stretches = prolong_rests(resting);
  auto run = Run::make(resting, {}, meshes);
  if (!run) return run.error();
  RestTrial trial;
  const auto tick_of = [&](double time) {
    return std::min(run->rows().size(), static_cast<std::size_t>(std::llround(time * scene.rate)));
  };
  bool touches = false;
  for (const Stretch& stretch : stretches) {
    const std::size_t end = tick_of(stretch.until);
    if (end == 0 || end < tick_of(stretch.start)) break;  // a fault ended the run before
    trial.rests.push_back(run->watch(stretch.start, end));
    touches = touches || trial.rests.back().force > 0;
  }
  trial.fault = run->fault();
  if (touches || trial.fault != driver::Fault::kNone) return trial;
  // The path rests nowhere on an object: stop the hand inside of the objects it touches.
  const auto stops = deepest_ticks(scene, run->rows());
  if (stops.empty()) return trial;
  auto again = Run::make(stopped, stops, meshes);
  if (!again) return again.error();
  const auto settling = static_cast<std::size_t>(kSettling * scene.rate);
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const std::size_t end = stops[i] + (i + 1) * settling;
    if (end > again->rows().size()) break;
    trial.rests.push_back(again->watch(static_cast<double>(stops[i]) / scene.rate, end));
  }
  trial.fault = again->fault();
  return trial;
}

}  // namespace thimble::stability
