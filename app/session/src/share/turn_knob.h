#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "share/shared_reader.h"
#include "share/shared_scene.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Returns the number of the knob with the given name if it allows `value`. The error lists the
/// available knobs, or the bounds that the value violates. Real-time: never from the servo thread.
driver::Result<std::size_t> find_knob(const std::vector<SharedScene::Knob>& knobs,
                                      const std::string& name, double value);

/// Changes a knob by an argument "NAME=VALUE" of `thimble view --turn`. The error is that of
/// `find_knob`. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> turn_knob(SharedReader& reader, const std::string& order);

}  // namespace thimble::session
