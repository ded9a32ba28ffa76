#pragma once

#include <cstdint>

#include "compat/core/arm_channel.h"

namespace thimble::compat {

/// Returns whether library `api` may list the arms in this process: it is the first of the
/// compatibility libraries that this process asked for arms. So a program that searches through
/// several libraries finds each arm once. Never from the servo thread.
bool may_list_arms(Channel& channel, const char* api) noexcept;

}  // namespace thimble::compat
