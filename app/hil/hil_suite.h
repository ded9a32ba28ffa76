#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Callbacks of a suite.
struct HilListener {
  /// Called before each check with its name, its number from 1 on, and the number of checks.
  std::function<void(const std::string& name, std::size_t number, std::size_t count)> begun{};
  /// Called after each check with all results so far; the last is the new one.
  std::function<void(const std::vector<HilResult>& results)> ended{};
};

/// Returns the names of all checks, in their order.
std::vector<std::string> hil_checks();

/// Returns the names of the checks that these options select, in their order. A check that applies
/// forces also selects the feel check.
std::vector<std::string> chosen_checks(const HilOptions& options);

/// Runs the selected checks of an arm, in the order of `hil_checks`. A check that applies forces
/// does not run if the arm has not passed its feel check, or after a fault. Stops when `rig.stop`
/// is set. Returns a result for each selected check, including those that did not run. Real-time:
/// never from the servo thread.
std::vector<HilResult> run_hil_suite(const HilRig& rig, const HilOptions& options,
                                     const HilListener& listener);

/// Adds a result with the reason for each selected check that is missing in `results`.
std::vector<HilResult> with_not_run(std::vector<HilResult> results, const HilOptions& options,
                                    const std::string& why);

}  // namespace thimble::hil
