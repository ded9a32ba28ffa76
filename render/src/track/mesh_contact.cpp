#include "track/mesh_contact.h"

namespace thimble::render {

template class TrackedContact<SurfaceTracker>;
template class TrackedContact<ProxyPointTracker>;
template class TrackedContact<OffsetTracker>;

}  // namespace thimble::render
