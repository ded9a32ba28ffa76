#pragma once

#include <memory>
#include <optional>

#include "compact_mesh/packed_surface.h"
#include "mesh/contact_mesh.h"
#include "search/contact_search.h"
#include "thimble/driver/export.h"
#include "thimble/render/search/search_choice.h"

namespace thimble::render {

/// Builds the chosen search. The default is a grid for fewer than 8,000 evenly distributed
/// triangles (GridSearch), else a tree. Keeps a reference: the surface must outlive the search.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::shared_ptr<const ContactSearch> make_search(
    const ContactMesh& mesh, std::optional<SearchChoice> choice = {});
std::shared_ptr<const ContactSearch> make_search(const PackedSurface& surface,
                                                 std::optional<SearchChoice> choice = {});

/// Builds a search that supports moving triangles (ContactSearch::refit): linear if that is chosen,
/// else a tree. A grid does not: triangles that enter new volumes would need room in lists that are
/// stored without gaps. Keeps a reference: the mesh must outlive the search. Real-time: never from
/// the servo thread.
std::shared_ptr<ContactSearch> make_moving_search(const ContactMesh& mesh,
                                                  std::optional<SearchChoice> choice = {});

}  // namespace thimble::render
