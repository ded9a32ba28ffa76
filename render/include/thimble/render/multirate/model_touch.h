#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <memory>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/multirate/local_model.h"
#include "thimble/render/multirate/model_slot.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Sets how models are followed.
struct ModelTouchSettings {
  /// Stiffest that arm, loop and hand carry, N/m: (b + B) / L with the latency L of the *servo*
  /// [PHYSICS 1.1]. A stiffer model is felt as one of this stiffness with the same surface.
  double stiffness_max = 0;
  /// Share of the force by which it may change in a tick on the way to a new model; half of what a
  /// hand can tell is 3.5 % [PHYSICS 6], and the tip moves as well.
  double jump = 0.02;
  double jump_least = 0.003;  ///< The same where there is hardly a force, N.
  double late = 0.05;  ///< Age from which a model is told as held, s: three periods of 60 Hz.
  double hold = 0.25;  ///< Age up to which a model is felt unchanged, s.
  double fade = 0.25;  ///< Time in which it then fades to nothing, s.
  /// Power that models may give while the tip touches beyond what the hand has put in, W. What the
  /// object moves by itself needs it. A pinch grip takes up ten times the default at 60 mm/s.
  double power = 0.001;
  /// What the hand has put in beyond what the model could give back is kept up to here, J [chosen:
  /// half of what the gate lets go, PHYSICS 7 case 11].
  double reserve = 0.001;
};

/// How old what is felt is.
enum class ModelAge : std::uint8_t {
  kNothing,   ///< No model was ever published.
  kFollowed,  ///< The newest model is followed.
  kHeld,      ///< The slow side is late; its last model is felt unchanged.
  kFading,    ///< It is silent; what is felt fades.
  kSilent,    ///< Nothing is felt until it publishes again.
};

/// Returns the name of an age as it stands in reports ("fading"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(ModelAge age) noexcept;

/// Counts what models went through.
struct ModelCounters {
  std::uint64_t taken = 0;     ///< Models that were followed.
  std::uint64_t refused = 0;   ///< With a flaw, or a time that has not come or is long over.
  std::uint64_t softened = 0;  ///< Stiffer than `stiffness_max`.
  std::uint64_t bounded = 0;   ///< Ticks in which the account kept the force from rising.
  std::uint64_t faded = 0;     ///< Times the slow side fell silent.
};

/// Feels a simulation of some 10 to 100 Hz at the servo's rate: evaluates the newest local model in
/// every tick, moves to the next one without a jump, and gives no energy that the hand did not put
/// in. What stays of the slow loop's latency is the age of the plane, not of the force: a held
/// force obeys K (T/2 + delay) <= b + B with the slow T, a held model with the servo's.
///
/// What is felt is itself one model: force F at the tip and stiffness K, moved along with the tip
/// (F -= K way). It could give back at most A = F K^-1 F / 2. Beside it stands an account of the
/// work that the hand has done on it since it touched. In each tick stiffness, then force, go as
/// far towards the newest model as the jump and the account (A <= account) allow. A is convex in
/// both together, so there is one farthest place. So a stiffer K is taken at once, a softer
/// one when it is paid for; a force falls freely and rises as far as it is paid for. What comes up
/// behind a tip that is inside begins where the tip is: nobody is thrown out.
///
/// Silence is told by `age()`. Real-time: safe, but for the constructor.
class THIMBLE_EXPORT ModelTouch final : public ObjectTouch {
 public:
  /// Makes one. Fails if a setting is not finite, or not above 0 where it must be. Keeps a
  /// reference to the slot. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<ModelTouch>> make(const ModelSlot& slot,
                                                          const ModelTouchSettings& settings);

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override;
  /// Knows only what is near the tip: false.
  bool inside(const Eigen::Vector3d&) const noexcept override { return false; }
  bool stands_still() const noexcept override { return false; }

  /// Returns how old what is felt is; from any thread.
  ModelAge age() const noexcept { return age_.load(std::memory_order_relaxed); }
  /// Returns the counters; on the servo's thread, or when it has ended.
  const ModelCounters& counters() const noexcept { return counters_; }
  /// Returns the account, J; as `counters`.
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
  bool known_ = false;             // there is a newest model
  double share_ = 1;               // of it that is left by fading
  Eigen::Vector3d p_WT_{0, 0, 0};  // at the tick before, m
  bool begun_ = false;
  // What is felt: the force of the springs at the tip, also where it would pull and nothing is
  // felt.
  Eigen::Vector3d force_{0, 0, 0};
  Eigen::Matrix3d stiffness_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d n_W_{0, 0, 1};
  double damping_ = 0;
  double energy_ = 0;      // J
  bool touching_ = false;  // force_ pushes
};

}  // namespace thimble::render
