#pragma once

#include <cstdint>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::stability {

/// Hand, arm, wire and surface for friction tests. The defaults are a PHANTOM-like arm with a hand
/// in pinch grip at 1 kHz [PHYSICS 0].
struct FrictionRigSettings {
  double encoder_step = 3e-5;  ///< At the tip along x, m; 0: ideal encoders.
  std::int64_t delay_ns = 0;   ///< From the host's write to the motors.
  std::int64_t period_ns = 1'000'000;
  double arm_mass = 0.075;      ///< kg
  double arm_viscous = 0.005;   ///< N s/m
  double arm_coulomb = 0.04;    ///< N
  double hand_mass = 0.025;     ///< kg
  double hand_stiffness = 300;  ///< N/m
  double hand_damping = 3;      ///< N s/m
  double tremor_amplitude = 0;  ///< m
  double load = 1;              ///< Normal force of the surface, N, constant.
  double depth = 0.001;         ///< m
};

/// One corner of the hand's path along the surface.
struct RigPoint {
  double time = 0;  ///< s
  double x = 0;     ///< Target of the hand, m, within 0.03 of the middle.
};

/// Signals along x, one entry per tick.
struct RigRun {
  double period = 0.001;         ///< s
  std::vector<double> x;         ///< True position of the tip, m.
  std::vector<double> x_read;    ///< Position in the driver, m.
  std::vector<double> x_wanted;  ///< Target of the hand, m.
  std::vector<double> force;     ///< Force sent along x, N.
  bool fault = false;            ///< A fault of the device ended the loop early.
};

/// The force law of the rig: friction on a surface with constant normal force `load` (N), which is
/// not sent. Keeps only a reference to the friction. Real-time: safe.
class EvenSurface {
 public:
  EvenSurface(render::AnyStage& friction, double load, double depth)
      : friction_(friction), load_(load), depth_(depth) {}

  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept;

 private:
  render::AnyStage& friction_;
  double load_, depth_;
};

/// Strokes along a straight line, through all layers from the wire up, in virtual time. The
/// simulated vintage arm is at its home pose, where one joint moves x; its encoder has the given
/// step. Wire, driver, velocity estimate, safety gate and servo loop are those of any session. The
/// surface presses with a constant force, which is not sent, as if the hand balanced it exactly, so
/// that only friction acts. Begins at rest; forces rise softly within the first 0.3 s.
/// Precondition: the settings are in the simulator's range (otherwise Result::value throws).
/// Real-time: never from the servo thread.
RigRun rub(render::AnyStage& friction, const std::vector<RigPoint>& way, double duration,
           const FrictionRigSettings& settings);

/// Returns the properties of the rig that effects use. Real-time: never from the servo thread.
render::EffectContext effect_context_of(const FrictionRigSettings& settings);

}  // namespace thimble::stability
