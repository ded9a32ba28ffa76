#include "track/packed_contact_in_memory.h"

#include <utility>

#include "track/packed_contact_steps.h"

namespace thimble::render {

MemoryStore::MemoryStore(PackedSurface surface, std::optional<SearchChoice> search)
    : MemoryStore(std::make_shared<const PackedSurface>(std::move(surface)), nullptr) {
  search_ = make_search(*surface_, search);
}

MemoryStore::MemoryStore(std::shared_ptr<const PackedSurface> surface,
                         std::shared_ptr<const ContactSearch> search)
    : triangles_(surface->triangles().data()),
      origin_(surface->origin()),
      per_step_(surface->per_step()),
      step_(surface->step()),
      surface_(std::move(surface)),
      search_(std::move(search)) {}

template class PackedContact<MemoryStore>;

MemoryContact::MemoryContact(PackedSurface surface, std::optional<SearchChoice> search)
    : PackedContact(MemoryStore(std::move(surface), search)) {}

MemoryContact::MemoryContact(std::shared_ptr<const PackedSurface> surface,
                             std::shared_ptr<const ContactSearch> search)
    : PackedContact(MemoryStore(std::move(surface), std::move(search))) {}

driver::Result<MemoryContact> MemoryContact::build(const TriangleMesh& mesh,
                                                   const PackedSurfaceOptions& options) {
  auto surface = PackedSurface::build(mesh, options);
  if (!surface) return surface.error();
  return MemoryContact(std::move(surface).value());
}

}  // namespace thimble::render
