#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "arm_policy_home.h"
#include "bringup/doctor.h"
#include "support/mock/fake_usb.h"
#include "support/mock/mock_dhd.h"
#include "support/mock/mock_hd.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/real_arm_file.h"

namespace thimble::bringup {
namespace {

using driver::ArmKind;
using driver::BoardKind;
using driver::Certainty;
using driver::FoundArm;

/// Sets the paths of the libraries before the first search, because there is only one search.
const bool kNamed = [] {
  setenv("THIMBLE_DHD_LIBRARY", THIMBLE_MOCK_DHD, 1);
  setenv("THIMBLE_HD_LIBRARY", THIMBLE_MOCK_HD, 1);
  return true;
}();

/// Arms on USB whose vendors' libraries are installed.
class VendorLibraryTest : public ArmPolicyTest {
 protected:
  VendorLibraryTest()
      : usb_(std::string("vendor_") +
             testing::UnitTest::GetInstance()->current_test_info()->name()) {}

  template <class Mock>
  static Mock& mock(const char* file, const char* name) {
    void* const handle = dlopen(file, RTLD_LAZY);
    return *reinterpret_cast<Mock* (*)()>(dlsym(handle, name))();
  }

  FoundArm only() const {
    const auto arms = driver::find_arms(usb_.root());
    return arms && arms->size() == 1 ? arms->front() : FoundArm{};
  }

  /// Opens an arm as a run does; returns the device or the error.
  driver::Result<std::unique_ptr<driver::Device>> open(const FoundArm& arm,
                                                       const std::string& file) {
    auto found = scene::find_real_arm_file(arm, {.arm_file = kArms / (file + ".yaml")});
    if (!found) return found.error();
    auto link = scene::open_link(arm, found->file, {}, clock_);
    if (!link) return link.error();
    return driver::Device::open(std::move(link).value(), scene::device_settings(found->file, 1000),
                                clock_.now_ns());
  }

  support::FakeUsb usb_;
  driver::WallClock clock_{0};
};

TEST_F(VendorLibraryTest, OpensAForceDimensionArm) {
  ASSERT_TRUE(kNamed);
  usb_.plug("1-1", "1451", "0402", "FD1", 1, 2);
  const FoundArm arm = only();
  EXPECT_EQ(arm.kind, ArmKind::kDhd);
  EXPECT_EQ(arm.board, BoardKind::kDhdLibrary);
  EXPECT_EQ(arm.certainty, Certainty::kKnown);
  EXPECT_EQ(arm.software, "libdrd 3.17.5");
  // The library drives several arms, so the user must name one.
  const auto unnamed = scene::find_real_arm_file(arm);
  ASSERT_FALSE(unnamed);
  EXPECT_TRUE(holds(unnamed.error().message, "--arm NAME (installed are: omega3)"))
      << unnamed.error().message;
  auto& dhd = mock<support::MockDhd>(THIMBLE_MOCK_DHD, "mock_dhd");
  dhd.reset();
  {
    const auto device = open(arm, "omega3");
    ASSERT_TRUE(device) << device.error().message;
    EXPECT_EQ((*device)->state().p_WT.norm() < 1e-3, true);
  }
  EXPECT_EQ(dhd.closed, 1);
  for (const std::string& wrong : dhd.wrong) ADD_FAILURE() << wrong;
  EXPECT_FALSE(open(arm, "touch")) << "another library's file";
}

TEST_F(VendorLibraryTest, OpensATouch) {
  usb_.plug("1-1", "2988", "0302", "TT1", 1, 2);
  usb_.add_tty("1-1", 0, "ttyACM0");
  const FoundArm arm = only();
  EXPECT_EQ(arm.kind, ArmKind::kHd);
  EXPECT_EQ(arm.board, BoardKind::kHdLibrary);
  EXPECT_EQ(arm.software, THIMBLE_MOCK_HD);
  auto& hd = mock<support::MockHd>(THIMBLE_MOCK_HD, "mock_hd");
  hd.reset();
  {
    const auto device = open(arm, "touch");
    ASSERT_TRUE(device) << device.error().message;
  }
  EXPECT_EQ(hd.closed, 1);
  for (const std::string& wrong : hd.wrong) ADD_FAILURE() << wrong;
  EXPECT_FALSE(open(arm, "omega3")) << "another library's file";
}

TEST_F(VendorLibraryTest, TheDoctorNamesTheLibrary) {
  usb_.plug("1-1", "1451", "0402", "FD1", 1, 2);
  SystemInfo system;
  system.root = usb_.root();
  bool said = false;
  for (const Finding& found : examine(system)) {
    said = said || (holds(found.what, "FD1: its vendor's library is installed (libdrd 3.17.5)") &&
                    found.health == Health::kGood);
  }
  EXPECT_TRUE(said);
}

TEST_F(VendorLibraryTest, DoctorExplainsVendorLibraryAccess) {
  usb_.plug("1-1", "1451", "0402", "FD1", 1, 2);
  usb_.plug("1-2", "2988", "0302", "TT1", 1, 3);
  usb_.add_tty("1-2", 0, "ttyACM0");
  usb_.plug("1-3", "2988", "0304", "TX1", 1, 4);
  // root has access to every existing file.
  std::filesystem::remove(usb_.root() / "dev/bus/usb/001/002");
  std::filesystem::remove(usb_.root() / "dev/ttyACM0");
  SystemInfo system;
  system.root = usb_.root();
  const auto remedy = [&](const std::string& words) {
    for (const Finding& found : examine(system)) {
      if (holds(found.what, words)) return found.remedy;
    }
    return std::string("no finding contains: " + words);
  };
  // The vendors' set-up steps are not published, and our rule does not cover their arms.
  const std::string touch = remedy("TT1: you have no access to /dev/ttyACM0");
  EXPECT_TRUE(holds(touch, "are not published")) << touch;
  EXPECT_TRUE(holds(touch, R"(SUBSYSTEM=="tty", ATTRS{idVendor}=="2988", TAG+="uaccess")"))
      << touch;
  EXPECT_TRUE(holds(touch, "ID_MM_DEVICE_IGNORE")) << touch;
  const std::string omega = remedy("FD1: you have no access to /dev/bus/usb/001/002");
  EXPECT_TRUE(holds(omega, R"(ENV{DEVTYPE}=="usb_device", ATTR{idVendor}=="1451")")) << omega;
  EXPECT_TRUE(holds(remedy("TX1: no kernel driver is bound to it"), "usbhid"));
  for (const Finding& found : examine(system)) {
    EXPECT_FALSE(holds(found.what, "T1: ") && holds(found.remedy, "70-thimble")) << found.remedy;
  }
  const auto chosen = scene::choose_arm(*driver::find_arms(usb_.root()), "TT1");
  ASSERT_FALSE(chosen);
  EXPECT_TRUE(holds(chosen.error().message, "`thimble doctor` prints what to do"));
  EXPECT_FALSE(holds(chosen.error().message, "70-thimble"));
}

}  // namespace
}  // namespace thimble::bringup
