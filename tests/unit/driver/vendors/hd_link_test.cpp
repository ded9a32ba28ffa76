#include "vendors/hd/hd_link.h"

#include <chrono>
#include <thread>

#include "support/mock/mock_hd.h"
#include "unit/driver/vendors/vendor_link_test.h"

namespace thimble::driver {
namespace {

using Eigen::Vector3d;

/// The default device of OpenHaptics' library.
struct OpenHaptics {
  using Library = hd::Library;
  using Mock = support::MockHd;
  static constexpr const char* kFile = THIMBLE_MOCK_HD;
  static constexpr const char* kMock = "mock_hd";
  static constexpr const char* kName = "libHD";
  static constexpr std::int64_t kPeriod_ns = 2'000'000;
  static constexpr int kTicksAfter = 100;
  static constexpr auto load = hd::load;
  static constexpr auto open_link = hd::open_link;
  static void heal(Mock& mock) {
    mock.error = 0;
    mock.reports_nan = mock.late = false;
  }
};

using HdLinkTest = VendorLinkTest<OpenHaptics>;

TEST_F(HdLinkTest, ReadsPoseInMetresAndSendsTheGatedForce) {
  mock_->arm.R_BT = Eigen::AngleAxisd(0.3, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  mock_->arm.buttons = 2;
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0, 0.6, 0}, [&] {
    return device_->wire_counters().reports > 300 &&
           (device_->f_sent_W() - Vector3d(0, 0.6, 0)).norm() < 1e-9;
  }));
  EXPECT_LT((force_of_arm() - Vector3d(0, 0.6, 0)).norm(), 1e-9);
  EXPECT_LT((device_->state().p_WT - Vector3d(0, 0.002, 0)).norm(), 4e-4) << "0.6 N at 300 N/m";
  EXPECT_LT((device_->state().R_WT - mock_->arm.R_BT).norm(), 1e-5);
  EXPECT_EQ(device_->state().buttons, 2);
  EXPECT_EQ(device_->fault(), Fault::kNone);
  device_.reset();
  EXPECT_EQ(mock_->taken.back(), Vector3d(0, 0, 0));
}

TEST_F(HdLinkTest, ClampsToTheNominalForce) {
  mock_->nominal = 0.5;
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0, 0, 1}, [&] {
    return device_->wire_counters().reports > 300 && force_of_arm().z() > 0.49;
  }));
  EXPECT_NEAR(device_->f_sent_W().norm(), 0.5, 1e-9);
}

TEST_F(HdLinkTest, UncalibratedArmGetsNoForce) {
  mock_->calibrated = false;
  const auto link = hd::open_link(library_, clock_);
  ASSERT_FALSE(link);
  EXPECT_NE(link.error().message.find("thimble calibrate"), std::string::npos);
  EXPECT_EQ(mock_->calibrations, 0);
  for (const Vector3d& f : mock_->taken) EXPECT_EQ(f, Vector3d(0, 0, 0));
  EXPECT_NE(hd::how_to_calibrate(library_)->find("inkwell"), std::string::npos);
  mock_->styles = 1;
  EXPECT_NE(hd::how_to_calibrate(library_)->find("reset pose"), std::string::npos);
  ASSERT_TRUE(hd::calibrate(library_));
  ASSERT_NO_FATAL_FAILURE(open());
}

TEST_F(HdLinkTest, OpenErrorNamesTheReason) {
  mock_->there = false;
  const auto link = hd::open_link(library_, clock_);
  ASSERT_FALSE(link);
  EXPECT_NE(link.error().message.find("failure requested by the test"), std::string::npos);
  mock_->there = true;
  mock_->nominal = 0;
  EXPECT_FALSE(hd::open_link(library_, clock_));
  EXPECT_FALSE(hd::load("/nowhere/libHD.so"));
  EXPECT_NE(hd::load("libm.so.6").error().message.find("hdInitDevice"), std::string::npos);
}

TEST_F(HdLinkTest, NamesEachErrorOfTheLibraryAndLatchesZeroForce) {
  const auto error = [](unsigned code) { return [code](Mock& mock) { mock.error = code; }; };
  const auto nan = [](Mock& mock) { mock.reports_nan = true; };
  const auto late = [](Mock& mock) { mock.late = true; };
  const FaultRow rows[] = {
      {"library reports error: warm motors", error(0x0200), Fault::kRefused, 1},
      {"library reports error: exceeded force", error(0x0201), Fault::kRefused, 1},
      {"library reports error: exceeded velocity", error(0x0203), Fault::kRefused, 1},
      {"library reports error: device fault", error(0x0300), Fault::kTransportLost, 1},
      {"library reports error: communication", error(0x0302), Fault::kTransportLost, 1},
      {"library reports error: frame", error(0x0402), Fault::kNoReports, 1},
      {"NaN from the library", nan, Fault::kNoReports, 1},
      {"library's scheduler runs every 60 ms", late, Fault::kNoReports, 3}};
  expect_latched_zero(rows, 40'000'000);
}

TEST_F(HdLinkTest, ReplugGivesTheArmToTheNewLink) {
  expect_replugs([](Mock& mock) { mock.error = 0x0302; }, true);
}

TEST_F(HdLinkTest, ReplugMayOpenTheNewLinkFirst) {
  expect_replugs([](Mock& mock) { mock.error = 0x0302; }, false);
}

TEST_F(HdLinkTest, OneLinkOwnsTheLibrary) {
  expect_one_owner();
  EXPECT_FALSE(hd::calibrate(library_)) << "its end would stop the scheduler";
  EXPECT_FALSE(hd::how_to_calibrate(library_));
}

TEST_F(HdLinkTest, StalledLoopLosesItsForce) {
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0.6, 0, 0}, [&] { return device_->f_sent_W().x() > 0.5; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(force_of_arm(), Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace thimble::driver
