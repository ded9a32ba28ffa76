#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <atomic>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "observers/black_box.h"
#include "recording/h5_handle.h"
#include "recording/recorder.h"
#include "recording/recording_file.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/scratch.h"
#include "support/seed.h"
#include "thimble/session/recording.h"

namespace thimble::session {
namespace {

using driver::TickRecord;

const session::RecordingInfo kInfo{.scene = "elephant",
                                   .scene_file = "scenes/elephant.yaml",
                                   .scene_text = "name: elephant\n# \xc3\xa4\n",
                                   .arm = "vintage",
                                   .arm_file = "arms/vintage.yaml",
                                   .arm_text = "name: vintage\n",
                                   .device = "sim",
                                   .clock = "virtual",
                                   .program = "test",
                                   .rate = 1000,
                                   .seed = 0xfedcba9876543210U};

std::filesystem::path scratch(const char* name) {
  return support::scratch_folder() / name;
}

/// Makes a tick with a different value in every field.
TickRecord tick_number(std::uint64_t number) {
  std::mt19937_64 random(number + 1);
  std::uniform_real_distribution<double> value(-1, 1);
  TickRecord tick;
  tick.tick = number;
  tick.time_ns = static_cast<std::int64_t>(number * 1'000'000 + random() % 1000);
  tick.due_ns = static_cast<std::int64_t>(number * 1'000'000);
  tick.work_ns = static_cast<std::int64_t>(random() % 100'000);
  for (auto* vector : {&tick.q, &tick.p_WT, &tick.v_WT, &tick.p_WP, &tick.n_W, &tick.f_wanted_W,
                       &tick.f_sent_W, &tick.heat}) {
    for (double& x : *vector) x = value(random);
  }
  for (float& x : tick.q_WT) x = static_cast<float>(value(random));
  for (float& x : tick.gimbal) x = static_cast<float>(value(random));
  tick.gripper = static_cast<float>(value(random));
  tick.has_gripper = random() % 2 == 0;
  for (auto& count : tick.counts) count = static_cast<std::int32_t>(random());
  tick.depth = value(random);
  tick.feature = static_cast<std::int32_t>(random());
  tick.object = static_cast<std::int16_t>(random());
  tick.hops = static_cast<std::uint16_t>(random());
  tick.buttons = static_cast<std::uint16_t>(random());
  tick.in_contact = random() % 2 == 0;
  tick.fresh = random() % 2 == 0;
  tick.stage = static_cast<driver::DeviceStage>(random() % 3);
  tick.fault = static_cast<driver::Fault>(random() % (static_cast<int>(driver::kLastFault) + 1));
  tick.link =
      static_cast<driver::LinkState>(random() % (static_cast<int>(driver::kLastLinkState) + 1));
  tick.home_needed = random() % 2 == 0;
  return tick;
}

bool same(const TickRecord& a, const TickRecord& b) {
  for (const session::RecordingColumn& column : session::recording_columns()) {
    if (std::memcmp(reinterpret_cast<const unsigned char*>(&a) + column.offset,
                    reinterpret_cast<const unsigned char*>(&b) + column.offset,
                    column.bytes()) != 0) {
      return false;
    }
  }
  return true;
}

TEST(RecordingColumns, ContainEveryByteOfATickExceptPadding) {
  std::size_t bytes = 0;
  for (const session::RecordingColumn& column : session::recording_columns())
    bytes += column.bytes();
  // 4 long counters, 3 counts, 24 + 3 doubles, 8 floats, a triangle, 4 short numbers, 7 flags.
  EXPECT_EQ(bytes, 4 * 8 + 3 * 4 + 27 * 8 + 8 * 4 + 4 + 4 * 2 + 7U);
  // Padding: 4 bytes after the counts, 5 after the flags.
  EXPECT_EQ(sizeof(TickRecord) - bytes, 9U) << "a field of TickRecord is in no column";
}

TEST(Recording, ReadsBackBitIdentically) {
  const auto path = scratch("whole.h5");
  auto recorder = session::Recorder::open(path, kInfo, 3000);
  ASSERT_TRUE(recorder) << recorder.error().message;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    (**recorder)(tick_number(i));
    if (i % 700 == 0) (*recorder)->serve();
  }
  ASSERT_TRUE((*recorder)->finish());

  const auto read = session::read_recording(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->complete);
  ASSERT_EQ(read->ticks.size(), 3000U);
  for (std::uint64_t i = 0; i < 3000; ++i) ASSERT_TRUE(same(read->ticks[i], tick_number(i))) << i;
  EXPECT_EQ(read->info.scene, kInfo.scene);
  EXPECT_EQ(read->info.scene_text, kInfo.scene_text);
  EXPECT_EQ(read->info.arm_text, kInfo.arm_text);
  EXPECT_EQ(read->info.program, kInfo.program);
  EXPECT_EQ(read->info.rate, kInfo.rate);
  EXPECT_EQ(read->info.seed, kInfo.seed);
}

TEST(Recording, OlderRecordingHasNoHeatAndNoOrientation) {
  const auto path = scratch("older.h5");
  auto recorder = session::Recorder::open(path, kInfo, 10);
  ASSERT_TRUE(recorder) << recorder.error().message;
  for (std::uint64_t i = 0; i < 10; ++i) (**recorder)(tick_number(i));
  ASSERT_TRUE((*recorder)->finish());
  // The renamed column is unknown.
  std::ifstream in(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const std::string column : {"heat", "q_WT", "gimbal", "gripper", "has_gripper"}) {
    const std::size_t at = bytes.find('\0' + column + '\0');
    ASSERT_NE(at, std::string::npos) << column;
    bytes[at + column.size()] = 'x';
  }
  std::ofstream(path, std::ios::binary) << bytes;
  const auto read = session::read_recording(path);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->ticks.size(), 10U);
  EXPECT_EQ(read->ticks[3].heat, (std::array<double, 3>{}));
  EXPECT_EQ(read->ticks[3].q_WT, driver::TipQuaternion{});
  EXPECT_EQ(read->ticks[3].gripper, 0);
  EXPECT_FALSE(read->ticks[3].has_gripper);
  EXPECT_EQ(read->ticks[3].p_WT, tick_number(3).p_WT);
}

TEST(Recording, IsAsShortAsTheRunWas) {
  for (const std::uint64_t ticks : {0U, 1U, 999U}) {
    const auto path = scratch("short.h5");
    auto recorder = session::Recorder::open(path, kInfo, 1'000'000, true);
    ASSERT_TRUE(recorder);
    for (std::uint64_t i = 0; i < ticks; ++i) (**recorder)(tick_number(i));
    ASSERT_TRUE((*recorder)->finish());
    const auto read = session::read_recording(path);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE(read->complete);
    ASSERT_EQ(read->ticks.size(), ticks);
    if (ticks > 0) {
      EXPECT_TRUE(same(read->ticks.back(), tick_number(ticks - 1)));
    }
    EXPECT_LT(std::filesystem::file_size(path), 64'000 + ticks * 300);
    EXPECT_FALSE(std::filesystem::exists(scratch("short.thimble-part.h5")));
  }
}

// A recording with room for 10 hours, killed by SIGKILL at any time, can be opened and lacks less
// than 100 ms.
TEST(Recording, KilledRunLosesLessThan100ms) {
  for (const int ticks : {400, 437, 5'500}) {
    const auto path = scratch("killed.h5");
    int pipe_ends[2];
    ASSERT_EQ(pipe(pipe_ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      auto recorder = session::Recorder::open(path, kInfo, 36'000'000, true);
      if (!recorder) _exit(1);
      (*recorder)->start_thread();
      for (std::uint64_t i = 0;; ++i) {
        const auto now = std::chrono::steady_clock::now().time_since_epoch();
        TickRecord tick = tick_number(i);
        tick.time_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
        (**recorder)(tick);
        if (write(pipe_ends[1], &tick.time_ns, sizeof tick.time_ns) < 0) _exit(1);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
    close(pipe_ends[1]);
    std::int64_t last = 0;
    // The child reports each recorded tick; it is killed at an arbitrary time.
    for (int i = 0; i < ticks; ++i) {
      ASSERT_EQ(read(pipe_ends[0], &last, sizeof last), static_cast<ssize_t>(sizeof last));
    }
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    for (std::int64_t told = 0; read(pipe_ends[0], &told, sizeof told) == sizeof told;) last = told;
    close(pipe_ends[0]);

    const auto read = session::read_recording(path);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_FALSE(read->complete);
    ASSERT_GT(read->ticks.size(), 0U);
    for (std::uint64_t i = 0; i < read->ticks.size(); ++i) {
      ASSERT_EQ(read->ticks[i].p_WT, tick_number(i).p_WT) << i;
    }
    RecordProperty("ms_lost", static_cast<int>((last - read->ticks.back().time_ns) / 1'000'000));
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    constexpr std::int64_t kLost_ns = 300'000'000;  // less than the shortest run
#else
    constexpr std::int64_t kLost_ns = 100'000'000;
#endif
    EXPECT_LT(last - read->ticks.back().time_ns, kLost_ns) << ticks;
  }
}

TEST(Recording, FullDiskEndsRecordingAndKeepsTicks) {
  const auto path = scratch("full.h5");
  const pid_t child = fork();
  if (child == 0) {
    auto recorder = session::Recorder::open(path, kInfo, 100'000);
    if (!recorder) _exit(2);
    for (std::uint64_t i = 0; i < 1000; ++i) (**recorder)(tick_number(i));
    (*recorder)->serve();
    // From here on the system rejects writes beyond the first bytes of the file, as on a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit none{1, 1};
    if (setrlimit(RLIMIT_FSIZE, &none) != 0) _exit(3);
    for (std::uint64_t i = 1000; i < 20'000; ++i) {
      (**recorder)(tick_number(i));
      if (i % 100 == 0) (*recorder)->serve();  // the ring has room, whatever the disk reports
    }
    if ((*recorder)->dropped() != 0) _exit(4);
    const auto finished = (*recorder)->finish();
    if (finished) _exit(5);
    const bool told = finished.error().message.find("after 1000 ticks") != std::string::npos;
    _exit(told ? 0 : 6);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const auto read = session::read_recording(path);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->ticks.size(), 1000U);
  EXPECT_FALSE(read->complete);
  EXPECT_TRUE(same(read->ticks.back(), tick_number(999)));
  EXPECT_FALSE(std::filesystem::exists(scratch("full.thimble-part.h5")));
}

TEST(Recording, BeyondItsMaximumDurationIsIncomplete) {
  const auto path = scratch("longest.h5");
  auto recorder = session::Recorder::open(path, kInfo, 100);
  ASSERT_TRUE(recorder);
  for (std::uint64_t i = 0; i < 150; ++i) (**recorder)(tick_number(i));
  const auto finished = (*recorder)->finish();
  ASSERT_FALSE(finished);
  EXPECT_NE(finished.error().message.find("full after 100 ticks"), std::string::npos)
      << finished.error().message;
  const auto read = session::read_recording(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->ticks.size(), 100U);
  EXPECT_FALSE(read->complete);
}

// A child that is forked while another thread holds a sanitizer's allocator hangs with GCC 12; LLVM
// locks its allocators at a fork since pull requests 75290 and 96600, as glibc always does.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kForksBesideThreads = false;
#else
constexpr bool kForksBesideThreads = true;
#endif

// The initial capacity is small, so that the file grows many times.
TEST(Recording, GrowsAsItIsWritten) {
  const auto path = scratch("grows.h5");
  constexpr std::uint64_t kTicks = 5000;
  {
    auto file = session::RecordingFile::create(path, kInfo, {.rows_max = 1'000'000, .room = 16});
    ASSERT_TRUE(file) << file.error().message;
    std::vector<TickRecord> ticks;
    for (std::uint64_t i = 0; i < kTicks; ++i) {
      ticks.push_back(tick_number(i));
      if (ticks.size() < 1 + i % 23) continue;
      const auto appended = file->append(ticks);
      ASSERT_TRUE(appended) << appended.error().message;
      ticks.clear();
      // The file can be read at any time, also while a thread creates the larger one.
      if (kForksBesideThreads && i % 1000 > 976) {
        const auto now = session::read_recording(path);
        ASSERT_TRUE(now) << now.error().message;
        EXPECT_EQ(now->ticks.size(), i + 1);
        EXPECT_FALSE(now->complete);
      }
    }
    ASSERT_TRUE(file->append(ticks));
    ASSERT_TRUE(file->finish(true));
  }
  const auto read = session::read_recording(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->complete);
  ASSERT_EQ(read->ticks.size(), kTicks);
  for (std::uint64_t i = 0; i < kTicks; ++i) ASSERT_TRUE(same(read->ticks[i], tick_number(i))) << i;
}

// Recordings are read by a child of this process, which must not wait for a lock of another thread.
TEST(Recording, IsReadWhileAnotherThreadMakesOne) {
  if (!kForksBesideThreads) GTEST_SKIP() << "a sanitizer's allocator may stay locked in a child";
  const auto path = scratch("read.h5");
  ASSERT_TRUE(session::write_recording(path, kInfo, {}));
  std::atomic<bool> stop{false};
  std::thread maker([&] {
    while (!stop.load()) {
      EXPECT_TRUE(session::RecordingFile::create(scratch("made.h5"), kInfo, {}, true));
    }
  });
  int refused = 0;
  for (int i = 0; i < 30; ++i) refused += session::read_recording(path) ? 0 : 1;
  stop.store(true);
  maker.join();
  EXPECT_EQ(refused, 0);
}

// A file system without sparse files (FAT) has no space for a whole day at once.
TEST(Recording, WholeDayStartsWithASmallFile) {
  const auto path = scratch("day.h5");
  const auto recorder = session::Recorder::open(path, kInfo, 86'400'000);
  ASSERT_TRUE(recorder) << recorder.error().message;
  EXPECT_LT(std::filesystem::file_size(path), 100'000'000U);
}

TEST(Recording, EndsWhereTheFileCannotGrow) {
  const auto path = scratch("cannot_grow.h5");
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    auto file = session::RecordingFile::create(path, kInfo, {.rows_max = 1'000'000, .room = 100});
    if (!file) _exit(1);
    rlimit full{};
    if (getrlimit(RLIMIT_FSIZE, &full) != 0) _exit(2);
    full.rlim_cur = std::filesystem::file_size(path);
    if (setrlimit(RLIMIT_FSIZE, &full) != 0) _exit(2);
    std::vector<TickRecord> ticks;
    for (std::uint64_t i = 0; i < 150; ++i) ticks.push_back(tick_number(i));
    const auto appended = file->append(ticks);
    if (appended) _exit(3);
    if (appended.error().message.find("after 100 ticks") == std::string::npos) _exit(4);
    _exit(file->finish(false) ? 0 : 5);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const auto read = session::read_recording(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->ticks.size(), 100U);
  EXPECT_FALSE(read->complete);
  EXPECT_FALSE(std::filesystem::exists(scratch("cannot_grow.thimble-part.h5")));
}

TEST(Recording, IsReadableByItsOwnerOnly) {
  const auto path = scratch("private.h5");
  const mode_t before = umask(0);
  auto recorder = session::Recorder::open(path, kInfo, 100);
  const auto mode = std::filesystem::status(path).permissions();
  ASSERT_TRUE(recorder && (*recorder)->finish());
  umask(before);
  EXPECT_EQ(mode, std::filesystem::perms(0600));
  EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms(0600));
}

TEST(Recording, SecondWriterIsRefused) {
  const auto path = scratch("twice.h5");
  const auto first = session::Recorder::open(path, kInfo, 100);
  ASSERT_TRUE(first);
  for (const bool replace : {false, true}) {
    const auto second = session::Recorder::open(path, kInfo, 100, replace);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("being written"), std::string::npos)
        << second.error().message;
  }
}

TEST(Recording, CanBeReadWhileItIsWritten) {
  const auto path = scratch("read_along.h5");
  const auto recorder = session::Recorder::open(path, kInfo, 100);
  ASSERT_TRUE(recorder);
  (**recorder)(tick_number(0));
  (*recorder)->serve();
  const auto read = session::read_recording(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->ticks.size(), 1U);
}

// HDF5 locks files by flock unless this is switched off; other programs hold such locks.
TEST(Recording, CanBeReadWhileAnotherProgramLocksIt) {
  const auto path = scratch("locked.h5");
  ASSERT_TRUE(session::write_recording(path, kInfo, std::vector{tick_number(0)}));
  const int other = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(other, LOCK_EX | LOCK_NB), 0);
  const auto read = session::read_recording(path);
  ::close(other);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->ticks.size(), 1U);
}

TEST(Recording, DeviceIsNoRecording) {
  EXPECT_FALSE(session::kRecordingOutput.matches("/dev/null"));
}

TEST(Recording, SymbolicLinkStays) {
  const auto link = scratch("link.h5");
  std::filesystem::create_symlink("behind_link.h5", link);
  auto recorder = session::Recorder::open(link, kInfo, 100);
  ASSERT_TRUE(recorder && (*recorder)->finish());
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_TRUE(session::read_recording(scratch("behind_link.h5")));
}

TEST(Recording, Hdf5FileOfAnotherProgramIsKept) {
  const auto path = scratch("other_program.h5");
  session::silence_hdf5();
  {
    const session::H5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                                 H5Fclose);
    ASSERT_TRUE(file.good());
  }
  const auto size = std::filesystem::file_size(path);
  const auto refused = session::Recorder::open(path, kInfo, 10, true);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("not a recording"), std::string::npos)
      << refused.error().message;
  EXPECT_EQ(std::filesystem::file_size(path), size);
}

TEST(Recording, CountsDroppedTicksAndNeverWaits) {
  auto recorder = session::Recorder::open(scratch("slow.h5"), kInfo, 100'000);
  ASSERT_TRUE(recorder);
  for (std::uint64_t i = 0; i < session::Recorder::kRingTicks + 10; ++i)
    (**recorder)(tick_number(i));
  EXPECT_EQ((*recorder)->dropped(), 10U);
  const auto finished = (*recorder)->finish();
  ASSERT_FALSE(finished);
  EXPECT_NE(finished.error().message.find("10 ticks"), std::string::npos);
  EXPECT_FALSE(session::read_recording(scratch("slow.h5"))->complete);
}

TEST(Recording, UnwritableRecordingReportsThePath) {
  const auto refused = session::Recorder::open("/proc/no/such/place.h5", kInfo, 10);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("/proc/no/such/place.h5"), std::string::npos);
}

TEST(Recording, FileOfAnotherKindIsKept) {
  const auto scene = scratch("precious.yaml");
  std::ofstream(scene) << "name: precious\n";
  for (const bool replace : {false, true}) {
    const auto refused = session::Recorder::open(scene, kInfo, 10, replace);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("precious.yaml cannot be written: the existing file is "
                                           "not a recording"),
              std::string::npos)
        << refused.error().message;
  }
  std::string kept;
  std::getline(std::ifstream(scene), kept);
  EXPECT_EQ(kept, "name: precious");
}

TEST(Recording, IsReplacedOnlyIfThatIsAllowed) {
  const auto again = scratch("again.h5");
  std::ofstream(again).flush();  // an empty file contains nothing to lose
  EXPECT_TRUE(session::Recorder::open(again, kInfo, 10));
  const auto refused = session::Recorder::open(again, kInfo, 10);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--force"), std::string::npos) << refused.error().message;
  EXPECT_TRUE(session::Recorder::open(again, kInfo, 10, true));
}

TEST(Recording, NamesContainNoControlCharacters) {
  const auto path = scratch("escapes.h5");
  session::RecordingInfo info = kInfo;
  info.scene = "red \x1b[31m bell \a wide \302\23331m \303\244";
  info.scene_text = "\tname: kept\n";
  {
    const auto recorder = session::Recorder::open(path, info, 10);
    ASSERT_TRUE(recorder);
  }
  const auto read = session::read_recording(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->info.scene, "red ?[31m bell ? wide ?31m \303\244");
  EXPECT_EQ(read->info.scene_text, info.scene_text);
}

TEST(Recording, RejectsFilesOfOtherKinds) {
  EXPECT_NE(session::read_recording(scratch("none.h5")).error().message.find("no such file"),
            std::string::npos);
  std::ofstream(scratch("text.h5")) << "not a recording";
  EXPECT_NE(session::read_recording(scratch("text.h5")).error().message.find("not a recording"),
            std::string::npos);
}

// A recording with any damaged byte is read or rejected with an error.
TEST(Recording, WithAnyByteDamagedIsReadOrRefused) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "no threads meet here, and damaged files ask for more memory than it can give";
#endif
  const auto path = scratch("damaged.h5");
  const auto bytes_of = [&](std::uint64_t first) {
    auto recorder = session::Recorder::open(path, kInfo, 4, true);
    EXPECT_TRUE(recorder);
    for (std::uint64_t i = 0; i < 4; ++i) (**recorder)(tick_number(first + i));
    EXPECT_TRUE((*recorder)->finish());
    std::ifstream in(path, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(in)), {});
  };
  const std::string good = bytes_of(0);
  std::mt19937 random(static_cast<std::uint32_t>(support::seed_of(5)));
  int refused = 0;
  const int rounds = support::long_form() ? 20'000 : 300;
  for (int round = 0; round < rounds; ++round) {
    std::string bad = good;
    bad[random() % good.size()] = static_cast<char>(random());
    std::ofstream(path, std::ios::binary) << bad;
    const auto read = session::read_recording(path);
    if (!read) {
      ++refused;
      EXPECT_FALSE(read.error().message.empty());
    } else {
      EXPECT_LE(read->ticks.size(), 4U);
    }
  }
  // A damaged number is read, and an invalid tick is omitted; only a damaged table is an error.
  EXPECT_GT(refused, 0);
}

TEST(Recording, CutShortAnywhereIsReadOrRefused) {
  const auto path = scratch("cut.h5");
  auto recorder = session::Recorder::open(path, kInfo, 100);
  ASSERT_TRUE(recorder);
  for (std::uint64_t i = 0; i < 100; ++i) (**recorder)(tick_number(i));
  ASSERT_TRUE((*recorder)->finish());
  for (auto size = std::filesystem::file_size(path); size > 0;
       size -= std::min<std::uintmax_t>(size, 511)) {
    std::filesystem::resize_file(path, size);
    const auto read = session::read_recording(path);
    if (read) {
      EXPECT_LE(read->ticks.size(), 100U);
    }
  }
}

TEST(Csv, NumbersAreBitIdentical) {
  session::Recording recording;
  recording.info = kInfo;
  TickRecord tick = tick_number(7);
  tick.p_WT = {1.0 / 3, -std::numbers::pi * 1e-9, std::numeric_limits<double>::denorm_min()};
  recording.ticks = {tick_number(6), tick};
  const auto path = scratch("table.csv");
  ASSERT_TRUE(session::write_csv(recording, path));
  std::ifstream in(path);
  std::string heading, row;
  std::getline(in, heading);
  std::getline(in, row);
  std::getline(in, row);
  std::size_t columns = 0;
  for (const session::RecordingColumn& column : session::recording_columns())
    columns += column.width;
  std::vector<std::string> names, cells;
  for (auto* into : {&names, &cells}) {
    std::istringstream line(into == &names ? heading : row);
    for (std::string cell; std::getline(line, cell, ',');) into->push_back(cell);
  }
  ASSERT_EQ(names.size(), columns);
  ASSERT_EQ(cells.size(), columns);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto name = std::string("p_WT.") + "xyz"[k] + " [m]";
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    EXPECT_EQ(std::strtod(cells[static_cast<std::size_t>(at)].c_str(), nullptr), tick.p_WT[k]);
  }
  EXPECT_EQ(names.front(), "tick");
  EXPECT_EQ(cells.front(), "7");
}

TEST(BlackBox, KeepsTheSecondsBeforeAFaultUntilReleased) {
  session::BlackBox box(1000);
  TickRecord tick;
  const auto run = [&](int ticks, driver::Fault fault) {
    for (int i = 0; i < ticks; ++i) {
      tick.fault = fault;
      box.take(tick);
      ++tick.tick;
    }
  };
  run(20'000, driver::Fault::kNone);
  EXPECT_FALSE(box.full());
  EXPECT_TRUE(box.release().empty());
  run(30'000, driver::Fault::kOverSpeed);  // nothing is overwritten long after the fault
  ASSERT_TRUE(box.full());
  const auto kept = box.release();
  ASSERT_EQ(kept.size(), 8500U);
  EXPECT_EQ(kept.front().tick, 20'000 + 501 - 8500U);
  EXPECT_EQ(kept.back().tick, 20'500U);
  EXPECT_EQ(kept[kept.size() - 502].fault, driver::Fault::kNone);
  EXPECT_EQ(kept[kept.size() - 501].fault, driver::Fault::kOverSpeed);
  run(1000, driver::Fault::kOverSpeed);  // the same fault is not reported twice
  EXPECT_FALSE(box.full());
  run(1000, driver::Fault::kNone);
  run(10, driver::Fault::kNoReports);  // the run ends soon after a second fault
  EXPECT_FALSE(box.full());
  const auto second = box.release();
  EXPECT_EQ(second.size(), 2010U);
  EXPECT_EQ(second.back().fault, driver::Fault::kNoReports);
}

TEST(Recording, DoesNotAllocatePerTick) {
  auto recorder = session::Recorder::open(scratch("quiet.h5"), kInfo, 1000);
  ASSERT_TRUE(recorder);
  session::BlackBox box(1000);
  const TickRecord tick = tick_number(1);
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int i = 0; i < 1000; ++i) {
                (**recorder)(tick);
                box.take(tick);
              }
            }),
            0);
}

}  // namespace
}  // namespace thimble::session
