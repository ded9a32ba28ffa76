#include "bringup/doctor.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/mock/fake_usb.h"
#include "support/scratch.h"

namespace thimble::bringup {
namespace {

/// A correctly configured machine with a WoodenHaptics arm; each test breaks one part of it.
class DoctorTest : public ::testing::Test {
 protected:
  DoctorTest()
      : usb_(std::string("doctor_") +
             testing::UnitTest::GetInstance()->current_test_info()->name()) {
    usb_.write("etc/udev/rules.d/70-thimble.rules", "#");
    usb_.write("proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian 6.1");
    for (const std::string cpu : {"cpu0", "cpu1"}) {
      usb_.write(kCpus + cpu + "/cpufreq/scaling_governor", "performance");
      usb_.write(kCpus + cpu + "/cpuidle/state0/latency", "0");
      usb_.write(kCpus + cpu + "/cpuidle/state1/latency", "200");
    }
    usb_.write("dev/cpu_dma_latency", "");
    system_.root = usb_.root();
    system_.real_time_priority_max = 99;
    system_.in_plugdev = true;
  }

  void plug_woody(const std::string& port = "1-1") const {
    usb_.plug(port, "1234", "0006", "WH01", 1, 2);
    usb_.bind(port, 0, "usbhid");
    usb_.add_hidraw(port, 0, "hidraw3");
  }

  void plug_falcon() const { usb_.plug("1-2", "0403", "cb48", "F1", 1, 5); }

  /// Returns the finding that contains these words; fails the test if there is none.
  Finding finding(const std::string& words) const {
    for (const Finding& found : examine(system_)) {
      if (found.what.find(words) != std::string::npos) return found;
    }
    ADD_FAILURE() << "no finding about: " << words;
    return {};
  }

  std::size_t troubles() const {
    std::size_t count = 0;
    for (const Finding& found : examine(system_)) {
      EXPECT_EQ(found.health == Health::kGood, found.remedy.empty()) << found.what;
      count += found.health != Health::kGood;
    }
    return count;
  }

  static inline const std::string kCpus = "sys/devices/system/cpu/";
  support::FakeUsb usb_;
  SystemInfo system_;
};

TEST_F(DoctorTest, ReportsNoProblemOnAGoodMachine) {
  plug_woody();
  plug_falcon();
  EXPECT_EQ(troubles(), 0u);
}

TEST_F(DoctorTest, ReportsAMissingRule) {
  plug_woody();
  std::filesystem::remove(usb_.root() / "etc/udev/rules.d/70-thimble.rules");
  EXPECT_EQ(finding("rule is not installed").health, Health::kProblem);
  EXPECT_NE(finding("rule is not installed").remedy.find("udevadm"), std::string::npos);
}

TEST_F(DoctorTest, ExplainsMissingAccess) {
  plug_woody();
  std::filesystem::remove(usb_.root() / "dev/hidraw3");  // root has access to every existing file
  system_.in_plugdev = false;
  EXPECT_EQ(finding("have no access to /dev/hidraw3").health, Health::kProblem);
  EXPECT_NE(finding("have no access to").remedy.find("usermod -aG plugdev"), std::string::npos);
  system_.in_plugdev = true;
  EXPECT_NE(finding("have no access to").remedy.find("udevadm trigger"), std::string::npos);
  std::filesystem::remove(usb_.root() / "etc/udev/rules.d/70-thimble.rules");
  EXPECT_NE(finding("have no access to").what.find("rule is missing"), std::string::npos);
}

TEST_F(DoctorTest, ReportsMissingAndConflictingDrivers) {
  usb_.plug("1-1", "1234", "0006", "WH01", 1, 2);
  EXPECT_NE(finding("no kernel driver is bound to it").remedy.find("modprobe usbhid"),
            std::string::npos);
  usb_.plug("1-3", "16c0", "0483", "7654321", 1, 4);
  EXPECT_NE(finding("no serial port").remedy.find("modprobe cdc_acm"), std::string::npos);
  plug_falcon();
  usb_.bind("1-2", 0, "ftdi_sio");
  usb_.write(usb_.device_folder("1-2") / "1-2:1.0/ttyUSB0/latency_timer", "16");
  EXPECT_NE(finding("ftdi_sio").what.find("latency timer of 16 ms"), std::string::npos);
  EXPECT_NE(finding("ftdi_sio").remedy.find("1-2:1.0"), std::string::npos);
}

TEST_F(DoctorTest, FindsProblemsOfTheTouchLibrary) {
  const auto about = [&](const std::string& words) {
    const auto findings = examine(system_);
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& found) {
      return found.what.find(words) != std::string::npos;
    });
  };
  usb_.write("proc/812/comm", "ModemManager\n");
  EXPECT_FALSE(about("ModemManager"));  // without a Touch it has no effect
  EXPECT_FALSE(about("libncurses"));
  usb_.plug("1-5", "2988", "0302", "T1", 1, 6);
  EXPECT_NE(finding("ModemManager is running").remedy.find("stop ModemManager"), std::string::npos);
  EXPECT_NE(finding("libncurses.so.5").remedy.find("apt install libncurses5"), std::string::npos);
  usb_.write("usr/lib/x86_64-linux-gnu/libncurses.so.5", "");
  usb_.write("proc/812/comm", "bash\n");
  EXPECT_FALSE(about("ModemManager"));
  EXPECT_FALSE(about("libncurses"));
}

TEST_F(DoctorTest, FindsPowerSavingAndHubs) {
  plug_woody("1-4.2");
  usb_.write(usb_.device_folder("1-4.2") / "power/control", "auto");
  usb_.plug("1-4", "05e3", "0608", "", 1, 9, "12");
  EXPECT_NE(finding("suspend it").remedy.find("1-4.2/power/control"), std::string::npos);
  EXPECT_EQ(finding("full-speed hub").health, Health::kAdvice);
  usb_.write(usb_.device_folder("1-4") / "speed", "480");
  EXPECT_NE(finding("connected to a hub").remedy.find("directly into the computer"),
            std::string::npos);
}

TEST_F(DoctorTest, FindsTheKernelsRealTimeLimits) {
  plug_woody();
  system_.real_time_priority_max = 0;
  EXPECT_NE(finding("real-time priority").remedy.find("rtprio 80"), std::string::npos);
  usb_.write("proc/sys/kernel/sched_rt_runtime_us", "100000");
  EXPECT_NE(finding("100000 us").remedy.find("sysctl"), std::string::npos);
  usb_.write("proc/sys/kernel/sched_rt_runtime_us", "-1");  // no limit is valid
  EXPECT_EQ(troubles(), 1u);
}

TEST_F(DoctorTest, MissingPriorityIsAProblemForARealArm) {
  system_.real_time_priority_max = 0;
  EXPECT_EQ(finding("real-time priority").health, Health::kAdvice);
  plug_woody();
  EXPECT_EQ(finding("real-time priority").health, Health::kProblem);
}

TEST_F(DoctorTest, UnknownBoardGetsItsOwnUdevRule) {
  usb_.plug("1-3", "16c0", "0486", "7654321", 1, 4);
  usb_.call("1-3", "Teensyduino RawHID");
  usb_.bind("1-3", 0, "usbhid");
  usb_.add_hidraw("1-3", 0, "hidraw5", 64);
  Finding unknown = finding("board of unknown kind");
  EXPECT_EQ(unknown.health, Health::kAdvice);
  EXPECT_NE(unknown.what.find("16c0:0486, \"Teensyduino RawHID\""), std::string::npos);
  EXPECT_NE(unknown.remedy.find("--device 7654321"), std::string::npos);
  EXPECT_NE(unknown.remedy.find("board: teensy_raw_hid_64"), std::string::npos);
  EXPECT_EQ(unknown.remedy.find("udev"), std::string::npos) << "access is already granted";
  std::filesystem::remove(usb_.root() / "dev/hidraw5");
  unknown = finding("board of unknown kind");
  EXPECT_NE(unknown.remedy.find("echo 'SUBSYSTEM==\"hidraw\", ATTRS{idVendor}==\"16c0\", "
                                "ATTRS{idProduct}==\"0486\", ATTRS{serial}==\"7654321\", "
                                "TAG+=\"uaccess\""),
            std::string::npos)
      << unknown.remedy;
  EXPECT_NE(unknown.remedy.find("/etc/udev/rules.d/71-"), std::string::npos);
}

TEST_F(DoctorTest, NamesABoardWithoutSerialByItsSocket) {
  usb_.plug("1-1.4", "1234", "0006", "0123456789", 1, 4);
  usb_.bind("1-1.4", 0, "usbhid");
  usb_.add_hidraw("1-1.4", 0, "hidraw5", 14);
  std::filesystem::remove(usb_.root() / "dev/hidraw5");
  const Finding unknown = finding("board of unknown kind");
  EXPECT_NE(unknown.remedy.find("--device usb-1-1.4"), std::string::npos);
  EXPECT_NE(unknown.remedy.find("KERNELS==\"1-1.4\""), std::string::npos);
}

TEST_F(DoctorTest, BoardOfUnknownFormIsNeverOpened) {
  usb_.plug("1-3", "1234", "0006", "X1", 1, 4);
  usb_.bind("1-3", 0, "usbhid");
  usb_.add_hidraw("1-3", 0, "hidraw5", 64);
  EXPECT_NE(finding("64 bytes in and 64 bytes out").what.find("never opened"), std::string::npos);
}

TEST_F(DoctorTest, NamesTheProgramThatHasTheArm) {
  plug_woody();
  usb_.write("proc/77/comm", "steam");
  std::filesystem::create_directories(usb_.root() / "proc/77/fd");
  std::filesystem::create_symlink("/dev/hidraw3", usb_.root() / "proc/77/fd/12");
  EXPECT_EQ(finding("steam (process 77)").health, Health::kProblem);
}

TEST_F(DoctorTest, DetectsARealTimeKernelByEitherFile) {
  plug_woody();
  EXPECT_EQ(finding("PREEMPT_RT").health, Health::kGood);
  usb_.write("proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC Debian 6.1");
  EXPECT_EQ(finding("PREEMPT_RT").health, Health::kAdvice);
  EXPECT_EQ(troubles(), 1u);
  usb_.write("sys/kernel/realtime", "1");
  EXPECT_EQ(finding("PREEMPT_RT").health, Health::kGood);
}

TEST_F(DoctorTest, FindsASlowFrequencyGovernor) {
  plug_woody();
  EXPECT_EQ(finding("full speed").health, Health::kGood);
  usb_.write(kCpus + "cpu1/cpufreq/scaling_governor", "powersave");
  EXPECT_EQ(finding("governor is powersave").health, Health::kAdvice);
  EXPECT_NE(finding("governor").remedy.find("performance"), std::string::npos);
  EXPECT_EQ(troubles(), 1u);
}

TEST_F(DoctorTest, FindsDeepProcessorSleepStates) {
  plug_woody();
  EXPECT_EQ(finding("take 200 us to wake up; a run reduces this").health, Health::kGood);
  std::filesystem::remove(usb_.root() /
                          "dev/cpu_dma_latency");  // root may write every existing file
  EXPECT_EQ(finding("take 200 us to wake").health, Health::kAdvice);
  EXPECT_EQ(troubles(), 1u);
  usb_.write(kCpus + "cpu0/cpuidle/state1/disable", "1");
  EXPECT_EQ(troubles(), 1u) << "the sleep state of the other processor is still enabled";
  usb_.write(kCpus + "cpu1/cpuidle/state1/disable", "1");
  EXPECT_EQ(troubles(), 0u);
}

TEST_F(DoctorTest, SkipsValuesThatTheKernelDoesNotReport) {
  plug_woody();
  std::filesystem::remove_all(usb_.root() / kCpus);
  std::filesystem::remove(usb_.root() / "proc/sys/kernel/version");
  EXPECT_EQ(troubles(), 0u);
}

TEST_F(DoctorTest, ReportsMissingAndUnsupportedArms) {
  EXPECT_EQ(finding("No supported arm").health, Health::kAdvice);
  usb_.plug("1-5", "1451", "0402", "FD", 1, 6);
  EXPECT_EQ(finding("not public").health, Health::kAdvice);
  usb_.plug("1-6", "16c0", "0483", "H1", 1, 7);
  usb_.call("1-6", "Haply inverse3");
  EXPECT_NE(finding("Haply Inverse3").what.find("not public"), std::string::npos);
}

TEST(DoctorLog, ReportsLocationAndWriteAccess) {
  const auto folder = support::scratch_folder() / "doctor_log";
  std::filesystem::create_directories(folder);
  const Finding good = examine_log(folder / "to" / "be" / "made.log");
  EXPECT_EQ(good.health, Health::kGood);
  EXPECT_EQ(good.what, "Events are logged to " + (folder / "to/be/made.log").string() + ".");
  EXPECT_FALSE(std::filesystem::exists(folder / "to"));
  const Finding bad = examine_log("/proc/self/log/a.log");  // no folder can be created there
  if (geteuid() != 0) {
    EXPECT_EQ(bad.health, Health::kAdvice);
    EXPECT_EQ(bad.what, "Events cannot be logged to /proc/self/log/a.log.");
  }
}

}  // namespace
}  // namespace thimble::bringup
