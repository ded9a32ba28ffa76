#include <utility>

#include "compat/haply/haply_service.h"

// Replaces the other sources of this folder in builds without Boost.Beast or nlohmann's JSON.

namespace thimble::compat::haply {

class Service::Listener {};

Service::Service(std::unique_ptr<Listener> listener) : listener_(std::move(listener)) {}
Service::~Service() = default;

driver::Result<std::unique_ptr<Service>> Service::listen(std::uint16_t, Report) {
  return driver::Error{
      "--serve haply is not part of this build. Install libboost-dev and nlohmann-json3-dev, and "
      "build again with -D THIMBLE_WEB=ON."};
}

std::uint16_t Service::port() const noexcept {
  return 0;
}
bool Service::ready() const noexcept {
  return true;
}
int Service::programs() const noexcept {
  return 0;
}
int Service::refused() const noexcept {
  return 0;
}
void Service::leave() {}
bool Service::ended() const noexcept {
  return true;
}

}  // namespace thimble::compat::haply
