#include "ros2/dds_domain.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace thimble::ros2 {
namespace {

constexpr const char* kForeign =
    "10.9.8.7";  // an address of this computer that is not a loopback address

bool change_loopback(const char* name, const char* address) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  ifreq request{};
  std::strncpy(request.ifr_name, name, sizeof request.ifr_name - 1);
  bool done = true;
  if (address != nullptr) {
    auto& to = reinterpret_cast<sockaddr_in&>(request.ifr_addr);
    to.sin_family = AF_INET;
    done =
        inet_pton(AF_INET, address, &to.sin_addr) == 1 && ioctl(socket, SIOCSIFADDR, &request) == 0;
  } else {
    request.ifr_flags = IFF_UP | IFF_RUNNING;
    done = ioctl(socket, SIOCSIFFLAGS, &request) == 0;
  }
  close(socket);
  return done;
}

/// Returns the UDP ports of this network namespace, except that of `except`, and the total number
/// of datagrams that the kernel has dropped on them [/proc/net/udp].
struct Heard {
  std::vector<std::uint16_t> ports;
  unsigned long drops = 0;
};
Heard heard() {
  Heard all;
  std::ifstream lines("/proc/net/udp");
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::vector<std::string> words;
    for (std::string word; fields >> word;) words.push_back(word);
    if (words.size() < 13) continue;
    const auto colon = words[1].find(':');
    all.ports.push_back(
        static_cast<std::uint16_t>(std::strtoul(words[1].c_str() + colon + 1, nullptr, 16)));
    all.drops += std::strtoul(words.back().c_str(), nullptr, 10);
  }
  return all;
}

void send_to_all(const std::vector<std::uint16_t>& ports, const char* from) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in own{}, to{};
  own.sin_family = to.sin_family = AF_INET;
  inet_pton(AF_INET, from, &own.sin_addr);
  if (bind(socket, reinterpret_cast<sockaddr*>(&own), sizeof own) != 0) _exit(90);
  for (const std::uint16_t port : ports) {
    to.sin_port = htons(port);
    inet_pton(AF_INET, from, &to.sin_addr);
    sendto(socket, "RTPS", 4, 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
  }
  close(socket);
}

/// Runs `work` in a separate network namespace, in which this computer has a second address.
/// Returns its exit code; empty if the kernel forbids the namespace.
template <class Work>
std::optional<int> in_own_network(Work work) {
  constexpr int kForbidden = 99;
  const pid_t child = fork();
  if (child == 0) {
    unsetenv("CYCLONEDDS_URI");
    if (unshare(CLONE_NEWNET) != 0 || !change_loopback("lo", nullptr) ||
        !change_loopback("lo:1", kForeign)) {
      _exit(kForbidden);
    }
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kForbidden) return {};
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Returns 0 if a domain of this reach drops packets from addresses other than loopback, 1 if it
/// accepts them, and more on other errors.
int drops_foreign(RosReach reach) {
  RosOptions options;
  options.domain = 7;
  options.reach = reach;
  DdsDomain domain;
  if (domain.open(options) < 0) return 2;
  const dds_entity_t participant = dds_create_participant(options.domain, nullptr, nullptr);
  if (participant < 0) return 3;
  const Heard before = heard();
  if (before.ports.empty()) return 4;
  send_to_all(before.ports, "127.0.0.1");
  if (heard().drops != before.drops) return 5;
  send_to_all(before.ports, kForeign);
  const bool dropped = heard().drops > before.drops;
  dds_delete(participant);
  return dropped ? 0 : 1;
}

TEST(DdsDomain, DropsPacketsFromOtherComputers) {
  for (const RosReach reach : {RosReach::kThisComputer, RosReach::kUnseen}) {
    const auto result = in_own_network([reach] { return drops_foreign(reach); });
    if (!result) GTEST_SKIP() << "no network namespace: run as root";
    EXPECT_EQ(*result, 0);
  }
}

TEST(DdsDomain, NetworkAcceptsPacketsFromOtherComputers) {
  const auto result = in_own_network([] { return drops_foreign(RosReach::kNetwork); });
  if (!result) GTEST_SKIP() << "no network namespace: run as root";
  EXPECT_EQ(*result, 1);
}

TEST(DdsDomain, IsSharedByPeersOfOneProcess) {
  const auto result = in_own_network([] {
    RosOptions options;
    options.domain = 7;
    DdsDomain first;
    if (first.open(options) < 0) return 1;
    {
      DdsDomain second;
      if (second.open(options) < 0) return 2;
    }
    const dds_entity_t participant = dds_create_participant(options.domain, nullptr, nullptr);
    return participant < 0 ? 3 : 0;
  });
  if (!result) GTEST_SKIP() << "no network namespace: run as root";
  EXPECT_EQ(*result, 0);
}

}  // namespace
}  // namespace thimble::ros2
