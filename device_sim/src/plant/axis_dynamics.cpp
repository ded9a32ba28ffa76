#include "plant/axis_dynamics.h"

#include <cmath>
#include <limits>
#include <string>

namespace thimble::device_sim {
namespace {

// Acceleration obeys the unforced equation, so its zeros are half a period apart. A piece is kept
// below a quarter period (pi / 2), where the bound in `may_dip` also holds.
constexpr double kPieceAngleMax = 1.5;

// Bisection without Newton's steps reduces a bracket to rounding within this number; Newton needs
// about four.
constexpr int kMaxIterations = 64;

bool is_amount(double value) {
  return value >= 0 && value < std::numeric_limits<double>::infinity();
}

struct Sample {
  double value;
  double slope;
};

// Finds the only zero between `low` and `high` by Newton's method inside a shrinking bracket.
// `low_sign` is the sign of the function at `low`.
template <class Function>
double zero_between(double low, double high, double guess, double low_sign,
                    const Function& function) noexcept {
  const double tolerance = 2 * std::numeric_limits<double>::epsilon() * high;
  double t = guess > low && guess < high ? guess : 0.5 * (low + high);
  for (int i = 0; i < kMaxIterations; ++i) {
    const Sample sample = function(t);
    if (sample.value == 0) return t;
    (sample.value * low_sign > 0 ? low : high) = t;
    double next = t - sample.value / sample.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double move = std::abs(next - t);
    t = next;
    if (!(move > tolerance)) break;
  }
  return t;
}

AxisResponse respond(const AxisMotion& m, double t) noexcept {
  return AxisResponse::at(m.damping, m.stiffness, t);
}

double zero_of_acceleration(const AxisMotion& m, double end, double a_end) noexcept {
  return zero_between(0, end, end * m.a / (m.a - a_end), m.a, [&m](double t) noexcept {
    const AxisResponse r = respond(m, t);
    const double a = m.acceleration(r);
    return Sample{a, m.jerk - m.stiffness * m.velocity(r) - m.damping * a};
  });
}

double zero_of_velocity(const AxisMotion& m, double low, double high, double guess,
                        double direction) noexcept {
  return zero_between(low, high, guess, direction, [&m](double t) noexcept {
    const AxisResponse r = respond(m, t);
    return Sample{m.velocity(r), m.acceleration(r)};
  });
}

// Returns whether a velocity with the same sign at both ends of a piece might lose it in between.
// Inside a piece an acceleration that rises from a < 0 through zero stays above a, so the velocity
// stays above v + a t. (The boundary value problem's influence functions are at most 1 within a
// quarter period.)
bool may_dip(const AxisMotion& m, double direction, double t, double a_end) noexcept {
  return m.a * direction < 0 && a_end * direction > 0 && (m.v + m.a * t) * direction <= 0;
}

constexpr double kNever = std::numeric_limits<double>::infinity();

// Returns the time at which a sliding axis comes to rest within t, or kNever.
double time_of_rest(const AxisMotion& m, double direction, double t) noexcept {
  const AxisResponse end = respond(m, t);
  const double v_end = m.velocity(end), a_end = m.acceleration(end);
  if (v_end * direction < 0) {
    if (m.v != 0) return zero_of_velocity(m, 0, t, t * m.v / (m.v - v_end), direction);
    // Starting from rest, time zero is also a root: search after the maximum of speed.
    if (!(a_end * direction < 0)) return t;
    return zero_of_velocity(m, zero_of_acceleration(m, t, a_end), t, t, direction);
  }
  if (!may_dip(m, direction, t, a_end)) return kNever;
  const double lowest = zero_of_acceleration(m, t, a_end);
  const double v_lowest = m.velocity(respond(m, lowest));
  if (!(v_lowest * direction < 0)) return kNever;
  return zero_of_velocity(m, 0, lowest, lowest * m.v / (m.v - v_lowest), direction);
}

}  // namespace

driver::Result<AxisDynamics> AxisDynamics::make(const PlantSettings& plant,
                                                const HandSettings& hand) {
  const struct {
    bool good;
    const char* name;
    const char* bounds;
  } amounts[] = {
      {is_amount(plant.mass) && plant.mass > 0, "tip mass", "above zero (kg)"},
      {is_amount(plant.viscous), "viscous friction", "not negative (N s/m)"},
      {is_amount(plant.coulomb), "Coulomb friction", "not negative (N)"},
      {is_amount(hand.mass), "hand mass", "not negative (kg)"},
      {is_amount(hand.stiffness), "hand stiffness", "not negative (N/m)"},
      {is_amount(hand.damping), "hand damping", "not negative (N s/m)"},
  };
  for (const auto& amount : amounts) {
    if (amount.good) continue;
    return driver::Error{std::string("The simulated arm's ") + amount.name +
                         " must be finite and " + amount.bounds + "."};
  }
  return AxisDynamics(plant, hand);
}

AxisDynamics::AxisDynamics(const PlantSettings& plant, const HandSettings& hand) noexcept
    : mass_(plant.mass + hand.mass),
      inverse_mass_(1 / mass_),
      friction_(plant.coulomb),
      hand_stiffness_(hand.stiffness),
      hand_damping_(hand.damping),
      damping_((plant.viscous + hand.damping) / mass_),
      stiffness_(hand.stiffness / mass_) {}

inline const AxisDynamics::Map& AxisDynamics::map_for(std::int64_t dt_ns) noexcept {
  return maps_[last_map_].dt_ns == dt_ns ? maps_[last_map_] : other_map_for(dt_ns);
}

const AxisDynamics::Map& AxisDynamics::other_map_for(std::int64_t dt_ns) noexcept {
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    if (maps_[i].dt_ns == dt_ns) {
      last_map_ = i;
      return maps_[i];
    }
  }
  last_map_ = (last_map_ + 1) % maps_.size();
  Map& map = maps_[last_map_];
  const double dt = static_cast<double>(dt_ns) * 1e-9;
  map.dt_ns = dt_ns;
  // Without dry friction there are no events.
  map.pieces =
      friction_ > 0 ? 1 + static_cast<int>(dt * std::sqrt(stiffness_) / kPieceAngleMax) : 1;
  map.t = dt / map.pieces;
  map.response = AxisResponse::at(damping_, stiffness_, map.t);
  return map;
}

double AxisDynamics::force_at_rest(double x, double anchor, const AxisDrive& drive) const noexcept {
  return drive.force + hand_stiffness_ * (anchor - x) + hand_damping_ * drive.anchor_speed;
}

AxisMotion AxisDynamics::motion(double v, double net, const AxisDrive& drive) const noexcept {
  return {v, net * inverse_mass_ - damping_ * v, stiffness_ * drive.anchor_speed, damping_,
          stiffness_};
}

void AxisDynamics::step(AxisState& state, const AxisDrive& drive, std::int64_t dt_ns) noexcept {
  if (!(dt_ns > 0)) return;
  const Map& map = map_for(dt_ns);
  AxisDrive now = drive;
  for (int piece = 0; piece < map.pieces; ++piece) {
    now.anchor = drive.anchor + drive.anchor_speed * (map.t * piece);
    const double force = force_at_rest(state.x, now.anchor, now);
    if (state.v == 0 && friction_ > 0) {
      // The force on an axis at rest is linear in time: inside at both ends means inside all the
      // time.
      const double force_end = force + hand_stiffness_ * drive.anchor_speed * map.t;
      if (std::abs(force) <= friction_ && std::abs(force_end) <= friction_) continue;
      step_with_events(state, now, map.t);
      continue;
    }
    const double direction = state.v > 0 ? 1 : -1;
    const AxisMotion m = motion(state.v, force - direction * friction_, now);
    const double v_end = m.velocity(map.response);
    if (friction_ > 0 &&
        (!(v_end * direction > 0) || may_dip(m, direction, map.t, m.acceleration(map.response)))) {
      step_with_events(state, now, map.t);
      continue;
    }
    state.x += m.way(map.response);
    state.v = v_end;
  }
}

void AxisDynamics::step_with_events(AxisState& state, AxisDrive drive, double t) noexcept {
  for (int event = 0; event < kMaxEvents; ++event) {
    double net = force_at_rest(state.x, drive.anchor, drive);
    double direction = state.v > 0 ? 1 : -1;
    if (state.v == 0) {
      direction = net > 0 ? 1 : -1;
      if (std::abs(net) <= friction_) {
        const double rate = hand_stiffness_ * drive.anchor_speed;
        direction = rate > 0 ? 1 : -1;
        const double wait = rate != 0 ? (direction * friction_ - net) / rate : kNever;
        if (!(wait < t)) return;
        drive.anchor += drive.anchor_speed * wait;
        t -= wait;
        ++counters_.breakaways;
        // Exactly at the edge of the friction cone: the rounding error must not push backwards.
        net = direction * friction_;
      }
    }
    const AxisMotion m = motion(state.v, net - direction * friction_, drive);
    const double rest = time_of_rest(m, direction, t);
    const bool comes_to_rest = rest < kNever;
    const AxisResponse end = respond(m, comes_to_rest ? rest : t);
    state.x += m.way(end);
    if (!comes_to_rest) {
      state.v = m.velocity(end);
      return;
    }
    state.v = 0;
    drive.anchor += drive.anchor_speed * rest;
    t -= rest;
    ++counters_.reversals;
    if (!(t > 0)) return;
  }
  ++counters_.unresolved;
  state.v = 0;
}

}  // namespace thimble::device_sim
