#pragma once

#include <cstdint>
#include <span>

#include "thimble/driver/tick_record.h"
#include "thimble/render/scene_touch.h"

namespace thimble::session {

/// Checks a run afterwards, outside the servo: counts the stretches of records in which the tip was
/// inside an object although no contact was felt. Looks at every end of a contact, and at up to
/// 20,000 of the other free records, evenly chosen. Stretches before the tip was outside for the
/// first time do not count: no contact can begin there. Real-time: never from the servo thread.
std::uint64_t count_lost_contacts(std::span<const driver::TickRecord> rows,
                                  const render::SceneTouch& touch);

}  // namespace thimble::session
