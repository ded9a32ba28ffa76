#include "arms/woody/woody_proof.h"

#include <array>
#include <cstdint>
#include <optional>

#include "arms/woody/woody_report.h"
#include "thimble/driver/arm.h"

namespace thimble::driver::woody {
namespace {

// Random data have the next number once in 65,536, so 20 in a row are not chance. They take 20 ms
// of the second that is waited. A board that has just got power waits half a second [S main.cpp,
// wait_ms].
constexpr int kWanted = 20;
constexpr std::int64_t kListen_ns = 1'000'000'000;
constexpr std::int64_t kWait_ns = 20'000'000;
// A wall clock ends the wait after a second; this bound ends it if the clock does not advance.
// [chosen]
constexpr int kReadsMax = 2000;

}  // namespace

Result<void> listen_for_board(Transport& wire, const Clock& clock) {
  const std::int64_t end_ns = clock.now_ns() + kListen_ns;
  std::optional<std::uint16_t> before;
  int in_a_row = 0, reports = 0;
  for (int i = 0; i < kReadsMax && clock.now_ns() < end_ns; ++i) {
    std::array<std::byte, kReportCapacity> buffer{};
    const TransportRead read = wire.read_latest(buffer, clock.now_ns() + kWait_ns);
    if (read.status == TransportStatus::kLost) {
      return Error{
          "The board was disconnected while its reports were checked. Check its cable and power."};
    }
    if (read.status != TransportStatus::kOk) continue;
    ++reports;
    const auto report = decode_input(std::span<const std::byte>(buffer).first(read.size));
    if (!report) {
      before.reset();
      in_a_row = 0;
      continue;
    }
    const auto expected =
        static_cast<std::uint16_t>(before.value_or(0) + 1 + static_cast<unsigned>(read.skipped));
    in_a_row = before && report->counter == expected ? in_a_row + 1 : 0;
    before = report->counter;
    if (in_a_row == kWanted) return {};
  }
  if (reports == 0) {
    return Error{
        "The board sends no reports by itself, unlike a WoodenHaptics board. Nothing was sent to "
        "it. Check its power. If the arm has other firmware, set the matching board in its arm "
        "file."};
  }
  return Error{
      "The board's reports are not numbered like those of a WoodenHaptics board, so it is another "
      "device with the same USB id. Nothing was sent to it. Unplug it, or name another device by "
      "--device."};
}

}  // namespace thimble::driver::woody
