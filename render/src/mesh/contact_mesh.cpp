#include "mesh/contact_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "mesh/adjacency.h"
#include "mesh/parallel_split.h"
#include "mesh/repair/checked_mesh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// A distance is three products and three sums of numbers no larger than the mesh, each wrong by
// 2^-53 of it, from a normal wrong by a few 2^-53: 64 x 2^-53 of the size covers them with room.
constexpr double kDepthRounding = 64 * 0x1p-53;

// The sum of two unit normals below which the faces are back to back. The direction of their
// average is then rounding, and the plane is put along the faces instead. At 1e-7 the direction
// would still be good to 1e-9.
constexpr double kOpposite = 1e-7;

Vector3d unit_normal(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return (b - a).cross(c - a).stableNormalized();
}

std::uint16_t rounded_up(double sine) {
  return static_cast<std::uint16_t>(
      std::min(std::ceil(sine * TriangleCell::kSineUnit), TriangleCell::kSineUnit));
}

}  // namespace

// The face of `n_first` has the shared edge upwards: from `from` along `edge`.
struct ContactMesh::EdgeSides {
  Vector3d from, edge, n_first, n_second;
  bool turned;  // for the triangle that has it downwards

  // Normal to the plane, positive on the side of the first face; of any length.
  Vector3d across() const noexcept { return (n_first + n_second).cross(edge); }

  // The length of `across`; 0 if the normal is the first face's. Of faces back to back with no
  // matter between, the first keeps everything outside its face; a gap of no width is treated the
  // same.
  double size() const noexcept {
    if (!((n_first + n_second).norm() > kOpposite)) return 0;
    const Vector3d wide = across();
    // By its largest component, so that no square overflows or underflows.
    const double most = wide.cwiseAbs().maxCoeff();
    const double squared = (wide / most).squaredNorm();
    return squared > 0 ? std::sqrt(squared) * most : 1;
  }

  Plane plane(double size) const noexcept {
    const Vector3d n = size > 0 ? Vector3d(across() / size) : n_first;
    const double d = -n.dot(from);
    return turned ? Plane{-n, -d} : Plane{n, d};
  }
};

template <class Work>
void ContactMesh::for_all(const Work& work) const {
  parallel_split(triangles_.size(), [&work](std::size_t begin, std::size_t end) noexcept {
    for (std::size_t t = begin; t < end; ++t) work(static_cast<std::int32_t>(t));
  });
}

driver::Result<ContactMesh> ContactMesh::build(const TriangleMesh& mesh,
                                               const ContactMeshOptions& options) {
  const auto neighbours = find_adjacency(mesh);
  auto looked = check_contact_mesh_async(mesh, neighbours, options.orient);
  // The findings of the check are reported, whatever else is wrong.
  std::optional<ContactMesh> contact;
  if (neighbours) contact = assemble(mesh, *neighbours, options);
  auto sound = looked.get();
  if (!sound) return sound.error();
  if (sound->turned) {
    const auto turned = find_adjacency(*sound->turned);
    if (!turned) return turned.error();
    contact = assemble(*sound->turned, *turned, options);
    contact->orientation_ = std::move(sound->orientation);
  } else if (!neighbours) {
    return neighbours.error();
  }
  return std::move(*contact);
}

ContactMesh ContactMesh::assemble(const TriangleMesh& mesh, const Adjacency& neighbours,
                                  const ContactMeshOptions& options) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.vertices) {
    if (p.allFinite()) box.extend(p);
  }
  ContactMesh contact;
  contact.vertices_ = mesh.vertices;
  contact.triangles_ = mesh.triangles;
  contact.cells_.resize(contact.triangles_.size());
  for (std::size_t t = 0; t < contact.cells_.size(); ++t) {
    contact.cells_[t].neighbours = neighbours[t];
  }
  const Vector3d size = box.isEmpty() ? Vector3d(0, 0, 0) : Vector3d(box.max() - box.min());
  const Vector3d low = box.isEmpty() ? Vector3d(0, 0, 0) : Vector3d(box.min());
  const Vector3d room = Vector3d::Constant(std::max(options.room, 0.0) * size.maxCoeff());
  contact.box_min_ = low - room;
  contact.box_max_ = (box.isEmpty() ? low : Vector3d(box.max())) + room;
  contact.origin_ = low + size / 2;
  // Far from the world's origin the vertices themselves carry the rounding of their place.
  contact.depth_rounding_ = kDepthRounding * ((size + 2 * room).norm() + contact.origin_.norm());
  contact.for_all([&contact](std::int32_t t) noexcept { contact.compute_face(t); });
  contact.collect_fans();
  if (options.edge_planes) {
    if (options.keep_planes) {
      contact.compute_edges();
    } else {
      contact.compute_edge_sizes();
    }
    contact.for_all([&contact](std::int32_t t) noexcept { contact.measure_edges(t); });
    contact.measure_around();
  }
  if (options.triangles_max > contact.triangles_.size()) contact.make_room(options.triangles_max);
  return contact;
}

void ContactMesh::move_vertex(std::int32_t vertex, const Vector3d& p_W) noexcept {
  moved_ = true;
  vertices_[static_cast<std::size_t>(vertex)] = p_W;
  for (const std::int32_t t : fan(vertex)) compute_face(t);
  for (const std::int32_t t : fan(vertex)) {
    for (std::size_t k = 0; k < 3; ++k) compute_edge(t, k);
  }
}

void ContactMesh::compute_face(std::int32_t triangle) noexcept {
  Plane& face = cells_[static_cast<std::size_t>(triangle)].face;
  face.n = unit_normal(position(triangle, 0), position(triangle, 1), position(triangle, 2));
  face.d = -face.n.dot(position(triangle, 0) - origin_);
}

void ContactMesh::compute_edge(std::int32_t triangle, std::size_t k) noexcept {
  const std::int32_t other = place_edge(triangle, k);
  measure_edges(triangle);
  measure_edges(other);
}

// Computes the plane over an edge and stores the same numbers in both triangles, whichever is
// given. Returns the triangle behind it.
std::int32_t ContactMesh::place_edge(std::int32_t triangle, std::size_t k) noexcept {
  const std::int32_t other = cell(triangle).neighbours[k];
  const std::int32_t from = corners(triangle)[k];
  const std::int32_t to = corners(triangle)[(k + 1) % 3];
  std::size_t j = 0;
  while (j < 2 && !(corners(other)[j] == to && corners(other)[(j + 1) % 3] == from)) ++j;
  const Plane plane = made_edge_plane(triangle, k);
  edges_[static_cast<std::size_t>(triangle)][k] = plane;
  edges_[static_cast<std::size_t>(other)][j] = {-plane.n, -plane.d};
  return other;
}

// Computed for the triangle that has the edge upwards, so that both have the same numbers.
ContactMesh::EdgeSides ContactMesh::edge_sides(std::int32_t triangle,
                                               std::size_t k) const noexcept {
  const std::int32_t other = cell(triangle).neighbours[k];
  const std::int32_t from = corners(triangle)[k];
  const std::int32_t to = corners(triangle)[(k + 1) % 3];
  const bool upwards = from < to;
  const std::int32_t low = upwards ? from : to;
  const std::int32_t high = upwards ? to : from;
  return {.from = position(low) - origin_,
          .edge = position(high) - position(low),
          .n_first = cell(upwards ? triangle : other).face.n,
          .n_second = cell(upwards ? other : triangle).face.n,
          .turned = !upwards};
}

Plane ContactMesh::made_edge_plane(std::int32_t triangle, std::size_t k) const noexcept {
  const EdgeSides sides = edge_sides(triangle, k);
  return sides.plane(edge_sizes_.empty() ? sides.size()
                                         : edge_sizes_[static_cast<std::size_t>(triangle)][k]);
}

void ContactMesh::compute_edge_sizes() {
  edge_sizes_.resize(triangles_.size());
  for_all([this](std::int32_t t) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      edge_sizes_[static_cast<std::size_t>(t)][k] = edge_sides(t, k).size();
    }
  });
}

void ContactMesh::compute_edges() {
  edges_.resize(triangles_.size());
  for_all([this](std::int32_t t) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      // Each edge is done once, by the triangle that has it upwards.
      if (corners(t)[k] < corners(t)[(k + 1) % 3]) place_edge(t, k);
    }
  });
}

// An edge plane leans over its face by half the angle there: backwards if the edge is concave.
void ContactMesh::measure_edges(std::int32_t triangle) noexcept {
  TriangleCell& measured = cells_[static_cast<std::size_t>(triangle)];
  double concave = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double lean = edge_plane(triangle, k).n.dot(measured.face.n);
    if (lean < -TriangleCell::kFlat) concave = std::max(concave, -lean);
  }
  measured.concave = rounded_up(concave);
}

void ContactMesh::collect_fans() {
  std::vector<std::uint32_t> counts(vertices_.size(), 0);
  for (const auto& triangle : triangles_) {
    for (const std::int32_t v : triangle) ++counts[static_cast<std::size_t>(v)];
  }
  fan_of_.reserve(vertices_.size());
  std::uint64_t begin = 0;
  for (const std::uint32_t count : counts) {
    fan_of_.emplace_back(begin, 0);
    begin += count;
  }
  fans_.resize(3 * triangles_.size());
  fans_built_ = fans_.size();
  for (std::int32_t t = 0; t < triangle_count(); ++t) {
    for (const std::int32_t v : corners(t)) {
      Fan& fan = fan_of_[static_cast<std::size_t>(v)];
      fans_[fan.begin() + fan.count()] = t;
      fan = {fan.begin(), fan.count() + 1};
    }
  }
}

// Half the difference of two unit normals is the sine of half the angle between them.
void ContactMesh::measure_around() {
  for_all([this](std::int32_t triangle) noexcept {
    TriangleCell& measured = cells_[static_cast<std::size_t>(triangle)];
    double max_squared = 0;
    for (const std::int32_t v : corners(triangle)) {
      const auto around = fan(v);
      if (around.size() > TriangleCell::kFanMax) max_squared = 4;
      if (max_squared == 4) break;
      for (const std::int32_t t : around) {
        max_squared = std::max(max_squared, (cell(t).face.n - measured.face.n).squaredNorm());
      }
    }
    measured.around = rounded_up(std::sqrt(max_squared) / 2);
  });
}

}  // namespace thimble::render
