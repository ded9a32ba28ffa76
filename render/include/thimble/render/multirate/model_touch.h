#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <memory>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/multirate/local_model.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Settings of the tracking of models.
struct ModelTouchSettings {
  /// Largest stiffness for which arm, loop and hand are stable, N/m: (b + B) / L with the latency L
  /// of the *servo* [PHYSICS 1.1]. A stiffer model is rendered with this stiffness and the same
  /// surface.
  double stiffness_max = 0;
  /// Largest change of the force per tick while it approaches a new model, as a fraction of the
  /// force. Half of the just noticeable difference is 3.5 % [PHYSICS 6], and the tip moves as well.
  double jump = 0.02;
  double min_jump = 0.003;  ///< Smallest value of that change, for small forces, N.
  /// Age from which a model is reported as held, s: three periods of 60 Hz.
  double late = 0.05;
  double hold = 0.25;  ///< Age up to which a model is rendered unchanged, s.
  double fade = 0.25;  ///< Time in which the force then fades to zero, s.
  /// Power that models may give during contact in addition to the energy input of the hand, W. It
  /// allows the object to move by itself. A pinch grip absorbs ten times the default at 60 mm/s.
  double power = 0.001;
  /// Largest reserve of energy that the hand has put in beyond what the model could give back, J
  /// [chosen: half of what the gate allows, PHYSICS 7 case 11].
  double reserve = 0.001;
};

/// Age of the rendered model.
enum class ModelAge : std::uint8_t {
  kNothing,   ///< No model has been published.
  kFollowed,  ///< The newest model is followed.
  kHeld,      ///< The simulation is late; its last model is rendered unchanged.
  kFading,    ///< The simulation is silent; the force fades.
  kSilent,    ///< The force is zero until the simulation publishes again.
};

/// Returns the name of an age in reports ("fading"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(ModelAge age) noexcept;

/// Counters of models.
struct ModelCounters {
  std::uint64_t taken = 0;  ///< Number of models followed.
  /// Number of models with a flaw, or with a time in the future or too far in the past.
  std::uint64_t refused = 0;
  std::uint64_t softened = 0;  ///< Number of models stiffer than `stiffness_max`.
  /// Number of ticks in which the energy account prevented a rise of the force.
  std::uint64_t bounded = 0;
  std::uint64_t faded = 0;  ///< Number of times that the simulation became silent.
};

/// Renders a simulation of about 10 to 100 Hz at the servo's rate. It evaluates the newest local
/// model in every tick, moves to the next one without a jump, and gives no energy that the hand did
/// not put in. The latency of the slow loop affects only the age of the plane, not that of the
/// force. A held force is stable for K (T/2 + delay) <= b + B with the slow T, a held model with
/// the T of the servo.
///
/// The rendered state is itself a model: force F at the tip and stiffness K, updated with the
/// displacement of the tip (F -= K displacement). It could give back at most A = F K^-1 F / 2. An
/// energy account holds the work that the hand has done on it since contact. In each tick first the
/// stiffness, then the force approach the newest model as far as the jump and the account (A <=
/// account) allow. A is convex in both together, so the farthest point is unique. A stiffer K is
/// taken at once, a softer one when its energy is paid for. A force falls freely and rises as far
/// as it is paid for. A surface that appears behind a tip starts at the tip, so the tip is never
/// thrown out.
///
/// `age()` reports silence. Real-time: safe, except the constructor.
class THIMBLE_EXPORT ModelTouch final : public ObjectTouch {
 public:
  /// Creates a model touch. Fails if a setting is not finite, or not above 0 where required. Keeps
  /// a reference to the slot. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<ModelTouch>> make(const ModelSlot& slot,
                                                          const ModelTouchSettings& settings);

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override;
  /// Returns false: only the surface near the tip is known.
  bool inside(const Eigen::Vector3d&) const noexcept override { return false; }
  bool is_static() const noexcept override { return false; }
  bool stands_still() const noexcept override { return is_static(); }  // deprecated

  /// Returns the age of the rendered model; from any thread.
  ModelAge age() const noexcept { return age_.load(std::memory_order_relaxed); }
  /// Returns the counters; on the servo's thread, or after it has ended.
  const ModelCounters& counters() const noexcept { return counters_; }
  /// Returns the energy account, J; threads as for `counters`.
  double energy() const noexcept { return energy_; }

 private:
  ModelTouch(const ModelSlot& slot, const ModelTouchSettings& settings)
      : slot_(slot), settings_(settings) {}

  void take_news(std::int64_t now_ns) noexcept;
  void carry(const Eigen::Vector3d& way) noexcept;
  void fade_to(double share) noexcept;
  void begin_free(const Eigen::Vector3d& p_WT) noexcept;
  void soften(const Eigen::Vector3d& goal, double most) noexcept;
  void approach(const Eigen::Vector3d& p_WT) noexcept;
  void keep_account() noexcept;
  driver::ForceCommand command(const driver::DeviceState& state) const noexcept;

  const ModelSlot& slot_;
  ModelTouchSettings settings_;
  ModelCounters counters_;
  std::atomic<ModelAge> age_{ModelAge::kNothing};
  std::uint64_t seen_ = 0;
  LocalModel newest_;
  bool known_ = false;             // True if there is a newest model.
  double share_ = 1;               // Fraction of the model that remains while it fades.
  Eigen::Vector3d p_WT_{0, 0, 0};  // In the previous tick, m.
  bool begun_ = false;
  // Rendered model: the force of the springs at the tip, also if it would pull and is not rendered.
  Eigen::Vector3d force_{0, 0, 0};
  Eigen::Matrix3d stiffness_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d n_W_{0, 0, 1};
  double damping_ = 0;
  double energy_ = 0;      // J
  bool touching_ = false;  // True if force_ pushes.
};

}  // namespace thimble::render
