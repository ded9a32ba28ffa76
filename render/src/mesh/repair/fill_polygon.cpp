#include "mesh/repair/fill_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "mesh/file/triangulate_polygon.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::int32_t, 3>;
using Taken = std::function<bool(std::int32_t, std::int32_t)>;

// A ring within this share of its size from its mean plane is closed as a flat one.
constexpr double kFlat = 1e-3;

// Maximum size of a ring for which all triangulations are compared, which takes its cube.
constexpr std::size_t kWholeMax = 64;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

Vector3d normal_of(const HoleRing& ring, std::int32_t a, std::int32_t b, std::int32_t c) {
  const Vector3d& p = ring.corners[index(a)];
  return (ring.corners[index(b)] - p).cross(ring.corners[index(c)] - p);
}

// Returns whether three corners with this normal (twice the area) make a triangle.
bool has_area(const HoleRing& ring, std::int32_t a, std::int32_t b, std::int32_t c,
              double twice_area) {
  const Vector3d &p = ring.corners[index(a)], &q = ring.corners[index(b)],
                 &r = ring.corners[index(c)];
  const double longest =
      std::max({(q - p).squaredNorm(), (r - q).squaredNorm(), (p - r).squaredNorm()});
  return twice_area > kFillFlatness * longest;
}

bool is_flat(const HoleRing& ring) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : ring.corners) middle += p;
  middle /= static_cast<double>(ring.corners.size());
  Vector3d normal = Vector3d::Zero();
  double size = 0;
  for (std::size_t i = 0; i < ring.corners.size(); ++i) {
    const Vector3d& next = ring.corners[(i + 1) % ring.corners.size()];
    normal += (ring.corners[i] - middle).cross(next - middle);
    size = std::max(size, (ring.corners[i] - middle).norm());
  }
  const double length = normal.norm();
  if (!(length > 0)) return false;
  return std::all_of(ring.corners.begin(), ring.corners.end(), [&](const Vector3d& p) {
    return std::abs(normal.dot(p - middle)) <= kFlat * size * length;
  });
}

// Returns whether no triangle joins corners that are joined already, and each has an area.
bool may_stand(const HoleRing& ring, const std::vector<Triangle>& triangles, const Taken& taken) {
  const auto count = static_cast<std::int32_t>(ring.corners.size());
  for (const Triangle& t : triangles) {
    if (!has_area(ring, t[0], t[1], t[2], normal_of(ring, t[0], t[1], t[2]).norm())) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      const bool side = (a + 1) % count == b || (b + 1) % count == a;
      if (!side && taken(a, b)) return false;
    }
  }
  return true;
}

// Quality of a triangulation of a ring: the cosine of its sharpest bend, then its area.
struct Merit {
  double bend = 1;  // cosine; 1 for none
  double area = 0;

  bool better_than(const Merit& other) const {
    return bend > other.bend || (bend == other.bend && area < other.area);
  }
  Merit with(const Merit& other) const { return {std::min(bend, other.bend), area + other.area}; }
};

// The best triangulation of the part of a ring between two corners, for every two of them.
class Best {
 public:
  Best(const HoleRing& ring, std::vector<std::int32_t> kept, std::vector<Vector3d> beside,
       const Taken& taken)
      : ring_(ring),
        kept_(std::move(kept)),
        beside_(std::move(beside)),
        taken_(taken),
        size_(kept_.size()),
        ways_(size_ * size_) {}

  std::vector<Triangle> run() {
    for (std::size_t span = 2; span < size_; ++span) {
      for (std::size_t from = 0; from + span < size_; ++from) close(from, from + span);
    }
    std::vector<Triangle> triangles;
    if (at(0, size_ - 1).middle == 0) return triangles;
    collect(0, size_ - 1, triangles);
    return triangles;
  }

 private:
  struct Way {
    Merit merit;
    std::size_t middle = 0;  // third corner of the triangle over the chord; 0 for none
    Vector3d normal{0, 0, 0};
  };

  Way& at(std::size_t from, std::size_t to) { return ways_[from * size_ + to]; }

  // Normal behind a chord: of the triangle of its best triangulation, or of the triangle next to
  // the ring.
  const Vector3d& behind(std::size_t from, std::size_t to) {
    return to == from + 1 ? beside_[from] : at(from, to).normal;
  }

  void close(std::size_t from, std::size_t to) {
    const bool whole = from == 0 && to + 1 == size_;
    if (!whole && taken_(kept_[from], kept_[to])) return;
    Way best;
    for (std::size_t middle = from + 1; middle < to; ++middle) {
      const bool open = (middle > from + 1 && at(from, middle).middle == 0) ||
                        (to > middle + 1 && at(middle, to).middle == 0);
      if (open) continue;
      Vector3d normal = normal_of(ring_, kept_[from], kept_[middle], kept_[to]);
      const double area = normal.norm();
      if (!has_area(ring_, kept_[from], kept_[middle], kept_[to], area)) continue;
      normal /= area;
      Merit merit{std::min(normal.dot(behind(from, middle)), normal.dot(behind(middle, to))), area};
      if (whole) merit.bend = std::min(merit.bend, normal.dot(beside_[to]));
      if (middle > from + 1) merit = merit.with(at(from, middle).merit);
      if (to > middle + 1) merit = merit.with(at(middle, to).merit);
      if (best.middle == 0 || merit.better_than(best.merit)) best = {merit, middle, normal};
    }
    at(from, to) = best;
  }

  void collect(std::size_t from, std::size_t to, std::vector<Triangle>& triangles) {
    std::vector<std::pair<std::size_t, std::size_t>> chords{{from, to}};
    while (!chords.empty()) {
      const auto [a, b] = chords.back();
      chords.pop_back();
      if (b == a + 1) continue;
      const std::size_t middle = at(a, b).middle;
      triangles.push_back({kept_[a], kept_[middle], kept_[b]});
      chords.emplace_back(a, middle);
      chords.emplace_back(middle, b);
    }
  }

  const HoleRing& ring_;
  const std::vector<std::int32_t> kept_;  // remaining corners of the ring, in order
  const std::vector<Vector3d> beside_;    // behind the side from each of them to the next
  const Taken& taken_;
  const std::size_t size_;
  std::vector<Way> ways_;
};

// Cuts corners off until few enough are left to compare all triangulations, those with the least
// bend first.
bool cut_corners(const HoleRing& ring, const Taken& taken, std::vector<std::int32_t>& kept,
                 std::vector<Vector3d>& beside, std::vector<Triangle>& triangles) {
  while (kept.size() > kWholeMax) {
    double best = -std::numeric_limits<double>::infinity();
    std::size_t ear = 0;
    Vector3d ear_normal = Vector3d::Zero();
    const std::size_t count = kept.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t last = (i + count - 1) % count, next = (i + 1) % count;
      Vector3d normal = normal_of(ring, kept[last], kept[i], kept[next]);
      const double area = normal.norm();
      if (!has_area(ring, kept[last], kept[i], kept[next], area)) continue;
      if (taken(kept[last], kept[next])) continue;
      normal /= area;
      const Vector3d to_last = ring.corners[index(kept[last])] - ring.corners[index(kept[i])];
      const Vector3d to_next = ring.corners[index(kept[next])] - ring.corners[index(kept[i])];
      // A narrow corner that is flat is cut first: it meets nothing else of the ring.
      const double narrow = to_last.normalized().dot(to_next.normalized());
      const double merit = std::min(normal.dot(beside[last]), normal.dot(beside[i])) + narrow;
      if (merit > best) {
        best = merit;
        ear = i;
        ear_normal = normal;
      }
    }
    if (!std::isfinite(best)) return false;
    const std::size_t last = (ear + count - 1) % count;
    triangles.push_back({kept[last], kept[ear], kept[(ear + 1) % count]});
    beside[last] = ear_normal;
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(ear));
    beside.erase(beside.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return true;
}

}  // namespace

std::vector<Triangle> fill_polygon(const HoleRing& ring, const Taken& taken) {
  std::vector<std::int32_t> kept(ring.corners.size());
  std::iota(kept.begin(), kept.end(), 0);
  std::vector<Triangle> triangles;
  if (kept.size() > 3 && is_flat(ring)) {
    const bool cut = triangulate_polygon(ring.corners, kept, triangles);
    if (cut && may_stand(ring, triangles, taken)) return triangles;
    triangles.clear();
  }
  std::vector<Vector3d> beside = ring.beside;
  if (!cut_corners(ring, taken, kept, beside, triangles)) return {};
  const std::vector<Triangle> rest = Best(ring, kept, beside, taken).run();
  if (rest.empty()) return {};
  triangles.insert(triangles.end(), rest.begin(), rest.end());
  return may_stand(ring, triangles, taken) ? triangles : std::vector<Triangle>();
}

}  // namespace thimble::render
