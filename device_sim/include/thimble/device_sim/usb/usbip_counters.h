#pragma once

#include <cstdint>

namespace thimble::device_sim::usb {

/// Counts of what happened on one connection, or on all of a server.
struct UsbipCounters {
  std::uint64_t submitted = 0;  ///< Transfers asked for.
  std::uint64_t completed = 0;  ///< Transfers answered without error.
  std::uint64_t stalled = 0;    ///< Transfers answered by a stall.
  std::uint64_t babbled = 0;    ///< Transfers in which the device sent more than it was asked for.
  std::uint64_t unlinked = 0;   ///< Transfers taken back while pending.
};

}  // namespace thimble::device_sim::usb
