#include "vendors/dhd/dhd_link.h"

#include <chrono>
#include <thread>

#include "support/heap_guard.h"
#include "support/mock/mock_dhd.h"
#include "unit/driver/vendors/vendor_link_test.h"

namespace thimble::driver {
namespace {

using Eigen::Vector3d;

/// An arm of Force Dimension's library.
struct ForceDimension {
  using Library = dhd::Library;
  using Mock = support::MockDhd;
  static constexpr const char* kFile = THIMBLE_MOCK_DHD;
  static constexpr const char* kMock = "mock_dhd";
  static constexpr const char* kName = "libdrd";
  static constexpr std::int64_t kPeriod_ns = 1'000'000;
  static constexpr int kTicksAfter = 50;
  static constexpr auto load = dhd::load;
  static constexpr auto open_link = dhd::open_link;
  static void heal(Mock& mock) {
    mock.fails.clear();
    mock.reports_nan = mock.late = false;
  }
};

class DhdLinkTest : public VendorLinkTest<ForceDimension> {
 protected:
  ~DhdLinkTest() override {
    device_.reset();
    EXPECT_FALSE(mock_->force_on);
  }
};

TEST_F(DhdLinkTest, ReadsPoseGripperAndButtonsAndSendsForce) {
  EXPECT_EQ(library_.version, "3.17.5");
  mock_->wrist = mock_->gripper = true;
  mock_->arm.R_BT = Eigen::AngleAxisd(0.3, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  mock_->arm.buttons = 3;
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0, 0.6, 0}, [&] {
    return device_->wire_counters().reports > 400 &&
           (device_->f_sent_W() - Vector3d(0, 0.6, 0)).norm() < 1e-9;
  }));
  EXPECT_LT((force_of_arm() - Vector3d(0, 0.6, 0)).norm(), 1e-9);
  EXPECT_LT((device_->state().p_WT - Vector3d(0, 0.002, 0)).norm(), 4e-4) << "0.6 N at 300 N/m";
  EXPECT_LT((device_->state().R_WT - mock_->arm.R_BT).norm(), 1e-5);
  EXPECT_FLOAT_EQ(device_->state().gripper, 0.012F);
  EXPECT_EQ(device_->state().buttons, 3);
  EXPECT_EQ(device_->fault(), Fault::kNone);
  device_.reset();
  EXPECT_EQ(mock_->taken.back(), Vector3d(0, 0, 0));
  EXPECT_EQ(mock_->stopped, 1);
  EXPECT_EQ(mock_->found_zero, 0) << "the user has not allowed it to move";
}

TEST_F(DhdLinkTest, UncalibratedArmGetsNoForceOrMotion) {
  mock_->initialised = false;
  const auto link = dhd::open_link(library_, clock_);
  ASSERT_FALSE(link);
  EXPECT_NE(link.error().message.find("thimble calibrate"), std::string::npos);
  EXPECT_EQ(mock_->found_zero, 0);
  EXPECT_TRUE(mock_->taken.empty());
  ASSERT_TRUE(dhd::find_zero(library_));
  EXPECT_EQ(mock_->found_zero, 1);
  ASSERT_NO_FATAL_FAILURE(open());
}

TEST_F(DhdLinkTest, OpenErrorNamesTheReason) {
  const auto message = [&] {
    const auto link = dhd::open_link(library_, clock_);
    return link ? std::string() : link.error().message;
  };
  mock_->arms = 0;
  EXPECT_NE(message().find("found no arm"), std::string::npos);
  mock_->arms = 2;
  EXPECT_NE(message().find("found 2 arms"), std::string::npos);
  mock_->arms = 1;
  mock_->held = true;
  EXPECT_NE(message().find("failure requested by the test"), std::string::npos);
  mock_->held = false;
  for (const char* step :
       {"dhdSetWatchdog", "dhdSetGravityCompensation", "dhdSetBrakes", "dhdEnableForce"}) {
    mock_->fails = step;
    EXPECT_NE(message().find("did not"), std::string::npos) << step;
    EXPECT_TRUE(mock_->taken.empty()) << step;
  }
  const auto absent = dhd::load("/nowhere/libdrd.so.3");
  ASSERT_FALSE(absent);
  EXPECT_NE(absent.error().message.find("/nowhere/libdrd.so.3"), std::string::npos);
  const auto other = dhd::load("libm.so.6");
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("has no function dhdGetDeviceCount"), std::string::npos);
}

TEST_F(DhdLinkTest, NamesEachFaultOfTheLibraryAndLatchesZeroForce) {
  const auto failing = [](const char* function) {
    return [function](Mock& mock) { mock.fails = function; };
  };
  const auto nan = [](Mock& mock) { mock.reports_nan = true; };
  const auto late = [](Mock& mock) { mock.late = true; };
  const auto trip = [](Mock& mock) { mock.tripped = true; };
  const FaultRow rows[] = {
      {"library reports error: position", failing("dhdGetPosition"), Fault::kNoReports, 1},
      {"library reports error: velocity", failing("dhdGetLinearVelocity"), Fault::kNoReports, 1},
      {"NaN from the library", nan, Fault::kNoReports, 1},
      {"library answers 60 ms late", late, Fault::kNoReports, 3},
      {"library rejects the force", failing("dhdSetForce"), Fault::kTransportLost, 0},
      // The state is queried every 32nd time; forces accepted meanwhile reach no motor.
      {"library switched the forces off", trip, Fault::kRefused, 200}};
  expect_latched_zero(rows, 30'000'000);
}

TEST_F(DhdLinkTest, ReplugGivesTheArmToTheNewLink) {
  expect_replugs([](Mock& mock) { mock.fails = "dhdSetForce"; }, true);
}

TEST_F(DhdLinkTest, ReplugMayOpenTheNewLinkFirst) {
  expect_replugs([](Mock& mock) { mock.fails = "dhdSetForce"; }, false);
}

TEST_F(DhdLinkTest, OneLinkOwnsTheLibrary) {
  expect_one_owner();
  EXPECT_FALSE(dhd::find_zero(library_)) << "its end would close the arm";
}

TEST_F(DhdLinkTest, StalledLoopLosesItsForce) {
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0.6, 0, 0}, [&] { return device_->f_sent_W().x() > 0.5; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(force_of_arm(), Vector3d(0, 0, 0));
}

TEST_F(DhdLinkTest, DoesNotAllocateOnTheServoThread) {
  ASSERT_NO_FATAL_FAILURE(open());
  int calls = 0, ticks = 100;
  ticks_until({0.1, 0, 0}, [&] {
    calls += support::heap_calls_of([&] {
      device_->read(clock_.now_ns(), 0);
      device_->write({.f_T_W = {0.1, 0, 0}, .touch = {}});
    });
    return --ticks <= 0;
  });
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace thimble::driver
