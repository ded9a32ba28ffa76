#pragma once

#include <array>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "twin/relive.h"
#include "twin/twin_forces.h"
#include "twin/twin_motion.h"

namespace thimble::twin {

/// How a recording is compared.
struct TwinOptions {
  double window = 0.2;  ///< Length of the pieces that the twin relives, s; 0.05 to 2.
  TwinSpan span;        ///< What of the recording.
};

/// How near a twin comes along one axis of the world.
struct TwinAxis {
  char name = 'x';        ///< x, y or z.
  double error_rms = 0;   ///< Of where the tip is, m.
  double motion_rms = 0;  ///< Of the recorded motion less a straight line in each window, m.
  /// The figure of merit: 100 (1 - error / motion), percent. 100: the same; 0: no nearer than a
  /// straight line. Not a number where the axis moved by less than the encoders' steps.
  double fit = 0;
};

/// A constant of the arm file, and what another value of it alone would mend.
struct TwinRemedy {
  std::string key;       ///< As the file names it.
  std::string unit;      ///< SI
  double value = 0;      ///< Of the file.
  double best = 0;       ///< With which the error is least.
  double expected = 0;   ///< Error by the differences about the file's value, RMS, m.
  double error_rms = 0;  ///< Error that the twin has with it, m.
};

/// Error and motion at a frequency, along each axis of the world, as amplitudes.
struct TwinSpectrum {
  double frequency = 0;            ///< Hz
  std::array<double, 3> error{};   ///< m
  std::array<double, 3> motion{};  ///< m
};

/// How far a twin and its arm are apart.
struct TwinComparison {
  std::array<TwinAxis, 3> axes{};
  double error_rms = 0;              ///< Over all axes, m.
  double step_error = 0;             ///< What the encoders' steps leave of it, m.
  double seconds = 0;                ///< That were compared.
  std::vector<TwinRemedy> remedies;  ///< The best first.
  /// Constants that together bring the twin nearer than any of them alone, each with its last
  /// value; empty where one is enough, or where others add nothing. Their `error_rms` is that of
  /// all.
  std::vector<TwinRemedy> together;
  std::vector<TwinSpectrum> spectrum;
  std::vector<std::string> told;  ///< Of the recording, a sentence each.

  /// Returns the share of the motion that is missed even with the best constant, 0 to 1 or more.
  double missed() const;
  /// Where more is missed, the arm is not that of the file with one constant changed. [chosen]
  static constexpr double kMissed = 0.05;

  /// A remedy that mends less of the error than this names nothing. [chosen]
  static constexpr double kWorth = 0.01;
  /// Returns whether there is a constant worth another value: the first remedy then.
  bool has_remedy() const {
    return !remedies.empty() && remedies.front().error_rms < (1 - kWorth) * error_rms;
  }
};

/// What the pictures are drawn of.
struct TwinTrace {
  std::vector<TwinWindow> windows;
  Relived relived;
  double dt = 0;  ///< s between ticks
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
};

/// A comparison with what it rests on.
struct TwinResult {
  TwinComparison comparison;
  TwinForces forces;
  TwinTrace trace;
};

/// Lets the simulated arm of a file relive a recording, and finds how far both are apart and which
/// constant keeps them so: each in turn takes the value of least error, found by central
/// differences and Gauss-Newton steps, each of which is tried. Errors: as twin_motion and Relive.
/// Real-time: never from the servo thread.
driver::Result<TwinResult> compare_twin(const session::Recording& recording,
                                        const scene::ArmFile& file, const TwinOptions& options);

}  // namespace thimble::twin
