#include "studies/fuzz_scenes/trouble_run.h"
#include "setup.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>

#include "energy_guard_settings.h"
#include "simulated_arm.h"
#include "stability/rest_warnings.h"
#include "stability/signal.h"
#include "studies/fuzz_scenes/energy_given.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

constexpr double kCorner = 50;        // Hz [PHYSICS 2.5]
constexpr double kRestWindow = 0.25;  // s

/// Computes the account of one run, tick by tick.
class Account {
 public:
  explicit Account(const session::Session& session)
      : arm_(*session.simulation()->board_arm()),
        period_(static_cast<double>(session.setup().period_ns()) * 1e-9),
        force_max_(session.scene().arms.front().arm.limits.force_max),
        p_(arm_.plant().p_BT()) {
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
    // The arm's motion since the last tick, under the force of the previous tick.
    const device_sim::Plant& plant = arm_.plant();
    const Vector3d p = plant.p_BT(), v = plant.v_BT();
    if (!(sent.squaredNorm() + p.squaredNorm() + v.squaredNorm() < HUGE_VAL)) {
      ++found_.not_finite;
      return;
    }
    found_.force_share = std::max(found_.force_share, sent.norm() / force_max_);
    found_.speed = std::max(found_.speed, v.norm());
    const Vector3d wanted(record.f_wanted_W[0], record.f_wanted_W[1], record.f_wanted_W[2]);
    given_.book(plant.f_T_B().dot(p - p_), 0.5 * wanted.norm() * record.depth);
    p_ = p;
  }

  TroubleFound close() {
    const double rate = 1 / period_;
    const auto rest = static_cast<std::size_t>(kRestWindow * rate);
    double square = 0;
    for (const auto& axis : force_) {
      if (axis.size() < rest) continue;
      const std::vector<double> fast = stability::high_passed(axis, rate, kCorner);
      const double one = stability::root_mean_square(std::span(fast).last(rest));
      square += one * one;
    }
    found_.limit_cycle = found_.not_finite > 0 ? 0 : std::sqrt(square);
    found_.contact /= std::max(ticks_, 1.0);
    found_.given = given_.max();
    return found_;
  }

 private:
  const device_sim::SimulatedArm& arm_;
  double period_;
  double force_max_;
  Vector3d p_;
  EnergyGiven given_;
  double ticks_ = 0;
  std::array<std::vector<double>, 3> force_;
  TroubleFound found_;
};

}  // namespace

bool TroubleFound::bad() const {
  // NaN counts as bad.
  return not_finite > 0 || fault > 0 || !(force_share <= 1 + 1e-9) || !(given <= given_bound);
}

double TroubleFound::badness() const {
  if (not_finite > 0) return 1e9;
  // A fault switches the force off, so other values mean little then.
  return (fault > 0 ? 1e6 : 0) + (force_share > 1 + 1e-9 ? 1e5 : 0) + given / given_bound +
         (must_oscillate ? 0 : 10 * limit_cycle);
}

TroubleFound run_for_trouble(const std::filesystem::path& scene_file, const RandomScene& scene) {
  TroubleFound found{.must_oscillate = scene.oscillates};
  auto opened = session::Session::open(scene_file, {});
  if (!opened) {
    found.refused = true;
    return found;
  }
  session::Session& session = **opened;
  Account account(session);
  const std::atomic<bool> stop{false};
  driver::run_servo(session.device(), session.setup().clock(), driver::ForceLaw(session.touch()),
                    driver::TickSink(account),
                    {.period_ns = session.setup().period_ns(), .ticks = session.setup().ticks()},
                    stop);
  found = account.close();
  found.given_bound =
      energy_let_go(scene::energy_settings(session.scene().arms.front().arm, session.scene().rate,
                                           session.scene().energy)) +
      scene.own_energy;
  found.must_oscillate = scene.oscillates;
  found.unforetold = !found.must_oscillate && found.limit_cycle > kLimitCycleMax &&
                     stability::rest_causes(session.scene()).empty();
  return found;
}

std::vector<double> numbers_of(const TroubleFound& found) {
  return {found.refused ? 1.0 : 0.0,
          found.not_finite,
          found.fault,
          found.force_share,
          found.limit_cycle,
          found.speed,
          found.given,
          found.given_bound,
          found.contact,
          found.must_oscillate ? 1.0 : 0.0,
          found.unforetold ? 1.0 : 0.0};
}

TroubleFound trouble_of(const std::vector<double>& numbers) {
  TroubleFound found;
  if (numbers.size() < 11) return found;
  found.refused = numbers[0] > 0;
  found.not_finite = numbers[1];
  found.fault = numbers[2];
  found.force_share = numbers[3];
  found.limit_cycle = numbers[4];
  found.speed = numbers[5];
  found.given = numbers[6];
  found.given_bound = numbers[7];
  found.contact = numbers[8];
  found.must_oscillate = numbers[9] > 0;
  found.unforetold = numbers[10] > 0;
  return found;
}

}  // namespace thimble::studies
