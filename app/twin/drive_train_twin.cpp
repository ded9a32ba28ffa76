#include "twin/drive_train_twin.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "math/elementary.h"
#include "plant/drive_train_plant.h"
#include "twin/twin_motors.h"

namespace thimble::twin {
namespace {

constexpr std::int64_t kSubStep_ns = 100'000;
constexpr double kLagsKept = 20;  // after which a current has decayed to 2e-9

/// Returns the model of an arm with this geometry.
template <class Geometry>
driver::JointModel<Geometry> model_of(const driver::ArmModel& model) {
  if constexpr (std::is_same_v<Geometry, device_sim::BoardGeometry>) {
    return device_sim::board_model(model);
  } else {
    return driver::model_as<Geometry>(model);
  }
}

/// An arm with a drive train: the encoders are on the motors, and the tip is behind elastic cables
/// or joints with friction.
template <class Geometry, class Tip>
class DriveTrainTwin final : public TwinMover {
 public:
  using Plant = device_sim::DriveTrainPlant<Geometry, Tip>;

  DriveTrainTwin(const TwinMotion& motion, const scene::ArmFile& file, Plant plant)
      : motion_(motion),
        delay_(file, motion.dt),
        geometry_(model_of<Geometry>(file.model).geometry),
        free_B_(driver::free_axes(file.motors())),
        train_(file.simulated.drive_train),
        wiring_(file.simulated.firmware.wiring),
        current_max_(file.simulated.motors.current_max),
        plant_(std::move(plant)) {}

  bool stretches() const noexcept override { return train_.compliant(); }

  void move(std::size_t stretch, std::size_t begin, const TwinStart& start,
            std::span<Eigen::Vector3d> seen) override {
    const std::vector<TwinSample>& samples = motion_.stretches[stretch];
    // The tip of an arm with one or two motors stays on its line or plane.
    plant_.put(state_at(samples, begin,
                        {start.p_BT.cwiseProduct(free_B_), start.v_BT.cwiseProduct(free_B_),
                         start.stretch, start.stretch_rate}));
    for (std::size_t j = 0; j < seen.size(); ++j) {
      if (j > 0) pass(samples, begin + j - 1);
      Eigen::Matrix3d J;
      geometry_.forward(plant_.q(), seen[j], J);
    }
  }

 private:
  /// Returns the currents sent to the motors `late` ticks before, A.
  Eigen::Vector3d sent(const std::vector<TwinSample>& samples, std::size_t k,
                       std::size_t late) const {
    return wiring_.motors(samples[k - late].amperes);
  }

  void pass(const std::vector<TwinSample>& samples, std::size_t k) {
    plant_.set_currents(sent(samples, k, delay_.whole + 1));
    plant_.step(plant_.p_BH(), delay_.part_ns);
    plant_.set_currents(sent(samples, k, delay_.whole));
    plant_.step(plant_.p_BH(), delay_.rest_ns);
  }

  /// Returns the actual currents at the beginning of tick `begin`, A.
  Eigen::Vector3d currents_at(const std::vector<TwinSample>& samples, std::size_t begin) const {
    const double lag = train_.current_lag;
    const Eigen::Vector3d limit = Eigen::Vector3d::Constant(current_max_);
    const auto asked = [&](std::size_t k, std::size_t late) -> Eigen::Vector3d {
      return sent(samples, k, late).cwiseMax(-limit).cwiseMin(limit);
    };
    if (!(lag > 0)) return asked(begin - 1, delay_.whole);
    const double part = math::exp(-1e-9 * static_cast<double>(delay_.part_ns) / lag);
    const double rest = math::exp(-1e-9 * static_cast<double>(delay_.rest_ns) / lag);
    const auto memory = static_cast<std::size_t>(std::ceil(kLagsKept * lag / motion_.dt));
    std::size_t k = std::max(delay_.whole + 1, begin > memory ? begin - memory : 0);
    Eigen::Vector3d amperes = asked(k, delay_.whole + 1);
    for (; k < begin; ++k) {
      const Eigen::Vector3d older = asked(k, delay_.whole + 1), newer = asked(k, delay_.whole);
      amperes = older + part * (amperes - older);
      amperes = newer + rest * (amperes - newer);
    }
    return amperes;
  }

  /// Motor angles are those of the encoders; links lag by the stretch of the cables. The currents
  /// follow from those sent in all ticks before the window.
  device_sim::DriveTrainState state_at(const std::vector<TwinSample>& samples, std::size_t begin,
                                       const TwinStart& start) {
    device_sim::DriveTrainState state{.p_BT = start.p_BT, .v_BT = start.v_BT};
    const auto q = geometry_.inverse(start.p_BT);
    if (!q) return state;  // out of reach: stays at its limit
    Eigen::Vector3d p_BT;
    Eigen::Matrix3d J;
    geometry_.forward(*q, p_BT, J);
    state.q_rotor = *q;
    state.rate_rotor = J.inverse() * start.v_BT;
    if (train_.compliant()) {
      geometry_.forward(*q - start.stretch, state.p_BT, J);
      state.v_BT = J * (state.rate_rotor - start.stretch_rate);
    }
    state.amperes = currents_at(samples, begin);
    return state;
  }

  const TwinMotion& motion_;
  TwinDelay delay_;
  Geometry geometry_;
  Eigen::Vector3d free_B_;  // 1 for each axis along which the tip can move, else 0
  device_sim::DriveTrainSettings train_;
  device_sim::WiringSettings wiring_;
  double current_max_;  // A
  Plant plant_;
};

template <class Geometry, class Tip>
driver::Result<std::unique_ptr<TwinMover>> make_with(const TwinMotion& motion,
                                                     const scene::ArmFile& file) {
  device_sim::SimulatedArmSettings settings = file.simulated;
  settings.hand = {};              // no hand
  settings.drive_train.heat = {};  // a window is too short for heat, and each runs many times
  const Eigen::Vector3d& p_BT = motion.stretches.front().front().p_BT;
  auto plant = device_sim::DriveTrainPlant<Geometry, Tip>::make(model_of<Geometry>(file.model),
                                                                settings, p_BT, p_BT, kSubStep_ns);
  if (!plant) return plant.error();
  return std::unique_ptr<TwinMover>(
      std::make_unique<DriveTrainTwin<Geometry, Tip>>(motion, file, std::move(plant).value()));
}

template <class Geometry>
driver::Result<std::unique_ptr<TwinMover>> make_of(const TwinMotion& motion,
                                                   const scene::ArmFile& file) {
  return file.simulated.drive_train.has_joint_friction()
             ? make_with<Geometry, device_sim::LinkedTip>(motion, file)
             : make_with<Geometry, device_sim::PointTip>(motion, file);
}

}  // namespace

driver::Result<std::unique_ptr<TwinMover>> make_drive_train_twin(const TwinMotion& motion,
                                                                 const scene::ArmFile& file) {
  if (file.is<driver::SerialArm>()) return make_of<driver::SerialArm>(motion, file);
  if (file.is<driver::LinkageArm>()) return make_of<driver::LinkageArm>(motion, file);
  return make_of<device_sim::BoardGeometry>(motion, file);
}

}  // namespace thimble::twin
