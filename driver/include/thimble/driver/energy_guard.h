#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Names the stage of the gate that keeps the arm from giving more energy than it took.
enum class EnergyStage : std::uint8_t {
  kNone,       ///< No such stage; a tick executes nothing for it.
  kPassivity,  ///< Observer and controller: books energy, damps when too much went out.
  kBounding,   ///< Bounds each force so that the arm's own friction pays for every leak.
};

/// Sets the energy stage of a gate.
struct EnergyGuardSettings {
  EnergyStage stage = EnergyStage::kNone;  ///< Which one, if any.
  double mass = 0;       ///< Least apparent mass at the tip, kg. Passivity: must be > 0.
  double allowance = 0;  ///< Energy that may go out before the controller acts, J. Must be >= 0.
  /// Most energy that is kept to one's credit, J; passivity: must be > 0. Without an end to it an
  /// hour of rubbing would pay for a minute of trouble.
  double reservoir = 0;
  /// Debt at which the controller damps as hard as it may, J; in proportion before; beyond, the
  /// force fades and is gone at twice that. 0: at once, in jolts (2 N on 1 N were seen), no fading.
  double onset = 0;
  /// Speed that a tip at rest may seem to have when one count of its encoders flickers, m/s; slower
  /// is not damped, and what is above it only by the rest. 0: everything is damped, and each count
  /// is a jolt of damping times step over period (0.6 N were seen).
  double speed_floor = 0;
  /// Damping that arm and hand have for sure, N s/m. It pays for what a force that is held for a
  /// tick, and late, gives beyond the potential that it is the gradient of. Counts only in ticks in
  /// which a storage is named or a program asks for a force.
  double dissipation = 0;
  double slope = 0;     ///< c1 of the bound, N/m. Bounding: must be > 0; 2 b / T makes it passive.
  int delay_ticks = 0;  ///< Ticks from sampling to force beyond the hold, 0 to kDelayMost.
  static constexpr int kDelayMost = 15;  ///< Most ticks of delay that it can count.
};

/// What happened at the motors since the tick before; the device books it.
struct EnergyFlow {
  double work = 0;  ///< Done on the hand by what was truly sent, after all clamps and rounding, J.
  Eigen::Vector3d move_W{0, 0, 0};    ///< Way of the tip, m.
  Eigen::Vector3d f_sent_W{0, 0, 0};  ///< What was sent in the tick before, N.
  /// What the springs that are pressed hold now, J: the hand's, and to be given back. It only moves
  /// the end of the credit; a wrong one gives nobody energy that he did not bring.
  double held = 0;
  /// Change of the energy in the law's storages (ForceCommand::stored) since the tick before, J.
  double stored_change = 0;
  /// What arm and hand have taken from the motion by their own damping, J: settings' dissipation.
  double dissipated = 0;
  /// Part of the force that is asked for now that a program asked for (ForceCommand), N; its work
  /// is not part of `work`.
  Eigen::Vector3d f_program_W{0, 0, 0};
};

/// Books the energy that the arm took from the hand and finds the damping that gets back what went
/// out too much [PHYSICS 1.6, Hannaford and Ryu; derived again there].
///
/// In three dimensions power is f . v: one account for all directions, since a hand is hurt by the
/// sum. Damping acts against the velocity, where a given force takes most energy.
/// All functions are Real-time: safe.
class THIMBLE_EXPORT PassivityObserver {
 public:
  explicit PassivityObserver(const EnergyGuardSettings& settings) noexcept : settings_(settings) {}

  /// Forgets the past.
  void restart() noexcept {
    energy_ = 0;
    share_ = 1;
  }

  /// Books `work` done on the hand, J. Credit ends at the reservoir and what springs `held` beyond.
  void book(double work, double held = 0) noexcept;
  /// Books a tick of a law that has storages. A fall of the stored energy pays for work on the
  /// hand; a rise is paid from what the hand gave in this tick, and from nothing else: what a
  /// storage gets otherwise (another hand, a force that the soft start holds back) is its own.
  ///
  /// So for any two ticks a < b, with S the stored energy, D what was dissipated, and P the rises
  /// that no hand paid:
  ///
  ///     work(a, b) <= S_a - S_b + P(a, b) + D(a, b) + (E_a - E_b),
  ///
  /// where E_a is at most the reservoir (and what springs hold), and E_b at least minus
  /// (allowance + 2 onset), where no force of the law is left that could give more, but for the
  /// tick and the delay until then.
  void book(const EnergyFlow& flow) noexcept;

  /// Finds the damping for the tip's velocity (m/s): -alpha v, N, with alpha the least that pays
  /// the debt within a tick of `dt` (s), and never above m / (T (1 + 2 delay)): a damper on a mass
  /// oscillates by itself beyond m / T, earlier when late. Up to the debt `onset` that end rises in
  /// proportion. What of v is below the speed floor is not damped.
  Eigen::Vector3d damping(const Eigen::Vector3d& v_WT, double dt) const noexcept;

  /// Finds the share of a force that may stand, after `dt` (s): 1, and less from a debt beyond the
  /// onset on, 0 at twice that. It falls with the debt and does not rise with it: a force that
  /// followed its debt both ways would be a spring of F^2 / onset, 8 N/mm for 4 N, which no arm
  /// carries (it oscillated by 0.1 mm at 60 Hz). It comes back, over kReturn, from half the onset
  /// on: damping pays a debt, and never quite to its end, while a force that is gone pays nothing.
  double share(double dt) noexcept;
  static constexpr double kReturn = 2;  ///< Time from none to all, s [chosen: no hand is startled].

  /// Returns the energy on the account, J; below 0 the arm gave more than it took.
  double energy() const noexcept { return energy_; }

 private:
  EnergyGuardSettings settings_;
  double energy_ = 0;  // J
  double share_ = 1;   // of the force
};

/// Finds how long a force may be so that storage |f|^2 / (2 c1) and the arm's friction pay for all
/// that is given: |f_last - c1 move| [PHYSICS 1.6, Kim and Ryu; the slope form in 3-D].
///
/// Why: a held force f over a way s takes -f . s from the hand, and viscous friction b takes at
/// least b |s|^2 / T more. The sum covers the change of |f|^2 / (2 c1) if |f'|^2 <= |f|^2 - 2 c1
/// f.s
/// + 2 c1 b |s|^2 / T, which is |f - c1 s|^2 when c1 = 2 b / T. Falling below is always allowed.
/// Real-time: safe.
THIMBLE_EXPORT double bounded_force(const EnergyFlow& flow, double slope) noexcept;

}  // namespace thimble::driver
