#include "hil/heat_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "text/counted.h"

namespace thimble::hil {
namespace {

using driver::HeatGuard;

// Both sources use the same integer mA over the same times: only rounding errors differ.
constexpr double kApartMax = 1e-4;        // of the limit
constexpr double kHeatSlack = 1e-3;       // of the limit: how much colder a motor may be counted
constexpr double kCurrentSlack = 0.0005;  // A: a message holds integer mA
// Min. heat for a comparison: colder windings show delays, not constants.
constexpr double kComparedFrom = 0.002;  // of the limit
// A winding is never warmer than the driver's estimate if the file is correct (motor_heat.h); a
// late message makes it so for a moment.
constexpr double kRatioMax = 1.02;

}  // namespace

HeatWatch::HeatWatch(const scene::ArmFile& file, const bringup::BenchArm& bench)
    : file_(file),
      bench_(bench),
      named_(bench.device().heat().named()),
      model_(driver_heat()),
      hottest_(model_.maxCoeff()),
      lowered_before_(bench.device().heat().lowered()) {
  if (!named_) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    continuous_[k] = file.heat.continuous_current[i];
    time_constant_[k] = file.heat.time_constant[i];
    peak_[k] = file.model.drives[i].current_max;
  }
}

HeatWatch::Array HeatWatch::driver_heat() const {
  const std::array<double, 3>& heat = bench_.device().heat().heat();
  return {heat[0], heat[1], heat[2]};
}

/// Returns the currents of the acting force, as in its message, A, unsigned.
HeatWatch::Array HeatWatch::currents() const {
  const Eigen::Vector3d f_T_B = file_.R_WB.transpose() * bench_.device().f_sent_W();
  Array amperes = (J_BT_.transpose() * f_T_B).array().abs();
  for (std::size_t i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = file_.model.drives[i];
    amperes[static_cast<Eigen::Index>(i)] /= drive.ratio * drive.torque_constant;
  }
  return 1e-3 * (1e3 * amperes).round();
}

/// Returns the max. currents for motors of this heat, as HeatGuard guarantees them, A. A current
/// that is held until the arm's watchdog fires must not bring a motor beyond its limit.
HeatWatch::Array HeatWatch::allowed(const Array& heat) const {
  constexpr double kFrom = HeatGuard::kWarning;
  const double hold = 1e-9 * static_cast<double>(file_.limits.watchdog_ns);  // s
  const Array held = 1 / (1 - (-hold / time_constant_).exp()) - 1;
  const Array fall = (((peak_ / continuous_).square() - 1).max(0) / (1 - kFrom)).min(held);
  const Array lowered = continuous_ * (1 + fall * (1 - heat).max(0)).sqrt();
  return (heat > kFrom).select(lowered.min(peak_), peak_);
}

void HeatWatch::tick(const driver::DeviceState& state) {
  if (!named_) return;
  // The force of the previous tick acts until now, and the driver updates its heat up to then.
  const Array thought = driver_heat();
  hottest_ = std::max(hottest_, thought.maxCoeff());
  apart_ = std::max(apart_, (thought - model_).abs().maxCoeff());
  const Array amperes = currents();
  const Array max_currents = allowed(model_ - kHeatSlack) + kCurrentSlack;
  over_ = std::max(over_, (amperes / max_currents).maxCoeff());
  const Array load = (amperes / continuous_).square();
  load_ += state.dt * load;
  time_ += state.dt;
  model_ += (1 - (-state.dt / time_constant_).exp()) * (load - model_);
  compare_windings(thought);
  Eigen::Vector3d p_BT;
  std::visit([&](const auto& build) { build.forward(state.q, p_BT, J_BT_); }, file_.model.geometry);
}

void HeatWatch::compare_windings(const Array& thought) {
  const auto rise = bench_.winding_rise();
  const double limit = file_.simulated.drive_train.heat.rise;  // K
  if (!rise || !(limit > 0)) return;
  const Array winding = rise->array() / limit;
  max_winding_ = std::max(max_winding_, winding.maxCoeff());
  for (int i = 0; i < 3; ++i) {
    if (std::max(winding[i], thought[i]) < kComparedFrom) continue;
    const double ratio = winding[i] / std::max(thought[i], kComparedFrom);
    if (ratio <= winding_ratio_) continue;
    winding_ratio_ = ratio;
    winding_there_ = winding[i];
    thought_there_ = thought[i];
    winding_motor_ = i + 1;
  }
}

std::vector<session::Figure> HeatWatch::figures() const {
  if (!named_) return {};
  std::vector<session::Figure> figures{
      {"motor_heat", hottest_, "of the limit", "<= 1", "by the driver's model"},
      {"heat_from_model", apart_, "of the limit", fmt::format("<= {:g}", kApartMax),
       "difference between the driver's heat and that of the arm file's model"},
      {"heat_in_the_end", (load_ / time_).maxCoeff(), "of the limit", "",
       "limit for an unlimited duration of this motion"},
      {"current_of_allowed", over_, "", "<= 1", "of the current that the heat of the motor allows"},
      {"ticks_lowered_by_heat",
       static_cast<double>(bench_.device().heat().lowered() - lowered_before_), "", "", ""}};
  if (winding_motor_ > 0) {
    figures.push_back(
        {"winding_heat", max_winding_, "of the limit", "<= 1", "of the simulated motors"});
    figures.push_back({"winding_of_thought", winding_ratio_, "", fmt::format("<= {:g}", kRatioMax),
                       "temperature rise of a winding, divided by the driver's estimate"});
  }
  return figures;
}

std::string HeatWatch::text() const {
  if (!named_) {
    return " The heat of the motors is unknown because the arm file has no joints: "
           "continuous_current.";
  }
  std::string text = fmt::format(
      " By the driver's model the hottest motor reached {:.0f} % of its limit, and would reach "
      "{:.0f} % if this motion continued forever{}.",
      100 * hottest_, 100 * (load_ / time_).maxCoeff(),
      apart_ <= kApartMax
          ? ", in agreement with the arm file's model"
          : fmt::format("; the arm file's model differs by up to {:.1f} % of the limit",
                        100 * apart_));
  const auto lowered = bench_.device().heat().lowered() - lowered_before_;
  if (lowered > 0)
    text += fmt::format(" The force was reduced because of heat in {}.",
                        scene::counted(lowered, "tick"));
  if (over_ > 1) {
    text += fmt::format(" A motor received {:.2f} times the current that its heat allows.", over_);
  }
  if (!bench_.simulated()) {
    return text +
           " No sensor measures the temperature of the windings, so this check cannot detect "
           "motors that heat more than the arm file says.";
  }
  if (winding_motor_ == 0) {
    return text + (bench_.winding_rise() && file_.simulated.drive_train.heat.named()
                       ? " The windings stayed too cold for a comparison."
                       : " The simulation has no motor heat (drive_train: heat), so there are no "
                         "winding temperatures to compare.");
  }
  if (winding_ratio_ <= kRatioMax) {
    return text +
           fmt::format(" The simulated windings were never warmer than that: at most {:.0f} %.",
                       100 * max_winding_);
  }
  return text +
         fmt::format(
             " Motor {} was at {:.2g} % of its limit when the driver estimated {:.2g} %: it heats "
             "more than the arm file says (joints: continuous_current, thermal_time_constant).",
             winding_motor_, 100 * winding_there_, 100 * thought_there_);
}

}  // namespace thimble::hil
