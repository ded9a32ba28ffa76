#include "hand/surface_route.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "mesh/file/weld_mesh.h"
#include "mesh/mesh_edges.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

// Edges longer than this fraction of the mesh get additional points that a path may pass. [chosen:
// an edge of a cube has eight]
constexpr double kLongEdge = 1.0 / 16;
constexpr int kEdgePointsMax = 8;

// Step of a path as a fraction of the mesh, and number of straightening passes. [chosen: paths over
// a sphere of 2,000 triangles are within 2 % of great circles]
constexpr double kStep = 1.0 / 200;
constexpr int kStraighteningPasses = 30;

// Number of grid points along each axis for paths through free space, in the box of the mesh with a
// margin. [chosen: openings of a thirtieth of the mesh are found]
constexpr int kGrid = 40;
constexpr double kGridMargin = 0.1;  // margin as a fraction of the box's diagonal

std::vector<Vector3d> resampled(const std::vector<Vector3d>& path, double step) {
  std::vector<Vector3d> points{path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const int pieces =
        std::max(1, static_cast<int>(std::ceil((path[i] - path[i - 1]).norm() / step)));
    for (int k = 1; k <= pieces; ++k) {
      points.push_back(path[i - 1] + (path[i] - path[i - 1]) * (static_cast<double>(k) / pieces));
    }
  }
  return points;
}

// Grid of points in space. A point is tested only when a path reaches it.
class FreeGrid {
 public:
  FreeGrid(const Vector3d& origin, const Vector3d& step,
           std::function<bool(const Vector3d&)> is_free)
      : origin_(origin), step_(step), is_free_(std::move(is_free)) {}

  // Returns the shortest path over free neighbouring points, diagonals included; empty if there is
  // none.
  std::vector<Vector3d> find(const Vector3d& from, const Vector3d& to) {
    constexpr int kCells = kGrid * kGrid * kGrid;
    const int start = free_cell_at(from), goal = free_cell_at(to);
    if (start < 0 || goal < 0) return {};
    std::vector<double> length(kCells, std::numeric_limits<double>::infinity());
    std::vector<int> before(kCells, -1);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    length[static_cast<std::size_t>(start)] = 0;
    open.emplace(0, start);
    while (!open.empty()) {
      const int cell = open.top().second;
      open.pop();
      if (cell == goal) break;
      for_each_neighbour(cell, [&](int next) {
        const double reached =
            length[static_cast<std::size_t>(cell)] + (place(next) - place(cell)).norm();
        if (!(reached < length[static_cast<std::size_t>(next)]) || !is_free_(place(next))) return;
        length[static_cast<std::size_t>(next)] = reached;
        before[static_cast<std::size_t>(next)] = cell;
        open.emplace(reached + (place(next) - place(goal)).norm(), next);
      });
    }
    std::vector<Vector3d> path;
    if (goal != start && before[static_cast<std::size_t>(goal)] < 0) return path;
    for (int cell = goal; cell >= 0; cell = before[static_cast<std::size_t>(cell)]) {
      path.push_back(place(cell));
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

 private:
  Vector3d place(int cell) const {
    const Vector3d index(cell % kGrid, cell / kGrid % kGrid, cell / (kGrid * kGrid));
    return origin_ + (index + Vector3d::Constant(0.5)).cwiseProduct(step_);
  }

  template <class Take>
  void for_each_neighbour(int cell, Take take) const {
    const int x = cell % kGrid, y = cell / kGrid % kGrid, z = cell / (kGrid * kGrid);
    for (int k = std::max(z - 1, 0); k <= std::min(z + 1, kGrid - 1); ++k) {
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, kGrid - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, kGrid - 1); ++i) {
          if (i != x || j != y || k != z) take(i + kGrid * (j + kGrid * k));
        }
      }
    }
  }

  // Returns the free cell nearest to a point, among the cells around it; -1 if none is free.
  int free_cell_at(const Vector3d& p) const {
    const Vector3d index = (p - origin_).cwiseQuotient(step_);
    std::array<int, 3> at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at[axis] =
          static_cast<int>(std::clamp(index[static_cast<Eigen::Index>(axis)], 0.0, kGrid - 1.0));
    }
    const int cell = at[0] + kGrid * (at[1] + kGrid * at[2]);
    if (is_free_(place(cell))) return cell;
    int best = -1;
    for_each_neighbour(cell, [&](int next) {
      const bool nearer = best < 0 || (place(next) - p).norm() < (place(best) - p).norm();
      if (nearer && is_free_(place(next))) best = next;
    });
    return best;
  }

  const Vector3d origin_, step_;
  const std::function<bool(const Vector3d&)> is_free_;
};

}  // namespace

/// Graph of the corners of a surface and of points on its long edges. Two nodes are connected if
/// one triangle contains both.
class SurfaceRoute::Graph {
 public:
  Graph(const render::TriangleMesh& mesh_W, double size)
      : mesh_(render::weld_mesh(mesh_W)),
        points_(mesh_.vertices),
        nodes_of_(mesh_.triangles.size()) {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      nodes_of_[t].assign(mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    }
    const std::vector<render::EdgeUse> uses = render::sorted_edge_uses(mesh_);
    for (std::size_t begin = 0; begin < uses.size();) {
      const std::size_t end = render::end_of_edge(uses, begin);
      const Vector3d from = points_[static_cast<std::size_t>(uses[begin].low)];
      const Vector3d edge = points_[static_cast<std::size_t>(uses[begin].high)] - from;
      const int count =
          std::min(kEdgePointsMax, static_cast<int>(edge.norm() / (kLongEdge * size)));
      for (int k = 1; k <= count; ++k) {
        for (std::size_t i = begin; i < end; ++i) {
          nodes_of_[static_cast<std::size_t>(uses[i].triangle)].push_back(
              static_cast<std::int32_t>(points_.size()));
        }
        points_.push_back(from + edge * (static_cast<double>(k) / (count + 1)));
      }
      begin = end;
    }
    triangles_of_.resize(points_.size());
    for (std::size_t t = 0; t < nodes_of_.size(); ++t) {
      for (const std::int32_t node : nodes_of_[t]) {
        triangles_of_[static_cast<std::size_t>(node)].push_back(static_cast<std::int32_t>(t));
      }
    }
  }

  // Returns the shortest path over the nodes between two triangles; empty if there is none.
  // Algorithm: E. W. Dijkstra, 1959, with the straight distance to the goal as lower bound (P.
  // Hart, N. Nilsson, B. Raphael, 1968).
  std::vector<Vector3d> find(const SurfacePoint& from, const SurfacePoint& to) const {
    std::vector<double> length(points_.size(), std::numeric_limits<double>::infinity());
    std::vector<std::int32_t> before(points_.size(), -1);
    using Entry = std::pair<double, std::int32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto reach = [&](std::int32_t node, double how_far, std::int32_t via) {
      const auto n = static_cast<std::size_t>(node);
      if (!(how_far < length[n])) return;
      length[n] = how_far;
      before[n] = via;
      open.emplace(how_far + (points_[n] - to.p_WS).norm(), node);
    };
    for (const std::int32_t node : nodes_of_[from.triangle]) {
      reach(node, (points_[static_cast<std::size_t>(node)] - from.p_WS).norm(), -1);
    }
    const auto& goals = nodes_of_[to.triangle];
    while (!open.empty()) {
      const auto [bound, node] = open.top();
      open.pop();
      const auto n = static_cast<std::size_t>(node);
      if (std::find(goals.begin(), goals.end(), node) != goals.end()) {
        std::vector<Vector3d> path{to.p_WS};
        for (std::int32_t at = node; at >= 0; at = before[static_cast<std::size_t>(at)]) {
          path.push_back(points_[static_cast<std::size_t>(at)]);
        }
        path.push_back(from.p_WS);
        std::reverse(path.begin(), path.end());
        return path;
      }
      if (bound > length[n] + (points_[n] - to.p_WS).norm())
        continue;  // a shorter path was found since
      for (const std::int32_t t : triangles_of_[n]) {
        for (const std::int32_t next : nodes_of_[static_cast<std::size_t>(t)]) {
          reach(next, length[n] + (points_[static_cast<std::size_t>(next)] - points_[n]).norm(),
                node);
        }
      }
    }
    return {};
  }

 private:
  const render::TriangleMesh mesh_;  // same triangles as the mesh in the world, with corners welded
  std::vector<Vector3d> points_;
  std::vector<std::vector<std::int32_t>> nodes_of_;      // points of each triangle
  std::vector<std::vector<std::int32_t>> triangles_of_;  // triangles at each point
};

SurfaceRoute::SurfaceRoute(const render::TriangleMesh& mesh_W, SurfaceProbe& probe)
    : mesh_(mesh_W), probe_(probe) {
  for (const Vector3d& p : mesh_W.vertices) box_.extend(p);
  size_ = box_.diagonal().norm();
  const Vector3d beyond = Vector3d::Constant(kGridMargin * size_);
  box_ = {box_.min() - beyond, box_.max() + beyond};
}

SurfaceRoute::~SurfaceRoute() = default;

std::vector<Vector3d> SurfaceRoute::over_surface(const Vector3d& p_from, const Vector3d& p_to) {
  if (!graph_) graph_ = std::make_unique<Graph>(mesh_, size_);
  const SurfacePoint from = probe_.closest(p_from);
  const SurfacePoint to = probe_.closest(p_to);
  if (from.triangle == to.triangle) return resampled({from.p_WS, to.p_WS}, kStep * size_);
  std::vector<Vector3d> path = graph_->find(from, to);
  if (path.empty()) return path;
  path = resampled(path, kStep * size_);
  straighten(path);
  return path;
}

// Moves each point to the closest point of the surface to the midpoint of its neighbours, if that
// is near enough.
void SurfaceRoute::straighten(std::vector<Vector3d>& path) {
  for (int pull = 0; pull < kStraighteningPasses; ++pull) {
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
      const Vector3d p = probe_.closest((path[i - 1] + path[i + 1]) / 2).p_WS;
      const double reach = 2 * kStep * size_;
      if ((p - path[i - 1]).norm() <= reach && (p - path[i + 1]).norm() <= reach) path[i] = p;
    }
  }
}

std::vector<Vector3d> SurfaceRoute::through_free_space(const Vector3d& p_from,
                                                       const Vector3d& p_to) {
  const SurfacePoint from = probe_.closest(p_from);
  const SurfacePoint to = probe_.closest(p_to);
  FreeGrid grid(box_.min(), box_.sizes() / kGrid,
                [this](const Vector3d& p) { return is_outside(p); });
  const double above = box_.sizes().maxCoeff() / kGrid;
  std::vector<Vector3d> path = grid.find(from.p_WS + above * from.n_W, to.p_WS + above * to.n_W);
  if (path.empty()) return path;
  path.insert(path.begin(), from.p_WS);
  path.push_back(to.p_WS);
  // Removes all corners that free space does not need.
  std::vector<Vector3d> corners{path.front()};
  for (std::size_t i = 0; i + 1 < path.size();) {
    std::size_t next = path.size() - 1;
    while (next > i + 1 && !is_free(path[i], path[next])) --next;
    corners.push_back(path[next]);
    i = next;
  }
  return corners;
}

bool SurfaceRoute::is_outside(const Vector3d& p_W) {
  const SurfacePoint near = probe_.closest(p_W);
  return near.n_W.dot(p_W - near.p_WS) >= -1e-9 * size_;
}

// Returns whether all points along a line are outside, as seen from the closest surface.
bool SurfaceRoute::is_free(const Vector3d& p_from, const Vector3d& p_to) {
  const std::vector<Vector3d> points = resampled({p_from, p_to}, kStep * size_);
  return std::all_of(points.begin(), points.end(),
                     [this](const Vector3d& p) { return is_outside(p); });
}

}  // namespace thimble::scene
