#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "report/figure_output.h"

namespace thimble::bench {

/// Console reporter of Google Benchmark that also stores the median of each benchmark as a figure,
/// in nanoseconds of CPU or manual time per iteration.
class FiguresReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    benchmark::ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.error_occurred) continue;
      const bool median = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
      if (!median && !(run.run_type == Run::RT_Iteration && run.repetitions <= 1)) continue;
      const std::string& arguments = run.run_name.args;
      const auto goal = run.counters.find("goal_below_ns");
      figures_.push_back(
          {.name = run.run_name.function_name + (arguments.empty() ? "" : "/" + arguments),
           .value = time_of(run) * 1e9 / benchmark::GetTimeUnitMultiplier(run.time_unit),
           .unit = "ns",
           .goal = goal == run.counters.end()
                       ? std::string()
                       : "< " + std::to_string(static_cast<long>(goal->second.value))});
    }
  }

  std::vector<session::Figure>& figures() { return figures_; }

 private:
  /// Returns processor time, which does not depend on other load, unless the benchmark measured the
  /// time itself.
  static double time_of(const Run& run) {
    const bool manual = run.run_name.time_type == "manual_time";
    return manual ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime();
  }

  std::vector<session::Figure> figures_;
};

}  // namespace thimble::bench
