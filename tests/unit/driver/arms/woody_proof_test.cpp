#include "arms/woody/woody_proof.h"

#include <gtest/gtest.h>

#include <functional>

#include "arms/woody/woody_report.h"
#include "support/random.h"

namespace thimble::driver::woody {
namespace {

/// A board that sends a report in each frame of 1 ms, or none, and counts what is written to it.
class Board final : public Transport {
 public:
  using ReportSource = std::function<std::optional<InputReport>(int frame)>;
  Board(VirtualClock& clock, ReportSource source) : clock_(clock), source_(std::move(source)) {}

  TransportRead read_latest(std::span<std::byte> buffer,
                            std::int64_t deadline_ns) noexcept override {
    if (lost) return {.status = TransportStatus::kLost};
    clock_.sleep_until_ns(std::min(deadline_ns, clock_.now_ns() + 1'000'000));
    const auto report = source_(frame_++);
    if (!report) return {};
    const auto bytes = encode_input(*report);
    std::copy(bytes.begin(), bytes.end(), buffer.begin());
    return {.status = TransportStatus::kOk, .size = size, .skipped = skipped};
  }
  TransportStatus write(std::span<const std::byte>) noexcept override {
    ++written;
    return TransportStatus::kOk;
  }

  bool lost = false;
  std::size_t size = kReportSize;
  std::uint32_t skipped = 0;
  int written = 0;

 private:
  VirtualClock& clock_;
  ReportSource source_;
  int frame_ = 0;
};

InputReport numbered(int number) {
  return {.counts = {1, 2, 3}, .counter = static_cast<std::uint16_t>(number)};
}

std::string refusal(const Board::ReportSource& source, std::size_t size = kReportSize) {
  VirtualClock clock;
  Board board(clock, source);
  board.size = size;
  const auto heard = listen_for_board(board, clock);
  EXPECT_EQ(board.written, 0);
  EXPECT_LE(clock.now_ns(), 1'100'000'000);
  return heard ? "" : heard.error().message;
}

TEST(WoodyProof, AcceptsNumberedReportsWithoutSending) {
  EXPECT_EQ(refusal([](int frame) { return numbered(frame); }), "");
  EXPECT_EQ(refusal([](int frame) { return numbered(65'530 + frame); }), "");  // the number wraps
  // Half a second of silence after power-on, and reports left over from an earlier time.
  EXPECT_EQ(refusal([](int frame) -> std::optional<InputReport> {
              if (frame < 500) return {};
              return numbered(frame == 500 ? 7 : 40'000 + frame);
            }),
            "");
}

TEST(WoodyProof, SkippedReportsAdvanceTheExpectedNumber) {
  VirtualClock clock;
  Board board(clock, [](int frame) { return numbered(4 * frame); });
  board.skipped = 3;
  EXPECT_TRUE(listen_for_board(board, clock));
  EXPECT_EQ(board.written, 0);
}

TEST(WoodyProof, RefusesOtherBoardsAndSendsThemNothing) {
  const auto silent = refusal([](int) { return std::nullopt; });
  EXPECT_NE(silent.find("sends no reports by itself"), std::string::npos) << silent;
  support::Random random(8);
  const auto noise =
      refusal([&](int) { return numbered(static_cast<int>(random.bits() % 65'536)); });
  EXPECT_NE(noise.find("not numbered"), std::string::npos) << noise;
  EXPECT_NE(refusal([](int) { return numbered(5); }), "");
  EXPECT_NE(refusal([](int frame) { return numbered(2 * frame); }), "");
  EXPECT_NE(refusal([](int frame) { return numbered(-frame); }), "");
  EXPECT_NE(refusal([](int frame) { return numbered(frame % 20); }), "");  // only 19 correct steps
  EXPECT_NE(refusal([](int frame) { return numbered(frame); }, 7), "");
}

TEST(WoodyProof, ReportsADisconnectedBoard) {
  VirtualClock clock;
  Board board(clock, [](int frame) { return numbered(frame); });
  board.lost = true;
  EXPECT_FALSE(listen_for_board(board, clock));
}

}  // namespace
}  // namespace thimble::driver::woody
