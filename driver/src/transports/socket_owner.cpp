#include "transports/socket_owner.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

namespace thimble::driver {
namespace {

/// One end of a connection in the format of the kernel's lists: words of the address in the
/// machine's byte order, and the port.
struct Address {
  std::array<std::uint32_t, 4> words{};
  bool four = false;  // IPv4: only the first word counts
  std::uint16_t port = 0;
};

/// Converts an address, also an IPv4 address mapped into IPv6, to an Address; empty for another
/// family.
std::optional<Address> address_of(const sockaddr_storage& from) {
  Address address;
  if (from.ss_family == AF_INET) {
    sockaddr_in four{};
    std::memcpy(&four, &from, sizeof four);
    address.four = true;
    address.words[0] = four.sin_addr.s_addr;
    address.port = ntohs(four.sin_port);
    return address;
  }
  if (from.ss_family != AF_INET6) return {};
  sockaddr_in6 six{};
  std::memcpy(&six, &from, sizeof six);
  std::memcpy(address.words.data(), &six.sin6_addr, sizeof six.sin6_addr);
  address.port = ntohs(six.sin6_port);
  if (IN6_IS_ADDR_V4MAPPED(&six.sin6_addr)) {
    address.four = true;
    address.words = {address.words[3], 0, 0, 0};
  }
  return address;
}

/// Formats an address as in /proc/net/tcp, or as in /proc/net/tcp6 if `six`.
std::string listed(const Address& address, bool six) {
  std::array<char, 64> text{};
  const auto& w = address.words;
  if (!six) {
    std::snprintf(text.data(), text.size(), "%08X:%04X", w[0], address.port);
  } else if (address.four) {
    std::snprintf(text.data(), text.size(), "0000000000000000%08X%08X:%04X", htonl(0xffff), w[0],
                  address.port);
  } else {
    std::snprintf(text.data(), text.size(), "%08X%08X%08X%08X:%04X", w[0], w[1], w[2], w[3],
                  address.port);
  }
  return text.data();
}

/// Searches one of the kernel's lists for a connection.
std::optional<uid_t> user_in(const char* list, const std::string& local,
                             const std::string& remote) {
  std::ifstream lines(list);
  std::string line;
  std::getline(lines, line);  // column names
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string number, here, there, state, queues, timer, retransmits;
    unsigned long user = 0, timeout = 0, inode = 0;
    if (!(fields >> number >> here >> there) || here != local || there != remote) continue;
    if (!(fields >> state >> queues >> timer >> retransmits >> user >> timeout >> inode)) continue;
    // A connection that no process holds (closed, or not accepted yet) is listed as root's.
    if (inode == 0) return {};
    return static_cast<uid_t>(user);
  }
  return {};
}

}  // namespace

std::optional<uid_t> user_of_peer(int socket) {
  sockaddr_storage own{}, other{};
  socklen_t own_size = sizeof own, other_size = sizeof other;
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&own), &own_size) != 0 ||
      getpeername(socket, reinterpret_cast<sockaddr*>(&other), &other_size) != 0) {
    return {};
  }
  const auto here = address_of(own), there = address_of(other);
  if (!here || !there) return {};
  // The other end is listed from its own point of view.
  if (there->four) {
    if (auto user = user_in("/proc/net/tcp", listed(*there, false), listed(*here, false))) {
      return user;
    }
  }
  return user_in("/proc/net/tcp6", listed(*there, true), listed(*here, true));
}

std::string distrust_of_peer(int socket) {
  const auto user = user_of_peer(socket);
  if (!user) return "a process that cannot be identified";
  if (*user == geteuid() || *user == 0) return {};
  return "a process of user " + std::to_string(*user);
}

}  // namespace thimble::driver
