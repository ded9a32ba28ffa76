#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/identify.h"
#include "bringup/identify/simulated_bench.h"
#include "bringup/identify/unidentified_parameters.h"
#include "support/identify/hidden_arm.h"

namespace thimble::support {

inline constexpr double kKnownMass = 0.025;  // kg

/// Returns constants as identified behind elastic cables, for tests of their report.
inline bringup::ArmConstants constants_behind_cables() {
  bringup::ArmConstants found;
  found.mass = {0.075, 1e-3};
  found.gain = {bringup::Estimate{1, 0.01}, {1, 0.01}, {1, 0.01}};
  found.delay = {0.001, 1e-5};
  found.cables.emplace();
  for (bringup::CableConstants& cable : *found.cables) {
    cable.inertia = {2e-4, 1e-5};
    cable.stiffness = {50, 1};
    cable.damping = {0.02, 1e-3};
  }
  return found;
}

/// Identifies an arm whose file names no periods of cogging. `hold_it` keeps the hand of its file
/// on it.
inline driver::Result<bringup::Identified> identified(const HiddenArm& arm,
                                                      const bringup::IdentifyOptions& options,
                                                      bool hold_it = false) {
  const bringup::OpenBench open = [&](bool loaded) {
    return bringup::simulated_bench(arm.file, loaded ? options.known_mass : 0, hold_it);
  };
  scene::ArmFile named = arm.file;
  named.simulated.drive_train.periods_per_turn = 0;
  const std::atomic<bool> never{false};
  return bringup::identify(open, named, options, never);
}

/// Returns whether the list of unidentified parameters names this one.
inline bool leaves_open(const bringup::Identified& found, const std::string& what) {
  const auto sentences = bringup::unidentified_parameters(found);
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& one) { return one.find(what) != std::string::npos; });
}

/// Errors of the estimates of one constant, and how often their intervals contained the truth.
struct Score {
  const char* name;
  double max;        // allowed error, relative or in s
  double worst = 0;  // largest abs(estimate - truth), in the same unit
  int held = 0, all = 0;
  int missed = 0;  // neither within `max` of the truth nor with the truth in the interval

  void add(const bringup::Estimate& estimate, double truth, bool relative = true) {
    const double off = std::abs(estimate.value - truth) / (relative ? std::abs(truth) : 1);
    worst = std::max(worst, off);
    ++all;
    held += estimate.holds(truth) ? 1 : 0;
    missed += off > max && !estimate.holds(truth) ? 1 : 0;
  }

  /// Adds the error of an estimate only if its interval does not contain the truth.
  void add_outside_interval(const bringup::Estimate& estimate, double truth, bool relative = true) {
    const double before = worst;
    add(estimate, truth, relative);
    if (estimate.holds(truth)) worst = before;
  }

  void print() const {
    std::printf("%-9s worst %.3g of %.3g, %d of %d intervals hold the truth\n", name, worst, max,
                held, all);
  }
};

/// Prints the scores. Expects that each worst error is allowed and that nine in ten intervals
/// contain the truth, for each score with more than `few` intervals. A single one of few may miss
/// by chance, so those are checked together.
inline void expect_scores(std::initializer_list<const Score*> scores, int few) {
  int held = 0, all = 0;
  for (const Score* score : scores) {
    score->print();
    EXPECT_LT(score->worst, score->max) << score->name;
    held += score->held;
    all += score->all;
    if (score->all > few) {
      EXPECT_GE(score->held, 0.9 * score->all) << score->name;
    }
  }
  EXPECT_GE(held, 0.9 * all);
}

}  // namespace thimble::support
