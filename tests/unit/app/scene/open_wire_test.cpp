// A program sends nothing to a board that has not proved to be an arm. Tests the whole path: the
// folders of the kernel, the choice of the arm, and its connection, with scripted libraries and a
// pseudo-terminal.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <thread>

#include "support/mock/fake_hidapi.h"
#include "support/mock/fake_usb.h"
#include "thimble/scene/real_arm.h"

namespace thimble::scene {
namespace {

scene::ArmFile file_of(const std::string& name) {
  auto file =
      scene::load_arm(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" / (name + ".yaml"));
  EXPECT_TRUE(file) << file.error().message;
  return file ? std::move(file).value() : scene::ArmFile{};
}

const char* const kFiles[] = {"woodenhaptics", "woodenhaptics_teensy", "polhem", "vintage_phantom",
                              "falcon"};

/// One board, plugged into a simulated machine.
class OpenWireTest : public ::testing::Test {
 protected:
  OpenWireTest()
      : usb_(std::string("open_wire_") +
             testing::UnitTest::GetInstance()->current_test_info()->name()) {
    hid_ = {};
    hid_.coming = 1'000'000;
  }

  void plug_hid(const char* vendor, const char* product_id, const char* product, int bytes) {
    usb_.plug("1-1", vendor, product_id, "B1", 1, 2);
    usb_.call("1-1", product);
    usb_.add_hidraw("1-1", 0, "hidraw3", static_cast<unsigned char>(bytes));
    hid_.report_bytes = bytes;
  }

  /// Lists the board, with the path of its node on this machine.
  std::vector<driver::FoundArm> plugged_in() {
    auto arms = driver::find_arms(usb_.root());
    EXPECT_TRUE(arms);
    for (driver::FoundArm& arm : *arms) {
      arm.node = port_.empty()
                     ? (usb_.root() / std::filesystem::path(arm.node).relative_path()).string()
                     : port_;
    }
    return *arms;
  }

  /// Opens the board with an arm file. Returns the error message, or "" on success.
  std::string open(const std::string& file, const std::string& device = "B1") {
    const auto chosen = scene::choose_arm(plugged_in(), device);
    if (!chosen) return chosen.error().message;
    if (!*chosen) return "none chosen";
    const auto link = scene::open_link(**chosen, file_of(file), "", clock_);
    return link ? "" : link.error().message;
  }

  support::FakeUsb usb_;
  support::FakeHidapi& hid_ = support::fake_hidapi();
  std::string port_;
  driver::WallClock clock_;
};

TEST_F(OpenWireTest, RawHidTeensyNeedsDeviceAndBoardName) {
  plug_hid("16c0", "0486", "Teensyduino RawHID", 64);
  EXPECT_EQ(open("polhem", "auto"), "none chosen");
  for (const char* file : {"woodenhaptics", "woodenhaptics_teensy", "vintage_phantom", "falcon"}) {
    EXPECT_NE(open(file).find("is a teensy_raw_hid_64"), std::string::npos) << file;
  }
  EXPECT_EQ(hid_.open, 0);
  EXPECT_EQ(open("polhem"), "");
  EXPECT_EQ(hid_.messages, 0u);  // the first message is the zero force of Device::open
}

TEST_F(OpenWireTest, SendsNothingToAForeignMbedBoard) {
  plug_hid("1234", "0006", "HID DEVICE", 8);
  EXPECT_NE(open("woodenhaptics", "auto").find("not numbered"), std::string::npos);
  hid_.coming = 0;
  EXPECT_NE(open("woodenhaptics").find("sends no reports by itself"), std::string::npos);
  EXPECT_EQ(hid_.messages, 0u);
  EXPECT_EQ(hid_.open, 0);
}

TEST_F(OpenWireTest, OpensTheWoodenHapticsThatProvesItself) {
  plug_hid("1234", "0006", "HID DEVICE", 8);
  hid_.numbered_last = true;
  EXPECT_EQ(open("woodenhaptics", "auto"), "");
  EXPECT_EQ(hid_.messages, 0u);
  for (const char* file : {"woodenhaptics_teensy", "polhem", "vintage_phantom", "falcon"}) {
    EXPECT_NE(open(file).find("is a mbed_hid_8"), std::string::npos) << file;
  }
  EXPECT_EQ(hid_.messages, 0u);
}

TEST_F(OpenWireTest, SendsNothingToAnUnnamed14ByteBoard) {
  plug_hid("1234", "0006", "HID DEVICE", 14);
  EXPECT_EQ(open("polhem", "auto"), "none chosen");
  EXPECT_NE(open("woodenhaptics"), "");
  EXPECT_EQ(open("polhem"), "");
  EXPECT_EQ(hid_.messages, 0u);
}

TEST_F(OpenWireTest, NeverOpensABoardWithUnknownReports) {
  plug_hid("1234", "0006", "Polhem", 64);
  EXPECT_EQ(open("polhem", "auto"), "none chosen");
  for (const char* file : kFiles) {
    EXPECT_NE(open(file).find("does not open it"), std::string::npos) << file;
  }
  EXPECT_EQ(hid_.open, 0);
  EXPECT_EQ(hid_.messages, 0u);
}

/// Serial board at the other end of a pseudo-terminal.
class OpenSerialTest : public OpenWireTest {
 protected:
  OpenSerialTest() : far_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (far_ < 0 || grantpt(far_) != 0 || unlockpt(far_) != 0) return;
    port_ = ptsname(far_);
  }
  ~OpenSerialTest() override { close(far_); }

  void plug_serial(const char* product) {
    usb_.plug("1-1", "16c0", "0483", "B1", 1, 2);
    usb_.call("1-1", product);
    usb_.add_tty("1-1", 0, "ttyACM0");
  }
  std::string hear() const {
    std::string text(256, '\0');
    const ssize_t count = ::read(far_, text.data(), text.size());
    text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return text;
  }

  int far_;
};

TEST_F(OpenSerialTest, TeensyNeedsDeviceAndBoardName) {
  plug_serial("USB Serial");
  EXPECT_EQ(open("polhem", "auto"), "none chosen");
  EXPECT_NE(open("woodenhaptics").find("is a text_lines"), std::string::npos);
  EXPECT_NE(open("falcon"), "");
  EXPECT_EQ(hear(), "");
}

TEST_F(OpenSerialTest, NeverOpensAnotherMakersArm) {
  plug_serial("Haply inverse3");
  EXPECT_EQ(open("woodenhaptics_teensy", "auto"), "none chosen");
  for (const char* file : kFiles) {
    EXPECT_NE(open(file).find("Haply Inverse3"), std::string::npos) << file;
  }
  EXPECT_EQ(hear(), "");
}

TEST_F(OpenSerialTest, RequestsTheModelWithZeroCurrentsOnly) {
  plug_serial("USB Serial");
  // The board answers as a Polhem, but a WoodenHaptics is expected. Its answer is already waiting.
  const std::string answer = "[1,0,0,0,0,0,0,0]\n";
  std::string heard;
  std::atomic<bool> done{false};
  std::thread board([&] {
    while (!done.load()) {
      const std::string words = hear();
      heard += words;
      if (!words.empty()) (void)!::write(far_, answer.data(), answer.size());
      std::this_thread::yield();
    }
  });
  const std::string refused = open("woodenhaptics_teensy");
  done.store(true);
  board.join();
  EXPECT_NE(refused.find("reports model 1"), std::string::npos) << refused;
  ASSERT_FALSE(heard.empty());
  for (std::size_t at = 0; at < heard.size(); at += 8) {
    EXPECT_EQ(heard.substr(at, 8), "[0,0,0]\n");
  }
}

}  // namespace
}  // namespace thimble::scene
