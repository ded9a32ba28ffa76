#pragma once

#include <string>

#include "compat/core/arm_channel.h"

namespace thimble::compat {

/// Returns the channel that THIMBLE_EXEC names, mapped at the first call; null where there is none.
/// `trouble`, if given, says why. Never from the servo thread.
Channel* open_channel(std::string* trouble = nullptr);

/// Returns the descriptor of the channel's file, by which this process holds its locks
/// (arm_channel.h); -1 where there is no channel. Never from the servo thread.
int channel_file();

/// Uses a channel of this process instead, whose file is `path`; null: none any more. For programs
/// that are served inside `thimble exec`, and for tests; while no arm is open.
void use_channel(Channel* channel, const std::string& path = {});

}  // namespace thimble::compat
