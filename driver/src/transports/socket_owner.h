#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Returns the user whose process holds the other end of a TCP connection within this computer, as
/// the kernel lists it [proc(5), /proc/net/tcp]. Empty if no process holds it: the other end is on
/// another computer, is not accepted yet, or was closed. Real-time: never from the servo thread.
std::optional<uid_t> user_of_peer(int socket);

/// Returns the reason to distrust the other end of a connection, as a phrase: "a process of user
/// 65534". Empty if a process of this user or of root holds it. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT std::string distrust_of_peer(int socket);

}  // namespace thimble::driver
