// Arms whose wire is described by their file: how their boards are recognised, that nothing is sent
// before, and that they behave like arms with a wire in C++.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "arm_table.h"
#include "support/boards/described_port.h"
#include "support/heap_guard.h"
#include "support/mock/fake_usb.h"
#include "support/scratch.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/real_arm_file.h"
#include "thimble/session/session.h"
#include "wires/described_link.h"
#include "wires/wire_table.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

const char* const kWire = R"(
protocol: described
wire:
  transport: serial
  usb: {id: "16c0:0483", product: My arm}
  exchange: ask
  watchdog: 0.1
  report:
    framing: header
    begin: aa 55
    size: 18
    checksum: crc16_ccitt
    fields:
      - {name: sequence, type: u16, at: 2}
      - {name: encoder_1, type: i32, at: 4}
      - {name: encoder_2, type: i32, at: 8}
      - {name: encoder_3, type: i32, at: 12}
  command:
    framing: header
    begin: aa 56
    size: 10
    checksum: crc16_ccitt
    fields:
      - {name: motor_1, type: i16, at: 2, unit: A, scale: 0.001}
      - {name: motor_2, type: i16, at: 4, unit: A, scale: 0.001}
      - {name: motor_3, type: i16, at: 6, unit: A, scale: 0.001}
)";

ArmFile arm_of(const std::string& text) {
  const fs::path file = support::scratch_folder() / "described_arm.yaml";
  std::ofstream(file) << text;
  auto arm = load_arm(file);
  EXPECT_TRUE(arm) << arm.error().message;
  return arm ? std::move(arm).value() : ArmFile{};
}

std::string mistake_of(const std::string& text) {
  const fs::path file = support::scratch_folder() / "described_arm.yaml";
  std::ofstream(file) << text;
  const auto arm = load_arm(file);
  return arm ? "" : arm.error().message;
}

driver::DescribedBoard my_board() {
  return {.arm = "mine",
          .arm_file = "mine",
          .vendor_id = 0x16c0,
          .product_id = 0x0483,
          .product = "My arm",
          .serial = true};
}

/// Lists a serial board with this product string as driver::find_arms does.
driver::FoundArm found(const std::string& product, const driver::DescribedBoard& described) {
  static int number = 0;
  const support::FakeUsb usb("described_" + std::to_string(number++));
  usb.plug("1-1", "16c0", "0483", "B1", 1, 2);
  usb.call("1-1", product);
  usb.add_tty("1-1", 0, "ttyACM0");
  const auto arms = driver::find_arms(usb.root(), {described});
  EXPECT_TRUE(arms);
  EXPECT_EQ(arms->size(), 1u);
  return arms->front();
}

TEST(DescribedArm, IsRecognisedByItsWholeProductString) {
  const driver::FoundArm arm = found("My arm", my_board());
  EXPECT_EQ(arm.kind, driver::ArmKind::kDescribed);
  EXPECT_EQ(arm.certainty, driver::Certainty::kKnown);
  EXPECT_EQ(arm.arm_file, "mine");
  for (const char* other : {"My arm 2", "my arm", "My", "USB Serial"}) {
    EXPECT_NE(found(other, my_board()).kind, driver::ArmKind::kDescribed) << other;
  }
}

TEST(DescribedArm, IdsAndCommonStringsProveNothing) {
  driver::DescribedBoard ids = my_board();
  ids.product.clear();
  // A Teensy with any program stays a board of unknown kind.
  EXPECT_EQ(found("My arm", ids).kind, driver::ArmKind::kHfabLine);
  EXPECT_EQ(found("My arm", ids).certainty, driver::Certainty::kUnknown);
  driver::DescribedBoard common = my_board();
  common.product = "USB Serial";
  EXPECT_EQ(found("USB Serial", common).certainty, driver::Certainty::kUnknown);
}

TEST(DescribedArm, DoesNotReplaceAnArmThatIsKnown) {
  driver::DescribedBoard haply = my_board();
  haply.product = "Haply inverse3";
  EXPECT_EQ(found("Haply inverse3", haply).certainty, driver::Certainty::kUnsupported);
}

TEST(DescribedArm, FileOfAnotherBoardIsRefused) {
  const ArmFile file = arm_of(support::phantom_with_wire(kWire));
  EXPECT_TRUE(check_fits(file, found("My arm", my_board())));
  const auto other = check_fits(file, found("USB Serial", my_board()));
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("\"USB Serial\""), std::string::npos);
}

TEST(DescribedArm, NeedsAnInstalledArmFile) {
  const fs::path file = support::scratch_folder() / "described_arm.yaml";
  std::ofstream(file) << support::replaced(support::phantom_with_wire(kWire),
                                           "name: vintage_phantom", "name: described_nowhere");
  driver::FoundArm arm = found("My arm", my_board());
  const auto chosen = find_real_arm_file(arm, {.arm_file = file});
  ASSERT_FALSE(chosen);
  EXPECT_NE(chosen.error().message.find("installed arm file"), std::string::npos)
      << chosen.error().message;
  EXPECT_NE(find_real_arm_file(arm).error().message.find("No installed arm file is called mine"),
            std::string::npos);
}

TEST(DescribedArm, AnotherWireThanTheInstalledOneIsRefused) {
  // The installed vintage_phantom has a wire in C++.
  const fs::path file = support::scratch_folder() / "described_arm.yaml";
  std::ofstream(file) << support::phantom_with_wire(kWire);
  const auto chosen = find_real_arm_file(found("My arm", my_board()), {.arm_file = file});
  EXPECT_FALSE(chosen);
}

TEST(DescribedArm, WithoutAWatchdogHasAtMostHalfANewton) {
  const std::string bare =
      support::replaced(support::phantom_with_wire(kWire), "  watchdog: 0.1\n", "  watchdog: 0\n");
  const std::string mistake = mistake_of(bare);
  EXPECT_NE(mistake.find("force_max: expected at most 0.5 N, because the board has no watchdog"),
            std::string::npos)
      << mistake;
  const ArmFile phantom = arm_of(support::phantom_with_wire(kWire));
  std::string weak = bare;
  const std::size_t at = weak.find("  force_max:");
  ASSERT_NE(at, std::string::npos);
  weak.replace(at, weak.find('\n', at) - at, "  force_max: 0.5");
  EXPECT_EQ(mistake_of(weak), "");
  EXPECT_GT(phantom.limits.force_max, 0.5);
}

TEST(DescribedArm, GateDoesNotWaitLongerThanTheBoard) {
  const std::string slow = support::replaced(support::phantom_with_wire(kWire), "  watchdog: 0.1\n",
                                             "  watchdog: 0.05\n");
  EXPECT_NE(mistake_of(slow).find("watchdog: expected at most the time of the board's own"),
            std::string::npos);
}

/// Opens the simulated board of an arm file over a pseudo-terminal and reads its position.
void expect_opened(const std::string& text) {
  const ArmFile file = arm_of(text);
  ASSERT_TRUE(file.wire);
  auto settings = file.simulated;
  settings.firmware.protocol = driver::ArmKind::kDescribed;
  settings.firmware.described = file.wire;
  const Eigen::Vector3d p_BH = file.R_WB.transpose() * (file.workspace.middle() - file.p_WB);
  auto simulated = device_sim::SimulatedArm::make(
      driver::model_as<driver::SerialArm>(file.model), settings,
      device_sim::HandPath::make({{.time = 0, .p_BH = p_BH}}).value());
  ASSERT_TRUE(simulated) << simulated.error().message;
  support::PortServer server(*simulated, file.wire);
  driver::FoundArm arm = found("My arm", my_board());
  arm.node = server.node();
  driver::WallClock clock;
  auto link = open_link(arm, file, "", clock);
  ASSERT_TRUE(link) << link.error().message;
  auto device = driver::Device::open(std::move(link).value(), device_settings(file, 1000),
                                     clock.now_ns(), 2'000'000'000);
  ASSERT_TRUE(device) << device.error().message;
  const driver::DeviceState& state = (*device)->read(clock.now_ns(), clock.now_ns() + 20'000'000);
  EXPECT_LT((state.p_WT - file.workspace.middle()).norm(), 0.002);
}

TEST(DescribedArm, OpensOverAPseudoTerminal) {
  expect_opened(support::phantom_with_wire(kWire));
}

TEST(DescribedArm, WithSlipOpensOverAPseudoTerminal) {
  std::string text = support::phantom_with_wire(kWire);
  for (int direction = 0; direction < 2; ++direction) {
    text.replace(text.find("framing: header"), 15, "framing: slip");
  }
  expect_opened(text);
}

TEST(DescribedArm, WithALengthOpensOverAPseudoTerminal) {
  std::string text = support::phantom_with_wire(kWire);
  for (int direction = 0; direction < 2; ++direction) {
    text.replace(text.find("framing: header"), 15, "framing: length\n    length_adds: 3");
  }
  text = support::replaced(text, "begin: aa 55", "begin: aa");
  expect_opened(support::replaced(text, "begin: aa 56", "begin: ab"));
}

TEST(DescribedArm, SilentBoardGetsItsStartMessageOnly) {
  const ArmFile file = arm_of(support::replaced(
      support::phantom_with_wire(kWire), "  watchdog: 0.1\n",
      "  watchdog: 0.1\n  start:\n    - {send: \"'HI'\", expect: \"'OK' ??\", within: 0.05}\n"));
  ASSERT_TRUE(file.wire);
  const support::PortEnd board;
  driver::WallClock clock;
  const auto opened = driver::open_described(board.node(), *file.wire, clock);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("the expected answer did not arrive within 50 ms"),
            std::string::npos)
      << opened.error().message;
  EXPECT_EQ(board.hear(), "HI");
}

TEST(DescribedArm, ExpectedAnswerIsFoundBehindOtherBytes) {
  const ArmFile file = arm_of(support::replaced(
      support::phantom_with_wire(kWire), "  watchdog: 0.1\n",
      "  watchdog: 0.1\n  start:\n    - {send: \"'HI'\", expect: \"'OK' ??\", within: 5}\n"));
  ASSERT_TRUE(file.wire);
  const support::PortEnd board;
  std::thread answers([&] {
    std::string heard;
    for (int i = 0; i < 1000 && heard.size() < 2; ++i) {
      heard += board.hear();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    board.say("noOOK7");
  });
  driver::WallClock clock;
  const auto opened = driver::open_described(board.node(), *file.wire, clock);
  answers.join();
  EXPECT_TRUE(opened) << opened.error().message;
}

TEST(DescribedArm, NothingIsSentToAStreamThatIsNotThatOfTheFile) {
  const ArmFile file = arm_of(
      support::replaced(support::phantom_with_wire(kWire), "exchange: ask", "exchange: stream"));
  ASSERT_TRUE(file.wire);
  const support::PortEnd board;
  std::atomic<bool> stop{false};
  std::thread speaks([&] {
    while (!stop.load()) {
      board.say("a text from another device\n");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  driver::WallClock clock;
  const auto opened = driver::open_described(board.node(), *file.wire, clock);
  stop.store(true);
  speaks.join();
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("Nothing was sent"), std::string::npos);
  EXPECT_EQ(board.hear(), "");
}

TEST(DescribedArm, CodecAllocatesNothing) {
  const ArmFile file = arm_of(support::phantom_with_wire(kWire));
  const auto arm = driver::make_arm(file.protocol, file.model, file.wire.get());
  ASSERT_TRUE(arm);
  std::array<std::byte, driver::kReportCapacity> bytes{};
  driver::ArmReading reading;
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int i = 0; i < 1000; ++i) {
                const std::size_t size = arm->encode(driver::MotorCurrents(), bytes);
                (void)arm->decode(std::span(bytes).first(size), reading);
              }
            }),
            0);
}

/// Moves the simulated board of an arm file by 4 cm and returns the counts that the driver decodes.
std::vector<std::array<std::int32_t, 3>> counts_of(const std::string& text) {
  const ArmFile file = arm_of(text);
  if (!file.wire) return {};
  auto settings = file.simulated;
  settings.firmware.protocol = driver::ArmKind::kDescribed;
  settings.firmware.described = file.wire;
  const auto at = [&](double y) -> Eigen::Vector3d {
    return file.R_WB.transpose() * (file.workspace.middle() + Eigen::Vector3d(0, y, 0) - file.p_WB);
  };
  auto simulated = device_sim::SimulatedArm::make(
      driver::model_as<driver::SerialArm>(file.model), settings,
      device_sim::HandPath::make({{.time = 0, .p_BH = at(-0.02)}, {.time = 0.5, .p_BH = at(0.02)}})
          .value());
  EXPECT_TRUE(simulated) << simulated.error().message;
  if (!simulated) return {};
  const auto arm = driver::make_arm(file.protocol, file.model, file.wire.get());
  std::vector<std::array<std::int32_t, 3>> counts;
  for (int tick = 1; tick <= 600; ++tick) {
    simulated->advance_to(tick * 1'000'000);
    driver::ArmReading reading;
    const auto report = simulated->sample_now();
    if (arm->decode(report, reading)) counts.push_back(reading.counts);
  }
  return counts;
}

TEST(DescribedArm, WrappingCountersAreContinuousForTheDriver) {
  const std::string whole = support::phantom_with_wire(kWire);
  std::string wrapping = whole;
  for (const char* axis : {"encoder_1", "encoder_2", "encoder_3"}) {
    const std::size_t at = wrapping.find("type: i32", wrapping.find(axis));
    wrapping.replace(at, 9, "type: u32, wrap: 9");
  }
  const auto counted = counts_of(whole), unwrapped = counts_of(wrapping);
  ASSERT_EQ(counted.size(), 600u);
  ASSERT_EQ(unwrapped.size(), 600u);
  // The first report is the reference: within half of the range around zero.
  std::int32_t max_way = 0;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t way = counted[i][k] - counted[0][k];
      ASSERT_EQ(unwrapped[i][k] - unwrapped[0][k], way) << "tick " << i;
      max_way = std::max(max_way, std::abs(way));
    }
  }
  EXPECT_GT(max_way, 512) << "no counter wraps: this test could not fail";
}

/// Runs a scene with the simulated arm of a file and returns its ticks.
std::vector<driver::TickRecord> run_with(const std::string& arm_text) {
  const fs::path folder = support::scratch_folder();
  std::ofstream(folder / "described_run_arm.yaml") << arm_text;
  std::ofstream(folder / "described_run.yaml")
      << "name: described\narm: described_run_arm.yaml\nduration: 0.6\nobjects:\n"
         "  - {name: plate, plane: {normal: [0, 0, 1]}, stiffness: 300, damping: 1}\n"
         "hand: {path: [{t: 0, at: [0, 0, 0.02]}, {t: 0.3, at: [0, 0.01, -0.01]}]}\n";
  auto session = session::Session::open(folder / "described_run.yaml", {});
  EXPECT_TRUE(session) << session.error().message;
  if (!session) return {};
  (*session)->run();
  const auto ticks = (*session)->ticks(0);
  return {ticks.begin(), ticks.end()};
}

TEST(DescribedArm, RunIsBitIdenticalToThatOfTheWireInCpp) {
  const std::string wire =
      support::text_of_file(fs::path(THIMBLE_SOURCE_DIR) / "app/arms/wires/hfab_14_byte.yaml");
  const auto data = run_with(support::phantom_with_wire("\nprotocol: described\n" + wire));
  const auto code = run_with(
      support::text_of_file(fs::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml"));
  ASSERT_EQ(data.size(), code.size());
  ASSERT_GT(data.size(), 500u);
  double squares = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    ASSERT_EQ(data[i].p_WT, code[i].p_WT) << "tick " << i;
    ASSERT_EQ(data[i].f_sent_W, code[i].f_sent_W) << "tick " << i;
    squares += data[i].f_sent_W[2] * data[i].f_sent_W[2];
  }
  EXPECT_GT(squares, 0) << "no force: this test could not fail";
}

}  // namespace
}  // namespace thimble::scene
