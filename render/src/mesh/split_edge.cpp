// Splitting of edges of a ContactMesh without allocation.
#include <algorithm>
#include <bit>
#include <cstddef>

#include "mesh/contact_mesh.h"

namespace thimble::render {
namespace {

// Entries per possible triangle. The fan of a vertex moves to twice its room when it is full. So
// all places that a vertex has ever had are less than four of its last ones, and there are three of
// these per triangle. Most vertices move once; without room, nothing more is split. [chosen]
constexpr std::size_t kFanRoom = 8;

}  // namespace

void ContactMesh::make_room(std::size_t triangles_max) {
  triangles_max_ = triangles_max;
  vertices_.reserve(vertices_max());
  fan_of_.reserve(vertices_max());
  triangles_.reserve(triangles_max);
  cells_.reserve(triangles_max);
  edges_.reserve(triangles_max);
  fans_.reserve(fans_.size() + kFanRoom * triangles_max);
}

// Lists a triangle, of the highest number so far, at a vertex. Returns false if there is no room.
bool ContactMesh::add_to_fan(std::int32_t vertex, std::int32_t triangle) noexcept {
  Fan& fan = fan_of_[static_cast<std::size_t>(vertex)];
  const std::size_t count = fan.count();
  // A fan that has moved has room for the next power of two.
  if (fan.begin() < fans_built_ || std::has_single_bit(count)) {
    const std::size_t begin = fans_.size();
    const std::size_t room = std::bit_ceil(count + 1);
    if (fans_.capacity() - begin < room) return false;
    fans_.resize(begin + room, -1);
    std::copy_n(fans_.data() + fan.begin(), count, fans_.data() + begin);
    fan = {begin, count};
  }
  fans_[fan.begin() + count] = triangle;
  fan = {fan.begin(), count + 1};
  return true;
}

// Replaces old triangles by new ones at the end of the edge that has lost the old ones, in
// ascending order as everywhere.
void ContactMesh::change_fan(std::int32_t vertex, const EdgeSplit& split) noexcept {
  const Fan fan = fan_of_[static_cast<std::size_t>(vertex)];
  std::int32_t* const begin = fans_.data() + fan.begin();
  std::int32_t* end = begin + fan.count();
  for (const std::int32_t t : split.triangles) end = std::remove(begin, end, t);
  for (const std::int32_t t : split.others) *end++ = t;
}

EdgeSplit ContactMesh::split_edge(std::int32_t triangle, std::size_t k, bool keep_begin) noexcept {
  const std::int32_t behind = cell(triangle).neighbours[k];
  if (triangles_.size() + 2 > triangles_max_) return {};
  const std::int32_t a = corners(triangle)[k];
  const std::int32_t b = corners(triangle)[(k + 1) % 3];
  std::size_t j = 0;
  while (j < 2 && !(corners(behind)[j] == b && corners(behind)[(j + 1) % 3] == a)) ++j;
  const std::int32_t c = corners(triangle)[(k + 2) % 3];
  const std::int32_t d = corners(behind)[(j + 2) % 3];
  const bool more_than_one = c == d || cell(triangle).neighbours[(k + 1) % 3] == behind ||
                             cell(triangle).neighbours[(k + 2) % 3] == behind;
  const std::size_t fans_needed = 4 + 2 * std::bit_ceil(kValenceMax);
  if (more_than_one || fan(c).size() >= kValenceMax || fan(d).size() >= kValenceMax ||
      fans_.capacity() - fans_.size() < fans_needed) {
    return {};
  }

  const auto count = triangle_count();
  moved_ = true;  // new faces have other neighbours
  const EdgeSplit split{.vertex = vertex_count(),
                        .ends = {keep_begin ? a : b, keep_begin ? b : a},
                        .triangles = {triangle, behind},
                        .others = {count, count + 1}};
  const std::int32_t m = split.vertex;
  const auto [kept, lost] = split.ends;
  vertices_.push_back((position(a) + position(b)) / 2);
  for (std::size_t side = 0; side < 2; ++side) {
    const std::int32_t old = split.triangles[side];
    const std::int32_t other = split.others[side];
    const std::size_t edge = side == 0 ? k : j;
    // The one of the two other edges that ends at the vertex that the old triangle loses.
    const bool loses_begin = corners(old)[edge] == lost;
    const std::size_t lost_edge = loses_begin ? (edge + 2) % 3 : (edge + 1) % 3;
    const std::size_t kept_edge = loses_begin ? (edge + 1) % 3 : (edge + 2) % 3;
    triangles_.push_back(corners(old));
    cells_.push_back(cell(old));
    edges_.push_back(edge_planes(old));
    std::replace(triangles_[static_cast<std::size_t>(old)].begin(),
                 triangles_[static_cast<std::size_t>(old)].end(), lost, m);
    std::replace(triangles_.back().begin(), triangles_.back().end(), kept, m);
    TriangleCell& new_cell = cells_.back();
    new_cell.neighbours[edge] = split.others[1 - side];
    new_cell.neighbours[kept_edge] = old;
    // The triangle behind the edge that now belongs to the new one.
    const std::int32_t beyond = new_cell.neighbours[lost_edge];
    const std::int32_t from = triangles_.back()[lost_edge];
    auto& back = cells_[static_cast<std::size_t>(beyond)].neighbours;
    for (std::size_t i = 0; i < 3; ++i) {
      if (back[i] == old && corners(beyond)[(i + 1) % 3] == from) back[i] = other;
    }
    cells_[static_cast<std::size_t>(old)].neighbours[lost_edge] = other;
  }
  change_fan(lost, split);
  add_to_fan(c, split.others[0]);
  add_to_fan(d, split.others[1]);
  fan_of_.emplace_back(fans_.size(), 4);
  fans_.push_back(std::min(triangle, behind));
  fans_.push_back(std::max(triangle, behind));
  fans_.push_back(split.others[0]);
  fans_.push_back(split.others[1]);
  for (const auto& both : {split.triangles, split.others}) {
    for (const std::int32_t t : both) compute_face(t);
  }
  for (const auto& both : {split.triangles, split.others}) {
    for (const std::int32_t t : both) {
      for (std::size_t i = 0; i < 3; ++i) compute_edge(t, i);
    }
  }
  return split;
}

}  // namespace thimble::render
