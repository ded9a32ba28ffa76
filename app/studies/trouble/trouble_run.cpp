#include "studies/trouble/trouble_run.h"
#include "setup.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>

#include "simulated_arm.h"
#include "stability/rest_warnings.h"
#include "studies/signal.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble::app {
namespace {

using Eigen::Vector3d;

constexpr double kCorner = 50;        // Hz [STABILITY 2.5]
constexpr double kRestWindow = 0.25;  // s

/// Keeps the account of one run, tick by tick.
class Account {
 public:
  Account(const session::Session& session, double own_energy)
      : arm_(*session.simulation()->board_arm()),
        hand_(session.scene().arm.simulated.hand),
        mass_(session.scene().arm.simulated.plant.mass + hand_.mass),
        period_(static_cast<double>(session.setup().period_ns()) * 1e-9),
        force_max_(session.scene().arm.limits.force_max),
        own_energy_(own_energy) {
    p_ = arm_.plant().p_BT();
    v_ = arm_.plant().v_BT();
    hand_p_ = arm_.p_BH();
    first_ = energy();
    for (auto& axis : force_) axis.reserve(session.setup().ticks());
  }

  void operator()(const driver::TickRecord& record) noexcept {
    const Vector3d sent(record.f_sent_W[0], record.f_sent_W[1], record.f_sent_W[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      if (force_[i].size() < force_[i].capacity()) force_[i].push_back(record.f_sent_W[i]);
    }
    found_.contact += record.in_contact ? 1 : 0;
    ++ticks_;
    if (record.fault != driver::Fault::kNone) found_.fault = static_cast<double>(record.fault);
    // What the arm did since the last tick, under the force of the tick before.
    const device_sim::Plant& plant = arm_.plant();
    const Vector3d p = plant.p_BT(), v = plant.v_BT(), hand_p = arm_.p_BH();
    if (!(sent.squaredNorm() + p.squaredNorm() + v.squaredNorm() < HUGE_VAL)) {
      ++found_.not_finite;
      return;
    }
    found_.force_share = std::max(found_.force_share, sent.norm() / force_max_);
    found_.speed = std::max(found_.speed, v.norm());
    work_ += plant.f_T_B().dot(p - p_);
    found_.given = std::max(found_.given, work_ - own_energy_);
    // The hand's wish moves evenly within a step; its force is taken as the mean of both ends.
    const Vector3d way = hand_p - hand_p_;
    const Vector3d hand_v = way / period_;
    const Vector3d before = hand_.stiffness * (hand_p_ - p_) + hand_.damping * (hand_v - v_);
    const Vector3d after = hand_.stiffness * (hand_p - p) + hand_.damping * (hand_v - v);
    put_in_ += 0.5 * (before + after).dot(way);
    p_ = p;
    v_ = v;
    hand_p_ = hand_p;
    found_.excess = std::max(found_.excess, energy() - first_ - put_in_ - own_energy_);
  }

  TroubleFound close() {
    const double rate = 1 / period_;
    const auto rest = static_cast<std::size_t>(kRestWindow * rate);
    double square = 0;
    for (const auto& axis : force_) {
      if (axis.size() < rest) continue;
      const std::vector<double> fast = high_passed(axis, rate, kCorner);
      const double one = root_mean_square(std::span(fast).last(rest));
      square += one * one;
    }
    found_.tremble = found_.not_finite > 0 ? 0 : std::sqrt(square);
    found_.contact /= std::max(ticks_, 1.0);
    return found_;
  }

 private:
  double energy() const {
    return 0.5 * (mass_ * v_.squaredNorm() + hand_.stiffness * (p_ - hand_p_).squaredNorm());
  }

  const device_sim::SimulatedArm& arm_;
  device_sim::HandSettings hand_;
  double mass_;
  double period_;
  double force_max_;
  double own_energy_;
  Vector3d p_, v_, hand_p_;
  double first_ = 0;   // J
  double put_in_ = 0;  // J
  double work_ = 0;    // J, of the motors
  double ticks_ = 0;
  std::array<std::vector<double>, 3> force_;
  TroubleFound found_;
};

}  // namespace

bool TroubleFound::bad() const {
  // Written so that NaN is bad.
  return not_finite > 0 || fault > 0 || !(force_share <= 1 + 1e-9) || !(excess <= kEnergyAllowed);
}

double TroubleFound::badness() const {
  if (not_finite > 0) return 1e9;
  // A fault takes the force away, so what is beside it tells little.
  return (fault > 0 ? 1e6 : 0) + (force_share > 1 + 1e-9 ? 1e5 : 0) + excess / kEnergyAllowed +
         given / kEnergyAllowed + (must_tremble ? 0 : 10 * tremble);
}

TroubleFound run_for_trouble(const std::filesystem::path& scene_file, const RandomScene& scene) {
  TroubleFound found{.must_tremble = scene.trembles};
  auto opened = session::Session::open(scene_file, {});
  if (!opened) {
    found.refused = true;
    return found;
  }
  session::Session& session = **opened;
  Account account(session, scene.own_energy);
  const std::atomic<bool> stop{false};
  driver::run_servo(session.device(), session.setup().clock(), driver::ForceLaw(session.touch()),
                    driver::TickSink(account),
                    {.period_ns = session.setup().period_ns(), .ticks = session.setup().ticks()},
                    stop);
  found = account.close();
  found.must_tremble = scene.trembles;
  found.unforetold =
      !found.must_tremble && found.tremble > kTrembleMost && rest_warnings(session.scene()).empty();
  return found;
}

std::vector<double> numbers_of(const TroubleFound& found) {
  return {found.refused ? 1.0 : 0.0,
          found.not_finite,
          found.fault,
          found.force_share,
          found.excess,
          found.tremble,
          found.speed,
          found.given,
          found.contact,
          found.must_tremble ? 1.0 : 0.0,
          found.unforetold ? 1.0 : 0.0};
}

TroubleFound trouble_of(const std::vector<double>& numbers) {
  TroubleFound found;
  if (numbers.size() < 11) return found;
  found.refused = numbers[0] > 0;
  found.not_finite = numbers[1];
  found.fault = numbers[2];
  found.force_share = numbers[3];
  found.excess = numbers[4];
  found.tremble = numbers[5];
  found.speed = numbers[6];
  found.given = numbers[7];
  found.contact = numbers[8];
  found.must_tremble = numbers[9] > 0;
  found.unforetold = numbers[10] > 0;
  return found;
}

}  // namespace thimble::app
