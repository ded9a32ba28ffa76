#pragma once

#include <memory>
#include <optional>

#include "thimble/render/contact/compact_surface.h"
#include "thimble/render/contact/contact_mesh.h"
#include "thimble/render/contact/contact_search.h"

namespace thimble::render {

/// Says how contact is looked for while the tip is free. All give the same answers.
enum class SearchChoice {
  kLinear,  ///< Every triangle [BP 3.1]: no structure, time grows with the mesh.
  kGrid,    ///< Space cut into volumes [BP 4.1]: fastest where few triangles are of like size.
  kTree,    ///< A tree of boxes: fast however the triangles lie.
};

/// Builds the search that is named; if none is, a grid for up to 30,000 triangles that lie evenly
/// (GridSearch), else a tree. Keeps a reference: the surface must outlive the search.
/// Real-time: never from the servo thread.
std::shared_ptr<const ContactSearch> make_search(const ContactMesh& mesh,
                                                 std::optional<SearchChoice> choice = {});
std::shared_ptr<const ContactSearch> make_search(const CompactSurface& surface,
                                                 std::optional<SearchChoice> choice = {});

/// Builds a search that can be told that triangles have moved (ContactSearch::refit): linear if
/// that is named, else a tree. A grid cannot: triangles that come into new volumes would need room
/// in lists that stand close together. Keeps a reference: the mesh must outlive the search.
/// Real-time: never from the servo thread.
std::shared_ptr<ContactSearch> make_moving_search(const ContactMesh& mesh,
                                                  std::optional<SearchChoice> choice = {});

}  // namespace thimble::render
