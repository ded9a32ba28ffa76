#include "track/compact_contact.h"

#include <utility>

#include "track/record_contact_steps.h"

namespace thimble::render {

CompactStore::CompactStore(CompactSurface surface, std::optional<SearchChoice> search)
    : records_(surface.records().data()),
      origin_(surface.origin()),
      per_step_(surface.per_step()),
      step_(surface.step()),
      surface_(std::make_shared<const CompactSurface>(std::move(surface))),
      search_(make_search(*surface_, search)) {}

template class RecordContact<CompactStore>;

CompactContact::CompactContact(CompactSurface surface, std::optional<SearchChoice> search)
    : RecordContact(CompactStore(std::move(surface), search)) {}

driver::Result<CompactContact> CompactContact::build(const TriangleMesh& mesh,
                                                     const CompactSurfaceOptions& options) {
  auto surface = CompactSurface::build(mesh, options);
  if (!surface) return surface.error();
  return CompactContact(std::move(surface).value());
}

}  // namespace thimble::render
