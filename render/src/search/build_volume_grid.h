#pragma once

#include "search/search_frame.h"
#include "search/volume_grid.h"

namespace thimble::render {

/// Divides the box of a surface into volumes about as wide as its triangles. They are wider if the
/// sizes of the triangles vary widely; otherwise lists or the top would take more memory than a few
/// words per triangle. `Surface` is ContactMesh or PackedSurface. Real-time: never from the servo
/// thread.
template <class Surface>
VolumeGrid build_volume_grid(const Surface& surface, const SearchFrame& frame);

extern template VolumeGrid build_volume_grid(const ContactMesh&, const SearchFrame&);
extern template VolumeGrid build_volume_grid(const PackedSurface&, const SearchFrame&);

}  // namespace thimble::render
