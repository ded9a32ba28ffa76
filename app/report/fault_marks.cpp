#include "report/fault_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include "report/picture_style.h"

namespace thimble::report {
namespace {

using Eigen::Vector3d;
using render::MeshFault;
using Kind = render::MeshFault::Kind;

enum class Sign { kLine, kCircle, kDiamond, kSquare };

// Appearance of one kind. One hue per family, distinguishable by colour-blind people [M Okabe and
// Ito]: holes vermilion, more than two triangles purple, winding blue, no area black, repeated
// green.
struct Look {
  Kind kind;
  Sign sign;
  const char* ink;
  const char* pale;  // if hidden by the mesh
  const char* one;
  const char* many;
};

constexpr std::array<Look, 7> kLooks{
    {{Kind::kOpenEdge, Sign::kLine, "#d55e00", "#e8b48a", "open edge", "open edges"},
     {Kind::kNonManifoldEdge, Sign::kLine, "#8e2a8b", "#c9a3c8", "edge of 3+ triangles",
      "edges of 3+ triangles"},
     {Kind::kFlippedEdge, Sign::kLine, "#0072b2", "#94bfd9", "flipped edge", "flipped edges"},
     {Kind::kDuplicateTriangle, Sign::kLine, "#00805f", "#93c4b4", "repeated triangle",
      "repeated triangles"},
     {Kind::kDegenerateTriangle, Sign::kCircle, "#16181c", "#9a9da3", "triangle with no area",
      "triangles with no area"},
     {Kind::kNonManifoldVertex, Sign::kDiamond, "#8e2a8b", "#c9a3c8", "vertex joining parts",
      "vertices joining parts"},
     {Kind::kInsideOut, Sign::kSquare, "#0072b2", "#94bfd9", "part inside out",
      "parts inside out"}}};

constexpr double kPiece = 0.01;  // of the longest side: edges are hidden piece by piece
constexpr int kPiecesMax = 100;

// A few short edges are hard to find on a picture: up to this number, each gets a ring.
constexpr std::size_t kRingedMax = 12;
constexpr double kRingedPieces = 5;  // a longer line (in pieces) is visible without a ring

// Returns gnuplot's point type.
int point_type(Sign sign) {
  switch (sign) {
    case Sign::kCircle:
      return 6;
    case Sign::kDiamond:
      return 12;
    case Sign::kSquare:
    case Sign::kLine:
      break;
  }
  return 4;
}

const MeshFault* fault_of(const render::MeshFindings& found, Kind kind) {
  for (const MeshFault& fault : found.faults) {
    if (fault.kind == kind && !fault.places.empty()) return &fault;
  }
  return nullptr;
}

bool is_ringed(const Look& look, const MeshFault& fault) {
  return look.sign == Sign::kLine && fault.count <= kRingedMax;
}

// Collects points and lines in one view, hidden and visible ones separately.
class Blocks {
 public:
  Blocks(const MeshView& view, double tolerance, double piece)
      : view_(view), tolerance_(tolerance), piece_(piece) {}

  void add_point(const Vector3d& p) { stream(p) << line(p) << '\n'; }

  void add_line(const Vector3d& a, const Vector3d& b) {
    const double wanted = std::ceil((b - a).norm() / piece_);
    const int pieces = static_cast<int>(std::clamp(wanted, 1.0, double{kPiecesMax}));
    for (int i = 0; i < pieces; ++i) {
      const Vector3d from = a + (b - a) * i / pieces;
      const Vector3d to = a + (b - a) * (i + 1) / pieces;
      stream((from + to) / 2) << line(from) << line(to) << '\n';
    }
  }

  std::string text() const {
    return "nan nan\n\n" + hidden_.str() + "\n\nnan nan\n\n" + seen_.str() + "\n\n";
  }

 private:
  std::ostringstream& stream(const Vector3d& p) {
    return view_.hides(p, tolerance_) ? hidden_ : seen_;
  }

  std::string line(const Vector3d& p) const {
    const Eigen::Vector2d uv = view_.project(p);
    return number(uv.x()) + ' ' + number(uv.y()) + '\n';
  }

  const MeshView& view_;
  const double tolerance_;
  const double piece_;
  std::ostringstream hidden_, seen_;
};

void add_place(const render::FaultPlace& place, const render::TriangleMesh& mesh, Sign sign,
               Blocks& blocks) {
  std::vector<Vector3d> points;
  for (const std::int32_t v : place) {
    if (v < 0 || static_cast<std::size_t>(v) >= mesh.vertices.size()) continue;
    points.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    if (!points.back().allFinite()) return;
  }
  if (points.empty()) return;
  if (sign != Sign::kLine) {
    Vector3d middle(0, 0, 0);
    for (const Vector3d& p : points) middle += p / static_cast<double>(points.size());
    blocks.add_point(middle);
    return;
  }
  for (std::size_t i = 1; i < points.size(); ++i) blocks.add_line(points[i - 1], points[i]);
  if (points.size() == 3) blocks.add_line(points[2], points[0]);
}

// Returns the largest distance of a fault's vertices.
double fault_size(const render::FaultPlace& place, const render::TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const std::int32_t v : place) {
    if (v >= 0 && static_cast<std::size_t>(v) < mesh.vertices.size()) {
      box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
    }
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

}  // namespace

bool has_marks(const render::MeshFindings& found) {
  return std::any_of(kLooks.begin(), kLooks.end(),
                     [&found](const Look& look) { return fault_of(found, look.kind) != nullptr; });
}

std::string fault_table(const render::MeshFindings& found, const render::TriangleMesh& mesh,
                        const MeshView& view, double tolerance) {
  const double piece = std::max(kPiece * (found.box_max - found.box_min).maxCoeff(), 1e-300);
  std::string text =
      "# u, v; four blocks per kind of fault: hidden, in sight, rings hidden, rings in sight\n";
  for (const Look& look : kLooks) {
    const MeshFault* fault = fault_of(found, look.kind);
    if (fault == nullptr) continue;
    Blocks blocks(view, tolerance, piece);
    Blocks rings(view, tolerance, piece);
    for (const render::FaultPlace& place : fault->places) {
      add_place(place, mesh, look.sign, blocks);
      const bool is_short = fault_size(place, mesh) <= kRingedPieces * piece;
      if (is_ringed(look, *fault) && is_short) add_place(place, mesh, Sign::kCircle, rings);
    }
    text += blocks.text() + rings.text();
  }
  return text;
}

std::string fault_clauses(const render::MeshFindings& found, const std::string& data) {
  std::ostringstream hidden, ground, seen;
  int block = 0;
  for (const Look& look : kLooks) {
    const MeshFault* fault = fault_of(found, look.kind);
    if (fault == nullptr) continue;
    const auto clause = [&](int index) {
      return ", '" + data + "' index " + std::to_string(index) + " using 1:2 with ";
    };
    if (look.sign == Sign::kLine) {
      hidden << clause(block) << "lines lw 1 lc rgb '" << look.pale << "'";
      ground << clause(block + 1) << "lines lw 5 lc rgb '#ffffff'";
      seen << clause(block + 1) << "lines lw 2.6 lc rgb '" << look.ink << "'";
    } else {
      const std::string points = "points pt " + std::to_string(point_type(look.sign));
      hidden << clause(block) << points << " ps 1.2 lw 1.2 lc rgb '" << look.pale << "'";
      ground << clause(block + 1) << points << " ps 1.7 lw 5 lc rgb '#ffffff'";
      seen << clause(block + 1) << points << " ps 1.7 lw 2.4 lc rgb '" << look.ink << "'";
    }
    if (is_ringed(look, *fault)) {
      hidden << clause(block + 2) << "points pt 6 ps 3.4 lw 1.2 lc rgb '" << look.pale << "'";
      seen << clause(block + 3) << "points pt 6 ps 3.4 lw 1.6 lc rgb '" << look.ink << "'";
    }
    block += 4;
  }
  return hidden.str() + ground.str() + seen.str();
}

std::string fault_legend(const render::MeshFindings& found, double x, double y) {
  constexpr double kCharacter = 0.0071;  // of the picture's width, mean width in this font
  std::ostringstream commands;
  int id = 100;
  for (const Look& look : kLooks) {
    const MeshFault* fault = fault_of(found, look.kind);
    if (fault == nullptr) continue;
    const std::string words =
        std::to_string(fault->count) + " " + (fault->count == 1 ? look.one : look.many);
    if (look.sign == Sign::kLine) {
      commands << "set arrow " << id << " from screen " << number(x) << ", screen " << number(y)
               << " to screen " << number(x + 0.017) << ", screen " << number(y)
               << " nohead lw 3.5 lc rgb '" << look.ink << "'\n";
    } else {
      commands << "set label " << id << " '' at screen " << number(x + 0.009) << ", screen "
               << number(y) << " point pt " << point_type(look.sign) << " ps 1.7 lw 2.4 lc rgb '"
               << look.ink << "'\n";
    }
    commands << "set label " << id + 1 << " " << quote(words) << " at screen " << number(x + 0.023)
             << ", screen " << number(y) << " noenhanced textcolor rgb '" << kInk << "'\n";
    x += 0.023 + kCharacter * static_cast<double>(words.size()) + 0.018;
    id += 2;
  }
  return commands.str();
}

std::string end_of_legend(const render::MeshFindings& found) {
  std::ostringstream commands;
  int id = 100;
  for (const Look& look : kLooks) {
    if (fault_of(found, look.kind) == nullptr) continue;
    commands << (look.sign == Sign::kLine ? "unset arrow " : "unset label ") << id
             << "\nunset label " << id + 1 << "\n";
    id += 2;
  }
  return commands.str();
}

}  // namespace thimble::report
