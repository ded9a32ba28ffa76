#include "report/mesh_json.h"

#include <Eigen/Core>
#include <utility>

namespace thimble::report {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(render::MeshFault::Kind kind) {
  using Fault = render::MeshFault::Kind;
  switch (kind) {
    case Fault::kNotFinite:
      return "not_finite";
    case Fault::kIndexOutOfRange:
      return "index_out_of_range";
    case Fault::kDegenerateTriangle:
      return "degenerate_triangle";
    case Fault::kDuplicateTriangle:
      return "duplicate_triangle";
    case Fault::kOpenEdge:
      return "open_edge";
    case Fault::kNonManifoldEdge:
      return "non_manifold_edge";
    case Fault::kFlippedEdge:
      return "flipped_edge";
    case Fault::kNonManifoldVertex:
      return "non_manifold_vertex";
    case Fault::kInsideOut:
      return "inside_out";
  }
  return "";
}

const char* name_of(render::RepairChange::Kind kind) {
  using Change = render::RepairChange::Kind;
  switch (kind) {
    case Change::kDroppedBroken:
      return "dropped_broken";
    case Change::kWeldedVertex:
      return "welded_vertex";
    case Change::kDroppedDegenerate:
      return "dropped_degenerate";
    case Change::kDroppedDuplicate:
      return "dropped_duplicate";
    case Change::kClosedSeam:
      return "closed_seam";
    case Change::kSplitVertex:
      return "split_vertex";
    case Change::kPartedEdge:
      return "parted_edge";
    case Change::kFilledHole:
      return "filled_hole";
    case Change::kTurnedTriangle:
      return "turned_triangle";
    case Change::kDroppedVertex:
      return "dropped_vertex";
  }
  return "";
}

Json vector_json(const Eigen::Vector3d& vector) {
  return Json{vector.x(), vector.y(), vector.z()};
}

}  // namespace

nlohmann::ordered_json mesh_json(const render::MeshFindings& found) {
  Json faults = Json::array();
  for (const render::MeshFault& fault : found.faults) {
    faults.push_back(
        {{"kind", name_of(fault.kind)}, {"count", fault.count}, {"where", fault.where}});
  }
  Json whole{{"triangles", found.triangles},
             {"vertices", found.vertices},
             {"unused_vertices", found.unused_vertices},
             {"edges", found.edges},
             {"components", found.components},
             {"euler_characteristic", found.euler_characteristic},
             {"box_min", vector_json(found.box_min)},
             {"box_max", vector_json(found.box_max)},
             {"area", found.area}};
  if (found.touchable()) whole["volume"] = found.volume;
  whole["watertight"] = found.touchable();
  whole["faults"] = std::move(faults);
  return whole;
}

nlohmann::ordered_json changes_json(const std::vector<render::RepairChange>& changes) {
  Json list = Json::array();
  for (const render::RepairChange& change : changes) {
    list.push_back(
        {{"kind", name_of(change.kind)}, {"count", change.count}, {"where", change.where}});
  }
  return list;
}

}  // namespace thimble::report
