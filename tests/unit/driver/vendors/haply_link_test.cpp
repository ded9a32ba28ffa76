#include "vendors/haply/haply_link.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cstdlib>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "support/boards/link_fault.h"
#include "support/heap_guard.h"
#include "support/mock/mock_haply_service.h"
#include "support/patient_clock.h"
#include "support/vintage_arm.h"
#include "thimble/driver/device.h"
#include "vendors/linked_arms.h"

namespace thimble::driver {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using support::HaplyGreeting;
using support::HaplyLog;
using support::HaplyMischief;
using support::MockHaplyService;

// The service has its own thread, on a machine that may be busy: no test depends on speed, and a
// fault may be late.
constexpr std::int64_t kPatient_ns = 2'000'000'000;

/// Time for which a tick waits for the reaction of the service: none if an earlier message has not
/// been answered.
constexpr auto kServed = std::chrono::milliseconds(10);

class HaplyLinkTest : public ::testing::Test {
 protected:
  void greet(HaplyGreeting greeting = HaplyGreeting::kInverse3, bool old_spelling = false) {
    service_ = std::make_unique<MockHaplyService>(greeting, old_spelling, 0, &clock_);
  }

  static DeviceSettings settings(std::int64_t silence_ns) {
    DeviceSettings settings = support::vintage_settings();
    settings.R_WB = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()).toRotationMatrix();
    settings.p_WB = {-0.13, 0, -0.17};
    settings.motion = {.mass = 0.1, .delay_ticks = 0};
    settings.silence_limit_ns = silence_ns;
    settings.limits.stall_ns = 900'000'000;
    settings.limits.watchdog_ns = 1'000'000'000;
    settings.limits.speed_max = 20;
    return settings;
  }

  Result<std::unique_ptr<ArmLink>> link() {
    return haply::open_link("049D", service_->port(), clock_);
  }

  void open(std::int64_t silence_ns = kPatient_ns) {
    auto opened = link();
    ASSERT_TRUE(opened) << opened.error().message;
    auto device = Device::open(std::move(opened).value(), settings(silence_ns), clock_.now_ns());
    ASSERT_TRUE(device) << device.error().message;
    device_ = std::move(device).value();
    ASSERT_TRUE(device_->activate());
  }

  /// Runs a tick of a millisecond and waits until the service has handled its message. Returns the
  /// number of allocations of the servo thread.
  int tick(const Vector3d& f_T_W) {
    const std::uint64_t before = service_ ? service_->dealt_with() : 0;
    clock_.sleep_until_ns(clock_.now_ns() + 1'000'000);
    const int calls = support::heap_calls_of([&] {
      device_->read(clock_.now_ns(), 0);
      device_->write({.f_T_W = f_T_W, .touch = {}});
    });
    if (!service_ || device_->lost()) return calls;
    const auto end = std::chrono::steady_clock::now() + kServed;
    while (service_->dealt_with() == before && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    return calls;
  }

  /// Runs ticks until `done`, up to a maximum number.
  template <class Done>
  bool ticks_until(const Vector3d& f_T_W, Done&& done) {
    for (int i = 0; i < 10'000; ++i) {
      tick(f_T_W);
      if (done()) return true;
    }
    return false;
  }
  void ticks(int count, const Vector3d& f_T_W) {
    ticks_until(f_T_W, [&] { return --count <= 0; });
  }

  /// Starts a fault of the service while a force acts. Returns the resulting fault and the number
  /// of forces accepted before.
  Fault fault_of(HaplyMischief mischief, std::size_t& before) {
    greet();
    open(50'000'000);
    if (!device_) return Fault::kNone;
    const auto pushes = [&] { return device_->f_sent_W().x() > 0.5; };
    if (!ticks_until({1, 0, 0}, pushes)) {
      ADD_FAILURE() << "no force: " << describe(device_->fault());
      return Fault::kNone;
    }
    service_->begin(mischief);
    before = service_->log().taken_B.size();
    EXPECT_TRUE(ticks_until({1, 0, 0}, [&] { return device_->fault() != Fault::kNone; }));
    return device_->fault();
  }

  support::PatientClock clock_;
  std::unique_ptr<MockHaplyService> service_;
  std::unique_ptr<Device> device_;
};

TEST_F(HaplyLinkTest, SendsTheGatedForceInTheBaseFrame) {
  for (const bool old_spelling : {false, true}) {
    greet(HaplyGreeting::kInverse3, old_spelling);
    ASSERT_NO_FATAL_FAILURE(open());
    ASSERT_TRUE(ticks_until({0.4, 0, 0}, [&] {
      return (device_->f_sent_W() - Vector3d(0.4, 0, 0)).norm() < 1e-9 &&
             device_->wire_counters().reports > 300;
    }));
    // The world's x axis is minus the y axis of the service; the soft start is over.
    const HaplyLog log = service_->log();
    EXPECT_EQ(log.wrong, 0);
    ASSERT_FALSE(log.taken_B.empty());
    EXPECT_LT((log.taken_B.back() - Vector3d(0, -0.4, 0)).norm(), 1e-6);
    EXPECT_EQ(log.taken_B.front(), Vector3d(0, 0, 0)) << "the first message is zero force";
    // The hand of 300 N/m yields to the force, towards minus y.
    const double yielded = -0.13 - 0.4 / 300;
    EXPECT_NEAR(log.p_BT.y(), yielded, 2e-4);
    EXPECT_LT((device_->state().p_WT -
               (settings(0).p_WB + settings(0).R_WB * Vector3d(0.01, yielded, 0.17)))
                  .norm(),
              4e-4);
    EXPECT_EQ(device_->fault(), Fault::kNone) << describe(device_->fault());
    EXPECT_LT(
        (settings(0).p_WB + settings(0).R_WB * device_->state().q - device_->state().p_WT).norm(),
        1e-12)
        << "the axes of the base are used as joints";
    EXPECT_FALSE(device_->state().has_orientation);
    EXPECT_FALSE(device_->traits().motors.has_value());
    device_.reset();
  }
}

TEST_F(HaplyLinkTest, ReportsTheOrientationOfTheGrip) {
  greet(HaplyGreeting::kWithGrip);
  ASSERT_NO_FATAL_FAILURE(open());
  ticks(50, {0, 0, 0});
  ASSERT_TRUE(device_->state().has_orientation);
  // A quarter turn of the grip and a quarter turn of the base.
  const Matrix3d half = Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_LT((device_->state().R_WT - half).norm(), 1e-5);
  EXPECT_EQ(device_->state().buttons, 2);
}

TEST_F(HaplyLinkTest, EndsWithZeroForceAndAWebSocketClose) {
  greet();
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0.4, 0, 0}, [&] { return device_->f_sent_W().x() > 0.3; }));
  device_.reset();
  for (int i = 0; i < 2000 && !service_->log().closed_by_client; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(service_->log().closed_by_client);
  EXPECT_TRUE(service_->log().taken_B.back().isZero(0));
  EXPECT_EQ(service_->log().wrong, 0);
}

TEST_F(HaplyLinkTest, StalledLoopSendsNothing) {
  greet();
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0.4, 0, 0}, [&] { return device_->f_sent_W().x() > 0.3; }));
  clock_.sleep_until_ns(clock_.now_ns() + 100'000'000);
  const int messages = service_->log().messages;
  clock_.sleep_until_ns(clock_.now_ns() + 100'000'000);
  EXPECT_EQ(service_->log().messages, messages);
  EXPECT_TRUE(service_->log().f_T_B.isZero(0));
}

TEST_F(HaplyLinkTest, SendsNothingToAnUnprovenService) {
  const std::pair<HaplyGreeting, const char*> kCases[] = {
      {HaplyGreeting::kOther, "not Haply's service"},
      {HaplyGreeting::kNoJson, "not Haply's service"},
      {HaplyGreeting::kNothing, "sends no messages"},
      {HaplyGreeting::kNoArm, "no Inverse3 named 049D"},
      {HaplyGreeting::kUncalibrated, "not calibrated"},
      {HaplyGreeting::kInUse, "Another program uses the arm"}};
  for (const auto& [greeting, sentence] : kCases) {
    greet(greeting);
    const auto opened = link();
    ASSERT_FALSE(opened) << sentence;
    EXPECT_NE(opened.error().message.find(sentence), std::string::npos) << opened.error().message;
    EXPECT_EQ(service_->log().messages, 0) << sentence;
  }
}

TEST_F(HaplyLinkTest, ReportsAMissingServer) {
  greet();
  const std::uint16_t port = service_->port();
  service_.reset();
  const auto opened = haply::open_link("049D", port, clock_);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("No server listens on port " + std::to_string(port)),
            std::string::npos);
}

TEST_F(HaplyLinkTest, ListsTheArmsOfAServiceAndSendsNothing) {
  greet();
  const auto arms = haply::find_arms(service_->port());
  ASSERT_TRUE(arms) << arms.error().message;
  ASSERT_EQ(arms->size(), 1u);
  EXPECT_EQ(arms->front().device_id, "049D");
  EXPECT_EQ(arms->front().trouble, "");
  EXPECT_EQ(arms->front().versions, R"({"major_version":3,"minor_version":1})");
  EXPECT_EQ(service_->log().messages, 0);
  greet(HaplyGreeting::kUncalibrated);
  EXPECT_NE(haply::find_arms(service_->port())->front().trouble, "");
}

TEST_F(HaplyLinkTest, ArmIsFoundAtThePortOfTheUser) {
  greet();
  setenv("THIMBLE_HAPLY_PORT", std::to_string(service_->port()).c_str(), 1);
  const std::vector<FoundArm> found = find_linked_arms();
  unsetenv("THIMBLE_HAPLY_PORT");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, ArmKind::kHaply);
  EXPECT_EQ(found[0].board, BoardKind::kHaplyService);
  EXPECT_EQ(found[0].serial, "049D");
  EXPECT_EQ(found[0].address, "port " + std::to_string(service_->port()));
  EXPECT_EQ(found[0].software, R"({"major_version":3,"minor_version":1})");
  EXPECT_TRUE(found[0].accessible);
}

TEST(HaplyPort, IsThatOfTheServiceUnlessTheUserSetsAValidOne) {
  const std::uint16_t usual = haply::port_of_user();
  EXPECT_GT(usual, 0);
  for (const char* text : {"0", "-1", "65536", "80x", ""}) {
    setenv("THIMBLE_HAPLY_PORT", text, 1);
    EXPECT_EQ(haply::port_of_user(), usual) << text;
  }
  setenv("THIMBLE_HAPLY_PORT", "12345", 1);
  EXPECT_EQ(haply::port_of_user(), 12345);
  unsetenv("THIMBLE_HAPLY_PORT");
}

// The rows of the fault matrix for an arm behind a service: the fault of the service, the fault
// that latches, and the zero force that follows if the service still accepts messages.
TEST_F(HaplyLinkTest, NamesEachFaultOfAServiceAndLatchesZeroForce) {
  struct Row {
    const char* name;
    HaplyMischief mischief;
    Fault fault;
    int more;
  };
  // A message is sent every 10 ms to a service that does not answer; after 50 ms this is a fault.
  const Row rows[] = {{"service sends nothing", HaplyMischief::kSilent, Fault::kNoReports, 7},
                      {"service answers 60 ms late", HaplyMischief::kLate, Fault::kNoReports, 7},
                      {"NaN from the service", HaplyMischief::kNan, Fault::kNoReports, 2},
                      {"number too large", HaplyMischief::kInfinite, Fault::kNoReports, 2},
                      {"position in mm", HaplyMischief::kMillimetres, Fault::kNoReports, 2},
                      {"position without a number", HaplyMischief::kNull, Fault::kNoReports, 2},
                      {"invalid JSON", HaplyMischief::kGarbage, Fault::kNoReports, 2},
                      {"arm not ready", HaplyMischief::kNotReady, Fault::kNoReports, 2},
                      {"message of 1 MB", HaplyMischief::kHuge, Fault::kTransportLost, 2},
                      {"arm unplugged", HaplyMischief::kUnplugged, Fault::kTransportLost, 2},
                      {"socket closed", HaplyMischief::kClose, Fault::kTransportLost, 2},
                      {"service dies", HaplyMischief::kDie, Fault::kTransportLost, 2}};
  for (const Row& row : rows) {
    const support::LinkFaultRow promised(row.name, "Inverse3's service", row.fault, row.more);
    std::size_t before = 0;
    const Fault named = fault_of(row.mischief, before);
    ASSERT_TRUE(device_) << row.name;
    EXPECT_EQ(named, row.fault) << row.name << ": " << name(named);
    EXPECT_TRUE(device_->state().p_WT.allFinite()) << row.name;
    EXPECT_LT(device_->state().p_WT.norm(), 0.1) << row.name;
    service_->begin(HaplyMischief::kNone);
    ticks(100, {1, 0, 0});
    EXPECT_EQ(device_->fault(), row.fault) << row.name << " returned";
    EXPECT_EQ(device_->f_sent_W(), Vector3d(0, 0, 0)) << row.name;
    EXPECT_TRUE(service_->log().f_T_B.isZero(0)) << row.name;
    EXPECT_LE(support::forces_since(service_->log().taken_B, before), row.more) << row.name;
    if (row.fault == Fault::kNoReports) {
      EXPECT_TRUE(device_->zero_assured()) << row.name;
      EXPECT_TRUE(service_->log().taken_B.back().isZero(0)) << row.name;
    }
    device_.reset();
  }
}

TEST_F(HaplyLinkTest, CountsInvalidMessages) {
  greet();
  ASSERT_NO_FATAL_FAILURE(open());
  ticks(20, {0, 0, 0});
  EXPECT_EQ(device_->wire_counters().rejected, 0u);
  service_->begin(HaplyMischief::kNan);
  EXPECT_TRUE(ticks_until({0, 0, 0}, [&] { return device_->wire_counters().rejected > 5; }));
}

TEST_F(HaplyLinkTest, ContinuesAfterAMissingAnswer) {
  greet();
  ASSERT_NO_FATAL_FAILURE(open());
  service_->begin(HaplyMischief::kLeavesOneOut);
  const std::uint64_t before = device_->wire_counters().reports;
  EXPECT_TRUE(
      ticks_until({0, 0, 0}, [&] { return device_->wire_counters().reports > before + 20; }));
  EXPECT_EQ(device_->fault(), Fault::kNone);
}

TEST_F(HaplyLinkTest, NewLinkStartsWithoutForce) {
  greet();
  const std::uint16_t port = service_->port();
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0.4, 0, 0}, [&] { return device_->f_sent_W().x() > 0.3; }));
  service_.reset();
  ASSERT_TRUE(ticks_until({0.4, 0, 0}, [&] { return device_->lost(); }));
  EXPECT_EQ(device_->fault(), Fault::kTransportLost);
  service_ = std::make_unique<MockHaplyService>(HaplyGreeting::kInverse3, false, port, &clock_);
  auto again = link();
  ASSERT_TRUE(again) << again.error().message;
  ASSERT_TRUE(device_->offer(std::move(again).value()));
  ASSERT_TRUE(ticks_until({0.4, 0, 0}, [&] {
    return !device_->lost() && device_->state().fresh && service_->log().taken_B.size() > 20;
  }));
  for (const Vector3d& f : service_->log().taken_B) EXPECT_EQ(f, Vector3d(0, 0, 0));
  device_->ask_to_activate();
  EXPECT_TRUE(ticks_until({0.4, 0, 0}, [&] { return device_->f_sent_W().x() > 0.3; }));
  EXPECT_EQ(device_->fault(), Fault::kNone);
}

TEST_F(HaplyLinkTest, LeavesTheServiceWhenTheArmIsGone) {
  greet();
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0.4, 0, 0}, [&] { return device_->f_sent_W().x() > 0.3; }));
  service_->begin(HaplyMischief::kUnplugged);
  ASSERT_TRUE(ticks_until({0.4, 0, 0}, [&] { return device_->lost(); }));
  // Its last zero must not reach the arm after a new link drives it.
  for (int look = 0; look < 1000 && !service_->log().closed_by_client; ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(service_->log().closed_by_client);
}

TEST_F(HaplyLinkTest, DoesNotAllocateOnTheServoThread) {
  greet();
  ASSERT_NO_FATAL_FAILURE(open());
  ticks(20, {0.1, 0, 0});
  int calls = 0;
  for (int i = 0; i < 100; ++i) calls += tick({0.1, 0, 0});
  EXPECT_EQ(calls, 0);
  EXPECT_GT(device_->wire_counters().reports, 50u);
}

}  // namespace
}  // namespace thimble::driver
