#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {
namespace {

// The fault (for one and for many) and its remedy.
struct Wording {
  const char* one;
  const char* many;
  const char* remedy;
};

Wording wording_of(MeshFault::Kind kind) {
  switch (kind) {
    case MeshFault::Kind::kNotFinite:
      return {"vertex has a coordinate that is not finite",
              "vertices have coordinates that are not finite",
              "export the mesh again, or let a repair drop the triangles with them"};
    case MeshFault::Kind::kIndexOutOfRange:
      return {"triangle refers to a vertex that does not exist",
              "triangles refer to vertices that do not exist",
              "export the mesh again, or let a repair drop them"};
    case MeshFault::Kind::kDegenerateTriangle:
      return {"triangle has no area", "triangles have no area", "a repair drops such triangles"};
    case MeshFault::Kind::kDuplicateTriangle:
      return {"triangle repeats another one", "triangles repeat others",
              "a repair drops the copies"};
    case MeshFault::Kind::kOpenEdge:
      return {"edge belongs to only one triangle, so the mesh has a hole",
              "edges belong to only one triangle, so the mesh has a hole",
              "a repair fills holes, and open parts can be used as sheets"};
    case MeshFault::Kind::kNonManifoldEdge:
      return {"edge belongs to more than two triangles", "edges belong to more than two triangles",
              "a repair separates bodies that only touch there"};
    case MeshFault::Kind::kFlippedEdge:
      return {"edge joins triangles with opposite orientation",
              "edges join triangles with opposite orientation",
              "reverse the triangles on one side"};
    case MeshFault::Kind::kNonManifoldVertex:
      return {"vertex joins parts that share nothing else",
              "vertices join parts that share nothing else",
              "a repair gives each part its own vertex"};
    case MeshFault::Kind::kInsideOut:
      return {"closed component has its normals pointing into its material",
              "closed components have their normals pointing into their material",
              "a scene reverses its triangles on loading, and so does a repair"};
  }
  return {"fault is of an unknown kind", "faults are of an unknown kind", "report it as a bug"};
}

}  // namespace

std::string describe(const MeshFault& fault) {
  const Wording wording = wording_of(fault.kind);
  std::string sentence = std::to_string(fault.count) + " ";
  sentence += fault.count == 1 ? wording.one : wording.many;
  if (!fault.where.empty()) {
    sentence += (fault.count == 1 ? " (" : " (the first: ") + fault.where + ")";
  }
  return sentence + "; " + wording.remedy + ".";
}

}  // namespace thimble::render
