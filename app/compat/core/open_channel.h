#pragma once

#include <string>

#include "compat/core/arm_channel.h"

namespace thimble::compat {

/// Returns the channel that THIMBLE_EXEC names, mapped at the first call; null if there is none.
/// `trouble`, if not null, gets the reason. Never from the servo thread.
Channel* open_channel(std::string* trouble = nullptr);

/// Returns the descriptor of the channel's file, with which this process holds its locks
/// (arm_channel.h); -1 if there is no channel. Never from the servo thread.
int channel_file();

/// Uses a channel of this process instead, with the file `path`; null ends this. For clients served
/// inside `thimble exec`, and for tests. Call only while no arm is open.
void use_channel(Channel* channel, const std::string& path = {});

}  // namespace thimble::compat
