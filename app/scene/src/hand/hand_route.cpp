#include "thimble/scene/hand_route.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "hand/surface_probe.h"
#include "hand/surface_route.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

constexpr double kSampleTime = 0.002;  // s [chosen: 25 samples in the shortest period of a tremor]

// In a groove of the surface, the closest point moves faster than the point for which it is
// computed. Beyond this ratio it has jumped to another part of the surface. [chosen: large enough
// for folds]
constexpr double kRunMax = 8;
constexpr double kJumpMin = 0.002;  // m; a smaller jump is a crease, not another part [chosen]

// A hand cannot follow a kink of the surface faster than it can move (about 10 Hz), so the path
// over the surface is averaged over this time. [chosen]
constexpr int kSmoothSamples = 15;  // on each side: 60 ms in total

// Motion between two waypoints: a quintic with given velocities and zero acceleration at its ends.
// With zero velocities it is the minimum-jerk stroke of human reaching [M Flash, Hogan 1985].
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

// Averages each point of a stretch over its neighbours. Towards the ends there are fewer
// neighbours, and the end points do not change.
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

driver::Error no_path_error(const HandWaypoint& from, const HandWaypoint& to) {
  std::ostringstream text;
  text << "hand.path: there is no path from t = " << from.time << " s to " << to.time
       << " s over \"" << *from.on
       << "\", whose parts are not connected there; add a waypoint in between.";
  return {text.str()};
}

// Returns the fraction of the path that the hand has covered after the fraction `s` of the time.
// The hand is at rest at both ends.
double minimum_jerk(double s) {
  return s * s * s * (10 + s * (6 * s - 15));
}

// Polyline, evaluated at a fraction of its length.
class Polyline {
 public:
  explicit Polyline(std::vector<Vector3d> points) : points_(std::move(points)), length_to_{0} {
    for (std::size_t i = 1; i < points_.size(); ++i) {
      length_to_.push_back(length_to_.back() + (points_[i] - points_[i - 1]).norm());
    }
  }

  Vector3d at(double share) const {
    const double where = share * length_to_.back();
    const auto next = std::upper_bound(length_to_.begin() + 1, length_to_.end() - 1, where);
    const auto i = static_cast<std::size_t>(next - length_to_.begin());
    const double length = length_to_[i] - length_to_[i - 1];
    const double part = length > 0 ? std::min((where - length_to_[i - 1]) / length, 1.0) : 0;
    return points_[i - 1] + part * (points_[i] - points_[i - 1]);
  }

 private:
  std::vector<Vector3d> points_;
  std::vector<double> length_to_;  // length up to each point, m
};

// Path of the hand where the straight path jumps.
struct Detour {
  Polyline path;
  bool on_surface = false;
};

// Plans one route. `takes_detour_` holds the stretches that take a detour, because the straight
// path jumps there.
class Plan {
 public:
  Plan(const std::vector<HandWaypoint>& waypoints, const std::vector<NamedMesh>& objects)
      : waypoints_(waypoints), takes_detour_(waypoints.size(), false) {
    for (const NamedMesh& object : objects) {
      const auto [at, fresh] = probes_.try_emplace(object.name, *object.mesh_W);
      if (fresh) routes_.try_emplace(object.name, *object.mesh_W, at->second);
    }
  }

  driver::Result<HandRoute> run() {
    if (auto known = check(); !known) return known.error();
    // Free stretches that end on the surface lead to the pressed point, not to the closest point.
    for (const HandWaypoint& w : waypoints_) {
      targets_.push_back(w.on ? pressed(probes_.at(*w.on).closest(w.p_W), w.press) : w.p_W);
    }
    // Each iteration finds one more stretch that jumps.
    for (;;) {
      const std::size_t jumps_at = try_once();
      if (jumps_at == waypoints_.size()) return std::move(route_);
      if (takes_detour_[jumps_at]) {
        return no_path_error(waypoints_[jumps_at], waypoints_[jumps_at + 1]);
      }
      takes_detour_[jumps_at] = true;
    }
  }

 private:
  static Vector3d pressed(const SurfacePoint& point, double press) {
    return point.p_WS - press * point.n_W;
  }

  driver::Result<void> check() const {
    if (waypoints_.empty()) return driver::Error{"hand.path is empty; add waypoints."};
    for (std::size_t i = 1; i < waypoints_.size(); ++i) {
      if (waypoints_[i].time > waypoints_[i - 1].time) continue;
      std::ostringstream text;
      text << "hand.path: t = " << waypoints_[i].time << " s follows t = " << waypoints_[i - 1].time
           << " s; times must increase.";
      return driver::Error{text.str()};
    }
    for (const HandWaypoint& w : waypoints_) {
      if (w.on && !probes_.contains(*w.on)) {
        return driver::Error{"hand.path: \"" + *w.on + "\" is not an object of the scene."};
      }
    }
    return {};
  }

  // Returns the velocity at waypoint `i`: zero if the hand rests there, else the mean over its
  // neighbours.
  Vector3d speed_at(std::size_t i) const {
    const auto& w = waypoints_;
    if (i == 0 || i + 1 == w.size() || w[i].stop) return Vector3d::Zero();
    if (takes_detour_[i - 1] || takes_detour_[i]) return Vector3d::Zero();
    if (follows_surface(w[i - 1], w[i]) != follows_surface(w[i], w[i + 1])) return Vector3d::Zero();
    return (w[i + 1].p_W - w[i - 1].p_W) / (w[i + 1].time - w[i - 1].time);
  }

  // Plans all stretches. Returns the first that cannot be planned as it is, or the number of
  // waypoints.
  std::size_t try_once() {
    route_ = {{waypoints_.front().time, targets_.front()}};
    std::size_t run_begin =
        0;  // index in the route at which the present stretch on the surface begins
    for (std::size_t i = 0; i + 1 < waypoints_.size(); ++i) {
      const HandWaypoint& to = waypoints_[i + 1];
      const bool on_surface = follows_surface(waypoints_[i], to);
      if (!(takes_detour_[i] ? take_detour(i) : go_straight(i))) return i;
      const bool continues = i + 2 < waypoints_.size() && follows_surface(to, waypoints_[i + 2]);
      if (on_surface && !(continues && !to.stop)) smooth(route_, run_begin, route_.size() - 1);
      if (!on_surface || to.stop) run_begin = route_.size() - 1;
    }
    return waypoints_.size();
  }

  static int steps_of(double time) {
    return std::max(1, static_cast<int>(std::ceil(time / kSampleTime)));
  }

  bool go_straight(std::size_t i) {
    const HandWaypoint& from = waypoints_[i];
    const HandWaypoint& to = waypoints_[i + 1];
    const bool on_surface = follows_surface(from, to);
    const Quintic path{on_surface ? from.p_W : targets_[i], on_surface ? to.p_W : targets_[i + 1],
                       speed_at(i), speed_at(i + 1), to.time - from.time};
    const int steps = steps_of(path.time);
    SurfaceProbe* const probe = on_surface ? &probes_.at(*from.on) : nullptr;
    SurfacePoint last;
    if (probe) last = probe->closest(path.at(0));
    for (int step = 1; step <= steps; ++step) {
      const double s = static_cast<double>(step) / steps;
      const double time = from.time + s * path.time;
      Vector3d p_WH = path.at(s);
      if (probe) {
        const double asked = (p_WH - path.at(static_cast<double>(step - 1) / steps)).norm();
        const SurfacePoint point = probe->closest(p_WH);
        if (!((point.p_WS - last.p_WS).norm() <= std::max(kRunMax * asked, kJumpMin))) return false;
        last = point;
        p_WH = pressed(point, from.press + minimum_jerk(s) * (to.press - from.press));
      }
      route_.emplace_back(step == steps ? to.time : time, p_WH);
    }
    return true;
  }

  // Finds a path over the surface if it is connected there, else through the space between its
  // parts.
  std::optional<Detour> find_detour(std::size_t i) {
    const HandWaypoint& from = waypoints_[i];
    const HandWaypoint& to = waypoints_[i + 1];
    SurfaceRoute& route = routes_.at(*from.on);
    std::vector<Vector3d> points = route.over_surface(from.p_W, to.p_W);
    if (!points.empty()) return Detour{Polyline(std::move(points)), true};
    points = route.through_free_space(targets_[i], targets_[i + 1]);
    if (points.empty()) return {};
    points.front() = targets_[i];
    points.back() = targets_[i + 1];
    return Detour{Polyline(std::move(points)), false};
  }

  bool take_detour(std::size_t i) {
    const HandWaypoint& from = waypoints_[i];
    const HandWaypoint& to = waypoints_[i + 1];
    if (!detours_.contains(i)) {
      std::optional<Detour> found = find_detour(i);
      if (!found) return false;
      detours_.emplace(i, std::move(*found));
    }
    const Detour& detour = detours_.at(i);
    const int steps = steps_of(to.time - from.time);
    for (int step = 1; step <= steps; ++step) {
      const double s = static_cast<double>(step) / steps;
      Vector3d p_WH = detour.path.at(minimum_jerk(s));
      if (detour.on_surface) {
        const SurfacePoint point = probes_.at(*from.on).closest(p_WH);
        p_WH = pressed(point, from.press + minimum_jerk(s) * (to.press - from.press));
      }
      route_.emplace_back(step == steps ? to.time : from.time + s * (to.time - from.time), p_WH);
    }
    return true;
  }

  const std::vector<HandWaypoint>& waypoints_;
  std::vector<bool> takes_detour_;  // by the waypoint at which a stretch begins
  std::map<std::string, SurfaceProbe> probes_;
  std::map<std::string, SurfaceRoute> routes_;
  std::map<std::size_t, Detour> detours_;  // found detours, by the waypoint at which they begin
  std::vector<Vector3d> targets_;
  HandRoute route_;
};

}  // namespace

driver::Result<HandRoute> plan_hand(const std::vector<HandWaypoint>& waypoints,
                                    const std::vector<NamedMesh>& objects) {
  return Plan(waypoints, objects).run();
}

}  // namespace thimble::scene
