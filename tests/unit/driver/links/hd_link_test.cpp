#include "links/hd/hd_link.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "support/heap_guard.h"
#include "support/boards/link_fault.h"
#include "support/mock/mock_hd.h"
#include "support/vintage_arm.h"
#include "thimble/driver/device.h"

namespace thimble::driver {
namespace {

using Eigen::Vector3d;

/// The default device of OpenHaptics' library, over a strict one that stands in for it.
class HdLinkTest : public ::testing::Test {
 protected:
  HdLinkTest() {
    auto library = hd::load(THIMBLE_MOCK_HD);
    EXPECT_TRUE(library) << library.error().message;
    library_ = std::move(library).value();
    void* const handle = dlopen(THIMBLE_MOCK_HD, RTLD_LAZY | RTLD_NOLOAD);
    mock_ = reinterpret_cast<support::MockHd* (*)()>(dlsym(handle, "mock_hd"))();
    mock_->reset();
  }
  ~HdLinkTest() override {
    device_.reset();
    EXPECT_EQ(mock_->opened, mock_->closed);
    for (const std::string& wrong : mock_->wrong) ADD_FAILURE() << wrong;
  }

  static DeviceSettings settings(std::int64_t silence_ns) {
    DeviceSettings settings = support::vintage_settings();
    settings.R_WB.setIdentity();
    settings.p_WB.setZero();
    settings.motion = {.mass = 0.1, .delay_ticks = 0};
    settings.silence_limit_ns = silence_ns;
    settings.limits.stall_ns = 900'000'000;
    settings.limits.watchdog_ns = 1'000'000'000;
    settings.limits.speed_max = 20;
    return settings;
  }

  void open(std::int64_t silence_ns = 2'000'000'000) {
    auto link = hd::open_link(library_, clock_);
    ASSERT_TRUE(link) << link.error().message;
    auto device = Device::open(std::move(link).value(), settings(silence_ns), clock_.now_ns());
    ASSERT_TRUE(device) << device.error().message;
    device_ = std::move(device).value();
    ASSERT_TRUE(device_->activate());
  }

  template <class Done>
  bool ticks_until(const Vector3d& f_T_W, Done&& done) {
    for (int i = 0; i < 5'000; ++i) {
      clock_.sleep_until_ns(clock_.now_ns() + 2'000'000);
      device_->read(clock_.now_ns(), 0);
      device_->write({.f_T_W = f_T_W, .touch = {}});
      if (done()) return true;
    }
    return false;
  }

  Vector3d force_of_arm() const {
    const std::lock_guard lock(mock_->mutex);
    return mock_->arm.f_T_B;
  }
  void with_mock(const std::function<void(support::MockHd&)>& change) const {
    const std::lock_guard lock(mock_->mutex);
    change(*mock_);
  }

  WallClock clock_{0};
  hd::Library library_;
  support::MockHd* mock_ = nullptr;
  std::unique_ptr<Device> device_;
};

TEST_F(HdLinkTest, TellsPoseAndButtonsInMetresAndGivesTheGatedForce) {
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

TEST_F(HdLinkTest, GivesNoMoreThanTheLibrarysNominalForceAndTellsWhatIsLeft) {
  mock_->nominal = 0.5;
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0, 0, 1}, [&] {
    return device_->wire_counters().reports > 300 && force_of_arm().z() > 0.49;
  }));
  EXPECT_NEAR(device_->f_sent_W().norm(), 0.5, 1e-9);
}

TEST_F(HdLinkTest, AnArmThatIsNotCalibratedGetsNoForce) {
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

TEST_F(HdLinkTest, SaysWhyAnArmCannotBeOpened) {
  mock_->there = false;
  const auto link = hd::open_link(library_, clock_);
  ASSERT_FALSE(link);
  EXPECT_NE(link.error().message.find("told to fail"), std::string::npos);
  mock_->there = true;
  mock_->nominal = 0;
  EXPECT_FALSE(hd::open_link(library_, clock_));
  EXPECT_FALSE(hd::load("/nowhere/libHD.so"));
  EXPECT_NE(hd::load("libm.so.6").error().message.find("hdInitDevice"), std::string::npos);
}

TEST_F(HdLinkTest, NamesEachErrorOfTheLibraryAndLatchesZeroForce) {
  using Mock = support::MockHd;
  const auto error = [](unsigned code) { return [code](Mock& mock) { mock.error = code; }; };
  const auto nan = [](Mock& mock) { mock.tells_nan = true; };
  const auto late = [](Mock& mock) { mock.late = true; };
  struct Row {
    const char* name;
    std::function<void(Mock&)> begin;
    Fault fault;
    int more;
  };
  const Row rows[] = {
      {"library says error: warm motors", error(0x0200), Fault::kRefused, 1},
      {"library says error: exceeded force", error(0x0201), Fault::kRefused, 1},
      {"library says error: exceeded velocity", error(0x0203), Fault::kRefused, 1},
      {"library says error: device fault", error(0x0300), Fault::kTransportLost, 1},
      {"library says error: communication", error(0x0302), Fault::kTransportLost, 1},
      {"library says error: frame", error(0x0402), Fault::kNoReports, 1},
      {"NaN from the library", nan, Fault::kNoReports, 1},
      {"library's scheduler turns every 60 ms", late, Fault::kNoReports, 3}};
  for (const Row& row : rows) {
    mock_->reset();
    ASSERT_NO_FATAL_FAILURE(open(40'000'000));
    ASSERT_TRUE(ticks_until({1, 0, 0}, [&] { return device_->f_sent_W().x() > 0.5; }));
    const support::LinkFaultRow promised(row.name, "libHD", row.fault, row.more);
    std::size_t before = 0;
    with_mock([&](Mock& mock) {
      row.begin(mock);
      before = mock.taken.size();
    });
    EXPECT_TRUE(ticks_until({1, 0, 0}, [&] { return device_->fault() != Fault::kNone; }));
    EXPECT_EQ(device_->fault(), row.fault) << row.name << ": " << name(device_->fault());
    EXPECT_TRUE(device_->state().p_WT.allFinite());
    with_mock([](Mock& mock) {
      mock.error = 0;
      mock.tells_nan = mock.late = false;
    });
    int more = 100;
    ticks_until({1, 0, 0}, [&] { return --more <= 0; });
    EXPECT_EQ(device_->fault(), row.fault) << row.name;
    EXPECT_EQ(device_->f_sent_W(), Vector3d(0, 0, 0)) << row.name;
    device_.reset();
    with_mock([&](const Mock& mock) {
      EXPECT_LE(support::forces_since(mock.taken, before), row.more) << row.name;
      EXPECT_EQ(mock.arm.f_T_B, Vector3d(0, 0, 0)) << row.name;
      for (const std::string& wrong : mock.wrong) ADD_FAILURE() << row.name << ": " << wrong;
    });
  }
}

TEST_F(HdLinkTest, ALoopThatStandsStillLosesItsForce) {
  ASSERT_NO_FATAL_FAILURE(open());
  ASSERT_TRUE(ticks_until({0.6, 0, 0}, [&] { return device_->f_sent_W().x() > 0.5; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(force_of_arm(), Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace thimble::driver
