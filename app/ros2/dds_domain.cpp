#include "ros2/dds_domain.h"

#include <linux/filter.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <system_error>

namespace thimble::ros2 {
namespace {

/// A local-only domain of this process.
struct OpenDomain {
  dds_entity_t entity = 0;
  int users = 0;
};

std::mutex& opening() {
  static std::mutex& only = *new std::mutex;
  return only;
}
std::map<std::uint32_t, OpenDomain>& domains() {
  static auto& all = *new std::map<std::uint32_t, OpenDomain>;
  return all;
}

// Participants of this computer discover each other by multicast over the loopback interface.
constexpr const char* kHere =
    "<CycloneDDS><Domain id=\"any\"><General><Interfaces>"
    "<NetworkInterface name=\"lo\" multicast=\"true\"/>"
    "</Interfaces></General></Domain></CycloneDDS>";
// The same without announcements.
constexpr const char* kHereUnseen =
    "<CycloneDDS><Domain id=\"any\"><General>"
    "<Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General></Domain></CycloneDDS>";

/// Lists the datagram sockets of this process.
std::set<int> datagram_sockets() {
  std::set<int> found;
  std::error_code ended;
  for (std::filesystem::directory_iterator entry("/proc/self/fd", ended), none;
       !ended && entry != none; entry.increment(ended)) {
    const int file = std::atoi(entry->path().filename().c_str());
    int type = 0, family = 0;
    socklen_t size = sizeof type;
    if (getsockopt(file, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) continue;
    size = sizeof family;
    if (getsockopt(file, SOL_SOCKET, SO_DOMAIN, &family, &size) == 0 && family == AF_INET) {
      found.insert(file);
    }
  }
  return found;
}

/// Makes an IPv4 socket drop all packets not sent from this computer's loopback addresses; the
/// kernel itself drops such addresses from outside. Returns whether it succeeded.
bool accept_loopback_only(int socket) {
  constexpr std::uint32_t kSource = static_cast<std::uint32_t>(SKF_NET_OFF) + 12;  // RFC 791
  std::array<sock_filter, 5> program{{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kSource),
      BPF_STMT(BPF_ALU | BPF_AND | BPF_K, 0xff000000),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0x7f000000, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, 0xffffffff),
      BPF_STMT(BPF_RET | BPF_K, 0),
  }};
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
}

}  // namespace

dds_return_t DdsDomain::open(const RosOptions& options) {
  if (options.reach == RosReach::kNetwork) return 0;
  const std::lock_guard lock(opening());
  OpenDomain& domain = domains()[options.domain];
  if (domain.users == 0) {
    const std::set<int> before = datagram_sockets();
    domain.entity = dds_create_domain(
        options.domain, options.reach == RosReach::kThisComputer ? kHere : kHereUnseen);
    if (domain.entity < 0) return domain.entity;
    for (const int socket : datagram_sockets()) {
      if (before.contains(socket) || accept_loopback_only(socket)) continue;
      dds_delete(domain.entity);
      return DDS_RETCODE_NOT_ALLOWED_BY_SECURITY;
    }
  }
  ++domain.users;
  open_ = true;
  number_ = options.domain;
  return 0;
}

DdsDomain::~DdsDomain() {
  if (!open_) return;
  const std::lock_guard lock(opening());
  OpenDomain& domain = domains()[number_];
  if (--domain.users == 0) dds_delete(domain.entity);
}

}  // namespace thimble::ros2
