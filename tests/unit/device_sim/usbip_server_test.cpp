#include "thimble/device_sim/usb/usbip_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <random>
#include <span>
#include <vector>

#include "support/boards/usb_host.h"
#include "support/seed.h"
#include "thimble/device_sim/usb/vhci.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"
#include "usb/usbip_session.h"

namespace thimble::device_sim::usb {
namespace {

constexpr std::int32_t kStalled = -32, kBabble = -75, kUnlinked = -104;

/// A device with distinguishable packets: each packet to the host begins with its number.
class CountingDevice final : public UsbDevice {
 public:
  CountingDevice() {
    description_.vendor_id = 0x1234;
    description_.product_id = 6;
    description_.product = "counter";
    description_.interfaces.resize(1);
    description_.interfaces[0].endpoints = {{0x81, TransferKind::kInterrupt, 8, 1},
                                            {0x01, TransferKind::kInterrupt, 8, 1},
                                            {0x82, TransferKind::kBulk, 64, 0},
                                            {0x02, TransferKind::kBulk, 64, 0},
                                            {0x83, TransferKind::kInterrupt, 8, 4}};
  }
  const UsbDescription& description() const noexcept override { return description_; }
  void advance_to(std::int64_t) noexcept override {}
  PacketResult control(const SetupPacket& setup, std::span<std::byte> data) noexcept override {
    last_setup = setup;
    for (std::byte& byte : data) byte = std::byte{0xcc};
    return {setup.request == 0x55 ? Answer::kDone : Answer::kStall, data.size()};
  }
  PacketResult in(std::uint8_t address, std::span<std::byte> packet) noexcept override {
    if (silent) return {Answer::kNak, 0};
    std::fill(packet.begin(), packet.end(), std::byte{0});
    packet[0] = static_cast<std::byte>(++sent);
    if (address == 0x82) return {Answer::kDone, sent % 3 == 0 ? 10U : 64U};
    return {Answer::kDone, in_size};
  }
  PacketResult out(std::uint8_t, std::span<const std::byte> packet) noexcept override {
    if (silent) return {Answer::kNak, 0};
    taken.insert(taken.end(), packet.begin(), packet.end());
    ++packets_taken;
    return {Answer::kDone, packet.size()};
  }

  bool silent = false;
  unsigned sent = 0, packets_taken = 0;
  std::size_t in_size = 8;
  std::vector<std::byte> taken;
  SetupPacket last_setup;

 private:
  UsbDescription description_;
};

class UsbipServerTest : public testing::Test {
 protected:
  CountingDevice device_;
  FaultyDevice faulty_{device_};
  UsbipServer server_{faulty_, "1-1"};
};

class AttachedHost : public UsbipServerTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(host_.import_device());
    host_.configure();
  }
  support::UsbHost host_{server_};
};

TEST_F(UsbipServerTest, ListsItsDeviceAndHangsUp) {
  support::UsbHost host(server_);
  host.say(encode_request({}));
  EXPECT_EQ(host.hear(), encode_list(&device_.description(), "1-1"));
  EXPECT_TRUE(host.hung_up());
}

TEST_F(UsbipServerTest, GivesTheDeviceToOneClientAtATime) {
  support::UsbHost first(server_);
  ASSERT_TRUE(first.import_device());
  support::UsbHost second(server_);
  EXPECT_FALSE(second.import_device());
  EXPECT_TRUE(second.hung_up());
  first.hang_up();
  EXPECT_FALSE(server_.attached());
  support::UsbHost third(server_);
  EXPECT_TRUE(third.import_device());
}

TEST_F(UsbipServerTest, RefusesADeviceThatItDoesNotHave) {
  support::UsbHost host(server_);
  host.say(encode_request({.kind = UsbipRequest::Kind::kImport, .bus_id = "9-9", .size = 0}));
  EXPECT_EQ(host.hear().size(), kImportRefusalSize);
  EXPECT_TRUE(host.hung_up());
}

/// A client whose socket a test controls; it reads nothing by itself.
class DeafClient {
 public:
  explicit DeafClient(UsbipServer& server) {
    int ends[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
    server.adopt(ends[0]);
    socket_ = ends[1];
  }
  ~DeafClient() { close(socket_); }
  DeafClient(const DeafClient&) = delete;
  DeafClient& operator=(const DeafClient&) = delete;

  /// Sends as much as the socket accepts; returns the number of bytes.
  std::size_t say(std::span<const std::byte> bytes) const {
    const auto sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    return sent > 0 ? static_cast<std::size_t>(sent) : 0;
  }
  bool hung_up() const {
    std::array<std::byte, 4096> bytes;
    ssize_t got = 0;
    do {
      got = recv(socket_, bytes.data(), bytes.size(), 0);
    } while (got > 0);
    return got == 0 || errno == ECONNRESET;
  }

 private:
  int socket_;
};

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST_F(UsbipServerTest, StopsReadingFromClientThatDoesNotRead) {
  const DeafClient client(server_);
  client.say(encode_request({.kind = UsbipRequest::Kind::kImport, .bus_id = "1-1", .size = 0}));
  server_.serve(0);
  ASSERT_TRUE(server_.attached());
  const auto unlink = encode_command({.kind = UsbipCommand::Kind::kUnlink, .sequence = 1});
  std::vector<std::byte> many;
  for (int i = 0; i < 100; ++i) many.insert(many.end(), unlink.begin(), unlink.end());
  // The kernel bounds the buffers of the sockets; beyond that they accept nothing.
  std::size_t sent = 0;
  for (int i = 0; i < 20'000; ++i) {
    sent += client.say(many);
    server_.serve(0);
  }
  EXPECT_LT(sent, std::size_t{4} << 20);
}

TEST_F(UsbipServerTest, AttachedClientThatDoesNotReadIsDisconnected) {
  const DeafClient client(server_);
  client.say(encode_request({.kind = UsbipRequest::Kind::kImport, .bus_id = "1-1", .size = 0}));
  server_.serve(0);
  const auto unlink = encode_command({.kind = UsbipCommand::Kind::kUnlink, .sequence = 1});
  std::vector<std::byte> many;
  for (int i = 0; i < 100; ++i) many.insert(many.end(), unlink.begin(), unlink.end());
  for (int i = 0; i < 20'000; ++i) {
    client.say(many);
    server_.serve(0);
  }
  server_.frame(UsbipServer::kPatience_ns - kSecond_ns);
  EXPECT_TRUE(server_.attached());
  server_.frame(UsbipServer::kPatience_ns + kSecond_ns);
  EXPECT_FALSE(server_.attached());
  EXPECT_TRUE(client.hung_up());
}

TEST_F(UsbipServerTest, AttachedClientMayBeSilent) {
  const DeafClient client(server_);
  client.say(encode_request({.kind = UsbipRequest::Kind::kImport, .bus_id = "1-1", .size = 0}));
  server_.serve(0);
  for (int second = 1; second < 100; ++second) server_.frame(second * kSecond_ns);
  EXPECT_TRUE(server_.attached());
}

TEST_F(UsbipServerTest, ClientThatAsksForNothingIsDisconnected) {
  const DeafClient client(server_);
  server_.frame(UsbipServer::kPatience_ns - kSecond_ns);
  EXPECT_FALSE(client.hung_up());
  server_.frame(UsbipServer::kPatience_ns + kSecond_ns);
  EXPECT_TRUE(client.hung_up());
}

TEST_F(UsbipServerTest, IdleClientsDoNotKeepOthersOut) {
  const auto server = UsbipServer::open(faulty_, {.port = 0});
  ASSERT_TRUE(server.ok()) << server.error().message;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons((*server)->port());
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto connected = [&] {
    const int client = socket(AF_INET, SOCK_STREAM, 0);
    EXPECT_EQ(connect(client, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    (*server)->serve(1000);
    return client;
  };
  std::vector<int> clients;
  for (std::size_t i = 0; i < 2 * UsbipServer::kClientsMax; ++i) clients.push_back(connected());
  clients.push_back(connected());
  const auto request = encode_request({});
  send(clients.back(), request.data(), request.size(), MSG_NOSIGNAL);
  (*server)->serve(1000);
  std::array<std::byte, 4096> bytes;
  EXPECT_GT(recv(clients.back(), bytes.data(), bytes.size(), MSG_DONTWAIT), 0);
  for (const int client : clients) close(client);
}

TEST_F(UsbipServerTest, ListensOnAFreePortOfThisMachine) {
  const auto server = UsbipServer::open(faulty_, {.port = 0});
  ASSERT_TRUE(server.ok()) << server.error().message;
  EXPECT_NE((*server)->port(), 0);
  const auto second = UsbipServer::open(faulty_, {.port = (*server)->port()});
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find("--port"), std::string::npos);
}

TEST_F(AttachedHost, AnswersTheRequestsOfAnEnumeration) {
  const auto device = host_.control(
      {.request_type = 0x80, .request = 6, .value = kDeviceDescriptor << 8, .length = 64});
  ASSERT_TRUE(device.has_value());
  EXPECT_EQ(device->data, build_descriptor(device_.description(), kDeviceDescriptor, 0));
  const auto start = host_.control(
      {.request_type = 0x80, .request = 6, .value = kConfigurationDescriptor << 8, .length = 9});
  ASSERT_TRUE(start.has_value());
  EXPECT_EQ(start->data.size(), 9U);  // at most the requested length
  const auto chosen = host_.control({.request_type = 0x80, .request = 8, .length = 1});
  ASSERT_TRUE(chosen.has_value());
  EXPECT_EQ(chosen->data, std::vector<std::byte>{std::byte{1}});
  const auto unknown = host_.control(
      {.request_type = 0x80, .request = 6, .value = 0x0600, .length = 10});  // device qualifier
  ASSERT_TRUE(unknown.has_value());
  EXPECT_EQ(unknown->status, kStalled);
}

TEST_F(AttachedHost, HandsClassAndVendorRequestsToTheDevice) {
  const auto done = host_.control({.request_type = 0xc0, .request = 0x55, .value = 7, .length = 3});
  ASSERT_TRUE(done.has_value());
  EXPECT_EQ(done->status, 0);
  EXPECT_EQ(done->data, std::vector<std::byte>(3, std::byte{0xcc}));
  EXPECT_EQ(device_.last_setup.value, 7);
  EXPECT_EQ(host_.control({.request_type = 0x40, .request = 0x66})->status, kStalled);
}

TEST_F(AttachedHost, PollsAnInterruptEndpointOnceInAFrame) {
  std::vector<std::uint32_t> asked;
  for (int i = 0; i < 5; ++i) asked.push_back(host_.ask(1, 8));
  EXPECT_FALSE(host_.done(asked[0]).has_value());  // no transfer completes between frames
  const std::int64_t begin = host_.frame();
  host_.frames(5);
  for (int i = 0; i < 5; ++i) {
    const auto done = host_.done(asked[static_cast<std::size_t>(i)]);
    ASSERT_TRUE(done.has_value());
    EXPECT_EQ(done->frame, begin + i + 1);
    EXPECT_EQ(done->data[0], static_cast<std::byte>(i + 1));  // in order
  }
}

TEST_F(AttachedHost, KeepsTheIntervalOfAnEndpoint) {
  std::vector<std::int64_t> frames;
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t asked = host_.ask(3, 8);
    for (int k = 0; k < 10; ++k) {
      host_.frames();
      if (const auto done = host_.done(asked)) {
        frames.push_back(done->frame);
        break;
      }
    }
  }
  ASSERT_EQ(frames.size(), 3U);
  for (const std::int64_t frame : frames) EXPECT_EQ(frame % 4, 0);
  EXPECT_EQ(frames[2] - frames[1], 4);
}

TEST_F(AttachedHost, EndsABulkTransferAtAShortPacket) {
  const std::uint32_t asked = host_.ask(2, 4096);
  host_.frames();
  const auto done = host_.done(asked);
  ASSERT_TRUE(done.has_value());
  EXPECT_EQ(done->moved, 64U + 64U + 10U);
}

TEST_F(AttachedHost, CutsWhatItSendsIntoPackets) {
  const std::vector<std::byte> sent(150, std::byte{9});
  const std::uint32_t reported = host_.tell(2, sent);
  host_.frames();
  ASSERT_TRUE(host_.done(reported).has_value());
  EXPECT_EQ(device_.packets_taken, 3U);
  EXPECT_EQ(device_.taken, sent);
}

TEST_F(AttachedHost, HostWaitsWhileTheDeviceIsNotReady) {
  device_.silent = true;
  const std::uint32_t asked = host_.ask(1, 8), reported = host_.tell(1, std::vector<std::byte>(8));
  host_.frames(100);
  EXPECT_FALSE(host_.done(asked).has_value());
  EXPECT_FALSE(host_.done(reported).has_value());
  device_.silent = false;
  host_.frames();
  EXPECT_TRUE(host_.done(asked).has_value());
  EXPECT_TRUE(host_.done(reported).has_value());
}

TEST_F(AttachedHost, CancelsOnlyPendingTransfers) {
  const std::uint32_t first = host_.ask(1, 8), second = host_.ask(1, 8);
  const std::uint32_t back = host_.take_back(second);
  EXPECT_EQ(host_.done(back)->status, kUnlinked);
  host_.frames(3);
  EXPECT_TRUE(host_.done(first).has_value());
  EXPECT_FALSE(host_.done(second).has_value());
  EXPECT_EQ(host_.done(host_.take_back(first))->status, 0);
}

TEST_F(AttachedHost, ReportsBabbleAndKeepsTheHostsBuffer) {
  device_.in_size = 16;
  const std::uint32_t asked = host_.ask(1, 8);
  host_.frames();
  const auto done = host_.done(asked);
  ASSERT_TRUE(done.has_value());
  EXPECT_EQ(done->status, kBabble);
  EXPECT_EQ(done->data.size(), 8U);
  EXPECT_EQ(server_.counters().babbled, 1U);
}

TEST_F(AttachedHost, HaltsAStalledEndpointUntilTheHostClearsIt) {
  faulty_.order(*parse_fault("stall in for=1"));
  const std::uint32_t asked = host_.ask(1, 8);
  // The fault covers the current frame; the first packet is in the next one.
  faulty_.order(*parse_fault("stall in for=3"));
  host_.frames();
  EXPECT_EQ(host_.done(asked)->status, kStalled);
  host_.frames(10);
  const std::uint32_t again = host_.ask(1, 8);
  host_.frames();
  EXPECT_EQ(host_.done(again)->status, kStalled);
  const auto status =
      host_.control({.request_type = 0x82, .request = 0, .index = 0x81, .length = 2});
  EXPECT_EQ(status->data[0], std::byte{1});
  ASSERT_EQ(host_.control({.request_type = 0x02, .request = 1, .index = 0x81})->status, 0);
  const std::uint32_t now = host_.ask(1, 8);
  host_.frames();
  EXPECT_EQ(host_.done(now)->status, 0);
}

TEST_F(AttachedHost, HasNoEndpointBeforeItIsConfigured) {
  host_.hang_up();
  support::UsbHost fresh(server_);
  ASSERT_TRUE(fresh.import_device());
  const std::uint32_t asked = fresh.ask(1, 8);
  fresh.frames();
  EXPECT_LT(fresh.done(asked)->status, 0);
  fresh.configure();
  const std::uint32_t unknown = fresh.ask(9, 8);
  fresh.frames();
  EXPECT_LT(fresh.done(unknown)->status, 0);
}

TEST_F(AttachedHost, DisconnectsWhenTheDeviceLeaves) {
  host_.ask(1, 8);
  faulty_.order(*parse_fault("unplug for=5"));
  host_.frames();
  EXPECT_TRUE(host_.hung_up());
  support::UsbHost early(server_);
  EXPECT_FALSE(early.import_device());
  host_.frames(5);
  support::UsbHost again(server_);
  EXPECT_TRUE(again.import_device());
}

TEST_F(AttachedHost, DisconnectsOnInvalidMessages) {
  host_.say(std::vector<std::byte>(64, std::byte{0xff}));
  EXPECT_TRUE(host_.hung_up());
}

TEST_F(AttachedHost, DisconnectsClientWithTooManyTransfers) {
  for (std::size_t i = 0; i <= UsbipSession::kPendingMax; ++i) host_.ask(1, 8);
  EXPECT_TRUE(host_.hung_up());
}

TEST_F(UsbipServerTest, SurvivesInvalidClients) {
  std::mt19937_64 random(support::seed_of(3));
  for (int round = 0; round < 300; ++round) {
    support::UsbHost host(server_);
    if (round % 2 == 0) {
      ASSERT_TRUE(host.import_device());
    }
    for (int piece = 0; piece < 20 && !host.hung_up(); ++piece) {
      UsbipCommand command;
      command.sequence = static_cast<std::uint32_t>(piece);
      command.endpoint = static_cast<std::uint8_t>(random() % 17);
      command.to_host = random() % 2 == 0;
      command.length = static_cast<std::uint32_t>(random() % 100);
      for (std::byte& byte : command.setup) byte = static_cast<std::byte>(random());
      std::vector<std::byte> bytes =
          encode_command(command, std::vector<std::byte>(command.to_host ? 0 : command.length));
      if (random() % 4 == 0) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
      if (random() % 6 == 0) bytes.resize(random() % bytes.size());
      host.say(bytes);
      host.frames();
    }
  }
  support::UsbHost host(server_);
  EXPECT_TRUE(host.import_device());
}

TEST(Vhci, FindsTheFirstFreePortForAFullSpeedDevice) {
  const char* status =
      "hub port sta spd dev      sockfd local_busid\n"
      "hs  0000 006 002 00010001 000003 1-1\n"
      "ss  0008 004 000 00000000 000000 0-0\n"
      "hs  0001 004 000 00000000 000000 0-0\n";
  EXPECT_EQ(find_free_port(status), 1);
  EXPECT_EQ(find_free_port("hs 0000 006 002 00010001 000003 1-1"), std::nullopt);
  EXPECT_EQ(find_free_port(""), std::nullopt);
  EXPECT_EQ(find_free_port("\n\nhs\nhs x y\n"), std::nullopt);
}

TEST(Vhci, MissingVirtualHostErrorHasARemedy) {
  const auto attached = attach_to_kernel(1, "1-1", "/nonexistent/vhci_hcd.0");
  ASSERT_FALSE(attached.ok());
  EXPECT_NE(attached.error().message.find("modprobe vhci-hcd"), std::string::npos);
}

}  // namespace
}  // namespace thimble::device_sim::usb
