#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "thimble/driver/result.h"
#include "thimble/scene/quality.h"
#include "thimble/session/histogram.h"

namespace thimble::studies {

/// What a loop of one rate did on this machine.
struct RateBench {
  double rate = 0;                            ///< Asked for, Hz.
  session::Histogram period, lateness, work;  ///< As RunStatistics.
  bool priority = false;                      ///< The kernel runs it before all others.
  std::string advice;                         ///< What to do about what was refused.
  std::string trouble;                        ///< A fault, if one ended the run.
};

/// The answer to "is it good enough".
struct RateVerdict {
  bool enough = false;
  double late_us = 0, work_us = 0;  ///< 99.9th percentiles of wake-up and tick.
  double headroom = 0;              ///< Share of the period that is left then; below 0 if none is.
  double stiffness_lost = 0;        ///< Share of K_max that uneven ticks cost [PHYSICS 1.1].
  std::string sentence;
};

/// Touches a scene with the simulated arm on the wall clock for `seconds` at `rate` (Hz), at a
/// quality. The error names what is wrong with the scene. Real-time: never from the servo thread.
driver::Result<RateBench> bench_rate(const std::filesystem::path& scene, double rate,
                                     double seconds,
                                     scene::Quality quality = scene::Quality::kNormal);

/// Judges it: enough if 999 of 1000 ticks are done within their period, and uneven ticks cost less
/// of the stiffness than can be felt.
RateVerdict verdict_of(const RateBench& bench);

/// Returns the share of K_max that ticks of uneven length cost: 1 - E[T]^2 / E[T^2] [PHYSICS 1.1].
double stiffness_lost(const session::Histogram& period);

/// Returns it as figures.
std::vector<session::Figure> figures_of(const RateBench& bench, const RateVerdict& verdict);

}  // namespace thimble::studies
