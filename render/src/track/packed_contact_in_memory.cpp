#include "track/packed_contact_in_memory.h"

#include <utility>

#include "track/packed_contact_steps.h"

namespace thimble::render {

InMemoryStore::InMemoryStore(PackedSurface surface, std::optional<SearchChoice> search)
    : InMemoryStore(std::make_shared<const PackedSurface>(std::move(surface)), nullptr) {
  search_ = make_search(*surface_, search);
}

InMemoryStore::InMemoryStore(std::shared_ptr<const PackedSurface> surface,
                             std::shared_ptr<const ContactSearch> search)
    : triangles_(surface->triangles().data()),
      origin_(surface->origin()),
      per_step_(surface->per_step()),
      step_(surface->step()),
      surface_(std::move(surface)),
      search_(std::move(search)) {}

template class PackedContact<InMemoryStore>;

InMemoryContact::InMemoryContact(PackedSurface surface, std::optional<SearchChoice> search)
    : PackedContact(InMemoryStore(std::move(surface), search)) {}

InMemoryContact::InMemoryContact(std::shared_ptr<const PackedSurface> surface,
                                 std::shared_ptr<const ContactSearch> search)
    : PackedContact(InMemoryStore(std::move(surface), std::move(search))) {}

driver::Result<InMemoryContact> InMemoryContact::build(const TriangleMesh& mesh,
                                                       const PackedSurfaceOptions& options) {
  auto surface = PackedSurface::build(mesh, options);
  if (!surface) return surface.error();
  return InMemoryContact(std::move(surface).value());
}

}  // namespace thimble::render
