#include "transports/socket_owner.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>

namespace thimble::driver {
namespace {

/// A port of this computer to which processes connect.
class Port {
 public:
  explicit Port(int family) : family_(family), listener_(socket(family, SOCK_STREAM, 0)) {
    sockaddr_storage any = address(0);
    EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&any), size()), 0);
    EXPECT_EQ(listen(listener_, 4), 0);
    socklen_t length = sizeof any;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&any), &length);
    port_ = family == AF_INET ? reinterpret_cast<sockaddr_in*>(&any)->sin_port
                              : reinterpret_cast<sockaddr_in6*>(&any)->sin6_port;
  }
  ~Port() { close(listener_); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  int connect_here() const {
    const int client = socket(family_, SOCK_STREAM, 0);
    const sockaddr_storage to = address(port_);
    EXPECT_EQ(connect(client, reinterpret_cast<const sockaddr*>(&to), size()), 0);
    return client;
  }
  int accept_one() const { return accept(listener_, nullptr, nullptr); }

 private:
  socklen_t size() const { return family_ == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6); }
  sockaddr_storage address(std::uint16_t port) const {
    sockaddr_storage any{};
    if (family_ == AF_INET) {
      auto& four = *reinterpret_cast<sockaddr_in*>(&any);
      four.sin_family = AF_INET;
      four.sin_port = port;
      four.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    } else {
      auto& six = *reinterpret_cast<sockaddr_in6*>(&any);
      six.sin6_family = AF_INET6;
      six.sin6_port = port;
      six.sin6_addr = in6addr_loopback;
    }
    return any;
  }

  int family_;
  int listener_;
  std::uint16_t port_ = 0;
};

class SocketOwner : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Families, SocketOwner, ::testing::Values(AF_INET, AF_INET6));

TEST_P(SocketOwner, IsThisUserForOwnConnection) {
  const Port port(GetParam());
  const int client = port.connect_here();
  const int server = port.accept_one();
  EXPECT_EQ(user_of_peer(server), geteuid());
  EXPECT_EQ(user_of_peer(client), geteuid());
  EXPECT_EQ(distrust_of_peer(server), "");
  close(client);
  close(server);
}

TEST_P(SocketOwner, HasNoUserOnceClosed) {
  const Port port(GetParam());
  const int client = port.connect_here();
  const int server = port.accept_one();
  close(client);
  EXPECT_EQ(user_of_peer(server), std::nullopt) << "the kernel lists it as a socket of root";
  EXPECT_NE(distrust_of_peer(server), "");
  close(server);
}

TEST_P(SocketOwner, HasNoUserBeforeItIsAccepted) {
  const Port port(GetParam());
  const int client = port.connect_here();
  EXPECT_EQ(user_of_peer(client), std::nullopt);
  close(client);
}

TEST_P(SocketOwner, IsOtherUser) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may act as another user";
  const Port port(GetParam());
  int held[2];
  ASSERT_EQ(pipe(held), 0);
  const pid_t other = fork();
  if (other == 0) {
    close(held[1]);
    if (setgid(65534) != 0 || setuid(65534) != 0) _exit(1);
    port.connect_here();
    char byte = 0;
    static_cast<void>(read(held[0], &byte, 1));
    _exit(0);
  }
  const int server = port.accept_one();
  EXPECT_EQ(user_of_peer(server), uid_t{65534});
  EXPECT_EQ(distrust_of_peer(server), "a process of user 65534");
  close(held[1]);
  close(held[0]);
  waitpid(other, nullptr, 0);
  close(server);
}

TEST(SocketOwnerOfMappedAddress, IsFoundFromBothSides) {
  // An IPv6 socket that connects to 127.0.0.1, as many programs do.
  const Port port(AF_INET);
  const int known = port.connect_here();
  sockaddr_in to{};
  socklen_t length = sizeof to;
  getpeername(known, reinterpret_cast<sockaddr*>(&to), &length);
  close(port.accept_one());
  close(known);
  sockaddr_in6 mapped{};
  mapped.sin6_family = AF_INET6;
  mapped.sin6_port = to.sin_port;
  mapped.sin6_addr.s6_addr[10] = mapped.sin6_addr.s6_addr[11] = 0xff;
  std::memcpy(&mapped.sin6_addr.s6_addr[12], &to.sin_addr, 4);
  const int client = socket(AF_INET6, SOCK_STREAM, 0);
  ASSERT_EQ(connect(client, reinterpret_cast<const sockaddr*>(&mapped), sizeof mapped), 0);
  const int server = port.accept_one();
  EXPECT_EQ(user_of_peer(server), geteuid());
  EXPECT_EQ(user_of_peer(client), geteuid());
  close(client);
  close(server);
}

}  // namespace
}  // namespace thimble::driver
