#pragma once

#include <array>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "twin/replay.h"
#include "twin/twin_forces.h"
#include "twin/twin_motion.h"

namespace thimble::twin {

/// Options of a comparison.
struct TwinOptions {
  double window = 0.2;  ///< Length of the windows, s; 0.05 to 2.
  TwinSpan span;        ///< Compared part of the recording.
};

/// Agreement of a twin along one axis of the world.
struct TwinAxis {
  char name = 'x';        ///< x, y or z.
  double error_rms = 0;   ///< Error of the tip position, m.
  double motion_rms = 0;  ///< Recorded motion less a straight line in each window, m.
  /// The figure of merit: 100 (1 - error / motion), percent. 100: identical; 0: no better than a
  /// straight line. Not a number if the axis moved by less than the encoders' steps.
  double fit = 0;
};

/// A constant of the arm file, and the effect of another value of only this constant.
struct TwinRemedy {
  std::string key;       ///< Key in the file.
  std::string unit;      ///< SI
  double value = 0;      ///< Value in the file.
  double best = 0;       ///< Value with the smallest error.
  double expected = 0;   ///< Error predicted from derivatives at the file's value, RMS, m.
  double error_rms = 0;  ///< Error of the twin with the best value, m.
};

/// Error and motion at a frequency, along each axis of the world, as amplitudes.
struct TwinSpectrum {
  double frequency = 0;            ///< Hz
  std::array<double, 3> error{};   ///< m
  std::array<double, 3> motion{};  ///< m
};

/// Difference between a twin and its arm.
struct TwinComparison {
  std::array<TwinAxis, 3> axes{};
  double error_rms = 0;   ///< RMS error over all axes, m.
  double step_error = 0;  ///< Part of it that is due to the encoders' steps, m.
  double seconds = 0;     ///< Compared time, s.
  /// Constants in the order of their improvement, the best first.
  std::vector<TwinRemedy> remedies;
  /// Constants that together improve the twin more than any of them does by itself, each with its
  /// final value. Empty if one is enough, or if others add nothing. Their `error_rms` is that of
  /// all.
  std::vector<TwinRemedy> together;
  std::vector<TwinSpectrum> spectrum;
  std::vector<std::string> messages;  ///< Messages about the recording, a sentence each.

  /// Returns the share of the motion that is missed even with the best constant, 0 to 1 or more.
  double missed() const;
  /// If more is missed, the arm is not that of the file with one constant changed. [chosen]
  static constexpr double kMissed = 0.05;

  /// A constant that removes a smaller share of the error is not named. [chosen]
  static constexpr double kWorth = 0.01;
  /// Returns whether another value of a constant is worthwhile; it is the first remedy.
  bool has_remedy() const {
    return !remedies.empty() && remedies.front().error_rms < (1 - kWorth) * error_rms;
  }
};

/// Data for the pictures.
struct TwinTrace {
  std::vector<TwinWindow> windows;
  ReplayError replayed;
  double dt = 0;  ///< s between ticks
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
};

/// A comparison with its data.
struct TwinResult {
  TwinComparison comparison;
  TwinForces forces;
  TwinTrace trace;
};

/// Replays a recording on the simulated arm of a file, and finds the error and the constant that
/// explains it. Each constant in turn takes the value of smallest error, found by central
/// differences and Gauss-Newton steps. Each step is verified. Fails like twin_motion and Replay.
/// Real-time: never from the servo thread.
driver::Result<TwinResult> compare_twin(const session::Recording& recording,
                                        const scene::ArmFile& file, const TwinOptions& options);

}  // namespace thimble::twin
