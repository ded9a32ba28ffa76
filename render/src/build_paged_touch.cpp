#include "build_paged_touch.h"

#include <utility>

#include "build_surface_touch.h"

namespace thimble::render {

std::unique_ptr<ObjectTouch> build_paged_touch(std::shared_ptr<PagedSurface> pages,
                                               const PagedPlace& place,
                                               const SurfaceChoice& surface) {
  return build_surface_touch(PagedContact(std::move(pages), place), surface);
}

}  // namespace thimble::render
