#pragma once

#include <cstdint>

#include "thimble/scene/arm_file.h"

namespace thimble::scene {

/// Longest wait for the first report of a real arm, ns [chosen].
inline constexpr std::int64_t kReportTimeout_ns = 1'000'000'000;

/// Returns the longest wait for the first report of a simulated arm, ns. Its wire delays the
/// report, and the message that some boards answer.
inline std::int64_t report_timeout_ns(const ArmFile& file) {
  const auto& wire = file.simulated.wire;
  return kReportTimeout_ns + wire.delay_in_ns + wire.delay_out_ns + 2 * wire.jitter_ns;
}

}  // namespace thimble::scene
