#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Follows a suite.
struct HilListener {
  /// Called before each check with its name, its number from 1 on, and how many there are.
  std::function<void(const std::string& name, std::size_t number, std::size_t count)> begun{};
  /// Called after each check with all results until then; the last is the new one.
  std::function<void(const std::vector<HilResult>& results)> ended{};
};

/// Returns the names of all checks, in their order.
std::vector<std::string> hil_checks();

/// Returns the names of the checks that these options choose, in their order. A check that pushes
/// brings the feel check with it.
std::vector<std::string> chosen_checks(const HilOptions& options);

/// Runs the checks that need an arm: its reports, the feel check, its constants, its watchdog,
/// friction at rest, the stiffest wall against law and simulation, a spring of known stiffness, a
/// soak, and a cable that is pulled. What pushes does not run where the arm has not passed its feel
/// check, and after a fault. Stops when `rig.stop` is set; returns a result for each chosen check,
/// also for those that did not run. Real-time: never from the servo thread.
std::vector<HilResult> run_hil_suite(const HilRig& rig, const HilOptions& options,
                                     const HilListener& listener);

/// Returns results that say of each chosen check beyond those that are given why it did not run.
std::vector<HilResult> with_not_run(std::vector<HilResult> results, const HilOptions& options,
                                    const std::string& why);

}  // namespace thimble::hil
