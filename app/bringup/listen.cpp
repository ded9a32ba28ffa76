#include "bringup/listen.h"

#include <fmt/format.h>

#include "text/counted.h"

namespace thimble::bringup {

std::string ReportStatistics::text() const {
  return fmt::format(
      "{:.0f} reports per second; {} had no report, {} skipped, {} rejected, {} refused.",
      static_cast<double>(reports) / seconds, scene::counted(missing, "tick"),
      scene::counted(skipped, "report"), rejected, scene::counted(refused, "message"));
}

ReportStatistics listen(BenchArm& bench, double seconds, const std::atomic<bool>& stop) {
  const auto rest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
  const driver::WireCounters before = bench.device().wire_counters();
  const bool whole = bench.run(seconds, rest, stop);
  const driver::WireCounters& after = bench.device().wire_counters();
  return {.seconds = seconds,
          .reports = after.reports - before.reports,
          .missing = after.missing - before.missing,
          .skipped = after.skipped - before.skipped,
          .rejected = after.rejected - before.rejected,
          .refused = after.refused - before.refused,
          .whole = whole};
}

}  // namespace thimble::bringup
