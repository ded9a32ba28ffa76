// Replaces the server in builds without its library.
#include "web/web_server.h"

namespace thimble::web {

class WebServer::Parts {};

driver::Result<std::unique_ptr<WebServer>> WebServer::listen(session::RunAttachment&,
                                                             std::uint16_t) {
  return driver::Error{
      "The live page is not part of this build. Install libboost-dev and build again with -D "
      "THIMBLE_WEB=ON."};
}

WebServer::WebServer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
WebServer::~WebServer() = default;
std::string WebServer::address() const {
  return {};
}
std::uint16_t WebServer::port() const noexcept {
  return 0;
}
std::size_t WebServer::pages() const noexcept {
  return 0;
}
void WebServer::step() {}
void WebServer::leave(std::chrono::milliseconds) {}

}  // namespace thimble::web
