#include "arms/falcon/falcon_boot.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "system/regular_file.h"

namespace thimble::driver::falcon {
namespace {

constexpr std::array<std::byte, 3> kGreeting{std::byte{0x0a}, std::byte{0x43}, std::byte{0x0d}};
constexpr std::array<std::byte, 4> kGreetingAnswer{std::byte{0x0a}, std::byte{0x44},
                                                   std::byte{0x2c}, std::byte{0x0d}};
constexpr std::array<std::byte, 1> kReady{std::byte{0x41}};

Error line_lost(const char* step) {
  return Error{std::string("The Falcon's USB converter refused a request (") + step +
               "). Unplug the arm from USB and from power, plug it in again and retry."};
}

/// Reads until `wanted` is full or a read returns nothing; returns the number of bytes.
std::size_t read_all(SerialLine& line, std::span<std::byte> wanted, int timeout_ms) {
  std::size_t size = 0;
  while (size < wanted.size()) {
    const int count = line.read(wanted.subspan(size), timeout_ms);
    if (count <= 0) break;
    size += static_cast<std::size_t>(count);
  }
  return size;
}

/// Returns whether the bytes that the line delivers end with `answer`. The converter may deliver
/// stray earlier bytes (a zero is known [S]), so `answer` need not be at the beginning.
bool answers(SerialLine& line, std::span<const std::byte> answer, int timeout_ms) {
  std::array<std::byte, 64> heard{};
  std::size_t size = 0;
  while (size < heard.size()) {
    const int count = line.read(std::span(heard).subspan(size), timeout_ms);
    if (count <= 0) return false;
    size += static_cast<std::size_t>(count);
    const auto end = heard.begin() + static_cast<std::ptrdiff_t>(size);
    if (std::search(heard.begin(), end, answer.begin(), answer.end()) != end) return true;
  }
  return false;
}

void pause(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

/// Sends every block; returns the number of bytes echoed correctly, which is all of them on
/// success.
std::size_t send_blocks(SerialLine& line, std::span<const std::byte> firmware, int timeout_ms) {
  std::array<std::byte, kBlockSize> echo{};
  for (std::size_t sent = 0; sent < firmware.size();) {
    const auto block = firmware.subspan(sent, std::min(kBlockSize, firmware.size() - sent));
    if (!line.write(block)) return sent;
    const auto heard = std::span(echo).first(block.size());
    if (read_all(line, heard, timeout_ms) != block.size()) return sent;
    if (!std::equal(block.begin(), block.end(), heard.begin())) return sent;
    sent += block.size();
  }
  return firmware.size();
}

}  // namespace

Result<std::vector<std::byte>> read_firmware(const std::filesystem::path& file) {
  constexpr std::size_t kLargest =
      65536;  // the processor has 36 kB of RAM (TMS320C281x data sheet)
  const auto bytes = read_file(file, kLargest);
  std::error_code status;
  const bool too_large = is_regular(file) && std::filesystem::file_size(file, status) > kLargest;
  if (!bytes && !too_large) {
    return Error{"The firmware file " + file.string() +
                 " cannot be read. Pass the path of the image that came with the Falcon's "
                 "software; Thimble does not include it."};
  }
  if (!bytes || bytes->empty()) {
    return Error{file.string() + " is not Falcon firmware: it is " +
                 (bytes ? "empty." : "larger than 64 kB.")};
  }
  std::vector<std::byte> firmware(bytes->size());
  std::transform(bytes->begin(), bytes->end(), firmware.begin(),
                 [](char c) { return static_cast<std::byte>(c); });
  return firmware;
}

Result<void> enter_run_mode(SerialLine& line) {
  if (!line.set_latency_ms(1)) return line_lost("latency timer");
  if (!line.set_rate_divisor(kRunDivisor)) return line_lost("run rate");
  if (!line.purge()) return line_lost("purge");
  return {};
}

bool firmware_answers(SerialLine& line, const BootSettings& settings) {
  // The first packet after a mode change may follow an incomplete one; a second packet resolves
  // that.
  for (int attempt = 0; attempt < 3; ++attempt) {
    if (home_once(line, 0, settings).answered) return true;
  }
  return false;
}

Result<void> enter_boot_loader(SerialLine& line, const BootSettings& settings) {
  const auto set_up = [&] {
    return line.purge() &&
           line.set_latency_ms(static_cast<std::uint8_t>(settings.upload_latency_ms)) &&
           line.set_rate_divisor(kBootDivisor) && line.set_frame_8n1() && line.set_rts(false) &&
           line.set_dtr(false);
  };
  if (!set_up()) return line_lost("boot set-up");
  pause(settings.settle_ms);
  if (!line.set_dtr(true)) return line_lost("reset");
  pause(settings.settle_ms);

  bool greeted = false;
  for (int attempt = 0; attempt < settings.greetings_max && !greeted; ++attempt) {
    if (!line.write(kGreeting)) return line_lost("greeting");
    greeted = answers(line, kGreetingAnswer, settings.answer_timeout_ms);
  }
  if (!greeted) {
    return Error{
        "The Falcon's boot loader does not answer. Check that its power supply is plugged in, and "
        "plug the arm directly into the computer, not into a hub."};
  }
  if (!line.set_dtr(false) || !line.set_rate_divisor(kUploadDivisor)) return line_lost("upload");
  pause(settings.settle_ms);
  if (!line.write(kReady)) return line_lost("upload rate");
  if (!answers(line, kReady, settings.answer_timeout_ms)) {
    return Error{
        "The Falcon's boot loader does not answer at the upload rate. Switch the arm off and on "
        "and retry."};
  }
  return {};
}

Result<UploadReport> upload_firmware(SerialLine& line, std::span<const std::byte> firmware,
                                     const BootSettings& settings) {
  UploadReport report{.size = firmware.size()};
  std::string why = "no attempt was made";
  while (report.attempts < settings.block_attempts_max) {
    ++report.attempts;
    // The loader may be in an unknown state. After a reset the next byte is certainly the first.
    if (auto entered = enter_boot_loader(line, settings); !entered) return entered.error();
    const std::size_t sent = send_blocks(line, firmware, settings.answer_timeout_ms);
    if (sent < firmware.size()) {
      report.resumed_at = sent;
      why = "the echo was wrong or missing at byte " + std::to_string(sent);
      continue;
    }
    if (auto running = enter_run_mode(line); !running) return running.error();
    if (firmware_answers(line, settings)) return report;
    why = "the firmware did not answer after the upload";
  }
  return Error{"The Falcon did not accept its firmware in " + std::to_string(report.attempts) +
               " attempts (last error: " + why +
               "). Plug the arm directly into the computer, switch it off and on, and check that "
               "the file is a firmware image of the Falcon."};
}

Result<UploadReport> prepare(SerialLine& line, const std::filesystem::path& firmware_file,
                             const BootSettings& settings) {
  if (auto running = enter_run_mode(line); !running) return running.error();
  if (firmware_answers(line, settings)) return UploadReport{};
  if (firmware_file.empty()) {
    return Error{
        "The Falcon has no firmware, because it loses it when it is switched off. Pass the image "
        "that came with its software by --firmware FILE."};
  }
  auto firmware = read_firmware(firmware_file);
  if (!firmware) return firmware.error();
  return upload_firmware(line, *firmware, settings);
}

HomingState home_once(SerialLine& line, std::uint8_t homed_before, const BootSettings& settings) {
  HostPacket ask;
  ask.lights = static_cast<std::uint8_t>(kHomingMode |
                                         (homed_before == kAllHomed ? kGreenLight : kRedLight));
  HomingState state;
  if (!line.write(encode_host_packet(ask))) return state;
  // Skip bytes before the beginning of a packet, then take sixteen bytes.
  std::array<std::byte, kPacketSize> packet{};
  for (std::size_t skipped = 0; skipped < 4 * kPacketSize; ++skipped) {
    if (read_all(line, std::span(packet).first(1), settings.answer_timeout_ms) != 1) return state;
    if (packet[0] != std::byte{'<'}) continue;
    const auto rest = std::span(packet).subspan(1);
    if (read_all(line, rest, settings.answer_timeout_ms) != rest.size()) return state;
    const auto answer = decode_arm_packet(packet);
    if (!answer) continue;
    return {.answered = true, .homed = answer->homed, .counts = answer->counts};
  }
  return state;
}

}  // namespace thimble::driver::falcon
