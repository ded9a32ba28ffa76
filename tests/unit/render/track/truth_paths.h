#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "mesh/contact_mesh.h"
#include "search/contact_search.h"
#include "support/random.h"

namespace thimble::render {

using Eigen::Vector3d;

/// A path and the reference results along it.
struct Path {
  std::vector<Vector3d> tips;     // NaN: the tip is removed
  std::vector<double> distances;  // to the closest point of the mesh, m; below 0 outside
  std::vector<Vector3d> outs;     // unit directions to it
};

/// Start of a path: from just above the middle of a random triangle to just below it.
struct PathBegin {
  Vector3d above, below, n;
  bool free = false;  // no other sheet of the mesh is in between
};

inline PathBegin random_begin(const ContactMesh& mesh, const ContactSearch& search,
                              support::Random& random) {
  const auto t =
      static_cast<std::int32_t>(random.bits() % static_cast<std::uint64_t>(mesh.triangle_count()));
  const Vector3d middle = (mesh.position(t, 0) + mesh.position(t, 1) + mesh.position(t, 2)) / 3;
  const Vector3d n = mesh.cell(t).face.n;
  PathBegin entry{.above = middle + 1e-5 * n, .below = middle - 1e-5 * n, .n = n};
  entry.free = !search.inside(entry.above) && search.inside(entry.below);
  return entry;
}

/// Returns a path 0.2 to 1 mm below the surface that is independent of any tracker: it uses the
/// closest point of all triangles. Restarts at a random triangle every 500 ticks.
inline Path skin_path(const ContactMesh& mesh, const ContactSearch& search, int ticks, double step,
                      std::uint64_t seed) {
  support::Random random(seed);
  Path path;
  Vector3d p(0, 0, 0), heading(1, 0, 0);
  const auto add = [&](const Vector3d& tip) {
    path.tips.push_back(tip);
    const SurfacePoint near = search.closest(tip, std::numeric_limits<double>::infinity());
    path.distances.push_back(search.inside(tip) ? near.distance : -near.distance);
    path.outs.push_back((near.p_W - tip).normalized());
  };
  bool begun = false;
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick % 500 == 0 || !begun) {
      const PathBegin entry = random_begin(mesh, search, random);
      p = entry.below;
      begun = entry.free;
      if (!begun) continue;
      path.tips.push_back(Vector3d::Constant(std::nan("")));
      path.distances.push_back(0);
      path.outs.push_back({0, 0, 0});
      add(entry.above);
      add(p);
      heading = random.direction();
      continue;
    }
    const SurfacePoint near = search.closest(p, std::numeric_limits<double>::infinity());
    const Vector3d out = near.distance > 0 ? Vector3d((near.p_W - p) / near.distance)
                                           : mesh.cell(near.triangle).face.n;
    heading += 0.3 * random.direction();
    heading = (heading - heading.dot(out) * out).normalized();
    const double wanted = 6e-4 + 4e-4 * std::sin(0.01 * tick);
    Vector3d next = p + step * heading;
    const SurfacePoint there = search.closest(next, std::numeric_limits<double>::infinity());
    if (there.distance > 0) {
      const double side = search.inside(next) ? 1 : -1;
      const Vector3d to = side * (there.p_W - next) / there.distance;
      next += (side * there.distance - wanted) * to;
    }
    const Vector3d moved = next - p;
    p += std::min(1.0, step / moved.norm()) * moved;
    // Never outside: a tip outside has no contact to lose.
    if (!search.inside(p)) {
      begun = false;
      continue;
    }
    add(p);
  }
  return path;
}

/// Returns a path from the surface to places all over the body and back.
inline Path deep_path(const ContactMesh& mesh, const ContactSearch& search, int ticks,
                      std::uint64_t seed) {
  support::Random random(seed);
  Path path;
  Vector3d p(0, 0, 0), heading(0, 0, 0), goal(0, 0, 0);
  double step = 0;
  bool begun = false;
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick % 500 == 0 || !begun) {
      const PathBegin entry = random_begin(mesh, search, random);
      heading = -entry.n;
      p = entry.below;
      begun = entry.free;
      if (!begun) continue;
      path.tips.push_back(Vector3d::Constant(std::nan("")));
      path.tips.push_back(entry.above);
      path.tips.push_back(p);
      path.distances.insert(path.distances.end(), {0, -1e-5, 1e-5});
      path.outs.insert(path.outs.end(), 3, -heading);
      goal = mesh.box_min() + (mesh.box_max() - mesh.box_min())
                                  .cwiseProduct(Vector3d(0.5, 0.5, 0.5) + random.in_box(0.4));
      step = 5e-4 * std::pow(0.02, random.uniform(0, 1));
      continue;
    }
    heading = (heading + 0.15 * random.direction() + 0.05 * (goal - p).normalized()).normalized();
    p += step * heading;
    if (!search.inside(p)) {
      begun = false;
      continue;
    }
    path.tips.push_back(p);
    const SurfacePoint near = search.closest(p, std::numeric_limits<double>::infinity());
    path.distances.push_back(near.distance);
    path.outs.push_back((near.p_W - p).normalized());
  }
  return path;
}

}  // namespace thimble::render
