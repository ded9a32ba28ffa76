#include "identified/plot_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bringup/identify/cables/two_mass_search.h"
#include "bringup/identify/joint_friction.h"
#include "bringup/identify/line_forces.h"
#include "bringup/identify/link_inertia/masses_per_pose.h"

namespace thimble::identified {
namespace {

constexpr double kExcerpt = 2;  // s, from the middle of the motion
constexpr double kGap = 0.02;   // s, more than the distance of two adjacent pieces
constexpr std::size_t kPointsMax = 1500;
constexpr int kSteps = 21;             // intervals of speed for the medians
constexpr std::size_t kInStepMin = 8;  // min. number of pieces for a median
constexpr int kFrequencies = 400;

/// Writes a block of lines for each axis; `line(equation number, time)` returns one line.
template <class Line>
std::string by_axis(const bringup::FittedMotion& motion, double from, double until,
                    const Line& line) {
  std::string text;
  const auto& equations = motion.equations.equations();
  for (int axis = 0; axis < 3; ++axis) {
    double before = HUGE_VAL;
    for (std::size_t i = 0; i < equations.size(); ++i) {
      const double time = equations[i].middle * motion.motion().dt;
      if (equations[i].axis != axis || time < from || time > until) continue;
      // An empty line interrupts the plotted line where pieces were omitted.
      if (time - before > kGap) text += "\n";
      text += line(i, time);
      before = time;
    }
    text += "\n\n";
  }
  return text;
}

/// Returns the quantile of some values: `share` of them are below it.
double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Returns the constants of the same arm with cables that do not stretch.
bringup::TwoMassTheta stiff_of(const bringup::CableFit& lines) {
  bringup::TwoMassTheta stiff = lines.stretches ? lines.elastic.theta : lines.rigid.theta;
  stiff.tail<6>().setZero();
  return stiff;
}

}  // namespace

std::string fit_table(const bringup::FittedMotion& motion) {
  const double middle =
      0.5 * static_cast<double>(motion.motion().samples.size()) * motion.motion().dt;
  return "# time s, acceleration measured, fitted, m/s^2\n" +
         by_axis(motion, middle - kExcerpt / 2, middle + kExcerpt / 2,
                 [&](std::size_t i, double time) {
                   const double left = motion.equations.equations()[i].left;
                   return fmt::format("{:.4f} {:.6g} {:.6g}\n", time, left,
                                      left - motion.residual.rest[static_cast<Eigen::Index>(i)]);
                 });
}

std::string rest_table(const bringup::FittedMotion& motion) {
  return "# time s, residual of the fit, m/s^2\n" +
         by_axis(motion, 0, HUGE_VAL, [&](std::size_t i, double time) {
           return fmt::format("{:.4f} {:.6g}\n", time,
                              motion.residual.rest[static_cast<Eigen::Index>(i)]);
         });
}

std::string friction_table(const bringup::FittedMotion& motion, const bringup::Identified& found) {
  std::string text = "# speed rad/s, torque of friction N m\n";
  for (const auto& points : bringup::joint_friction(motion, found)) {
    const std::size_t stride = points.size() / kPointsMax + 1;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      text += fmt::format("{:.6g} {:.6g}\n", points[i].speed, points[i].torque);
    }
    text += "\n\n";
  }
  return text;
}

std::string friction_medians(const bringup::FittedMotion& motion,
                             const bringup::Identified& found) {
  std::string text = "# speed rad/s, torque N m: median, lower and upper quartile, fit\n";
  for (const auto& points : bringup::joint_friction(motion, found)) {
    std::vector<double> speeds;
    for (const bringup::FrictionPoint& point : points) speeds.push_back(std::abs(point.speed));
    const double max_speed = speeds.empty() ? 0 : quantile(speeds, 0.98);
    const double step = 2 * max_speed / kSteps;
    for (int k = 0; k < kSteps; ++k) {
      const double from = -max_speed + k * step;
      std::vector<double> seen, fitted;
      for (const bringup::FrictionPoint& point : points) {
        if (point.speed < from || point.speed >= from + step) continue;
        seen.push_back(point.torque);
        fitted.push_back(point.fitted);
      }
      if (seen.size() < kInStepMin) continue;
      text += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.6g}\n", from + 0.5 * step,
                          quantile(seen, 0.5), quantile(seen, 0.25), quantile(seen, 0.75),
                          quantile(fitted, 0.5));
    }
    text += "\n\n";
  }
  return text;
}

std::string masses_table(const bringup::Identified& identified, const scene::ArmFile& file) {
  std::string text = "# apparent mass fitted, measured, half its interval, kg\n";
  const std::vector<bringup::PoseMass> places = bringup::pose_masses(*identified.over.fit, file);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bringup::PoseMass& place : places) {
      text += fmt::format("{:.6g} {:.6g} {:.3g}\n", place.mass[axis].value, place.seen[axis].value,
                          place.seen[axis].plus_minus);
    }
    text += "\n\n";
  }
  return text;
}

std::string lines_table(const bringup::Identified& identified, double dt) {
  const bringup::CableFit& lines = identified.lines;
  const bringup::TwoMassTheta stiff = stiff_of(lines);
  std::string text = "# frequency Hz, motion relative to stiff cables, half the interval\n";
  for (int joint = 0; joint < 3; ++joint) {
    for (std::size_t i = 0; i < identified.spectrum.lines.size(); ++i) {
      const bringup::SpectralLine& line = identified.spectrum.lines[i];
      const double rigid =
          std::abs(bringup::two_mass_answer(stiff, line, lines.JTJ, dt, false)[joint]);
      const double seen = std::abs(line.q[joint]) / rigid;
      const double error = bringup::kNormal95 * lines.noise[i][joint] / rigid;
      // Points that are hidden by noise are omitted.
      if (!(error < 0.5 * seen)) continue;
      text +=
          fmt::format("{:.6g} {:.6g} {:.6g}\n", line.omega / (2 * std::numbers::pi), seen, error);
    }
    text += "\n\n";
  }
  return text;
}

std::string resonance_table(const bringup::Identified& identified, double dt) {
  const bringup::CableFit& lines = identified.lines;
  const bringup::TwoMassTheta stiff = stiff_of(lines);
  std::string text = "# frequency Hz, fitted motion relative to stiff cables\n";
  for (int joint = 0; joint < 3; ++joint) {
    for (int k = 0; k <= kFrequencies; ++k) {
      const double share = static_cast<double>(k) / kFrequencies;
      bringup::SpectralLine line;
      const double hz =
          bringup::LineForces::kLowest *
          math::pow(bringup::LineForces::kHighest / bringup::LineForces::kLowest, share);
      line.omega = 2 * std::numbers::pi * hz;
      line.tau[joint] = 1;
      const double rigid =
          std::abs(bringup::two_mass_answer(stiff, line, lines.JTJ, dt, false)[joint]);
      const double found = lines.stretches
                               ? std::abs(bringup::two_mass_answer(lines.elastic.theta, line,
                                                                   lines.JTJ, dt, true)[joint])
                               : rigid;
      text += fmt::format("{:.6g} {:.6g}\n", hz, found / rigid);
    }
    text += "\n\n";
  }
  return text;
}

}  // namespace thimble::identified
