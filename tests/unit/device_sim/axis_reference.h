#pragma once

#include <cmath>

#include "plant/axis_dynamics.h"

namespace thimble::device_sim {

/// An independent reference: Runge-Kutta of order 4 in extended precision with tiny steps.
/// Bisection finds the times at which the velocity changes its sign or a held axis breaks loose.
class AxisReference {
 public:
  AxisReference(const PlantSettings& plant, const HandSettings& hand, const AxisDrive& drive)
      : mass_(static_cast<long double>(plant.mass) + hand.mass),
        plant_(plant),
        hand_(hand),
        drive_(drive) {}

  void run(long double& x, long double& v, long double end, int steps) {
    const long double dt = end / steps;
    for (int i = 0; i < steps; ++i) {
      long double t = dt * i;
      long double left = dt;
      for (int event = 0; event < 20 && left > 0; ++event) {
        if (v == 0 && held(x, t)) {
          if (held(x, t + left)) break;
          const long double wait = bisect(left, [&](long double s) { return held(x, t + s); });
          t += wait;
          left -= wait;
          sign_ = net(x, t) > 0 ? 1 : -1;
        } else if (v == 0) {
          sign_ = net(x, t) > 0 ? 1 : -1;
        } else {
          sign_ = v > 0 ? 1 : -1;
        }
        long double x1 = x, v1 = v;
        slide(x1, v1, t, left);
        if (v1 * sign_ >= 0) {
          x = x1;
          v = v1;
          break;
        }
        const long double stop = bisect(left, [&](long double s) {
          long double xs = x, vs = v;
          slide(xs, vs, t, s);
          return vs * sign_ > 0;
        });
        slide(x, v, t, stop);
        v = 0;
        t += stop;
        left -= stop;
      }
    }
  }

 private:
  long double net(long double x, long double t) const {
    const long double anchor = drive_.anchor + drive_.anchor_speed * t;
    return drive_.force + hand_.stiffness * (anchor - x) +
           static_cast<long double>(hand_.damping) * drive_.anchor_speed;
  }
  bool held(long double x, long double t) const { return std::abs(net(x, t)) <= plant_.coulomb; }
  long double acceleration(long double x, long double v, long double t) const {
    return (net(x, t) - (static_cast<long double>(plant_.viscous) + hand_.damping) * v -
            plant_.coulomb * sign_) /
           mass_;
  }
  void slide(long double& x, long double& v, long double t, long double h) const {
    const long double a1 = acceleration(x, v, t);
    const long double v2 = v + a1 * h / 2, a2 = acceleration(x + v * h / 2, v2, t + h / 2);
    const long double v3 = v + a2 * h / 2, a3 = acceleration(x + v2 * h / 2, v3, t + h / 2);
    const long double v4 = v + a3 * h, a4 = acceleration(x + v3 * h, v4, t + h);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  template <class Before>
  static long double bisect(long double high, const Before& before) {
    long double low = 0;
    for (int i = 0; i < 64; ++i) {
      const long double middle = (low + high) / 2;
      (before(middle) ? low : high) = middle;
    }
    return high;
  }

  long double mass_;
  PlantSettings plant_;
  HandSettings hand_;
  AxisDrive drive_;
  long double sign_ = 1;
};

}  // namespace thimble::device_sim
