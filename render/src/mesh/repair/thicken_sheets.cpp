#include "thimble/render/mesh/thicken_sheets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "mesh/mesh_edges.h"
#include "mesh/repair/fill_polygon.h"
#include "mesh/repair/orient_mesh.h"
#include "mesh/repair/sheet_wedges.h"
#include "mesh/vertex_normals.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Maximum offset of a corner, in half thicknesses, to keep the faces around it apart by one.
constexpr double kMiterMax = 2;

// Vertices of triangles without area are moved by this share of half the thickness, along
// alternating axes, until they have one.
constexpr double kNudge = 1e-3;
constexpr int kNudgesMax = 6;

// A face of the thin body may turn against its source face by at most this cosine.
constexpr double kTurnedMin = 0.2;

// Maximum number of times that corners are pulled back to half, where faces would turn over.
constexpr int kPullBackMax = 24;

// Makes thin bodies of the chosen triangles of a mesh.
class Thickening {
 public:
  Thickening(const CutMesh& cut, std::vector<std::int32_t> chosen, std::span<const EdgeUse> uses,
             double thickness)
      : mesh_(cut.mesh),
        chosen_(std::move(chosen)),
        half_(thickness / 2),
        groups_(join_corners(cut.mesh, uses, cut.sources)) {
    for_each_edge(cut.mesh, uses, cut.sources, [this](const EdgeUse& edge, const auto& wedges) {
      if (wedges.empty()) open_.push_back(edge);
    });
  }

  void run(TriangleMesh& thin, double& thinnest) {
    make_vertices();
    make_sides();
    make_rims();
    make_caps();
    pull_back();
    nudge();
    write(thin);
    for (const double length : lengths_) thinnest = std::min(thinnest, 2 * length);
  }

 private:
  Vector3d face_normal(std::size_t side) const {
    const auto& [a, b, c] = mesh_.triangles[side / 2];
    const Vector3d n = (at(b) - at(a)).cross(at(c) - at(a)).stableNormalized();
    return side % 2 == 0 ? n : Vector3d(-n);
  }

  const Vector3d& at(std::int32_t v) const { return mesh_.vertices[static_cast<std::size_t>(v)]; }

  // Returns the vertex of the thin body for a corner of a side.
  std::int32_t vertex_at(std::int32_t corner) {
    return number_[static_cast<std::size_t>(groups_.find(corner))];
  }

  // Places a vertex for each group of corners along the mean of its faces.
  void make_vertices() {
    number_.assign(6 * mesh_.triangles.size(), -1);
    for_each_corner([this](std::size_t side, std::size_t k, std::int32_t corner) {
      const auto root = static_cast<std::size_t>(groups_.find(corner));
      if (number_[root] < 0) {
        number_[root] = static_cast<std::int32_t>(from_.size());
        from_.push_back(at(mesh_.triangles[side / 2][k]));
        ways_.push_back(Vector3d::Zero());
        lengths_.push_back(half_);
        firsts_.push_back(side);
      }
      const auto& corners = mesh_.triangles[side / 2];
      const Vector3d& p = at(corners[k]);
      const double angle = corner_angle(at(corners[(k + 1) % 3]) - p, at(corners[(k + 2) % 3]) - p);
      ways_[static_cast<std::size_t>(number_[root])] += angle * face_normal(side);
    });
    for (std::size_t v = 0; v < ways_.size(); ++v) {
      const double length = ways_[v].norm();
      ways_[v] = length > 1e-6 ? Vector3d(ways_[v] / length) : way_between(v);
    }
    std::vector<double> lean(ways_.size(), 1);  // cosine of the face that leans away most
    for_each_corner([&](std::size_t side, std::size_t, std::int32_t corner) {
      const auto v = static_cast<std::size_t>(vertex_at(corner));
      lean[v] = std::min(lean[v], face_normal(side).dot(ways_[v]));
    });
    for (std::size_t v = 0; v < ways_.size(); ++v) {
      ways_[v] /= std::max(lean[v], 1 / kMiterMax);
    }
  }

  // Faces on top of each other have no way out: their vertex goes between them, into the first.
  Vector3d way_between(std::size_t vertex) const {
    Vector3d in = Vector3d::Zero();
    for (const std::int32_t v : mesh_.triangles[firsts_[vertex] / 2]) in += at(v) - from_[vertex];
    return in.stableNormalized();
  }

  template <class Do>
  void for_each_corner(Do do_corner) {
    for (const std::int32_t t : chosen_) {
      for (std::size_t side = 2 * static_cast<std::size_t>(t), end = side + 2; side < end; ++side) {
        for (std::size_t k = 0; k < 3; ++k) {
          do_corner(side, k, static_cast<std::int32_t>(3 * side + k));
        }
      }
    }
  }

  void make_sides() {
    for (const std::int32_t t : chosen_) {
      const auto front = static_cast<std::int32_t>(6 * t);
      triangles_.push_back({vertex_at(front), vertex_at(front + 1), vertex_at(front + 2)});
      triangles_.push_back({vertex_at(front + 3), vertex_at(front + 5), vertex_at(front + 4)});
    }
    sides_ = triangles_.size();
  }

  void add(std::int32_t a, std::int32_t b, std::int32_t c) {
    if (a != b && b != c && c != a) triangles_.push_back({a, b, c});
  }

  // Joins front and back along open edges. Sides left open at the ends of a rim are recorded.
  void make_rims() {
    for (const EdgeUse& use : open_) {
      const std::size_t front = 2 * static_cast<std::size_t>(use.triangle);
      const std::int32_t from = use.upward ? use.low : use.high;
      const std::int32_t to = use.upward ? use.high : use.low;
      const std::int32_t front_from = vertex_at(corner_of(mesh_, front, from));
      const std::int32_t front_to = vertex_at(corner_of(mesh_, front, to));
      const std::int32_t back_from = vertex_at(corner_of(mesh_, front + 1, from));
      const std::int32_t back_to = vertex_at(corner_of(mesh_, front + 1, to));
      add(front_to, front_from, back_from);
      add(front_to, back_from, back_to);
      if (front_from != back_from) ends_[front_from] = back_from;
      if (front_to != back_to) ends_[back_to] = front_to;
    }
  }

  // Where rims of three or more fans meet, their ends form a polygon: closes it.
  void make_caps() {
    while (!ends_.empty()) {
      std::vector<std::int32_t> ring{ends_.begin()->first};
      for (auto next = ends_.begin(); next != ends_.end(); next = ends_.find(ring.back())) {
        const std::int32_t to = next->second;
        ends_.erase(next);
        if (to == ring.front()) break;
        ring.push_back(to);
      }
      for (std::size_t i = 1; i + 1 < ring.size(); ++i) add(ring[0], ring[i + 1], ring[i]);
    }
  }

  Vector3d place(std::int32_t v) const {
    const auto i = static_cast<std::size_t>(v);
    return from_[i] + lengths_[i] * ways_[i];
  }

  // Halves the offset of corners around faces that would turn over, until none does.
  void pull_back() {
    for (int round = 0; round < kPullBackMax; ++round) {
      std::vector<bool> halve(lengths_.size(), false);
      for (std::size_t i = 0; i < sides_; ++i) {
        const auto& [a, b, c] = triangles_[i];
        const Vector3d n = (place(b) - place(a)).cross(place(c) - place(a)).stableNormalized();
        const std::size_t side = 2 * static_cast<std::size_t>(chosen_[i / 2]) + i % 2;
        if (n.dot(face_normal(side)) > kTurnedMin) continue;
        for (const std::int32_t v : triangles_[i]) halve[static_cast<std::size_t>(v)] = true;
      }
      if (std::find(halve.begin(), halve.end(), true) == halve.end()) return;
      for (std::size_t v = 0; v < halve.size(); ++v) {
        if (halve[v]) lengths_[v] /= 2;
      }
    }
  }

  // Faces on top of each other leave rims and caps of no area.
  void nudge() {
    for (int round = 0; round < kNudgesMax; ++round) {
      std::vector<bool> flat(from_.size(), false);
      for (const auto& [a, b, c] : triangles_) {
        const Vector3d ab = place(b) - place(a), ac = place(c) - place(a);
        const double longest =
            std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
        if (ab.cross(ac).norm() > kFillFlatness * longest) continue;
        for (const std::int32_t v : {a, b, c}) flat[static_cast<std::size_t>(v)] = true;
      }
      if (std::find(flat.begin(), flat.end(), true) == flat.end()) return;
      for (std::size_t v = 0; v < flat.size(); ++v) {
        if (!flat[v]) continue;
        // Different for any three vertices of a triangle.
        const auto axis = static_cast<Eigen::Index>((v + static_cast<std::size_t>(round)) % 3);
        from_[v][axis] += kNudge * half_ * (1 + static_cast<double>(v % 7));
      }
    }
  }

  void write(TriangleMesh& thin) const {
    const auto first = static_cast<std::int32_t>(thin.vertices.size());
    for (std::size_t v = 0; v < from_.size(); ++v) {
      thin.vertices.push_back(place(static_cast<std::int32_t>(v)));
    }
    for (const auto& [a, b, c] : triangles_) {
      thin.triangles.push_back({first + a, first + b, first + c});
    }
  }

  const TriangleMesh& mesh_;
  const std::vector<std::int32_t> chosen_;
  const double half_;
  Groups groups_;                     // of corners that become one vertex
  std::vector<std::int32_t> number_;  // of the vertex, per root of a group
  std::vector<EdgeUse> open_;
  // Per vertex: its source position, the direction and length of its offset, and a side that it
  // belongs to.
  std::vector<Vector3d> from_, ways_;
  std::vector<double> lengths_;
  std::vector<std::size_t> firsts_;
  std::vector<std::array<std::int32_t, 3>> triangles_;  // sides first, front and back alternating
  std::size_t sides_ = 0;
  std::map<std::int32_t, std::int32_t> ends_;  // sides of the polygons at the ends of rims
};

}  // namespace

ThickenedMesh thicken_sheets(const TriangleMesh& whole, double thickness) {
  ThickenedMesh done;
  const CutMesh cut = with_ambiguous_edges_cut(whole);
  const TriangleMesh& mesh = cut.mesh;
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  const MeshComponents parts = find_components(mesh, uses);
  const auto is_open = [&parts](std::int32_t t) {
    return !parts.closed[static_cast<std::size_t>(parts.component_of[static_cast<std::size_t>(t)])];
  };
  std::vector<std::int32_t> chosen;
  done.mesh.vertices = mesh.vertices;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangles.size()); ++t) {
    if (is_open(t)) {
      chosen.push_back(t);
    } else {
      done.mesh.triangles.push_back(mesh.triangles[static_cast<std::size_t>(t)]);
    }
  }
  done.report.sheets =
      static_cast<std::size_t>(std::count(parts.closed.begin(), parts.closed.end(), false));
  done.report.triangles = chosen.size();
  done.report.thinnest = thickness;
  if (chosen.empty()) return done;
  std::vector<EdgeUse> open_uses;
  std::copy_if(uses.begin(), uses.end(), std::back_inserter(open_uses),
               [&is_open](const EdgeUse& use) { return is_open(use.triangle); });
  Thickening(cut, std::move(chosen), open_uses, thickness).run(done.mesh, done.report.thinnest);
  return done;
}

std::string describe(const SheetReport& report, const std::string& unit) {
  if (report.sheets == 0) return {};
  std::ostringstream text;
  text << report.sheets << (report.sheets == 1 ? " part is" : " parts are")
       << " not closed and treated as " << (report.sheets == 1 ? "a sheet" : "sheets") << " of "
       << report.triangles << (report.triangles == 1 ? " triangle" : " triangles") << ", "
       << report.thinnest << " " << unit << " thick at the thinnest place.";
  return text.str();
}

}  // namespace thimble::render
