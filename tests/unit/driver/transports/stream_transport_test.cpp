#include "transports/stream_transport.h"

#include <gtest/gtest.h>

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "arms/hfab/hfab_line.h"

namespace thimble::driver {
namespace {

std::string bracketed(int number) {
  std::string text = "[";
  text += std::to_string(number);
  text += ']';
  return text;
}

/// A ping-pong arm in simulated time: answers each message with its number, `delay_ns` later.
class EchoStream final : public StreamTransport {
 public:
  explicit EchoStream(VirtualClock& clock)
      : StreamTransport(clock, {.begin = std::byte{'['}, .end = std::byte{']'}, .size_max = 20}),
        clock_(clock) {}

  std::int64_t delay_ns = 300'000;
  bool silent = false, gone = false, full = false;
  int max_unanswered = 0;  // unanswered messages at the same time
  std::vector<std::string> heard;

 private:
  TransportStatus pump(std::int64_t wait_ns) noexcept override {
    if (gone) return TransportStatus::kLost;
    const std::int64_t until_ns = clock_.now_ns() + wait_ns;
    if (answers_.empty() || answers_.front() > until_ns) {
      clock_.sleep_until_ns(until_ns);
      return TransportStatus::kOk;
    }
    clock_.sleep_until_ns(answers_.front());
    answers_.pop_front();
    const std::string text = bracketed(++answered_);
    finder().push({reinterpret_cast<const std::byte*>(text.data()), text.size()});
    return TransportStatus::kOk;
  }

  TransportStatus put(std::span<const std::byte> bytes) noexcept override {
    if (gone) return TransportStatus::kLost;
    if (full) return TransportStatus::kRefused;
    heard.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!silent) answers_.push_back(clock_.now_ns() + delay_ns);
    max_unanswered = std::max(max_unanswered, static_cast<int>(answers_.size()));
    return TransportStatus::kOk;
  }

  VirtualClock& clock_;
  std::deque<std::int64_t> answers_;
  int answered_ = 0;
};

class StreamTransportTest : public ::testing::Test {
 protected:
  std::string read(std::int64_t deadline_ns = 0) {
    std::array<std::byte, 64> buffer{};
    last_ = wire_.read_latest(buffer, deadline_ns);
    return {reinterpret_cast<const char*>(buffer.data()), last_.size};
  }
  TransportStatus write(std::string_view text = "[0]") {
    return wire_.write({reinterpret_cast<const std::byte*>(text.data()), text.size()});
  }
  void next_tick() { clock_.sleep_until_ns(++tick_ * 1'000'000); }

  VirtualClock clock_;
  EchoStream wire_{clock_};
  TransportRead last_;
  std::int64_t tick_ = 0;
};

TEST_F(StreamTransportTest, ReadsTheAnswerToThePreviousTick) {
  write();
  for (int tick = 1; tick <= 100; ++tick) {
    next_tick();
    EXPECT_EQ(read(clock_.now_ns()), bracketed(tick));
    EXPECT_EQ(last_.skipped, 0u);
    const std::int64_t before_ns = clock_.now_ns();
    EXPECT_EQ(write(), TransportStatus::kOk);
    EXPECT_EQ(clock_.now_ns(), before_ns);  // no waiting if the answer has arrived
  }
  EXPECT_EQ(wire_.max_unanswered, 1);
  EXPECT_EQ(wire_.counters().unanswered, 0u);
}

TEST_F(StreamTransportTest, WaitsForALateAnswer) {
  write();
  std::int64_t longest_ns = 0;
  for (int tick = 1; tick <= 500; ++tick) {
    wire_.delay_ns = tick % 5 == 0 ? 1'300'000 : 300'000;
    next_tick();
    read(clock_.now_ns());
    const std::int64_t before_ns = clock_.now_ns();
    write();
    longest_ns = std::max(longest_ns, clock_.now_ns() - before_ns);
  }
  EXPECT_EQ(longest_ns, 300'000);  // only until the answer
  EXPECT_EQ(wire_.max_unanswered, 1);
  EXPECT_EQ(wire_.counters().unanswered, 0u);
}

TEST_F(StreamTransportTest, WaitsForASilentArmOnlyOnce) {
  wire_.silent = true;
  write();
  std::int64_t waited_ns = 0;
  for (int tick = 0; tick < 20; ++tick) {
    next_tick();
    EXPECT_EQ(read(clock_.now_ns()), "");
    EXPECT_EQ(last_.status, TransportStatus::kNothing);
    const std::int64_t before_ns = clock_.now_ns();
    EXPECT_EQ(write("[zero]"), TransportStatus::kOk);
    waited_ns += clock_.now_ns() - before_ns;
  }
  EXPECT_EQ(waited_ns, StreamTransport::kTurn_ns);
  EXPECT_EQ(wire_.heard.size(), 21u);  // no message was delayed
  EXPECT_EQ(wire_.counters().unanswered, 20u);
}

TEST_F(StreamTransportTest, ContinuesAfterALostAnswer) {
  wire_.silent = true;
  write();
  wire_.silent = false;
  next_tick();
  EXPECT_EQ(read(clock_.now_ns()), "");
  write();
  next_tick();
  next_tick();
  EXPECT_EQ(read(clock_.now_ns()), "[1]");
}

TEST_F(StreamTransportTest, WaitsNoLongerThanTheDeadline) {
  wire_.delay_ns = 5'000'000;
  write();
  EXPECT_EQ(read(2'000'000), "");
  EXPECT_EQ(clock_.now_ns(), 2'000'000);
  EXPECT_EQ(read(10'000'000), "[1]");
  EXPECT_EQ(clock_.now_ns(), 5'000'000);
}

TEST_F(StreamTransportTest, StaysLostOnceTheWireIsGone) {
  write();
  wire_.gone = true;
  read(clock_.now_ns());
  EXPECT_EQ(last_.status, TransportStatus::kLost);
  wire_.gone = false;
  read(clock_.now_ns());
  EXPECT_EQ(last_.status, TransportStatus::kLost);
  EXPECT_EQ(write(), TransportStatus::kLost);
}

TEST_F(StreamTransportTest, ForwardsARefusal) {
  wire_.full = true;
  EXPECT_EQ(write(), TransportStatus::kRefused);
}

}  // namespace
}  // namespace thimble::driver
