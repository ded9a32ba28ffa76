#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/repair_mesh.h"

namespace thimble::report {

/// Returns the findings of a mesh as a JSON object: counts, box, area, faults with kind and count.
nlohmann::ordered_json mesh_json(const render::MeshFindings& found);

/// Returns the changes of a repair as a JSON list of objects with kind and count.
nlohmann::ordered_json changes_json(const std::vector<render::RepairChange>& changes);

}  // namespace thimble::report
