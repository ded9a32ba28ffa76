#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "vendors/haply/haply_message.h"
#include "vendors/haply/haply_socket.h"

namespace thimble::driver::haply {

/// How long a service may take to open and to say its first message, ns. [chosen: it is on this
/// computer, and what is slower than that carries no touch]
inline constexpr std::int64_t kPatience_ns = 250'000'000;

/// Returns the arms of the service on a port of this computer. It is listened to and told nothing.
/// Fails if nobody listens, or if it is no service of Haply's. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT Result<std::vector<FoundInverse3>> find_arms(std::uint16_t port,
                                                            std::int64_t timeout_ns = kPatience_ns);

/// Opens the link to one arm of that service. It gets no message before the service has proven by
/// its first one that it is Haply's and has this arm, ready to be used. A thread of the link's own
/// speaks with the service; it sends a force when the servo loop has a new one, and nothing
/// otherwise, so that an arm whose loop stands still gets none: the service keeps no force.
///
/// `read` gives the newest state; kRejected where a message could not be understood or held what
/// cannot be; kLost once the service closed or lists the arm no more. `write` refuses while the
/// force before has not gone out, which is when the service is late. Real-time: never from the
/// servo thread. `clock` is the loop's, outlives the link, and lets any thread ask for the time.
THIMBLE_EXPORT Result<std::unique_ptr<ArmLink>> open_link(const std::string& device_id,
                                                          std::uint16_t port, Clock& clock);

}  // namespace thimble::driver::haply
