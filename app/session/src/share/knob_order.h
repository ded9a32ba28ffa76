#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "share/shared_reader.h"
#include "share/shared_scene.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Returns the number of the knob of this name, which may be turned to `value`. The error names the
/// knobs that there are, or the bounds that the value misses. Real-time: never from the servo
/// thread.
driver::Result<std::size_t> find_knob(const std::vector<SharedScene::Knob>& knobs,
                                      const std::string& name, double value);

/// Turns the knob of an order "NAME=VALUE" of `thimble view --turn`. The error is that of
/// `find_knob`. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> turn_knob(SharedReader& reader, const std::string& order);

}  // namespace thimble::session
