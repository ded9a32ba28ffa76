#include "vendors/haply/haply_link.h"

// Replaces the other sources of this folder in a build without Boost.Beast or nlohmann's JSON.

namespace thimble::driver::haply {
namespace {

Error absent() {
  return {
      "Arms behind Haply's service (Inverse3) are not part of this build. Install libboost-dev and "
      "nlohmann-json3-dev, and build again with -D THIMBLE_WEB=ON."};
}

}  // namespace

std::uint16_t port_of_user() {
  return kPort;
}

Result<std::vector<FoundInverse3>> find_arms(std::uint16_t, std::int64_t) {
  return absent();
}

Result<std::unique_ptr<ArmLink>> open_link(const std::string&, std::uint16_t, Clock&) {
  return absent();
}

}  // namespace thimble::driver::haply
