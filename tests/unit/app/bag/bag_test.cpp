#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#ifdef THIMBLE_FAST_CDR
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#endif

#include "bag/bag_axes.h"
#include "bag/bag_messages.h"
#include "bag/read_bag.h"
#include "bag/write_bag.h"
#include "support/bag_maker.h"
#include "support/scratch.h"

namespace thimble::bag {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPose = "geometry_msgs/msg/PoseStamped";
constexpr const char* kWrench = "geometry_msgs/msg/WrenchStamped";

class Bag : public ::testing::Test {
 protected:
  Bag() {
    folder_ = support::scratch_folder() /
              (std::string("thimble_bag_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Bag() override { fs::remove_all(folder_); }

  fs::path file() const { return folder_ / "touch_0.db3"; }

  static std::vector<unsigned char> pose(std::int64_t stamp_ns, const Eigen::Vector3d& p,
                                         const std::string& frame = "world") {
    return encode(BagKind::kPositions, {stamp_ns, frame, p});
  }

  /// Reads positions and expects an error message that contains each of `parts`.
  void expect_refused(const std::vector<std::string>& parts, const std::string& topic = {}) const {
    const auto read = read_bag(file(), BagKind::kPositions, topic);
    ASSERT_FALSE(read);
    for (const std::string& part : parts) {
      EXPECT_NE(read.error().message.find(part), std::string::npos) << read.error().message;
    }
  }

  fs::path folder_;
};

TEST_F(Bag, UsesTheStampsOfHeaders) {
  {
    test::BagMaker maker(file());
    maker.topic(7, "/tf", "tf2_msgs/msg/TFMessage");
    maker.topic(9, "/pose", kPose);
    maker.message(7, 5, {0, 1, 0, 0});
    maker.message(9, 100, pose(1'700'000'000'500'000'000, {0.01, 0.02, 0.03}));
    maker.message(9, 900, pose(1'700'000'000'510'000'000, {0.04, 0.05, 0.06}));
    maker.message(9, 950, pose(1'700'000'000'510'000'000, {1, 1, 1}));  // same time: ignored
  }
  for (const fs::path& path : {file(), folder_}) {
    const auto read = read_bag(path, BagKind::kPositions);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->name, "/pose");
    EXPECT_EQ(read->frame, "world");
    EXPECT_EQ(read->clock, BagClock::kStamps);
    EXPECT_EQ(read->start_ns, 1'700'000'000'500'000'000);
    ASSERT_EQ(read->samples.size(), 2U);
    EXPECT_EQ(read->samples[0].time, 0);
    EXPECT_DOUBLE_EQ(read->samples[1].time, 0.01);
    EXPECT_EQ(read->samples[1].value, Eigen::Vector3d(0.04, 0.05, 0.06));
  }
  const auto received = read_bag(file(), BagKind::kPositions, "/pose", BagClock::kReceived);
  ASSERT_TRUE(received);
  EXPECT_EQ(received->start_ns, 100);
  EXPECT_EQ(received->samples.size(), 3U);
}

TEST_F(Bag, UsesTheRecordersTimesWithoutStamps) {
  {
    test::BagMaker maker(file());
    maker.topic(1, "/pose", kPose);
    maker.message(1, 2'000'000'000, pose(0, {0, 0, 0.2}));
    maker.message(1, 1'500'000'000, pose(0, {0, 0, 0.1}));
  }
  const auto read = read_bag(file(), BagKind::kPositions);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->clock, BagClock::kReceived);
  ASSERT_EQ(read->samples.size(), 2U);
  EXPECT_DOUBLE_EQ(read->samples[1].time, 0.5);
  EXPECT_EQ(read->samples[1].value.z(), 0.2);
}

TEST_F(Bag, JoinsTheFilesOfASplitRecording) {
  for (const int part : {1, 0}) {
    test::BagMaker maker(folder_ / ("touch_" + std::to_string(part) + ".db3"));
    maker.topic(1 + part, "/pose", kPose);
    maker.message(1 + part, 10 + part, pose(1'000'000'000 * (1 + part), {0.1 * part, 0, 0}));
  }
  const auto read = read_bag(folder_, BagKind::kPositions);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->samples.size(), 2U);
  EXPECT_DOUBLE_EQ(read->samples[1].time, 1);
}

TEST_F(Bag, ReadsBothByteOrders) {
  std::vector<unsigned char> bytes{0, 0, 0, 0};
  const auto put = [&bytes](auto value) {
    while ((bytes.size() - 4) % sizeof value != 0) bytes.push_back(0);
    const auto raw = std::bit_cast<std::array<unsigned char, sizeof value>>(value);
    bytes.insert(bytes.end(), raw.rbegin(), raw.rend());
  };
  put(std::int32_t{-2});
  put(std::uint32_t{5});
  put(std::uint32_t{2});
  bytes.insert(bytes.end(), {'w', 0});
  for (const double number : {1.0, 2.0, 3.0, 0.0, 0.0, 0.0}) put(number);
  const auto read = decode(BagKind::kForces, bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->stamp_ns, -1'999'999'995);
  EXPECT_EQ(read->frame, "w");
  EXPECT_EQ(read->value, Eigen::Vector3d(1, 2, 3));
  // A time before the epoch keeps its nanoseconds.
  const auto again = decode(BagKind::kForces, encode(BagKind::kForces, *read));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->stamp_ns, read->stamp_ns);
}

#ifdef THIMBLE_FAST_CDR
TEST_F(Bag, WritesTheSameBytesAsFastCdr) {
  for (const std::string frame : {"world", "w", "", "base"}) {
    for (const BagKind kind : {BagKind::kPositions, BagKind::kForces}) {
      std::vector<char> room(512);
      eprosima::fastcdr::FastBuffer buffer(room.data(), room.size());
      eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS,
                                 eprosima::fastcdr::Cdr::DDS_CDR);
      cdr.serialize_encapsulation();
      cdr << std::int32_t{12} << std::uint32_t{345} << frame << 0.1 << 0.2 << 0.3;
      if (kind == BagKind::kPositions) {
        cdr << 0.5 << 0.6 << 0.7 << 0.4;  // x, y, z, w
      } else {
        cdr << 0.0 << 0.0 << 0.0;
      }
      const std::vector<unsigned char> theirs(
          room.begin(), room.begin() + static_cast<std::ptrdiff_t>(cdr.getSerializedDataLength()));
      const auto ours =
          encode(kind, {12'000'000'345, frame, {0.1, 0.2, 0.3}}, {0.4, 0.5, 0.6, 0.7});
      EXPECT_EQ(ours, theirs) << frame;
      const auto read = decode(kind, theirs);
      ASSERT_TRUE(read);
      EXPECT_EQ(read->frame, frame);
      EXPECT_EQ(read->value, Eigen::Vector3d(0.1, 0.2, 0.3));
    }
  }
}
#endif

TEST_F(Bag, ListsTopicsIfOneIsMissing) {
  {
    test::BagMaker maker(file());
    maker.topic(1, "/arm/pose", kPose);
    maker.topic(2, "/goal", kPose);
    maker.topic(3, "/arm/wrench", kWrench);
    maker.message(1, 1, pose(1, {0, 0, 0}));
  }
  expect_refused({"several topics", "name one", "/arm/pose", "/goal"});
  expect_refused({"has no topic /pose", "/arm/pose (geometry_msgs/msg/PoseStamped)"}, "/pose");
  expect_refused({"/arm/wrench is of type geometry_msgs/msg/WrenchStamped", "expected"},
                 "/arm/wrench");
  expect_refused({"/goal has no messages"}, "/goal");
  EXPECT_TRUE(read_bag(file(), BagKind::kPositions, "/arm/pose"));
}

TEST_F(Bag, RejectsFilesThatAreNotBags) {
  expect_refused({"no such bag"});
  std::ofstream(file()) << "time x y z\n0 0 0 0\n";
  expect_refused({"is damaged, or not a ROS bag"});
  std::ofstream(file(), std::ios::trunc).flush();  // an empty file is an empty database
  expect_refused({"not a ROS bag", "the tables topics and messages are missing"});
  fs::remove(file());
  const auto none = read_bag(folder_, BagKind::kPositions);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("expected a file *.db3"), std::string::npos);
  std::ofstream(folder_ / "touch_0.mcap") << "x";
  for (const fs::path& path : {folder_, folder_ / "touch_0.mcap"}) {
    const auto mcap = read_bag(path, BagKind::kPositions);
    ASSERT_FALSE(mcap);
    EXPECT_NE(mcap.error().message.find("ros2 bag convert"), std::string::npos);
  }
}

TEST_F(Bag, RejectsInvalidMessages) {
  struct Case {
    std::string part;
    std::vector<unsigned char> second;
  };
  auto short_one = pose(2, {0, 0, 0});
  short_one.pop_back();
  auto long_one = pose(2, {0, 0, 0});
  long_one.resize(long_one.size() + 8);
  for (const Case& wrong :
       {Case{"message 2 of /pose is not a", {}}, Case{"message 2 of /pose is not a", short_one},
        Case{"message 2 of /pose is not a", long_one},
        Case{"message 2 of /pose is not a", encode(BagKind::kForces, {2, "world", {0, 0, 0}})},
        Case{"not finite", pose(2, {0, std::numeric_limits<double>::quiet_NaN(), 0})},
        Case{"not finite", pose(2, {0, 0, std::numeric_limits<double>::infinity()})},
        Case{"frame \"base\"", pose(2, {0, 0, 0}, "base")},
        Case{"more than a day", pose(100'000'000'000'000, {0, 0, 0})},
        Case{"the time of /pose decreases", pose(0, {0, 0, 0})},
        Case{"is compressed", {0x28, 0xB5, 0x2F, 0xFD, 0, 0, 0, 0}}}) {
    test::BagMaker maker(file());
    maker.topic(1, "/pose", kPose);
    maker.message(1, 10, pose(1, {0, 0, 0}));
    maker.message(1, 20, wrong.second);
    expect_refused({wrong.part});
  }
  test::BagMaker maker(file());
  maker.topic(1, "/pose", kPose, "json");
  maker.message(1, 10, pose(1, {0, 0, 0}));
  expect_refused({"serialized as \"json\""});
}

TEST_F(Bag, ReadsWhatItWrites) {
  BagTrack poses{.name = "/pose", .kind = BagKind::kPositions, .frame = "world", .messages = {}};
  BagTrack forces{.name = "/wrench", .kind = BagKind::kForces, .frame = "world", .messages = {}};
  for (int i = 0; i < 300; ++i) {
    poses.messages.push_back({.time_ns = 1'000'000 * i, .value = {0.001 * i, std::sin(i), -0.1}});
    forces.messages.push_back({.time_ns = 2'000'000 * i, .value = {0.0, 0.1 * i, 1.0 / (i + 1)}});
  }
  const fs::path bag = folder_ / "out" / "touch";
  const auto written = write_bag(bag, {poses, forces});
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_TRUE(fs::exists(bag / "touch_0.db3"));
  EXPECT_TRUE(fs::exists(bag / "metadata.yaml"));
  for (const BagTrack& track : {poses, forces}) {
    const auto read = read_bag(bag, track.kind);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->samples.size(), track.messages.size());
    for (std::size_t i = 0; i < read->samples.size(); ++i) {
      EXPECT_EQ(read->samples[i].value, track.messages[i].value);
      EXPECT_EQ(std::llround(1e9 * read->samples[i].time), track.messages[i].time_ns);
    }
  }
  const auto again = write_bag(bag, {poses});
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("already exists"), std::string::npos);
  EXPECT_FALSE(write_bag("/proc/none/bag", {poses}));
}

TEST_F(Bag, RotatesTheAxesOfTheOmnisDrivers) {
  const Eigen::Vector3d right_away_up(1, 2, 3);
  EXPECT_EQ(in_world(BagAxes::kOmni, right_away_up), Eigen::Vector3d(-2, 1, 3));
  EXPECT_EQ(in_world(BagAxes::kPlain, right_away_up), right_away_up);
}

}  // namespace
}  // namespace thimble::bag
