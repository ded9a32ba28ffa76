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

/// Max. time for a service to open and send its first message, ns. [chosen: it is on this computer,
/// and a slower one could not carry a touch]
inline constexpr std::int64_t kConnectTimeout_ns = 250'000'000;

/// Returns the arms of the service on a port of this computer. Only listens; sends nothing. Fails
/// if no program listens there, or if it is not Haply's service. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT Result<std::vector<FoundInverse3>> find_arms(
    std::uint16_t port, std::int64_t timeout_ns = kConnectTimeout_ns);

/// Opens the link to one arm of that service. The service gets no message before its first one has
/// proven that it is Haply's and has this arm, ready to be used. A thread of the link exchanges
/// data with the service. It sends a force when the servo loop has a new one, and nothing
/// otherwise. An arm whose loop has stopped therefore gets none: the service keeps no force.
///
/// `read` gives the newest state. It returns kRejected if a message could not be understood or held
/// impossible values, and kLost once the service closed or no longer lists the arm. `write` refuses
/// while the previous force is unsent, which means that the service is late. Real-time: never from
/// the servo thread. `clock` is the loop's, outlives the link, and may be read by any thread.
THIMBLE_EXPORT Result<std::unique_ptr<ArmLink>> open_link(const std::string& device_id,
                                                          std::uint16_t port, Clock& clock);

}  // namespace thimble::driver::haply
