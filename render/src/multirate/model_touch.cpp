#include "thimble/render/multirate/model_touch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace thimble::render {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A direction without stiffness counts as having this share of the whole [chosen], so that a force
/// left in it by a turning normal has a finite energy.
constexpr double kStiffnessShareMin = 0.01;

/// Minimum share of a force along its normal while models change [chosen].
constexpr double kPushMin = 0.2;

/// Returns the energy that a force on springs can release, F K^-1 F / 2, J; infinite without
/// springs. Convex in force and stiffness together, as the largest of F x - x K x / 2 over all x.
double available(const Vector3d& force, const Matrix3d& stiffness) noexcept {
  // Corrected for springs along one line, the case of most surfaces.
  const double least = kStiffnessShareMin * stiffness.trace();
  if (!(least > 0)) return force.isZero(0) ? 0 : std::numeric_limits<double>::infinity();
  const Matrix3d raised = stiffness + least * Matrix3d::Identity();
  return 0.5 * (1 + kStiffnessShareMin) * force.dot(raised.inverse() * force);
}

/// Removes the shear from a force. The rest is the part that begins and ends with the push along
/// the normal, and is the gradient of an energy.
Vector3d without_shear(const Vector3d& force, const Matrix3d& stiffness,
                       const Vector3d& n_W) noexcept {
  const Vector3d along = stiffness * n_W;
  const double own = n_W.dot(along);
  // Written so that NaN means no force.
  if (!(own > 0)) return Vector3d::Zero();
  return n_W.dot(force) / own * along;
}

}  // namespace

std::string_view name(ModelAge age) noexcept {
  switch (age) {
    case ModelAge::kNothing:
      return "nothing";
    case ModelAge::kFollowed:
      return "followed";
    case ModelAge::kHeld:
      return "held";
    case ModelAge::kFading:
      return "fading";
    case ModelAge::kSilent:
      return "silent";
  }
  return "";
}

driver::Result<std::unique_ptr<ModelTouch>> ModelTouch::make(const ModelSlot& slot,
                                                             const ModelTouchSettings& settings) {
  const auto refuse = [](const char* what, const char* must) {
    return driver::Error{std::string("ModelTouchSettings::") + what + " must be " + must + "."};
  };
  const auto above = [](double x) { return std::isfinite(x) && x > 0; };
  if (!above(settings.stiffness_max)) {
    return refuse("stiffness_max",
                  "set, and above 0 N/m; thimble tune prints the maximum for arm, loop and hand");
  }
  if (!(above(settings.jump) && settings.jump <= 1)) return refuse("jump", "above 0, at most 1");
  if (!above(settings.min_jump)) return refuse("min_jump", "above 0 N");
  if (!above(settings.hold)) return refuse("hold", "above 0 s");
  if (!above(settings.fade)) return refuse("fade", "above 0 s");
  if (!(settings.late > 0 && settings.late <= settings.hold)) {
    return refuse("late", "above 0 s, at most `hold`");
  }
  if (!(std::isfinite(settings.power) && settings.power >= 0)) {
    return refuse("power", "0 W or more");
  }
  if (!(std::isfinite(settings.reserve) && settings.reserve >= 0)) {
    return refuse("reserve", "0 J or more");
  }
  return std::unique_ptr<ModelTouch>(new ModelTouch(slot, settings));
}

driver::ForceCommand ModelTouch::update(const driver::DeviceState& state) noexcept {
  // An invalid tip position gives no force; the gate reports that fault.
  if (!state.p_WT.allFinite() || !state.v_WT.allFinite()) return {};
  take_news(state.time_ns);
  carry(begun_ ? Vector3d(state.p_WT - p_WT_) : Vector3d::Zero());
  p_WT_ = state.p_WT;
  begun_ = true;
  if (!known_) return {};
  const double age = static_cast<double>(state.time_ns - newest_.time_ns) * 1e-9;
  if (age > settings_.hold) {
    fade_to(std::max(0.0, 1 - (age - settings_.hold) / settings_.fade));
  } else {
    age_.store(age > settings_.late ? ModelAge::kHeld : ModelAge::kFollowed,
               std::memory_order_relaxed);
    if (!touching_) begin_free(state.p_WT);
    if (touching_) {
      energy_ += settings_.power * std::max(0.0, state.dt);
      approach(state.p_WT);
    }
  }
  if (touching_) keep_account();
  return command(state);
}

void ModelTouch::take_news(std::int64_t now_ns) noexcept {
  const std::uint64_t count = slot_.count();
  if (count == seen_) return;
  LocalModel model;
  if (!slot_.newest(model)) return;  // the model is just being written
  seen_ = count;
  // Another process may have written anything.
  const double age = static_cast<double>(now_ns - model.time_ns) * 1e-9;
  if (flaw_of(model) != ModelFlaw::kNone || !(age >= 0 && age <= settings_.hold) ||
      (known_ && model.time_ns <= newest_.time_ns)) {
    ++counters_.refused;
    return;
  }
  // The Frobenius norm is at least the largest eigenvalue, and equal to it for a plane.
  const double size = model.stiffness.norm();
  if (size > settings_.stiffness_max) {
    const double share = settings_.stiffness_max / size;
    model.stiffness *= share;
    model.f_T_W *= share;  // keeps the plane in place
    ++counters_.softened;
  }
  newest_ = model;
  known_ = true;
  share_ = 1;
  ++counters_.taken;
}

/// Moves the felt model along with the tip, and books the work of the hand.
void ModelTouch::carry(const Vector3d& way) noexcept {
  const Vector3d before = touching_ ? force_ : Vector3d::Zero();
  force_ -= stiffness_ * way;
  const bool pushes = n_W_.dot(force_) > 0;
  if (pushes && touching_) {
    // Exact for springs. The energy error of a held force within a tick is covered by K L <= b + B.
    energy_ -= 0.5 * (before + force_).dot(way);
  } else if (pushes) {
    // The touch began within this tick, from nothing.
    force_ = without_shear(force_, stiffness_, n_W_);
    energy_ = available(force_, stiffness_);
  } else {
    force_ = without_shear(force_, stiffness_, n_W_);
    energy_ = 0;
  }
  touching_ = pushes;
}

/// Fades the felt model: springs and force are scaled together, and so is the energy.
void ModelTouch::fade_to(double share) noexcept {
  if (share_ == 1) ++counters_.faded;
  const double rest = share_ > 0 ? share / share_ : 0;
  share_ = share;
  force_ *= rest;
  stiffness_ *= rest;
  damping_ *= rest;
  energy_ *= rest;
  if (!(share > 0)) {
    touching_ = false;
    energy_ = 0;
  }
  age_.store(share > 0 ? ModelAge::kFading : ModelAge::kSilent, std::memory_order_relaxed);
}

/// Takes the newest model unchanged: a free tip feels no jump.
void ModelTouch::begin_free(const Vector3d& p_WT) noexcept {
  stiffness_ = newest_.stiffness;
  n_W_ = newest_.n_W;
  damping_ = newest_.damping;
  energy_ = 0;
  const Vector3d force = newest_.f_T_W - stiffness_ * (p_WT - newest_.p_WR);
  if (n_W_.dot(force) > 0) {
    // The tip is inside a surface that appeared around it: contact begins at the tip.
    force_.setZero();
    touching_ = true;
  } else {
    force_ = without_shear(force, stiffness_, n_W_);
  }
}

/// Moves the stiffness as far towards the newest model's as `most` (J) allows at this force.
void ModelTouch::soften(const Vector3d& goal, double most) noexcept {
  if (stiffness_ == newest_.stiffness) return;
  // A model too soft for the account is felt stiffer, but in its own directions.
  const double length = goal.norm();
  const Vector3d there = length > 0 ? Vector3d(std::min(1.0, force_.norm() / length) * goal) : goal;
  const double size = newest_.stiffness.norm();
  const double times = available(there, newest_.stiffness) / most;
  Matrix3d end = newest_.stiffness;
  if (times > 1 && size > 0) end *= std::min(times, std::max(1.0, settings_.stiffness_max / size));
  const auto between = [&](double share) { return stiffness_ + share * (end - stiffness_); };
  const auto allows = [&](const Matrix3d& stiffness) {
    return available(force_, stiffness) <= most;
  };
  if (allows(end)) {
    stiffness_ = end;
    return;
  }
  double low = 0, high = 1;
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (low + high);
    (allows(between(middle)) ? low : high) = middle;
  }
  stiffness_ = between(low);
}

/// Moves the felt model towards the newest one, as far as jump and account allow.
void ModelTouch::approach(const Vector3d& p_WT) noexcept {
  Vector3d goal = newest_.f_T_W - newest_.stiffness * (p_WT - newest_.p_WR);
  if (!(newest_.n_W.dot(goal) > 0)) goal.setZero();
  // Rounding must not prevent a model that is already felt.
  const double paid = energy_ * (1 + 1e-9);
  soften(goal, std::max(paid, available(force_, stiffness_)));
  const Vector3d change = goal - force_;
  const double longest = std::max(settings_.jump * force_.norm(), settings_.min_jump);
  const double length = change.norm();
  double share = length > longest ? longest / length : 1;
  // The account allows force_ + s change up to the larger root of a s^2 + b s + c = 0.
  const double now = available(force_, stiffness_);
  const double a = available(change, stiffness_);
  const double b = available(force_ + change, stiffness_) - now - a;
  const double c = now - std::max(paid, now);
  if (a + b + c > 0 && a > 0) {
    const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
    // Uses the form without a difference of nearly equal numbers.
    const double most = b > 0 ? -2 * c / (b + root) : (root - b) / (2 * a);
    if (most < share) {
      share = std::max(0.0, most);
      ++counters_.bounded;
    }
  }
  force_ += share * change;
  // The normal and the damper follow. A normal along which the force hardly pushes would end the
  // touch abruptly.
  const double turn = std::max(share, settings_.jump);
  const Vector3d n_W = n_W_ + turn * (newest_.n_W - n_W_);
  const double size = n_W.norm(), pushed = force_.norm();
  if (n_W.dot(force_) > kPushMin * size * pushed) {
    n_W_ = n_W / size;
  } else if (pushed > 0) {
    n_W_ = force_ / pushed;
  }
  damping_ += settings_.jump * (newest_.damping - damping_);
}

/// Reduces the force if it could release more energy than was supplied, and drops the excess.
void ModelTouch::keep_account() noexcept {
  const double could = available(force_, stiffness_);
  if (could > energy_ * (1 + 1e-9)) {
    const double share = std::sqrt(std::max(0.0, energy_) / could);
    force_ *= std::max(share, 1 - settings_.jump);
    ++counters_.bounded;
  }
  energy_ = std::min(energy_, could + settings_.reserve);
}

driver::ForceCommand ModelTouch::command(const driver::DeviceState& state) const noexcept {
  driver::ForceCommand command;
  // Written so that NaN means no contact and no force.
  const double push = n_W_.dot(force_);
  const double own = n_W_.dot(stiffness_ * n_W_);
  if (!(touching_ && push > 0 && own > 0)) return command;
  const Vector3d force = force_ - damping_ * n_W_.dot(state.v_WT) * n_W_;
  if (n_W_.dot(force) > 0) command.f_T_W = force;
  const double depth = push / own;
  command.touch = {.in_contact = true,
                   .object = 0,
                   .feature = -1,
                   .depth = depth,
                   .p_WP = state.p_WT + depth * n_W_,
                   .n_W = n_W_,
                   .hops = 0};
  return command;
}

}  // namespace thimble::render
