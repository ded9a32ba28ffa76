#include "twin/compare_twin.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "log/progress.h"
#include "math/elementary.h"
#include "twin/twin_constants.h"

namespace thimble::twin {
namespace {

/// Correlation of two errors: sums over all ticks with a report.
double dot(const std::vector<TwinWindow>& windows, const ReplayError& a, const ReplayError& b) {
  double sum = 0;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    for (std::size_t j = 0; j < windows[w].seen.size(); ++j) {
      if (!windows[w].seen[j]) continue;
      const auto k = static_cast<Eigen::Index>(j);
      sum += a.error_B[w].col(k).dot(b.error_B[w].col(k));
    }
  }
  return sum;
}

/// Finds the value of one constant with the smallest error.
class Remedy {
 public:
  Remedy(Replay& replay, const scene::ArmFile& file, const TwinConstant& constant, ReplayError& now)
      : replay_(replay), file_(file), constant_(constant), now_(now) {}

  driver::Result<TwinRemedy> find() {
    const double value = constant_.get(file_);
    TwinRemedy remedy{.key = constant_.key,
                      .unit = constant_.unit,
                      .value = value,
                      .best = value,
                      .expected = now_.rms(),
                      .error_rms = now_.rms()};
    ReplayError at_best = now_;
    for (int round = 0; round < kRounds; ++round) {
      const auto step = step_from(remedy.best, at_best);
      if (!step) return step.error();
      if (round == 0) remedy.expected = now_.rms() * std::sqrt(std::max(0.0, 1 - step->second));
      bool nearer = false;
      double by = step->first;
      for (int half = 0; half < kHalves && !nearer; ++half, by /= 2) {
        const double to = std::max(constant_.min_value, remedy.best + by);
        if (to == remedy.best) break;
        auto there = at(to);
        if (!there) return there.error();
        if (!(there->square < at_best.square)) continue;
        nearer = true;
        const double gained = 1 - there->square / at_best.square;
        remedy.best = to;
        at_best = std::move(there).value();
        if (gained < kSettled) round = kRounds;
      }
      if (!nearer) break;
    }
    remedy.error_rms = at_best.rms();
    // An improved start of some window, found on the way, must not count for the constant.
    auto again = at(value);
    if (!again) return again.error();
    if (again->square < now_.square) now_ = std::move(again).value();
    return remedy;
  }

 private:
  static constexpr int kRounds = 4, kHalves = 2;
  static constexpr double kSettled = 0.02;

  driver::Result<ReplayError> at(double value) {
    scene::ArmFile other = file_;
    constant_.set(other, value);
    return replay_(other);
  }

  /// Returns the Gauss-Newton step from a value, and its predicted share of the squared error.
  driver::Result<std::pair<double, double>> step_from(double value, const ReplayError& here) {
    const double low = std::max(constant_.min_value, value - constant_.step);
    const double high = value + constant_.step;
    auto below = at(low), above = at(high);
    if (!below) return below.error();
    if (!above) return above.error();
    for (std::size_t w = 0; w < above->error_B.size(); ++w) {
      above->error_B[w] = (above->error_B[w] - below->error_B[w]) / (high - low);
    }
    const double slope = dot(replay_.windows(), *above, *above);
    const double along = dot(replay_.windows(), *above, here);
    if (!(slope > 0) || !(here.square > 0)) return std::pair{0.0, 0.0};
    return std::pair{-along / slope, along * along / (slope * here.square)};
  }

  Replay& replay_;
  const scene::ArmFile& file_;
  const TwinConstant& constant_;
  ReplayError& now_;
};

void find_axes(const Replay& replay, const ReplayError& replayed, TwinComparison& found) {
  Eigen::Vector3d error(0, 0, 0), motion(0, 0, 0);
  const Eigen::Matrix3d& R_WB = replay.motion().R_WB;
  const auto& windows = replay.windows();
  for (std::size_t w = 0; w < windows.size(); ++w) {
    for (std::size_t j = 0; j < windows[w].seen.size(); ++j) {
      if (!windows[w].seen[j]) continue;
      const auto k = static_cast<Eigen::Index>(j);
      error += (R_WB * replayed.error_B[w].col(k)).cwiseAbs2();
      motion += (R_WB * windows[w].motion_B.col(k)).cwiseAbs2();
    }
  }
  const auto count = static_cast<double>(replayed.count);
  for (int i = 0; i < 3; ++i) {
    TwinAxis& axis = found.axes[static_cast<std::size_t>(i)];
    axis.name = "xyz"[i];
    axis.error_rms = std::sqrt(error[i] / count);
    axis.motion_rms = std::sqrt(motion[i] / count);
    axis.fit = axis.motion_rms > found.step_error ? 100 * (1 - axis.error_rms / axis.motion_rms)
                                                  : std::numeric_limits<double>::quiet_NaN();
  }
}

/// Averages the power of all windows, each under a bell, like Welch; ticks without a report hold
/// the last.
void find_spectrum(const Replay& replay, const ReplayError& replayed, TwinComparison& found) {
  const std::size_t n = replay.ticks() - 1;
  const Eigen::Matrix3d& R_WB = replay.motion().R_WB;
  std::vector<double> bell(n);
  double area = 0;
  for (std::size_t j = 0; j < n; ++j) {
    bell[j] = 0.5 - 0.5 * math::cos(2 * std::numbers::pi * static_cast<double>(j) /
                                    static_cast<double>(n));
    area += bell[j];
  }
  found.spectrum.resize(n / 2);
  for (std::size_t k = 0; k < n / 2; ++k) {
    found.spectrum[k].frequency =
        static_cast<double>(k) / (static_cast<double>(n) * replay.motion().dt);
  }
  Eigen::FFT<double> fft;
  std::vector<double> signal(n);
  std::vector<std::complex<double>> lines;
  const auto add = [&](const Eigen::Matrix3Xd& of_B, const std::vector<bool>& seen, int axis,
                       std::array<double, 3> TwinSpectrum::*into) {
    double last = 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (seen[j]) last = R_WB.row(axis).dot(of_B.col(static_cast<Eigen::Index>(j)));
      signal[j] = bell[j] * last;
    }
    fft.fwd(lines, signal);
    for (std::size_t k = 0; k < n / 2; ++k) {
      (found.spectrum[k].*into)[static_cast<std::size_t>(axis)] +=
          std::norm(2.0 * lines[k] / area) / static_cast<double>(replay.windows().size());
    }
  };
  for (std::size_t w = 0; w < replay.windows().size(); ++w) {
    for (int axis = 0; axis < 3; ++axis) {
      const TwinWindow& window = replay.windows()[w];
      add(replayed.error_B[w], window.seen, axis, &TwinSpectrum::error);
      add(window.motion_B, window.seen, axis, &TwinSpectrum::motion);
    }
  }
  for (TwinSpectrum& line : found.spectrum) {
    for (double& value : line.error) value = std::sqrt(value);
    for (double& value : line.motion) value = std::sqrt(value);
  }
}

}  // namespace

double TwinComparison::missed() const {
  double square = 0;
  for (const TwinAxis& axis : axes) square += axis.motion_rms * axis.motion_rms / 3;
  const double error = remedies.empty() ? error_rms : remedies.front().error_rms;
  return square > 0 ? error / std::sqrt(square) : 0;
}

namespace {

// Such a twin is as good as the encoders' steps allow [twin_test].
constexpr double kNearSteps = 1.15;
// Min. share of the error that each further constant must remove.
constexpr double kFurther = 0.1;
constexpr int kTogetherMax = 4;

/// Changes constants one after the other, always the one with the largest improvement, starting
/// with the best single one, until the twin is near. Sets `file` to the arm with all of them.
/// Returns each constant with its final value.
std::vector<TwinRemedy> combine_remedies(Replay& replay, double step_error, const TwinRemedy& first,
                                         scene::ArmFile& file, scene::Progress& progress) {
  const std::vector<TwinConstant> constants = twin_constants(file);
  std::size_t tried = constants.size();  // one by one, before
  std::vector<TwinRemedy> together{first};
  const auto set = [&](const TwinRemedy& remedy) {
    for (const TwinConstant& constant : constants) {
      if (constant.key == remedy.key) constant.set(file, remedy.best);
    }
  };
  set(first);
  for (int round = 1; round < kTogetherMax; ++round) {
    auto now = replay(file);
    if (!now) break;
    const double before = now->rms();
    if (before < kNearSteps * step_error) break;
    TwinRemedy best;
    best.error_rms = before;
    for (const TwinConstant& constant : constants) {
      // With wrong values of other constants, the arm may be impossible to simulate.
      auto remedy = Remedy(replay, file, constant, *now).find();
      progress.set_share(++tried, constants.size() * kTogetherMax);
      if (remedy && remedy->error_rms < best.error_rms) best = std::move(remedy).value();
    }
    if (best.key.empty() || !(best.error_rms < (1 - kFurther) * before)) break;
    set(best);
    const auto same = std::find_if(together.begin(), together.end(),
                                   [&](const TwinRemedy& one) { return one.key == best.key; });
    if (same == together.end()) {
      together.push_back(best);
    } else {
      same->best = best.best;
    }
    for (TwinRemedy& one : together) one.error_rms = best.error_rms;
  }
  return together;
}

}  // namespace

driver::Result<TwinResult> compare_twin(const session::Recording& recording,
                                        const scene::ArmFile& file, const TwinOptions& options) {
  const auto motion = twin_motion(recording, file, options.span);
  if (!motion) return motion.error();
  auto replay = Replay::make(*motion, options.window);
  if (!replay) return replay.error();
  auto replayed = (*replay)(file);
  if (!replayed) return replayed.error();
  TwinComparison found;
  found.step_error = motion->step_error;
  found.seconds = static_cast<double>(replay->windows().size()) * options.window;
  found.messages = motion->messages;
  scene::Progress progress("twin");
  const std::vector<TwinConstant> constants = twin_constants(file);
  for (const TwinConstant& constant : constants) {
    auto remedy = Remedy(*replay, file, constant, *replayed).find();
    if (!remedy) return remedy.error();
    found.remedies.push_back(std::move(remedy).value());
    progress.set_share(found.remedies.size(), constants.size() * kTogetherMax);
  }
  found.error_rms = replayed->rms();
  for (TwinRemedy& remedy : found.remedies) {
    remedy.expected = std::min(remedy.expected, found.error_rms);
    if (remedy.error_rms < found.error_rms) continue;
    remedy.best = remedy.value;
    remedy.error_rms = found.error_rms;
  }
  find_axes(*replay, *replayed, found);
  find_spectrum(*replay, *replayed, found);
  TwinTrace trace{.windows = replay->windows(),
                  .replayed = std::move(replayed).value(),
                  .dt = motion->dt,
                  .R_WB = motion->R_WB};
  std::stable_sort(
      found.remedies.begin(), found.remedies.end(),
      [](const TwinRemedy& a, const TwinRemedy& b) { return a.error_rms < b.error_rms; });
  TwinForces forces = twin_forces(*motion, file);
  if (found.has_remedy()) {
    scene::ArmFile corrected = file;
    auto together =
        combine_remedies(*replay, found.step_error, found.remedies.front(), corrected, progress);
    if (together.size() > 1) found.together = std::move(together);
    forces.constants_explain =
        forces.other_acted() && !twin_forces(*motion, corrected).other_acted();
  }
  progress.set_share(1.0);
  return TwinResult{
      .comparison = std::move(found), .forces = std::move(forces), .trace = std::move(trace)};
}

}  // namespace thimble::twin
