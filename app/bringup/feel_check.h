#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bringup/bench_arm.h"
#include "thimble/scene/real_arm_terms.h"

namespace thimble::bringup {

/// Number of results of a check in which all steps passed: encoders, three directions, three
/// forces, watchdog.
inline constexpr std::size_t kFeelChecks = 8;

/// What one step of the check found.
struct CheckResult {
  std::string name;
  bool passed = false;
  std::string text;  ///< One sentence with figures.
};

/// Called before each step with what the user shall do; returns false to end the check.
using Prompt = std::function<bool(const std::string& what)>;

/// Asks the person at the arm a question; returns whether the answer is yes, or nothing if there is
/// none. Called while the device is left silent or idle.
using Question = std::function<std::optional<bool>(const std::string& what)>;

/// Checks an arm step by step: do all encoders count, do the directions agree with the world, does
/// a force push the way it should (0.4 N at most along x, y and z, and so little that no swapped
/// motors make it more than kFeelCheckForceMax; up to 0.49 N where dry friction holds the tip), and
/// do the motors go off by themselves when the arm gets no messages. `question` is asked where dry
/// friction hides the last; without it that step fails then. A wire that is wrong is named: an
/// encoder or motor that is dead, turned round, or swapped with another. The device must be idle;
/// it is idle afterwards, with zero force. Real-time: never from the servo thread.
std::vector<CheckResult> feel_check(BenchArm& bench, const scene::ArmFile& file,
                                    const Prompt& prompt, const std::atomic<bool>& stop,
                                    const Question& question = {});

/// Returns the way of a simulated hand that does what the prompts ask, without pauses between them
/// (seconds and points in the world, m). `p_WT` is where it begins.
std::vector<std::pair<double, Eigen::Vector3d>> feel_check_hand(const Eigen::Vector3d& p_WT);

}  // namespace thimble::bringup
