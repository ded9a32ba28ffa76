#include "thimble/render/contact/compact_contact.h"

#include <utility>

#include "thimble/render/contact/record_contact_steps.h"

namespace thimble::render {

CompactStore::CompactStore(CompactSurface surface)
    : surface_(std::make_shared<const CompactSurface>(std::move(surface))),
      search_(std::make_shared<const Bvh>(*surface_)),
      records_(surface_->records().data()) {}

template class RecordContact<CompactStore>;

CompactContact::CompactContact(CompactSurface surface)
    : RecordContact(CompactStore(std::move(surface))) {}

driver::Result<CompactContact> CompactContact::build(const TriangleMesh& mesh,
                                                     const CompactSurfaceOptions& options) {
  auto surface = CompactSurface::build(mesh, options);
  if (!surface) return surface.error();
  return CompactContact(std::move(surface).value());
}

}  // namespace thimble::render
