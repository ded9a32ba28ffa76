#include "thimble/render/mesh/repair_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

#include "mesh/mesh_edges.h"
#include "mesh/repair/fill_holes.h"
#include "mesh/repair/open_edges.h"
#include "mesh/repair/orient_mesh.h"
#include "mesh/repair/split_fans.h"
#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Kind = RepairChange::Kind;

// A larger tolerance would weld whole fingers of a scanned hand together.
constexpr double kToleranceMax = 0.01;

// Dropping a triangle may open a seam whose closing makes another one. After this number of rounds
// it does not converge.
constexpr int kRoundsMax = 16;

// Repairs one mesh; each function does the step in its name and reports it.
class Repair {
 public:
  Repair(const TriangleMesh& mesh, const RepairOptions& options)
      : options_(options), before_(mesh), origin_(mesh.triangles.size()) {
    done_.mesh = mesh;
    std::iota(origin_.begin(), origin_.end(), 0);
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : mesh.vertices) {
      if (p.allFinite()) box.extend(p);
    }
    const double share = options.tolerance > 0 ? std::min(options.tolerance, kToleranceMax) : 0;
    tolerance_ = box.isEmpty() ? 0 : share * box.diagonal().norm();
  }

  RepairedMesh run() {
    if (options_.drop) drop_broken();
    for (int round = 0; round < kRoundsMax; ++round) {
      const std::size_t before = changes();
      if (options_.weld && tolerance_ > 0) weld();
      if (options_.drop) drop_degenerate();
      if (options_.drop) drop_duplicates();
      if (options_.close_seams && tolerance_ > 0) close();
      if (changes() == before) break;
    }
    if (options_.split_vertices) split();
    const std::size_t whole = done_.mesh.triangles.size();
    if (options_.hole_share > 0 && options_.drop) fill();
    if (options_.orient) orient();
    if (options_.drop) drop_unused();
    std::sort(done_.changes.begin(), done_.changes.end(),
              [](const RepairChange& a, const RepairChange& b) { return a.kind < b.kind; });
    // No later step removes or reorders triangles.
    std::fill(origin_.begin() + static_cast<std::ptrdiff_t>(whole), origin_.end(), -1);
    done_.origins = std::move(origin_);
    return std::move(done_);
  }

 private:
  const Vector3d& at(std::int32_t vertex) const {
    return done_.mesh.vertices[static_cast<std::size_t>(vertex)];
  }

  static std::string text(const Vector3d& p) {
    std::ostringstream stream;
    stream << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
    return stream.str();
  }

  std::string vertex_text(std::int32_t vertex) const {
    return "vertex " + std::to_string(vertex) + " at " + text(at(vertex));
  }

  std::string triangle_text(std::size_t t) const {
    std::string words = "triangle " + std::to_string(origin_[t]);
    const auto old = static_cast<std::size_t>(origin_[t]);
    if (has_three_vertices(before_, old)) {
      const auto& [a, b, c] = before_.triangles[old];
      words += " near " + text((at(a) + at(b) + at(c)) / 3);
    }
    return words;
  }

  template <class Where>
  void record(Kind kind, Where where) {
    for (RepairChange& change : done_.changes) {
      if (change.kind == kind) {
        ++change.count;
        return;
      }
    }
    done_.changes.push_back({kind, 1, where()});
  }

  std::size_t changes() const {
    std::size_t sum = 0;
    for (const RepairChange& change : done_.changes) sum += change.count;
    return sum;
  }

  // Drops the triangles for which `is_bad` holds; it is called once each, in order.
  template <class IsBad>
  void drop(Kind kind, IsBad is_bad) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < done_.mesh.triangles.size(); ++t) {
      if (is_bad(t)) {
        record(kind, [&] { return triangle_text(t); });
        continue;
      }
      done_.mesh.triangles[kept] = done_.mesh.triangles[t];
      origin_[kept++] = origin_[t];
    }
    done_.mesh.triangles.resize(kept);
    origin_.resize(kept);
  }

  void drop_broken() {
    const auto size = static_cast<std::int64_t>(done_.mesh.vertices.size());
    drop(Kind::kDroppedBroken, [&](std::size_t t) {
      const auto& triangle = done_.mesh.triangles[t];
      return std::any_of(triangle.begin(), triangle.end(),
                         [&](std::int32_t v) { return v < 0 || v >= size || !at(v).allFinite(); });
    });
  }

  void weld() {
    for (const std::int32_t vertex : weld_open_edges(done_.mesh, tolerance_)) {
      record(Kind::kWeldedVertex, [&] { return vertex_text(vertex); });
    }
  }

  void drop_degenerate() {
    drop(Kind::kDroppedDegenerate, [&](std::size_t t) {
      if (!has_three_vertices(done_.mesh, t)) return true;
      const auto& [a, b, c] = done_.mesh.triangles[t];
      const Vector3d ab = at(b) - at(a);
      const Vector3d ac = at(c) - at(a);
      const double longest = std::max({ab.stableNorm(), ac.stableNorm(), (ac - ab).stableNorm()});
      // Same criterion as check_mesh.
      return !(ab.cross(ac).stableNorm() > kFlatness * longest * longest);
    });
  }

  void drop_duplicates() {
    std::set<std::array<std::int32_t, 3>> seen;
    drop(Kind::kDroppedDuplicate, [&](std::size_t t) {
      auto sorted = done_.mesh.triangles[t];
      std::sort(sorted.begin(), sorted.end());
      return !seen.insert(sorted).second;
    });
  }

  void close() {
    for (const std::int32_t t : close_seams(done_.mesh, tolerance_, origin_)) {
      record(Kind::kClosedSeam, [&] { return triangle_text(static_cast<std::size_t>(t)); });
    }
  }

  void split() {
    const SplitFans done = split_fans(done_.mesh, origin_);
    for (const std::int32_t v : done.vertices)
      record(Kind::kSplitVertex, [&] { return vertex_text(v); });
    for (const std::int32_t t : done.turned) {
      record(Kind::kTurnedTriangle, [&] { return triangle_text(static_cast<std::size_t>(t)); });
    }
    for (const std::int32_t t : done.parted_edges) {
      record(Kind::kPartedEdge, [&] { return triangle_text(static_cast<std::size_t>(t)); });
    }
  }

  void fill() {
    for (const FilledHole& hole : fill_holes(done_.mesh, options_.hole_share, origin_)) {
      record(Kind::kFilledHole, [&] {
        std::ostringstream words;
        words << hole.edges << " edges, " << hole.width << " wide, around " << text(hole.middle);
        return words.str();
      });
    }
  }

  void orient() {
    const OrientReport report = orient_mesh(done_.mesh);
    const auto first = static_cast<std::size_t>(report.first_turned);
    for (std::size_t i = 0; i < report.turned_triangles; ++i) {
      record(Kind::kTurnedTriangle, [&] { return triangle_text(first); });
    }
  }

  void drop_unused() {
    TriangleMesh& mesh = done_.mesh;
    std::vector<std::int32_t> number(mesh.vertices.size(), -1);
    for (const auto& triangle : mesh.triangles) {
      for (const std::int32_t v : triangle) number[static_cast<std::size_t>(v)] = 0;
    }
    // Vertices that were welded have been reported already.
    std::vector<bool> used_before(number.size(), false);
    for (const auto& triangle : before_.triangles) {
      for (const std::int32_t v : triangle) {
        if (v >= 0 && static_cast<std::size_t>(v) < number.size()) {
          used_before[static_cast<std::size_t>(v)] = true;
        }
      }
    }
    std::size_t kept = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] < 0) {
        if (!used_before[v]) {
          record(Kind::kDroppedVertex, [&] { return vertex_text(static_cast<std::int32_t>(v)); });
        }
        continue;
      }
      number[v] = static_cast<std::int32_t>(kept);
      mesh.vertices[kept++] = mesh.vertices[v];
    }
    mesh.vertices.resize(kept);
    for (auto& triangle : mesh.triangles) {
      for (std::int32_t& v : triangle) v = number[static_cast<std::size_t>(v)];
    }
  }

  const RepairOptions options_;
  const TriangleMesh& before_;
  std::vector<std::int32_t> origin_;  // original number of each triangle or of its whole
  double tolerance_ = 0;              // in the mesh's unit
  RepairedMesh done_;
};

}  // namespace

RepairedMesh repair_mesh(const TriangleMesh& mesh, const RepairOptions& options) {
  return Repair(mesh, options).run();
}

std::string describe(const RepairChange& change) {
  const auto words = [&change]() -> std::pair<const char*, const char*> {
    switch (change.kind) {
      case Kind::kDroppedBroken:
        return {"triangle without three finite vertices was dropped",
                "triangles without three finite vertices were dropped"};
      case Kind::kWeldedVertex:
        return {"vertex was merged with another within the tolerance",
                "vertices were merged with others within the tolerance"};
      case Kind::kDroppedDegenerate:
        return {"triangle with no area was dropped", "triangles with no area were dropped"};
      case Kind::kDroppedDuplicate:
        return {"triangle that repeats another one was dropped",
                "triangles that repeat others were dropped"};
      case Kind::kClosedSeam:
        return {"open edge was split to meet the vertices next to it",
                "open edges were split to meet the vertices next to them"};
      case Kind::kSplitVertex:
        return {"vertex that joined parts was duplicated",
                "vertices that joined parts were duplicated"};
      case Kind::kPartedEdge:
        return {"edge where bodies touch was separated", "edges where bodies touch were separated"};
      case Kind::kFilledHole:
        return {"hole was filled", "holes were filled"};
      case Kind::kTurnedTriangle:
        return {"triangle was reversed", "triangles were reversed"};
      case Kind::kDroppedVertex:
        return {"vertex that no triangle uses was dropped",
                "vertices that no triangle uses were dropped"};
    }
    return {"change of an unknown kind", "changes of an unknown kind"};
  }();
  std::string sentence = std::to_string(change.count) + " ";
  sentence += change.count == 1 ? words.first : words.second;
  if (!change.where.empty()) {
    sentence += (change.count == 1 ? " (" : " (the first: ") + change.where + ")";
  }
  return sentence + ".";
}

}  // namespace thimble::render
