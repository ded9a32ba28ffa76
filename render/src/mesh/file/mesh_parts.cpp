#include "mesh/file/mesh_parts.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "mesh/file/corner_values.h"
#include "mesh/file/read_off.h"  // kCoordinateMax

namespace thimble::render {
namespace {

// More than any file that can be touched has; instances can multiply a small file.
constexpr std::size_t kTrianglesMax = 100'000'000;

// Appends the values of a part whose triangles begin at `first`, turned if the part is.
template <class Values>
void append_part(const Values& part, std::size_t first, bool mirrored, Values& whole) {
  if (part.empty()) return;
  using Vector = typename Values::value_type::value_type;
  whole.resize(first, {no_value<Vector>(), no_value<Vector>(), no_value<Vector>()});
  for (const auto& [a, b, c] : part) {
    whole.push_back({a, mirrored ? c : b, mirrored ? b : c});
  }
}

}  // namespace

driver::Result<void> MeshParts::add(const TriangleMesh& part, const Eigen::Affine3d& place,
                                    bool single, const MeshAttributes* attributes) {
  if (mesh_.triangles.size() + part.triangles.size() > kTrianglesMax ||
      mesh_.vertices.size() + part.vertices.size() > 3 * kTrianglesMax) {
    return driver::Error{"it has more than 100 million triangles."};
  }
  const bool stays = place.matrix().isIdentity(0);
  const bool mirrored = place.linear().determinant() < 0;
  const double scale = place.linear().colwise().norm().maxCoeff();
  const auto first = static_cast<std::int32_t>(mesh_.vertices.size());
  for (const Eigen::Vector3d& vertex : part.vertices) {
    if (single) precision_.add(vertex, scale);
    const Eigen::Vector3d p = stays ? vertex : place * vertex;
    if (!(p.cwiseAbs().maxCoeff() <= kCoordinateMax) || p.hasNaN()) {
      return driver::Error{"vertex " + std::to_string(mesh_.vertices.size()) +
                           " has a coordinate that is not a number between -1e15 and 1e15."};
    }
    mesh_.vertices.push_back(p);
  }
  if (attributes != nullptr) {
    append_part(attributes->uv, mesh_.triangles.size(), mirrored, attributes_.uv);
    append_part(attributes->colours, mesh_.triangles.size(), mirrored, attributes_.colours);
  }
  for (const auto& [a, b, c] : part.triangles) {
    mesh_.triangles.push_back({first + a, first + (mirrored ? c : b), first + (mirrored ? b : c)});
  }
  ++parts_;
  moved_ += !stays;
  return {};
}

driver::Result<TriangleMesh> MeshParts::take(std::vector<std::string>& notes) {
  if (mesh_.triangles.empty()) return driver::Error{"it has no face with three corners."};
  if (auto kept = precision_.judge(mesh_, notes); !kept) return kept.error();
  if (moved_ > 0) {
    notes.push_back(std::to_string(moved_) + " of " + std::to_string(parts_) +
                    (parts_ == 1 ? " part was" : " parts were") + " placed by the file's nodes.");
  }
  complete(mesh_.triangles.size(), attributes_);
  return std::move(mesh_);
}

MeshAttributes MeshParts::take_attributes() {
  return std::move(attributes_);
}

}  // namespace thimble::render
