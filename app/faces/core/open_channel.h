#pragma once

#include <string>

#include "faces/core/arm_channel.h"

namespace thimble::faces {

/// Returns the channel that THIMBLE_EXEC names, mapped at the first call; null where there is none.
/// `trouble`, if given, says why. Never from the servo thread.
Channel* open_channel(std::string* trouble = nullptr);

/// Uses a channel of this process in place of that; null: none any more. For tests, while no arm is
/// open.
void use_channel(Channel* channel);

}  // namespace thimble::faces
