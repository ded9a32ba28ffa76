#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bringup/bench_arm.h"
#include "thimble/scene/arm_policy.h"

namespace thimble::bringup {

/// Number of results of a check of an arm with three motors in which all steps passed: encoders,
/// three directions, three forces, watchdog.
inline constexpr std::size_t kFeelChecks = 8;

/// Returns the same for an arm: it has a direction and a force per motor. Real-time: never from the
/// servo thread.
std::size_t feel_checks(const scene::ArmFile& file);

/// Returns the axes of the world (0, 1, 2) along which the tip moves: three, or those of the line
/// or plane of an arm with one or two motors. Empty if that is not along axes of the world.
/// Real-time: never from the servo thread.
std::vector<int> feel_check_axes(const scene::ArmFile& file);

/// Result of one step of the check.
struct CheckResult {
  std::string name;
  bool passed = false;
  std::string text;  ///< One sentence with figures.
};

/// Called before each step with the instruction for the user; returns false to end the check.
using Prompt = std::function<bool(const std::string& what)>;

/// Asks the user at the arm a question. Returns whether the answer is yes; empty without an answer.
/// Called while the device is silent or idle.
using Question = std::function<std::optional<bool>(const std::string& what)>;

/// Checks an arm step by step. All encoders count. The directions agree with the world. A force
/// pushes in the right direction. It is 0.4 N at most along x, y and z (0.49 N if dry friction
/// holds the tip), and so small that even swapped motors do not exceed kFeelCheckForceMax. The
/// motors switch off by themselves when the arm gets no messages. If dry friction hides the last,
/// `question` is asked; without it that step fails. Wrong wiring is named: an encoder or motor that
/// is dead, reversed, or swapped with another. The device must be idle; it is idle afterwards, with
/// zero force. Real-time: never from the servo thread.
std::vector<CheckResult> feel_check(BenchArm& bench, const scene::ArmFile& file,
                                    const Prompt& prompt, const std::atomic<bool>& stop,
                                    const Question& question = {});

/// Returns the path of a simulated hand that follows the prompts without pauses (seconds and points
/// in the world, m). `p_WT` is its start; `axes` are those of `feel_check_axes`.
std::vector<std::pair<double, Eigen::Vector3d>> feel_check_hand(const Eigen::Vector3d& p_WT,
                                                                const std::vector<int>& axes = {
                                                                    0, 1, 2});

}  // namespace thimble::bringup
