#pragma once

#include <cstdint>
#include <span>

#include "thimble/driver/tick_record.h"
#include "thimble/render/scene_touch.h"

namespace thimble::session {

/// Counts, after a run, the intervals of records in which the tip was inside an object without
/// contact. Checks every end of a contact, and up to 20,000 of the other free records, evenly
/// spaced. Intervals before the tip was outside for the first time are ignored, because no contact
/// can begin there. Real-time: never from the servo thread.
std::uint64_t count_lost_contacts(std::span<const driver::TickRecord> rows,
                                  const render::SceneTouch& touch);

}  // namespace thimble::session
