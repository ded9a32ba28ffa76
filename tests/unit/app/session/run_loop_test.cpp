// The loop of a run over a link of the test: when and in which order its observers are called.
#include "run_loop.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "arms/hfab/hfab_report.h"
#include "support/boards/scripted_transport.h"
#include "support/heap_guard.h"
#include "support/vintage_arm.h"
#include "thimble/driver/wire_link.h"

namespace thimble {
namespace {

/// Link of an arm that always reports its home pose.
class HomeTransport final : public driver::Transport {
 public:
  explicit HomeTransport(int& messages) : messages_(messages) {}
  driver::TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
    const auto bytes = driver::hfab::encode_input({});
    std::copy(bytes.begin(), bytes.end(), buffer.begin());
    return {.status = driver::TransportStatus::kOk, .size = bytes.size(), .skipped = 0};
  }
  driver::TransportStatus write(std::span<const std::byte>) noexcept override {
    ++messages_;
    return driver::TransportStatus::kOk;
  }

 private:
  int& messages_;
};

class RunLoopTest : public ::testing::Test {
 protected:
  /// Records the order of the observers' calls, and the messages sent before.
  class Witness final : public session::TickObserver {
   public:
    Witness(RunLoopTest& test, int number) : test_(test), number_(number) {}
    void take(const driver::TickRecord& record) noexcept override {
      if (test_.records_.size() < test_.records_.capacity()) {
        test_.records_.push_back({record.tick, number_, test_.messages_, record.f_sent_W[0]});
      }
    }

   private:
    RunLoopTest& test_;
    int number_;
  };
  struct Told {
    std::uint64_t tick;
    int observer, messages;
    double force;
  };

  void SetUp() override {
    records_.reserve(100);
    auto opened =
        driver::Device::open(std::make_unique<driver::WireLink>(
                                 std::make_unique<HomeTransport>(messages_),
                                 std::make_unique<driver::hfab::HfabArm>(support::vintage_model())),
                             support::vintage_settings(), 0);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
  }

  int messages_ = 0;
  std::vector<Told> records_;
  std::unique_ptr<driver::Device> device_;
  driver::VirtualClock clock_;
  std::atomic<bool> stop_{false};
};

TEST_F(RunLoopTest, ObserversRunInOrderAfterTheForce) {
  auto law = [](const driver::DeviceState&) noexcept {
    return driver::ForceCommand{.f_T_W = {1, 0, 0}, .touch = {}};
  };
  Witness first(*this, 1), second(*this, 2);
  session::RunLoop loop;
  loop.add(first);
  loop.add(second);
  EXPECT_FALSE(loop.begun());
  loop.begin(*device_, clock_, driver::ForceLaw(law), {.ticks = 5});
  EXPECT_TRUE(loop.begun());
  const int before = messages_;
  std::optional<driver::ServoEnd> end;
  EXPECT_EQ(support::heap_calls_of([&] {
              while (!(end = loop.tick(stop_))) EXPECT_FALSE(loop.end());
            }),
            0);
  EXPECT_EQ(end, driver::ServoEnd::kDone);
  EXPECT_EQ(loop.end(), driver::ServoEnd::kDone);
  ASSERT_EQ(records_.size(), 10u);
  for (std::size_t i = 0; i < records_.size(); ++i) {
    EXPECT_EQ(records_[i].tick, i / 2);
    EXPECT_EQ(records_[i].observer, i % 2 == 0 ? 1 : 2);
    EXPECT_EQ(records_[i].messages - before, static_cast<int>(i / 2 + 1))
        << "sent before the observers are called";
    EXPECT_NEAR(records_[i].force, static_cast<double>(i / 2) / 60, 1e-12)
        << "the gate's soft start";
  }
}

TEST_F(RunLoopTest, DoesNotCallObserversAfterItsEnd) {
  auto law = [](const driver::DeviceState&) noexcept { return driver::ForceCommand{}; };
  Witness witness(*this, 1);
  session::RunLoop loop;
  loop.add(witness);
  loop.begin(*device_, clock_, driver::ForceLaw(law), {});
  EXPECT_FALSE(loop.tick(stop_));
  stop_.store(true);
  EXPECT_EQ(loop.tick(stop_), driver::ServoEnd::kStopped);
  const int messages = messages_;
  const std::size_t reported = records_.size();
  EXPECT_EQ(loop.tick(stop_), driver::ServoEnd::kStopped);
  EXPECT_EQ(records_.size(), reported);
  EXPECT_EQ(messages_, messages);
}

}  // namespace
}  // namespace thimble
