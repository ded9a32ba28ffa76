#include "surface_turns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "math/elementary.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr auto kNone = static_cast<std::uint8_t>(SurfaceTurns::kClasses);

// In single precision, because a mesh of 10^5 triangles then fits into the cache. Normals are wrong
// by 6e-8, a hundred-thousandth of the chord of a flat edge.
struct Face {
  Eigen::Vector3f n{0, 0, 0};
  float area = 0;  // in the unit of `unit_area`; 0: absent
  // Classes of its least bent edge that is not flat, and of its least bent uneven edge.
  std::uint8_t curved = kNone, uneven = kNone;
};

// A side of a triangle that runs to a vertex with a larger number, listed with its begin.
struct Side {
  std::int32_t end = 0;
  std::int32_t triangle = 0;
};

bool exist(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& corners) {
  // A negative number is a very large one.
  const auto exists = [size = mesh.vertices.size()](std::int32_t vertex) {
    return static_cast<std::uint32_t>(vertex) < size;
  };
  return exists(corners[0]) && exists(corners[1]) && exists(corners[2]);
}

// Returns the square of the longest side of the box of all vertices, so that areas in this unit fit
// into single precision at any scale.
double unit_area(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
  const double side = mesh.vertices.empty() ? 0 : box.sizes().maxCoeff();
  return side * side;
}

std::vector<Face> faces_of(const TriangleMesh& mesh) {
  std::vector<Face> faces(mesh.triangles.size());
  const double unit = unit_area(mesh);
  for (std::size_t t = 0; t < faces.size(); ++t) {
    if (!exist(mesh, mesh.triangles[t])) continue;
    const auto at = [&](std::size_t k) -> const Vector3d& {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
    };
    const Vector3d across = (at(1) - at(0)).cross(at(2) - at(0));
    const double length = across.norm();
    const auto area = static_cast<float>(length / 2 / unit);
    // Written so that NaN and infinity count as absent.
    if (!(area > 0 && length < std::numeric_limits<double>::max())) continue;
    faces[t].n = (across / length).cast<float>();
    faces[t].area = area;
  }
  return faces;
}

// Chord between two directions of the last class.
double max_chord() {
  static const double chord = 2 * math::sin(SurfaceTurns::kMax / 2);
  return chord;
}

class Counter {
 public:
  Counter(const TriangleMesh& mesh, std::vector<Face>& faces, SurfaceTurns& turns)
      : mesh_(mesh), side_(std::sqrt(unit_area(mesh))), faces_(faces), turns_(turns) {}

  // Adds the edge of two triangles between the vertices `from` and `to`.
  void add(std::size_t one, std::size_t other, std::int32_t from, std::int32_t to) {
    Face& a = faces_[one];
    Face& b = faces_[other];
    const float square = (a.n - b.n).squaredNorm();
    if (square < kFlatSquare && is_flat(a, b, from, to, std::sqrt(double{square}))) return;
    const double at_edge = (double{a.area} + double{b.area}) / 3;
    const float place = std::sqrt(square) * per_chord_;
    if (!(place < static_cast<float>(SurfaceTurns::kClasses))) {
      turns_.sharp += at_edge;
      return;
    }
    const auto turn_class = static_cast<std::uint8_t>(place);
    turns_.edges[turn_class] += at_edge;
    a.curved = std::min(a.curved, turn_class);
    b.curved = std::min(b.curved, turn_class);
    constexpr auto kEven = static_cast<float>(SurfaceTurns::kEven);
    if (b.area < kEven * a.area) a.uneven = std::min(a.uneven, turn_class);
    if (a.area < kEven * b.area) b.uneven = std::min(b.uneven, turn_class);
  }

 private:
  static constexpr auto kFlatSquare =
      static_cast<float>(SurfaceTurns::kFlatChord * SurfaceTurns::kFlatChord);

  // Returns whether an edge with a small chord is flat. The triangles of a fine mesh turn little
  // however much its surface curves.
  bool is_flat(const Face& a, const Face& b, std::int32_t from, std::int32_t to,
               double chord) const {
    const auto at = [this](std::int32_t vertex) -> const Vector3d& {
      return mesh_.vertices[static_cast<std::size_t>(vertex)];
    };
    const double length = (at(to) - at(from)).norm() / side_;
    const double height_a = 2 * double{a.area} / length, height_b = 2 * double{b.area} / length;
    // The middle of a triangle is a third of its height above the edge. A vertex that is off by the
    // rounding tilts its triangle by that per height.
    if (chord < SurfaceTurns::kFlatCurvature * (height_a + height_b) / 3) return true;
    return chord < kTilts * SurfaceTurns::kRounding * (1 / height_a + 1 / height_b);
  }
  // The edge and the vertex of a triangle may be off, in opposite directions.
  static constexpr double kTilts = 2;

  const TriangleMesh& mesh_;
  double side_;
  std::vector<Face>& faces_;
  SurfaceTurns& turns_;
  float per_chord_ = static_cast<float>(static_cast<double>(SurfaceTurns::kClasses) / max_chord());
};

// Calls `take(from, to, triangle)` for each side of each triangle that has an area.
template <class Take>
void for_each_side(const TriangleMesh& mesh, const std::vector<Face>& faces, const Take& take) {
  for (std::size_t t = 0; t < faces.size(); ++t) {
    if (faces[t].area == 0) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    take(a, b, t);
    take(b, c, t);
    take(c, a, t);
  }
}

// The sides that run to a vertex with a larger number, by their begin.
class Sides {
 public:
  Sides(const TriangleMesh& mesh, const std::vector<Face>& faces)
      : begin_(mesh.vertices.size() + 2, 0) {
    // While sides are placed, the place of the next side of vertex v is at v + 1; it ends as the
    // begin of vertex v + 1.
    for_each_side(mesh, faces, [this](std::int32_t from, std::int32_t to, std::size_t) {
      if (from < to) ++begin_[static_cast<std::size_t>(from) + 2];
    });
    for (std::size_t v = 2; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    sides_.resize(begin_.back());
    for_each_side(mesh, faces, [this](std::int32_t from, std::int32_t to, std::size_t t) {
      if (from >= to) return;
      sides_[begin_[static_cast<std::size_t>(from) + 1]++] = {to, static_cast<std::int32_t>(t)};
    });
    for (std::size_t v = 0; v + 1 < begin_.size(); ++v) {
      if (begin_[v + 1] - begin_[v] <= kFew) continue;
      std::sort(sides_.begin() + begin_[v], sides_.begin() + begin_[v + 1], before);
    }
  }

  std::size_t size() const { return sides_.size(); }

  // Returns the triangle whose side runs from `from` to `to`, the larger number; -1 if there is
  // none.
  std::int32_t find(std::int32_t from, std::int32_t to) const {
    const auto v = static_cast<std::size_t>(from);
    auto side = sides_.begin() + begin_[v];
    const auto last = sides_.begin() + begin_[v + 1];
    if (last - side > static_cast<std::ptrdiff_t>(kFew)) {
      side = std::lower_bound(side, last, Side{to, 0}, before);
    } else {
      while (side != last && side->end != to) ++side;
    }
    return side != last && side->end == to ? side->triangle : -1;
  }

 private:
  // A vertex has few sides; those of a hub are sorted.
  static constexpr std::uint32_t kFew = 16;

  static bool before(const Side& a, const Side& b) {
    return a.end != b.end ? a.end < b.end : a.triangle < b.triangle;
  }

  std::vector<std::uint32_t> begin_;
  std::vector<Side> sides_;
};

}  // namespace

double SurfaceTurns::turn_of(std::size_t turn_class) {
  const double chord =
      max_chord() * static_cast<double>(turn_class + 1) / static_cast<double>(kClasses);
  return 2 * math::asin(chord / 2);
}

SurfaceTurns surface_turns(const TriangleMesh& mesh) {
  SurfaceTurns turns;
  std::vector<Face> faces = faces_of(mesh);
  const Sides sides(mesh, faces);
  Counter counter(mesh, faces, turns);
  std::size_t found = 0, sought = 0;
  for_each_side(mesh, faces, [&](std::int32_t from, std::int32_t to, std::size_t t) {
    if (from < to) return;
    ++sought;
    const std::int32_t other = sides.find(to, from);
    if (other < 0) return;
    ++found;
    counter.add(static_cast<std::size_t>(other), t, from, to);
  });
  turns.closed = found > 0 && found == sought && sought == sides.size();
  double area = 0;
  for (const Face& face : faces) {
    area += face.area;
    turns.triangles += face.area > 0 ? 1 : 0;
    if (face.curved < kNone) turns.curved[face.curved] += face.area;
    if (face.uneven < kNone) turns.uneven[face.uneven] += face.area;
  }
  if (!(area > 0)) return turns;
  for (std::size_t i = 0; i < SurfaceTurns::kClasses; ++i) {
    if (turns.edges[i] > 0) turns.classes_used = i + 1;
    turns.curved[i] /= area;
    turns.uneven[i] /= area;
    turns.edges[i] /= area;
  }
  turns.sharp /= area;
  return turns;
}

}  // namespace thimble::render
