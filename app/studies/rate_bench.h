#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"
#include "thimble/scene/quality.h"
#include "thimble/session/histogram.h"

namespace thimble::studies {

/// Result of a loop at one rate on this machine.
struct RateBench {
  double rate = 0;                            ///< Requested rate, Hz.
  session::Histogram period, lateness, work;  ///< As RunStatistics.
  bool priority = false;                      ///< The kernel granted it real-time priority.
  std::string advice;                         ///< What to do about refused permissions.
  std::string trouble;                        ///< A fault, if one ended the run.
};

/// Assessment of a result.
struct RateVerdict {
  bool enough = false;
  double late_us = 0, work_us = 0;  ///< 99.9th percentiles of wake-up latency and computing time.
  double headroom = 0;              ///< Remaining fraction of the period; negative if none remains.
  double stiffness_lost = 0;        ///< Fraction of K_max lost by uneven ticks [PHYSICS 1.1].
  std::string sentence;
};

/// Touches a scene with the simulated arm in wall-clock time for `seconds` at `rate` (Hz), with a
/// quality. `passed`, if any, is called ten times a second with the time since the start, s. The
/// error describes what is wrong with the scene. Real-time: never from the servo thread.
driver::Result<RateBench> bench_rate(const std::filesystem::path& scene, double rate,
                                     double seconds,
                                     scene::Quality quality = scene::Quality::kNormal,
                                     const std::function<void(double)>& passed = {});

/// Assesses a result: sufficient if 999 of 1000 ticks end within their period, and the stiffness
/// lost by uneven ticks cannot be felt.
RateVerdict verdict_of(const RateBench& bench);

/// Returns the fraction of K_max lost by ticks of uneven length: 1 - E[T]^2 / E[T^2] [PHYSICS 1.1].
double stiffness_lost(const session::Histogram& period);

/// Returns a result as figures.
std::vector<session::Figure> figures_of(const RateBench& bench, const RateVerdict& verdict);

}  // namespace thimble::studies
