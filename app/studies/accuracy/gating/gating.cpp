#include "studies/accuracy/gating/gating.h"
#include "setup.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <memory>
#include <utility>

#include "log/progress.h"
#include "report/picture_style.h"
#include "studies/accuracy/probed_stroke.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shared_meshes.h"
#include "thimble/session/session.h"

namespace thimble::studies {
namespace {

constexpr int kRounds = 5;

using Adjust = std::function<void(scene::Scene&)>;
using Meshes = std::shared_ptr<scene::SharedMeshes>;  // shared by all compared runs

driver::Result<std::unique_ptr<session::Session>> open_with(const std::filesystem::path& scene,
                                                            const Adjust& adjust,
                                                            const Meshes& meshes = {}) {
  session::SessionOptions options;
  options.adjust = adjust;
  options.meshes = meshes;
  return session::Session::open(scene, options);
}

Adjust without(const std::vector<GateDecision>& decisions) {
  return [decisions](scene::Scene& scene) {
    for (const GateDecision& one : decisions) {
      if (one.left_out) leave_out(one.name, scene);
    }
  };
}

double compare(std::span<const driver::TickRecord> full, std::span<const driver::TickRecord> some) {
  double squares = 0, size = 0;
  for (std::size_t i = 0; i < std::min(full.size(), some.size()); ++i) {
    if (!is_felt(full[i]) && !is_felt(some[i])) continue;
    std::array<double, 3> off{};
    for (std::size_t k = 0; k < 3; ++k) off[k] = some[i].f_sent_W[k] - full[i].f_sent_W[k];
    squares += report::length_of(off) * report::length_of(off);
    size += report::length_of(full[i].f_sent_W) * report::length_of(full[i].f_sent_W);
  }
  return size > 0 ? std::sqrt(squares / size) : 0;
}

// Returns ns per tick of both, alternating, in CPU time of this thread.
driver::Result<std::pair<double, double>> time_both(const std::filesystem::path& scene,
                                                    const Adjust& reduced, const Meshes& meshes) {
  std::vector<double> ns[2];
  for (int round = 0; round < kRounds; ++round) {
    for (const int which : {0, 1}) {
      auto session = open_with(scene, which == 0 ? Adjust() : reduced, meshes);
      if (!session) return session.error();
      const std::atomic<bool> stop{false};
      timespec begin{}, end{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
      (*session)->run(stop);
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
      const double spent = 1e9 * static_cast<double>(end.tv_sec - begin.tv_sec) +
                           static_cast<double>(end.tv_nsec - begin.tv_nsec);
      ns[which].push_back(spent / static_cast<double>((*session)->setup().ticks()));
    }
  }
  for (auto& list : ns) std::sort(list.begin(), list.end());
  return std::pair{ns[0][kRounds / 2], ns[1][kRounds / 2]};
}

driver::Result<std::vector<driver::TickRecord>> trace_of(const std::filesystem::path& scene,
                                                         const Adjust& adjust,
                                                         const Meshes& meshes) {
  auto session = open_with(scene, adjust, meshes);
  if (!session) return session.error();
  const std::atomic<bool> stop{false};
  (*session)->run(stop);
  const auto rows = (*session)->ticks();
  return std::vector<driver::TickRecord>(rows.begin(), rows.end());
}

std::optional<double> instructions_per_tick_of(const std::string& kind,
                                               const std::filesystem::path& scene, double ticks) {
  const auto counts = count_subject("gating/" + kind + "/" + scene.string());
  if (!counts || counts->size() != 1) return std::nullopt;
  return counts->front() / ticks;
}

// Shares of the time after the first run, all compared runs and the timed ones; the rest is
// counting [chosen].
constexpr double kRunShare = 0.02, kRunsShare = 0.1, kTimedShare = 0.2;

}  // namespace

driver::Result<GatingReport> decide_gating(const std::filesystem::path& scene, bool count) {
  scene::Progress progress("study gating");
  const auto meshes = std::make_shared<scene::SharedMeshes>();
  auto session = open_with(scene, {}, meshes);
  if (!session) return session.error();
  if ((*session)->simulation() == nullptr) return driver::Error{"The study needs a simulated arm."};
  const double ticks = static_cast<double>((*session)->setup().ticks());
  const std::atomic<bool> stop{false};
  (*session)->run(stop);
  progress.set_share(kRunShare);
  const auto full = (*session)->ticks();
  const RunObservations seen = look_at(full, 1 / (*session)->scene().rate);
  GatingReport report;
  report.force = seen.force_rms;
  report.decisions = decide((*session)->scene(), seen);
  // Omits one effect at a time, whatever was decided, to check the rule.
  for (GateDecision& one : report.decisions) {
    if (!one.changes) continue;
    const auto rows = trace_of(
        scene, [&](scene::Scene& changed) { leave_out(one.name, changed); }, meshes);
    if (!rows) return rows.error();
    one.change = compare(full, *rows);
    // Rules compare magnitudes; only the run shows the response of the hand.
    if (one.left_out && !(*one.change <= kShareFelt)) {
      one.left_out = false;
      one.rule += "; the rule holds, but the change of force below does not allow it";
    }
  }
  const Adjust reduced = without(report.decisions);
  const auto rows = trace_of(scene, reduced, meshes);
  if (!rows) return rows.error();
  report.change = compare(full, *rows);
  report.holds = report.change <= kShareFelt;
  progress.set_share(kRunsShare);
  const auto times = time_both(scene, reduced, meshes);
  if (!times) return times.error();
  report.full_ns = times->first;
  report.reduced_ns = times->second;
  progress.set_share(count ? kTimedShare : 1.0);
  if (count) {
    report.full_instructions = instructions_per_tick_of("full", scene, ticks);
    progress.set_share((1 + kTimedShare) / 2);
    report.reduced_instructions = instructions_per_tick_of("reduced", scene, ticks);
    progress.set_share(1.0);
  }
  return report;
}

bool probe_gating(const std::string& subject) {
  const auto slash = subject.find('/');
  if (slash == std::string::npos) return false;
  const std::filesystem::path scene = subject.substr(slash + 1);
  Adjust adjust;
  if (subject.substr(0, slash) == "reduced") {
    const auto report = decide_gating(scene, false);
    if (!report) return false;
    adjust = without(report->decisions);
  }
  auto session = open_with(scene, adjust);
  if (!session) return false;
  const std::atomic<bool> stop{false};
  thimble_probed_stroke([&] {
    (*session)->run(stop);
    return 0.0;
  });
  return true;
}

}  // namespace thimble::studies
