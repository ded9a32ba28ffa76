// Effect of the gate's rise limit on the energy of a touch: throws at walls and wedges with the
// limit, without it, and with two wrong limits.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "plant/axis_dynamics.h"
#include "support/hard_case.h"
#include "support/random.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::rise_limit_energy {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;     // s
constexpr double kForceMax = 8.5;  // N
constexpr double kMass = 0.075;    // kg
constexpr double kRise = 2000;     // N/s, as shipped

/// Limiter between the force law and the motors of the throws.
enum Limiter : std::size_t {
  kNone,       ///< Only the arm's force limit.
  kLength,     ///< Limit of the rise of the force's length only, as in an earlier gate.
  kGate,       ///< The gate.
  kSymmetric,  ///< Limit of every change of the vector, which a limit must not be.
};

/// Passes forces through one of the limiters.
class Between {
 public:
  Between(Limiter limiter, double rise_max)
      : limiter_(limiter),
        rise_(rise_max * kTick),
        gate_({.force_max = kForceMax,
               .speed_max = 50,
               .rise_max = rise_max,
               .soft_start = 1e-9,
               .stall_ns = 20'000'000,
               .watchdog_ns = 100'000'000}) {
    gate_.pass({0, 0, 0}, {0, 0, 0}, kTick);
  }

  Vector3d pass(const Vector3d& wanted, const Vector3d& v) {
    if (limiter_ == kGate) return gate_.pass(wanted, v, kTick).f_T_W();
    Vector3d f = wanted * std::min(1.0, kForceMax / std::max(wanted.norm(), 1e-300));
    if (limiter_ == kLength) {
      f *= std::min(1.0, (last_.norm() + rise_) / std::max(f.norm(), 1e-300));
    } else if (limiter_ == kSymmetric) {
      const Vector3d change = f - last_;
      if (change.norm() > rise_) f = last_ + rise_ / change.norm() * change;
    }
    return last_ = f;
  }

 private:
  Limiter limiter_;
  double rise_;
  driver::SafetyGate gate_;
  Vector3d last_{0, 0, 0};
};

/// A body of faces through the origin with the outward normals `n`: a wall of one, a wedge of two,
/// a plate of two opposite faces. Its force is the spring of the closest face.
struct Faces {
  std::array<Vector3d, 2> n;
  std::size_t count = 1;
  double stiffness = 1000;    ///< N/m
  double half_thickness = 0;  ///< distance of each face from the origin, m

  Vector3d force(const Vector3d& p) const {
    double nearest = -HUGE_VAL;
    std::size_t which = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double outside = n[i].dot(p) - half_thickness;
      if (outside > nearest) {
        nearest = outside;
        which = i;
      }
    }
    return nearest < 0 ? Vector3d(-stiffness * nearest * n[which]) : Vector3d(0, 0, 0);
  }
};

/// One throw at a body.
struct Throw {
  Vector3d p{0, 0, 0}, v{0, 0, 0};
  double phase = 0;    ///< share of a tick until the first sample
  double encoder = 0;  ///< m
};

/// Returns a throw from outside that meets the body near the origin.
Throw throw_at(const Faces& body, double speed, support::Random& random) {
  Throw thrown;
  const Vector3d out =
      body.half_thickness > 0 ? body.n[0] : Vector3d((body.n[0] + body.n[1]).normalized());
  const Vector3d aslant = random.direction();
  const Vector3d way = (aslant.dot(out) > 0 ? Vector3d(-aslant) : aslant) - out;
  thrown.v = speed * way.normalized();
  thrown.p = random.in_box(0.003) - 0.02 * way.normalized();
  thrown.phase = random.uniform(0, 1);
  thrown.encoder = random.bits() % 2 == 0 ? 0 : 3e-5;
  return thrown;
}

/// Returns the ratio of the kinetic energies after and before the throw.
double energy_back(const Faces& body, const Throw& thrown, Limiter limiter, double rise_max) {
  device_sim::AxisDynamics axis =
      device_sim::AxisDynamics::make({.mass = kMass, .viscous = 0.005, .coulomb = 0}, {}).value();
  std::array<device_sim::AxisState, 3> s;
  for (int i = 0; i < 3; ++i) {
    s[static_cast<std::size_t>(i)] = {.x = thrown.p[i], .v = thrown.v[i]};
    axis.step(s[static_cast<std::size_t>(i)], {}, static_cast<std::int64_t>(thrown.phase * 1e6));
  }
  Between between(limiter, rise_max);
  Vector3d before(0, 0, 0), sent(0, 0, 0);
  bool begun = false;
  int outside = 0;
  bool touched = false;
  for (int k = 0; k < (touched ? 4000 : 600) && outside < 3; ++k) {
    Vector3d p(s[0].x, s[1].x, s[2].x);
    if (thrown.encoder > 0) p = thrown.encoder * (p / thrown.encoder).array().round().matrix();
    const Vector3d v = begun ? Vector3d((p - before) / kTick) : Vector3d(0, 0, 0);
    before = p;
    begun = true;
    const Vector3d wanted = body.force(p);
    sent = between.pass(wanted, v);
    touched = touched || !wanted.isZero(0);
    outside = touched && wanted.isZero(0) && sent.isZero(0) ? outside + 1 : 0;
    for (int i = 0; i < 3; ++i) {
      axis.step(s[static_cast<std::size_t>(i)], {.force = sent[i]}, 1'000'000);
    }
  }
  return Vector3d(s[0].v, s[1].v, s[2].v).squaredNorm() / thrown.v.squaredNorm();
}

/// Energy ratios of many throws, for each limiter.
struct Back {
  std::array<double, 4> sum{}, most{};
  int throws = 0, acted = 0;

  void add(const std::array<double, 4>& energy) {
    for (std::size_t i = 0; i < energy.size(); ++i) {
      sum[i] += energy[i];
      most[i] = std::max(most[i], energy[i]);
    }
    ++throws;
    acted += energy[kGate] != energy[kNone];
  }
};

/// Throws at the same body from the same position through each limiter.
void throw_through_all(const Faces& body, const Throw& thrown, double rise_max, Back& back) {
  std::array<double, 4> energy{};
  for (std::size_t i = 0; i < energy.size(); ++i) {
    energy[i] = energy_back(body, thrown, static_cast<Limiter>(i), rise_max);
  }
  back.add(energy);
}

constexpr std::array<double, 4> kSpeeds{0.05, 0.1, 0.3, 1.0};  // m/s

TEST(RiseLimitEnergy, OneFaceKeepsTheEnergyOfALengthLimit) {
  for (const double stiffness : {300.0, 1000.0, 3000.0}) {
    for (const double speed : kSpeeds) {
      for (int i = 0; i < 40; ++i) {
        for (const double aslant : {0.0, 0.7}) {
          const Faces body{.n = {Vector3d(0, 0, 1)}, .stiffness = stiffness};
          const Throw thrown{.p = {0, 0, 0},
                             .v = speed * Vector3d(aslant, 0, -1).normalized(),
                             .phase = (i + 0.5) / 40,
                             .encoder = i % 2 == 0 ? 0 : 3e-5};
          const auto back = [&](Limiter limiter) {
            return energy_back(body, thrown, limiter, kRise);
          };
          ASSERT_NEAR(back(kGate), back(kLength), 1e-12) << stiffness << " " << speed;
          // The limit is above every step of the wall, so no limiter acts.
          if (1.1 * stiffness * speed <= kRise) {
            ASSERT_EQ(back(kGate), back(kNone)) << stiffness << " " << speed;
          }
        }
      }
    }
  }
}

TEST(HardCaseRiseLimit, WedgesReturnNoMoreThanWithout) {
  // Faces at random: the force turns from one tick to the next where the nearest face changes.
  support::Random random(5);
  double mean = 0, most = 0;
  int acted = 0;
  for (const bool plate : {false, true}) {
    for (const double stiffness : {300.0, 1000.0}) {
      for (const double speed : kSpeeds) {
        Back back;
        while (back.throws < 1000) {
          Faces body{
              .n = {random.direction(), random.direction()}, .count = 2, .stiffness = stiffness};
          if (plate) {
            body.n[1] = -body.n[0];
            body.half_thickness = 0.002;
          }
          if (!plate && body.n[0].dot(body.n[1]) < -0.9) continue;
          const Throw thrown = throw_at(body, speed, random);
          if (!body.force(thrown.p).isZero(0)) continue;
          throw_through_all(body, thrown, kRise, back);
        }
        EXPECT_LE(back.sum[kGate], back.sum[kNone] * (1 + 1e-12)) << stiffness << " " << speed;
        EXPECT_LE(back.most[kGate], back.most[kNone] * (1 + 1e-9)) << stiffness << " " << speed;
        mean = std::max(mean, back.sum[kGate] / back.sum[kNone]);
        most = std::max(most, back.most[kGate] / back.most[kNone]);
        acted += back.acted;
      }
    }
  }
  EXPECT_GT(acted, 100) << "the limit was hardly reached, so nothing was tested";
  support::record_hard_case(10,
                            "wedges and plates at random, rise limit on the vector, 0.05 to 1 m/s",
                            "<= mean energy back over that without it", mean, 1, "1");
  support::record_hard_case(10, "the same", "<= largest energy back over that without it", most, 1,
                            "1");
}

TEST(HardCaseRiseLimit, GuardWedgesThrowBack) {
  // Guard of the test above.
  support::Random random(5);
  Back back;
  while (back.throws < 1000) {
    const Faces body{.n = {random.direction(), random.direction()}, .count = 2, .stiffness = 1000};
    const Throw thrown = throw_at(body, 1, random);
    if (!body.force(thrown.p).isZero(0)) continue;
    throw_through_all(body, thrown, 300, back);
  }
  EXPECT_GT(back.sum[kSymmetric], 1.5 * back.sum[kNone]);
  // Any rise limit below stiffness times speed adds energy; one on the vector adds no more than one
  // on the length.
  EXPECT_LE(back.sum[kGate], back.sum[kLength]);
  EXPECT_LE(back.most[kGate], back.most[kLength] * (1 + 1e-9));
  support::record_hard_case(10, "guard: wedges at random, symmetric limit of 300 N/s, 1 m/s",
                            "> mean energy back over that without it",
                            back.sum[kSymmetric] / back.sum[kNone], 1.5, "1");
}

}  // namespace
}  // namespace thimble::rise_limit_energy
