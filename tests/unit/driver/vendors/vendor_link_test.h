#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>

#include "support/boards/link_fault.h"
#include "support/vintage_arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"

namespace thimble::driver {

/// A device behind a vendor's library, which a strict mock replaces. `Vendor` has the types
/// `Library` and `Mock`; `kFile`, the file of the mock library; `kMock`, its function that returns
/// the mock; `kName`, the name in the table of faults; `kPeriod_ns`, the period of the vendor's own
/// loop; `kTicksAfter`, the number of ticks for which a fault is observed; `load` and `open_link`;
/// and `heal`, which ends the effect of a fault.
template <class Vendor>
class VendorLinkTest : public ::testing::Test {
 protected:
  using Mock = typename Vendor::Mock;
  /// A fault of the library, the fault that the device latches, and the number of forces that may
  /// still be sent.
  struct FaultRow {
    const char* name;
    std::function<void(Mock&)> begin;
    Fault fault;
    int more;
  };

  VendorLinkTest() {
    auto library = Vendor::load(Vendor::kFile);
    EXPECT_TRUE(library) << library.error().message;
    library_ = std::move(library).value();
    void* const handle = dlopen(Vendor::kFile, RTLD_LAZY | RTLD_NOLOAD);
    mock_ = reinterpret_cast<Mock* (*)()>(dlsym(handle, Vendor::kMock))();
    mock_->reset();
  }
  ~VendorLinkTest() override {
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
    auto link = Vendor::open_link(library_, clock_);
    ASSERT_TRUE(link) << link.error().message;
    auto device = Device::open(std::move(link).value(), settings(silence_ns), clock_.now_ns());
    ASSERT_TRUE(device) << device.error().message;
    device_ = std::move(device).value();
    ASSERT_TRUE(device_->activate());
  }

  /// Requests the force (world, N) for up to 5,000 ticks and returns whether `done` became true.
  template <class Done>
  bool ticks_until(const Eigen::Vector3d& f_T_W, Done&& done) {
    for (int i = 0; i < 5'000; ++i) {
      clock_.sleep_until_ns(clock_.now_ns() + Vendor::kPeriod_ns);
      device_->read(clock_.now_ns(), 0);
      device_->write({.f_T_W = f_T_W, .touch = {}});
      if (done()) return true;
    }
    return false;
  }

  Eigen::Vector3d force_of_arm() const {
    const std::lock_guard lock(mock_->mutex);
    return mock_->arm.f_T_B;
  }
  void with_mock(const std::function<void(Mock&)>& change) const {
    const std::lock_guard lock(mock_->mutex);
    change(*mock_);
  }

  /// Expects that each row's fault is reported under force, and that from then on only zero is
  /// sent.
  void expect_latched_zero(std::span<const FaultRow> rows, std::int64_t silence_ns) {
    const Eigen::Vector3d zero(0, 0, 0);
    for (const FaultRow& row : rows) {
      mock_->reset();
      ASSERT_NO_FATAL_FAILURE(open(silence_ns));
      ASSERT_TRUE(ticks_until({1, 0, 0}, [&] { return device_->f_sent_W().x() > 0.5; }));
      const support::LinkFaultRow promised(row.name, Vendor::kName, row.fault, row.more);
      std::size_t before = 0;
      with_mock([&](Mock& mock) {
        row.begin(mock);
        before = mock.taken.size();
      });
      EXPECT_TRUE(ticks_until({1, 0, 0}, [&] { return device_->fault() != Fault::kNone; }));
      EXPECT_EQ(device_->fault(), row.fault) << row.name << ": " << name(device_->fault());
      EXPECT_TRUE(device_->state().p_WT.allFinite());
      with_mock(Vendor::heal);
      int more = Vendor::kTicksAfter;
      ticks_until({1, 0, 0}, [&] { return --more <= 0; });
      EXPECT_EQ(device_->fault(), row.fault) << row.name;
      EXPECT_EQ(device_->f_sent_W(), zero) << row.name;
      device_.reset();
      with_mock([&](const Mock& mock) {
        EXPECT_LE(support::forces_since(mock.taken, before), row.more) << row.name;
        EXPECT_EQ(mock.arm.f_T_B, zero) << row.name;
        for (const std::string& wrong : mock.wrong) ADD_FAILURE() << row.name << ": " << wrong;
      });
    }
  }

  /// Disconnects the arm by `pull` and reconnects it three times, as the replug watch of a run
  /// does. Expects that the new link owns the library's arm each time, and that no call is out of
  /// order. `closes_first`: the lost link is closed before the new one is opened.
  void expect_replugs(const std::function<void(Mock&)>& pull, bool closes_first) {
    ASSERT_NO_FATAL_FAILURE(open());
    for (int round = 1; round <= 3; ++round) {
      with_mock(pull);
      ASSERT_TRUE(ticks_until({0, 0, 0}, [&] { return device_->lost(); })) << round;
      with_mock(Vendor::heal);
      if (closes_first) device_->close_lost_link();
      auto link = Vendor::open_link(library_, clock_);
      ASSERT_TRUE(link) << round << ": " << link.error().message;
      ASSERT_TRUE(device_->offer(std::move(link).value()));
      const std::uint64_t before = device_->wire_counters().reports;
      EXPECT_TRUE(ticks_until({0, 0, 0}, [&] {
        return device_->wire_counters().reports > before + 50;
      })) << round;
      with_mock([&](const Mock& mock) {
        EXPECT_TRUE(mock.open) << round;
        EXPECT_TRUE(mock.force_on) << round;
        EXPECT_EQ(mock.opened, mock.closed + 1) << round;
        EXPECT_TRUE(mock.wrong.empty()) << round << ": " << mock.wrong.front();
      });
      EXPECT_FALSE(device_->lost()) << round;
      EXPECT_FALSE(device_->home_needed()) << "its vendor reports its pose";
    }
  }

  /// Expects that a second link is refused while the first works, and that the first is unaffected.
  void expect_one_owner() {
    ASSERT_NO_FATAL_FAILURE(open());
    const auto second = Vendor::open_link(library_, clock_);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("already opened"), std::string::npos);
    const std::uint64_t before = device_->wire_counters().reports;
    EXPECT_TRUE(
        ticks_until({0, 0, 0}, [&] { return device_->wire_counters().reports > before + 50; }));
    EXPECT_EQ(device_->fault(), Fault::kNone);
  }

  WallClock clock_{0};
  typename Vendor::Library library_;
  Mock* mock_ = nullptr;
  std::unique_ptr<Device> device_;
};

}  // namespace thimble::driver
