#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::driver {

/// Starts to listen on a port of the loopback interface, which only programs of this computer
/// reach. Returns the port; `port` 0 selects a free one. The error message ends with `remedy`.
/// Check each connection with distrust_of_peer (socket_owner.h). Real-time: never from the servo
/// thread.
inline Result<std::uint16_t> listen_on_loopback(boost::asio::ip::tcp::acceptor& acceptor,
                                                std::uint16_t port, const std::string& remedy) {
  using Acceptor = boost::asio::ip::tcp::acceptor;
  const boost::asio::ip::tcp::endpoint here(boost::asio::ip::address_v4::loopback(), port);
  boost::system::error_code failed;
  acceptor.open(here.protocol(), failed);
  if (!failed) acceptor.set_option(Acceptor::reuse_address(true), failed);
  if (!failed) acceptor.bind(here, failed);
  if (!failed) acceptor.listen(boost::asio::socket_base::max_listen_connections, failed);
  if (failed) {
    return Error{"Port " + std::to_string(port) +
                 " of this computer is not available: " + failed.message() + ". " + remedy};
  }
  return acceptor.local_endpoint(failed).port();
}

}  // namespace thimble::driver
