#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Stage of the gate that limits the energy that an arm gives to the hand to the energy that it
/// took.
enum class EnergyStage : std::uint8_t {
  kNone,  ///< No stage; costs nothing in a tick.
  /// Passivity observer and controller: accounts for energy, and damps if too much was given.
  kPassivity,
  kBounding,  ///< Bounds each force so that the friction of the arm dissipates any excess.
};

/// Settings of the energy stage of a gate.
struct EnergyGuardSettings {
  EnergyStage stage = EnergyStage::kNone;  ///< Energy stage.
  /// Smallest apparent mass at the tip, kg. Passivity: must be > 0.
  double mass = 0;
  /// Energy that may be given before the controller acts, J. Must be >= 0.
  double allowance = 0;
  /// Largest credit of energy, J; passivity: must be > 0. Without this limit, an hour of rubbing
  /// would pay for a minute of instability.
  double reservoir = 0;
  /// Debt at which the controller applies its maximum damping, J. Below it, damping is proportional
  /// to the debt; above it, the force fades and is zero at twice the onset. 0: immediate full
  /// damping, in jolts (2 N on 1 N were seen), and no fading.
  double onset = 0;
  /// Apparent speed of a tip at rest when one encoder count flickers, m/s. Only the part of a speed
  /// above it is damped. 0: everything is damped, and each count causes a jolt of damping times
  /// step over period (0.6 N were seen).
  double speed_floor = 0;
  /// Guaranteed damping of arm and hand, N s/m. It pays for the energy that a held and delayed
  /// force gives beyond the potential of which it is the gradient. Used only in ticks in which a
  /// storage is named or a program requests a force.
  double dissipation = 0;
  /// Slope c1 of the bound, N/m. Bounding: must be > 0; 2 b / T makes it passive.
  double slope = 0;
  /// Delay from sampling to force in addition to the hold, ticks, 0 to kDelayMax.
  int delay_ticks = 0;
  static constexpr int kDelayMax = 15;  ///< Largest delay that the stage can handle, ticks.
  /// Former name of kDelayMax.
  [[deprecated("renamed to kDelayMax")]] static constexpr int kDelayMost = kDelayMax;
};

/// Energy flow at the motors since the previous tick, computed by the device.
struct EnergyFlow {
  /// Work done on the hand by the forces actually sent, after all clamps and rounding, J.
  double work = 0;
  Eigen::Vector3d move_W{0, 0, 0};    ///< Displacement of the tip, m.
  Eigen::Vector3d f_sent_W{0, 0, 0};  ///< Force sent in the previous tick, N.
  /// Energy now stored in compressed surface springs, J; it came from the hand and is to be
  /// returned. It only shifts the limit of the credit, so a wrong value creates no energy.
  double held = 0;
  /// Change of the energy in the storages of the force law (ForceCommand::stored) since the
  /// previous tick, J.
  double stored_change = 0;
  /// Energy dissipated by the damping of arm and hand, J (EnergyGuardSettings::dissipation).
  double dissipated = 0;
  /// Part of the requested force that a program requested (ForceCommand), N. Its work is not part
  /// of `work`.
  Eigen::Vector3d f_program_W{0, 0, 0};
};

/// Accounts for the energy that the arm took from the hand and computes the damping that recovers
/// the excess given [PHYSICS 1.6, Hannaford and Ryu; derived again there].
///
/// In three dimensions power is f . v. There is one account for all directions, because the sum
/// hurts the hand. Damping acts against the velocity, where a given force takes the most energy.
/// All functions are Real-time: safe.
class THIMBLE_EXPORT PassivityObserver {
 public:
  explicit PassivityObserver(const EnergyGuardSettings& settings) noexcept : settings_(settings) {}

  /// Resets the account.
  void restart() noexcept {
    energy_ = 0;
    share_ = 1;
  }

  /// Subtracts the work done on the hand, J. The credit is limited to the reservoir plus the energy
  /// `held` in springs, J.
  void book(double work, double held = 0) noexcept;
  /// Accounts for one tick of a force law with storages. A decrease of the stored energy pays for
  /// work on the hand. An increase is paid only from the energy that the hand gave in this tick. A
  /// storage may gain energy otherwise (from another hand, or from a force that the soft start
  /// holds back); that energy is not charged to this account.
  ///
  /// For any two ticks a < b, with the stored energy S, the dissipated energy D, and the sum P of
  /// increases that no hand paid:
  ///
  ///     work(a, b) <= S_a - S_b + P(a, b) + D(a, b) + (E_a - E_b),
  ///
  /// where E_a is at most the reservoir plus the energy held in springs, and E_b is at least minus
  /// (allowance + 2 onset). At that point no force of the law is left that could give more, except
  /// during the tick and the delay until then.
  void book(const EnergyFlow& flow) noexcept;

  /// Returns the damping force for a tip velocity (m/s): -alpha v, N. alpha is the smallest value
  /// that pays the debt within a tick of `dt` (s), limited to m / (T (1 + 2 delay)). A damper on a
  /// mass oscillates beyond m / T, and earlier with a delay. Up to the debt `onset` the limit rises
  /// in proportion. The part of v below the speed floor is not damped.
  Eigen::Vector3d damping(const Eigen::Vector3d& v_WT, double dt) const noexcept;

  /// Returns the fraction of a force that is allowed after `dt` (s). It is 1 up to a debt of
  /// `onset`, and falls to 0 at twice that. It falls when the debt grows, but does not rise when
  /// the debt shrinks. Otherwise the force would act as a spring of F^2 / onset, 8 N/mm for 4 N,
  /// with which every arm is unstable (it oscillated by 0.1 mm at 60 Hz). The fraction recovers
  /// over kReturn once the debt is below half the onset. Damping reduces a debt but never quite to
  /// zero, and a force that is off pays nothing.
  double share(double dt) noexcept;
  /// Time from zero to full force, s [chosen: does not startle the hand].
  static constexpr double kReturn = 2;

  /// Returns the balance of the account, J; negative if the arm gave more than it took.
  double energy() const noexcept { return energy_; }

 private:
  EnergyGuardSettings settings_;
  double energy_ = 0;  // J
  double share_ = 1;   // Allowed fraction of the force.
};

/// Returns the largest allowed magnitude of a force: |f_last - c1 move|. The storage |f|^2 / (2 c1)
/// and the friction of the arm then pay for all energy given [PHYSICS 1.6, Kim and Ryu; the slope
/// form in 3-D].
///
/// Derivation: a held force f over a displacement s takes -f . s from the hand, and viscous
/// friction b takes at least b |s|^2 / T more. The sum covers the change of |f|^2 / (2 c1) if
/// |f'|^2 <= |f|^2 - 2 c1 f.s + 2 c1 b |s|^2 / T, which is |f - c1 s|^2 when c1 = 2 b / T. A
/// smaller force is always allowed. Real-time: safe.
THIMBLE_EXPORT double bounded_force(const EnergyFlow& flow, double slope) noexcept;

}  // namespace thimble::driver
