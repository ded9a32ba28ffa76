#include "emulated_program.h"

#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <utility>

#include "firmware/boards/plant_link.h"
#include "firmware/core/bytes.h"
#include "firmware/core/crc16.h"
#include "support/scratch.h"

extern char** environ;

namespace thimble::firmware_test {
namespace {

namespace fw = firmware;
using Bytes = std::vector<std::uint8_t>;

// Longest time for an answer, ms. [chosen: 10,000 times the usual one, for busy computers]
constexpr int kAnswer_ms = 30'000;

int listen_at(const std::filesystem::path& path) {
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  unlink(path.c_str());
  if (bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return -1;
  return listen(fd, 1) == 0 ? fd : -1;
}

bool readable(int fd) {
  pollfd wait{.fd = fd, .events = POLLIN, .revents = 0};
  return poll(&wait, 1, kAnswer_ms) == 1;
}

template <class Number>
void append(Bytes& bytes, Number value) {
  bytes.resize(bytes.size() + sizeof value);
  fw::put(bytes.data() + bytes.size() - sizeof value, value);
}

Bytes health_of(const fw::Inputs& inputs, bool hang) {
  Bytes bytes{fw::kHealth, fw::kWireVersion};
  for (const std::int16_t count : inputs.gimbal) append(bytes, count);
  append(bytes, inputs.supply_mV);
  append(bytes, inputs.temperature_dC);
  bytes.push_back(inputs.encoder_error ? 1 : 0);
  bytes.push_back(inputs.buttons);
  bytes.push_back(hang ? 1 : 0);
  bytes.push_back(0);
  return bytes;
}

}  // namespace

std::unique_ptr<EmulatedProgram> EmulatedProgram::start(const std::filesystem::path& image,
                                                        const fw::ArmConfig& config) {
  std::unique_ptr<EmulatedProgram> program(new EmulatedProgram);
  program->config_ = config;
  program->image_ = image;
  if (!program->launch(image) || !program->configure()) return nullptr;
  return program;
}

EmulatedProgram::~EmulatedProgram() {
  stop();
}

bool EmulatedProgram::launch(const std::filesystem::path& image) {
  static int number = 0;
  folder_ = support::scratch_folder() / ("qemu" + std::to_string(++number));
  std::filesystem::create_directories(folder_);
  host_.listener = listen_at(folder_ / "host");
  plant_.listener = listen_at(folder_ / "plant");
  const std::array<std::string, 15> arguments = {"qemu-system-arm",
                                                 "-M",
                                                 "mps2-an385",
                                                 "-kernel",
                                                 image.string(),
                                                 "-display",
                                                 "none",
                                                 "-monitor",
                                                 "none",
                                                 "-icount",
                                                 "shift=5,sleep=on",
                                                 "-serial",
                                                 "unix:" + (folder_ / "host").string(),
                                                 "-serial",
                                                 "unix:" + (folder_ / "plant").string()};
  std::array<char*, arguments.size() + 1> pointers{};
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    pointers[i] = const_cast<char*>(arguments[i].c_str());
  }
  if (posix_spawnp(&qemu_, pointers[0], nullptr, nullptr, pointers.data(), environ) != 0) {
    qemu_ = -1;
    return false;
  }
  for (Port* port : {&host_, &plant_}) {
    if (!readable(port->listener)) return false;
    port->fd = accept4(port->listener, nullptr, nullptr, SOCK_CLOEXEC);
    if (port->fd < 0) return false;
  }
  return true;
}

void EmulatedProgram::stop() noexcept {
  if (qemu_ > 0) {
    kill(qemu_, SIGKILL);
    waitpid(qemu_, nullptr, 0);
    qemu_ = -1;
  }
  for (Port* port : {&host_, &plant_}) {
    if (port->fd >= 0) close(port->fd);
    if (port->listener >= 0) close(port->listener);
    *port = {};
  }
}

bool EmulatedProgram::configure() {
  Bytes content(fw::kDescriptionSize);
  fw::encode_description(config_, 0, content.data());
  content[0] = fw::kConfiguration;
  content.resize(content.size() - 2);
  send(plant_, std::move(content));
  description_ = next(host_);
  health_.reset();
  return !failed_;
}

/// Sends content as a frame, with its CRC.
void EmulatedProgram::send(Port& port, Bytes content) {
  append(content, fw::crc16(content.data(), content.size()));
  std::array<std::uint8_t, fw::kFrameMax> frame{};
  const std::size_t size = fw::encode_frame(content.data(), content.size(), frame.data());
  if (::send(port.fd, frame.data(), size, MSG_NOSIGNAL) != static_cast<ssize_t>(size)) {
    failed_ = true;
  }
}

/// Returns the next frame of a port with a valid CRC; empty, with `failed_`, if none comes.
Bytes EmulatedProgram::next(Port& port) {
  while (!failed_) {
    std::uint8_t byte = 0;
    if (!readable(port.fd) || read(port.fd, &byte, 1) != 1) break;
    const std::size_t size = port.reader.take(byte);
    if (size < 3) continue;
    const std::uint8_t* content = port.reader.content();
    if (fw::get<std::uint16_t>(content + size - 2) != fw::crc16(content, size - 2)) break;
    return {content, content + size};
  }
  failed_ = true;
  return {};
}

void EmulatedProgram::send_sensors(bool tick, std::uint32_t time_us) {
  time_us_ = time_us;
  Bytes bytes{fw::kSensors, fw::kWireVersion, static_cast<std::uint8_t>(tick ? 1 : 0), 0};
  append(bytes, time_us);
  for (const std::int32_t count : inputs_.counts) append(bytes, count);
  send(plant_, std::move(bytes));
}

void EmulatedProgram::take_motors(bool tick) {
  const Bytes bytes = next(plant_);
  if (bytes.size() != fw::kMotorsSize) {
    failed_ = true;
    outputs_ = {};
    return;
  }
  outputs_.motors_on = bytes[2] != 0;
  for (std::size_t i = 0; i < fw::kMotorsMax; ++i) {
    outputs_.amperes[i] = fw::get<float>(bytes.data() + 4 + 4 * i);
  }
  outputs_.fed_us = fw::get<std::uint32_t>(bytes.data() + 24);
  if (!tick) return;
  pass_max_ = std::max(pass_max_, static_cast<double>(fw::get<std::uint32_t>(bytes.data() + 16)) /
                                      fw::get<std::uint32_t>(bytes.data() + 20));
}

void EmulatedProgram::tick(const fw::Inputs& inputs, std::uint32_t time_us,
                           std::span<std::uint8_t, fw::kHidReportSize> report) noexcept {
  inputs_ = inputs;
  Bytes health = health_of(inputs, false);
  if (health_ != health) {
    health_ = health;
    send(plant_, std::move(health));
  }
  send_sensors(true, time_us);
  take_motors(true);
  Bytes bytes;
  do {
    bytes = next(host_);
    if (bytes.size() == fw::kDescriptionSize) description_ = bytes;
  } while (bytes.size() == fw::kDescriptionSize);
  std::fill(report.begin(), report.end(), std::uint8_t{0});
  if (bytes.size() == fw::kStateSize) {
    std::copy(bytes.begin(), bytes.end(), report.begin());
  } else {
    failed_ = true;
  }
}

void EmulatedProgram::receive(std::span<const std::uint8_t> message,
                              std::uint32_t time_us) noexcept {
  if (time_us != time_us_) watch(time_us);
  std::array<std::uint8_t, fw::kFrameMax> frame{};
  const std::size_t size = fw::encode_frame(message.data(), message.size(), frame.data());
  if (size == 0 || message.empty()) return;
  if (::send(host_.fd, frame.data(), size, MSG_NOSIGNAL) != static_cast<ssize_t>(size)) {
    failed_ = true;
  }
  take_motors(false);
}

void EmulatedProgram::watch(std::uint32_t time_us) noexcept {
  send_sensors(false, time_us);
  take_motors(false);
}

void EmulatedProgram::restart() noexcept {
  stop();
  outputs_ = {};
  failed_ = !launch(image_) || !configure();
}

Bytes EmulatedProgram::hang() {
  send(plant_, health_of(inputs_, true));
  send_sensors(true, time_us_);
  // The emulated watchdog restarts the firmware, which asks for its configuration again. A frame
  // that arrives before is lost, so this one is repeated.
  description_.clear();
  for (int attempt = 0; attempt < 100 && description_.empty(); ++attempt) {
    Bytes content(fw::kDescriptionSize);
    fw::encode_description(config_, 0, content.data());
    content[0] = fw::kConfiguration;
    content.resize(content.size() - 2);
    send(plant_, std::move(content));
    pollfd wait{.fd = host_.fd, .events = POLLIN, .revents = 0};
    if (poll(&wait, 1, 100) == 1) description_ = next(host_);
  }
  health_.reset();
  outputs_ = {};
  return description_;
}

}  // namespace thimble::firmware_test
