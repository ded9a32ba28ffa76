#pragma once

#include <memory>

#include "disk_paging/paged_contact.h"
#include "thimble/driver/export.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Builds the force law of one object whose mesh is on disk. The owner of `pages` starts its
/// loader, or calls `serve` between ticks. Its query `inside` reads the disk. Real-time: never from
/// the servo thread.
THIMBLE_EXPORT std::unique_ptr<ObjectTouch> build_paged_touch(std::shared_ptr<PagedSurface> pages,
                                                              const PagedPlace& place,
                                                              const SurfaceChoice& surface);

}  // namespace thimble::render
