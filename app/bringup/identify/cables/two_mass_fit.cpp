#include "bringup/identify/cables/two_mass_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bringup/identify/cables/two_mass_search.h"
#include "bringup/identify/line_forces.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

constexpr int kRoundsMax = 100;
constexpr double kFitsWell = 3;  // chi^2 per degree of freedom

// Returns the frequency of a mass on a spring, Hz. `compliance`: of the spring, m/N.
double resonance_of(double compliance, double inverse_mass) {
  return std::sqrt(inverse_mass / compliance) / kTurn;
}

/// Searches near a bad fit for a better one, with single cables several times softer or stiffer:
/// starts with all joints alike lie in other local minima.
void look_about(const TwoMassSearch& search, double enough, TwoMassTheta& x, double& lowest_sum) {
  constexpr int kSweeps = 2, kSomeRounds = 30;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int joint = 0; joint < 3; ++joint) {
      for (const double softer : {0.1, 0.3, 3.0, 10.0}) {
        if (lowest_sum < enough) return;
        TwoMassTheta other = x;
        other[TwoMass::kCompliance + joint] += math::log(softer);
        other[TwoMass::kFade + joint] = math::log(1e-3);
        const double sum = search.minimise(other, true, kSomeRounds);
        if (sum < lowest_sum) lowest_sum = sum, x = other;
      }
    }
  }
}

/// Searches for cables from many starts, for each of several delays, because lines have many local
/// minima. If a rigid arm already fits, few starts suffice.
TwoMassTheta first_guess(const TwoMassSearch& search, const LineSpectrum& spectrum,
                         const TwoMassTheta& rigid, const MassNormalisedFit& slow, double stiff) {
  constexpr double kSoftest = 8, kStiffest = 400;  // Hz
  constexpr double kRotor = 0.3;                   // of the link's inertia
  constexpr int kFirstRounds = 5;
  const bool fits = stiff < kFitsWell * static_cast<double>(search.rows());
  const int stiffnesses = fits ? 3 : 8, delays = fits ? 1 : 9;
  struct Start {
    double sum;
    TwoMassTheta x;
  };
  std::vector<Start> starts;
  for (int i = 0; i < stiffnesses; ++i) {
    const double share = fits ? 1 - 0.15 * i : static_cast<double>(i) / (stiffnesses - 1);
    const double omega = kTurn * kSoftest * math::pow(kStiffest / kSoftest, share);
    for (int late = 0; late < delays; ++late) {
      TwoMassTheta x = rigid;
      if (!fits) x[TwoMass::kDelay] = 0.0007 * late;
      for (int joint = 0; joint < 3; ++joint) {
        const double inertia = spectrum.JTJ(joint, joint);
        x[TwoMass::kGain + joint] = slow.theta[joint] * (1 + kRotor);
        x[TwoMass::kInertia + joint] = kRotor * inertia;
        x[TwoMass::kRotorViscous + joint] = 0.1 * inertia;
        x[TwoMass::kCompliance + joint] = 1 / (omega * omega * inertia);
        x[TwoMass::kFade + joint] = 0.1 / omega;
      }
      x = into_search(x);
      const double sum = search.minimise(x, true, kFirstRounds);
      starts.push_back({sum, x});
    }
  }
  std::sort(starts.begin(), starts.end(),
            [](const Start& a, const Start& b) { return a.sum < b.sum; });
  starts.resize(std::min<std::size_t>(starts.size(), 3));
  for (Start& start : starts) start.sum = search.minimise(start.x, true, kRoundsMax);
  return std::min_element(starts.begin(), starts.end(),
                          [](const Start& a, const Start& b) { return a.sum < b.sum; })
      ->x;
}

void put_elastic(CableFit& found, const TwoMassSearch& search, const TwoMassTheta& x,
                 double lowest_sum) {
  TwoMass& elastic = found.elastic;
  elastic.theta = from_search(x);
  elastic.misfit = lowest_sum / static_cast<double>(search.rows() - TwoMass::kCount);
  elastic.covariance = std::max(1.0, elastic.misfit) * search.covariance(x, true);
  // The logarithms' deviations are relative.
  for (int k = 0; k < TwoMass::kCount; ++k) {
    if (!is_log(k)) continue;
    elastic.covariance.row(k) *= elastic.theta[k];
    elastic.covariance.col(k) *= elastic.theta[k];
  }
}

}  // namespace

double TwoMass::antiresonance(int joint, const Eigen::Matrix3d& JTJ) const {
  return resonance_of(theta[kCompliance + joint], 1 / JTJ(joint, joint));
}

double TwoMass::resonance(int joint, const Eigen::Matrix3d& JTJ) const {
  return resonance_of(theta[kCompliance + joint],
                      1 / JTJ(joint, joint) + 1 / theta[kInertia + joint]);
}

void refine_cables(CableFit& found, const LineSpectrum& spectrum, const SlowPart& slow, double dt) {
  TwoMassSearch search(spectrum, dt);
  search.measure_noise(found.elastic.theta, true);
  search.take_slow_part(slow);
  TwoMassTheta start = found.elastic.theta;
  start.segment<3>(TwoMass::kGain) = slow.gain;
  start.segment<3>(TwoMass::kInertia) = slow.gain.cwiseProduct(slow.ratio);
  start[TwoMass::kDelay] = slow.delay;
  // From the result of the lines without the slow part, and from the slow part.
  TwoMassTheta elastic = into_search(found.elastic.theta), other = into_search(start);
  double lowest_sum = search.minimise(elastic, true, kRoundsMax);
  const double sum = search.minimise(other, true, kRoundsMax);
  if (sum < lowest_sum) lowest_sum = sum, elastic = other;
  put_elastic(found, search, elastic, lowest_sum);
}

CableFit fit_cables(const LineSpectrum& spectrum, const MassNormalisedFit& slow, double dt) {
  CableFit found;
  found.JTJ = spectrum.JTJ;
  TwoMassSearch search(spectrum, dt);
  TwoMassTheta rigid = TwoMassTheta::Zero();
  rigid.head<3>() = slow.theta.head<3>();
  rigid[TwoMass::kViscous] = std::max(0.0, slow.theta[MassNormalisedFit::kViscous]);
  rigid[TwoMass::kDelay] = slow.delay.value;
  search.measure_noise(rigid, false);
  rigid = into_search(rigid);
  double stiff = search.minimise(rigid, false, kRoundsMax), lowest_sum = HUGE_VAL;
  TwoMassTheta elastic = first_guess(search, spectrum, from_search(rigid), slow, stiff);
  // The noise is the residual of the better fit between the lines.
  for (int round = 0; round < 2; ++round) {
    stiff = search.minimise(rigid, false, kRoundsMax);
    lowest_sum = search.minimise(elastic, true, kRoundsMax);
    if (round == 0) {
      search.measure_noise(from_search(lowest_sum < stiff ? elastic : rigid), lowest_sum < stiff);
    }
  }
  const auto count = static_cast<double>(search.rows());
  if (lowest_sum < stiff && lowest_sum > kFitsWell * count) {
    look_about(search, kFitsWell * count, elastic, lowest_sum);
    search.measure_noise(from_search(elastic), true);
    stiff = search.minimise(rigid, false, kRoundsMax);
    lowest_sum = search.minimise(elastic, true, kRoundsMax);
  }
  found.better = count * math::log(stiff / lowest_sum) - 6 * math::log(count);
  found.rigid.theta = from_search(rigid);
  found.rigid.theta.tail<6>().setZero();
  found.rigid.misfit = stiff / static_cast<double>(search.rows() - TwoMass::kRigidCount);
  put_elastic(found, search, elastic, lowest_sum);
  constexpr double kBetter = 20;
  double lowest = HUGE_VAL;  // Hz, oscillation of a link on its cable
  for (int i = 0; i < 3; ++i) {
    const double compliance = std::max(0.0, found.elastic.theta[TwoMass::kCompliance + i]);
    lowest = std::min(lowest, resonance_of(compliance, 1 / spectrum.JTJ(i, i)));
  }
  // Above all lines the cause is not a cable but the lag of an amplifier.
  found.stretches = found.better > kBetter && lowest < LineForces::kHighest;
  Eigen::Vector3d compliance, error;
  search.estimate_compliance(found.rigid.theta, compliance, error);
  for (int i = 0; i < 3; ++i) {
    const double max_compliance = std::max(0.0, compliance[i]) + kNormal95 * error[i];
    found.unseen_from[i] = resonance_of(max_compliance, 1 / spectrum.JTJ(i, i));
  }
  found.noise = search.sigma();
  return found;
}

}  // namespace thimble::bringup
