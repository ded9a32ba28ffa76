#include "thimble/scene/hand_route.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>

#include "surface_probe.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

constexpr double kSampleTime = 0.002;  // s [chosen: 25 samples in the shortest sway of a tremor]

// A closest point runs faster than its question where the surface is hollow; beyond this ratio it
// is a jump to another part of the surface. [chosen: loose enough for folds]
constexpr double kRunMax = 8;
constexpr double kJumpMin = 0.002;  // m; a smaller jump is a crease, not another part [chosen]

// A hand cannot follow a kink of the surface faster than it can move at all (about 10 Hz), so the
// way over the surface is averaged over this time. [chosen]
constexpr int kSmoothSamples = 15;  // to each side: 60 ms in all

// Where the hand is between the stations: a quintic with given speeds and no acceleration at its
// ends. With no speed either it is the minimum-jerk stroke of human reaching [M Flash, Hogan 1985].
struct Quintic {
  Vector3d from, to;
  Vector3d speed_from, speed_to;
  double time = 0;

  Vector3d at(double s) const {
    const double s3 = s * s * s;
    const double blend = s3 * (10 + s * (6 * s - 15));
    const double out = s - s3 * (6 + s * (3 * s - 8));
    const double in = -s3 * (4 + s * (3 * s - 7));
    return from + blend * (to - from) + time * (out * speed_from + in * speed_to);
  }
};

bool follows_surface(const HandWaypoint& from, const HandWaypoint& to) {
  return from.on && to.on && *from.on == *to.on;
}

// Speed at station `i`: zero where the hand rests, else the mean over its neighbours.
Vector3d speed_at(const std::vector<HandWaypoint>& w, std::size_t i) {
  if (i == 0 || i + 1 == w.size() || w[i].stop) return Vector3d::Zero();
  if (follows_surface(w[i - 1], w[i]) != follows_surface(w[i], w[i + 1])) return Vector3d::Zero();
  return (w[i + 1].p_W - w[i - 1].p_W) / (w[i + 1].time - w[i - 1].time);
}

// Averages each point of a stretch over its neighbours, fewer towards the ends, which stay.
void smooth(HandRoute& route, std::size_t first, std::size_t last) {
  const HandRoute raw(route.begin() + static_cast<std::ptrdiff_t>(first),
                      route.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const std::size_t reach =
        std::min({static_cast<std::size_t>(kSmoothSamples), i, raw.size() - 1 - i});
    Vector3d sum = Vector3d::Zero();
    for (std::size_t k = i - reach; k <= i + reach; ++k) sum += raw[k].second;
    route[first + i].second = sum / static_cast<double>(2 * reach + 1);
  }
}

driver::Error jump_error(const HandWaypoint& from, const HandWaypoint& to, double time) {
  std::ostringstream text;
  text << "The hand's way from t = " << from.time << " s to " << to.time
       << " s jumps on the surface "
       << "at t = " << time
       << " s: put a station between them, or move them closer to the surface.";
  return {text.str()};
}

}  // namespace

driver::Result<HandRoute> plan_hand(const std::vector<HandWaypoint>& waypoints,
                                    const std::vector<NamedMesh>& objects) {
  if (waypoints.empty()) return driver::Error{"The hand's way has no station."};
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    if (waypoints[i].time > waypoints[i - 1].time) continue;
    std::ostringstream text;
    text << "The hand's way has t = " << waypoints[i].time
         << " s after t = " << waypoints[i - 1].time << " s: times must grow.";
    return driver::Error{text.str()};
  }
  std::map<std::string, SurfaceProbe> probes;
  for (const NamedMesh& object : objects) probes.try_emplace(object.name, *object.mesh_W);
  for (const HandWaypoint& w : waypoints) {
    if (w.on && !probes.contains(*w.on)) {
      return driver::Error{"The hand's way touches \"" + *w.on + "\", which is no object here."};
    }
  }
  const auto pressed = [](const SurfacePoint& point, double press) -> Vector3d {
    return point.p_WS - press * point.n_W;
  };
  // Free stretches that end on the surface lead to the pressed point, not to the one near it.
  std::vector<Vector3d> stations;
  stations.reserve(waypoints.size());
  for (const HandWaypoint& w : waypoints) {
    stations.push_back(w.on ? pressed(probes.at(*w.on).closest(w.p_W), w.press) : w.p_W);
  }
  HandRoute route{{waypoints.front().time, stations.front()}};
  std::size_t run_begin = 0;  // where in the route the present stretch on the surface began
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i) {
    const HandWaypoint& from = waypoints[i];
    const HandWaypoint& to = waypoints[i + 1];
    const bool on_surface = follows_surface(from, to);
    const Quintic way{on_surface ? from.p_W : stations[i], on_surface ? to.p_W : stations[i + 1],
                      speed_at(waypoints, i), speed_at(waypoints, i + 1), to.time - from.time};
    const int steps = std::max(1, static_cast<int>(std::ceil(way.time / kSampleTime)));
    SurfaceProbe* const probe = on_surface ? &probes.at(*from.on) : nullptr;
    SurfacePoint last;
    if (probe) last = probe->closest(way.at(0));
    for (int step = 1; step <= steps; ++step) {
      const double s = static_cast<double>(step) / steps;
      const double time = from.time + s * way.time;
      Vector3d p_WH = way.at(s);
      if (probe) {
        const double asked = (p_WH - way.at(static_cast<double>(step - 1) / steps)).norm();
        const SurfacePoint point = probe->closest(p_WH);
        if (!((point.p_WS - last.p_WS).norm() <= std::max(kRunMax * asked, kJumpMin))) {
          return jump_error(from, to, time);
        }
        last = point;
        const double eased = s * s * s * (10 + s * (6 * s - 15));
        p_WH = pressed(point, from.press + eased * (to.press - from.press));
      }
      route.emplace_back(step == steps ? to.time : time, p_WH);
    }
    const bool goes_on = i + 2 < waypoints.size() && follows_surface(to, waypoints[i + 2]);
    if (on_surface && !(goes_on && !to.stop)) smooth(route, run_begin, route.size() - 1);
    if (!on_surface || to.stop) run_begin = route.size() - 1;
  }
  return route;
}

}  // namespace thimble::scene
