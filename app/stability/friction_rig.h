#pragma once

#include <cstdint>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::stability {

/// Hand, arm, wire and surface for the trial of a friction. The defaults are the PHANTOM-like set
/// with a hand in pinch grip at 1 kHz [PHYSICS 0].
struct FrictionRigSettings {
  double encoder_step = 3e-5;  ///< At the tip along x, m; 0: ideal encoders.
  std::int64_t delay_ns = 0;   ///< Delay from the host's write to the motors.
  std::int64_t period_ns = 1'000'000;
  double arm_mass = 0.075;      ///< kg
  double arm_viscous = 0.005;   ///< N s/m
  double arm_coulomb = 0.04;    ///< N
  double hand_mass = 0.025;     ///< kg
  double hand_stiffness = 300;  ///< N/m
  double hand_damping = 3;      ///< N s/m
  double tremor_amplitude = 0;  ///< m
  double load = 1;              ///< Constant force of the surface, N.
  double depth = 0.001;         ///< m
};

/// One corner of the hand's path along the surface.
struct RigPoint {
  double time = 0;  ///< s
  double x = 0;     ///< Wanted position of the hand, m, within 0.03 of the middle.
};

/// Motion and force along x, one entry per tick.
struct RigRun {
  double period = 0.001;         ///< s
  std::vector<double> x;         ///< True position of the tip, m.
  std::vector<double> x_read;    ///< Position seen by the driver, m.
  std::vector<double> x_wanted;  ///< Position wanted by the hand, m.
  std::vector<double> force;     ///< Force sent along x, N.
  bool fault = false;            ///< A fault of the device ended the loop early.
};

/// The force law of the rig: a surface that presses evenly with `load` (N), which is not sent, and
/// the friction on it. Keeps the friction only by reference. Real-time: safe.
class EvenSurface {
 public:
  EvenSurface(render::AnyStage& friction, double load, double depth)
      : friction_(friction), load_(load), depth_(depth) {}

  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept;

 private:
  render::AnyStage& friction_;
  double load_, depth_;
};

/// Rubs along a straight line through the whole loop. The simulated vintage arm is at its home
/// pose, where only one joint moves x; its encoder is quantized to the given step. Wire, driver,
/// velocity estimate, safety gate and servo loop are those of any session, in virtual time. The
/// surface presses with a constant force, which is not sent, as if the hand held it exactly, so
/// that only friction is measured. Begins at rest; forces open softly within the first 0.3 s.
/// Precondition: the settings are in the simulator's range (not checked; otherwise Result::value
/// throws). Real-time: never from the servo thread.
RigRun rub(render::AnyStage& friction, const std::vector<RigPoint>& way, double duration,
           const FrictionRigSettings& settings);

/// Returns the context of an effect in the rig. Real-time: never from the servo thread.
render::EffectContext effect_context_of(const FrictionRigSettings& settings);

}  // namespace thimble::stability
