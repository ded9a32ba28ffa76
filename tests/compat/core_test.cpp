// The core of all compatibility libraries: requested forces reach the motors through the gate.
#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <utility>

#include "byte_lock.h"
#include "compat/exec_rig.h"
#include "compat/server/foreign_libraries.h"
#include "compat/server/read_hand_path.h"
#include "support/scratch.h"

namespace thimble::compat {
namespace {

using Eigen::Vector3d;

constexpr double kQuantum = 0.005;  // N: a milliampere of each motor at the tip

Vector3d vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// Requests a force in each of `ticks` ticks.
void hold(int arm, const std::array<double, 3>& f_W, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    arms::ask_force(arm, {.f_W = f_W});
    arms::wait_until_taken(arm);
  }
}

TEST(CompatCore, MotorsGetTheRequestedForce) {
  ExecRig rig(in_step());
  ASSERT_EQ(arms::open(0, "test"), "");
  arms::enable_force(0, true);
  const Vector3d asked(0.2, -0.15, 0.1);
  hold(0, {asked.x(), asked.y(), asked.z()}, 600);
  EXPECT_LT((rig.motors.force_W() - asked).norm(), kQuantum) << rig.motors.force_W().transpose();
  ArmReading reading;
  ASSERT_TRUE(arms::read(0, reading));
  EXPECT_EQ(vector(reading.f_client_W), asked);
  EXPECT_TRUE(arms::close(0));
}

TEST(CompatCore, ForceIsZeroUntilEnabledAndThenRisesSlowly) {
  ExecRig rig(in_step());
  ASSERT_EQ(arms::open(0, "test"), "");
  hold(0, {0.3, 0, 0}, 400);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
  arms::enable_force(0, true);
  hold(0, {0.3, 0, 0}, 60);
  EXPECT_LT(rig.motors.force_W().norm(), 0.15);
  hold(0, {0.3, 0, 0}, 400);
  EXPECT_NEAR(rig.motors.force_W().x(), 0.3, kQuantum);
  arms::enable_force(0, false);
  hold(0, {0.3, 0, 0}, 10);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
}

TEST(CompatCore, LimitsTheForceAndReportsIt) {
  ExecRig rig(in_step());
  ASSERT_EQ(arms::open(0, "test"), "");
  arms::enable_force(0, true);
  ArmReading reading;
  bool limited = false;
  double max_force = 0;
  for (int i = 0; i < 500; ++i) {
    arms::ask_force(0, {.f_W = {0, 0, 50}});
    arms::wait_until_taken(0);
    arms::read(0, reading);
    limited = limited || reading.cuts.limited;
    max_force = std::max(max_force, vector(reading.f_sent_W).norm());
  }
  EXPECT_TRUE(limited || reading.fault != driver::Fault::kNone);
  EXPECT_LE(max_force, arms::facts(0).force_max * (1 + 1e-9));
  EXPECT_GT(max_force, 0);
}

TEST(CompatCore, ForceWithoutRenewalBecomesZeroAndReturnsSlowly) {
  ExecRig rig;
  ASSERT_EQ(arms::open(0, "test"), "");
  arms::enable_force(0, true);
  hold(0, {0.3, 0, 0}, 500);
  ASSERT_GT(rig.motors.force_W().x(), 0.25);
  // On a busy machine a check may come too late, so one successful check is enough.
  bool slowly = false;
  for (int look = 0; look < 20 && !slowly; ++look) {
    rig.wait(0, 40);  // twice the gate's stall
    ArmReading reading;
    arms::read(0, reading);
    EXPECT_TRUE(reading.stalled);
    EXPECT_EQ(rig.motors.force_W().norm(), 0);
    hold(0, {0.3, 0, 0}, 10);
    slowly = rig.motors.force_W().x() < 0.15;
  }
  EXPECT_TRUE(slowly) << "within 40 ms, not at once";
  hold(0, {0.3, 0, 0}, 500);
  EXPECT_NEAR(rig.motors.force_W().x(), 0.3, kQuantum);
  EXPECT_NE(rig.end().find("test did not renew its force"), std::string::npos);
}

TEST(CompatCore, NaNForceLatchesUntilForceIsEnabledAgain) {
  ExecRig rig(in_step());
  ASSERT_EQ(arms::open(0, "test"), "");
  arms::enable_force(0, true);
  hold(0, {0.2, 0, 0}, 400);
  hold(0, {std::nan(""), 0, 0}, 3);
  hold(0, {0.2, 0, 0}, 400);
  ArmReading reading;
  arms::read(0, reading);
  EXPECT_EQ(reading.fault, driver::Fault::kForceNotFinite);
  EXPECT_EQ(rig.motors.force_W().norm(), 0);
  arms::enable_force(0, true);
  hold(0, {0.2, 0, 0}, 700);
  arms::read(0, reading);
  EXPECT_EQ(reading.fault, driver::Fault::kNone);
  EXPECT_NEAR(rig.motors.force_W().x(), 0.2, kQuantum);
}

TEST(CompatCore, PacesALoopByItsTicks) {
  ExecRig rig;
  ASSERT_EQ(arms::open(0, "test"), "");
  const auto begin = std::chrono::steady_clock::now();
  hold(0, {0, 0, 0}, 300);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(took.count(), 0.29);
}

TEST(CompatCore, TwoArmsAreIndependent) {
  ExecOptions options = in_step();
  options.arms = {{.arm_file = "vintage_phantom"}, {.arm_file = "polhem"}};
  ExecRig rig(options);
  ASSERT_EQ(arms::count(), 2);
  ASSERT_EQ(arms::open(0, "test"), "");
  ASSERT_EQ(arms::open(1, "test"), "");
  EXPECT_STREQ(arms::facts(0).name.data(), "vintage_phantom");
  EXPECT_STREQ(arms::facts(1).name.data(), "polhem");
  EXPECT_FALSE(arms::facts(0).has_orientation);
  EXPECT_TRUE(arms::facts(1).has_orientation);
  arms::enable_force(0, true);
  arms::enable_force(1, true);
  for (int i = 0; i < 450; ++i) {
    arms::ask_force(0, {.f_W = {0.2, 0, 0}});
    arms::ask_force(1, {.f_W = {0, 0.1, 0}});
    arms::wait_until_taken(0);
    arms::wait_until_taken(1);
  }
  ArmReading one, two;
  arms::read(0, one);
  arms::read(1, two);
  EXPECT_NEAR(one.f_sent_W[0], 0.2, kQuantum);
  EXPECT_NEAR(two.f_sent_W[1], 0.1, kQuantum);
  EXPECT_NEAR(two.f_sent_W[0], 0, kQuantum);
}

TEST(CompatCore, ReopenedArmStartsWithoutForce) {
  ExecRig rig(in_step());
  for (int again = 0; again < 3; ++again) {
    ASSERT_EQ(arms::open(0, "test"), "");
    arms::enable_force(0, true);
    ExecRig::wait(0, 5);
    ArmReading reading;
    arms::read(0, reading);
    EXPECT_EQ(vector(reading.f_client_W).norm(), 0);
    hold(0, {0.1, 0, 0}, 20);
    EXPECT_TRUE(arms::close(0));
    EXPECT_FALSE(arms::close(0));
  }
}

TEST(CompatCore, ReadsAHandPathAndNamesWrongLines) {
  const std::string file = support::scratch_folder() / "hand_path.txt";
  const auto read = [&](const char* text) {
    std::ofstream(file) << text;
    return read_hand_path(file);
  };
  const auto good = read("# t x y z\n0 0.01 0 -0.02\n\n1.5, 0.02; 0 0 # to the user\n");
  ASSERT_TRUE(good) << good.error().message;
  ASSERT_EQ(good->path.size(), 2u);
  EXPECT_EQ(good->path[1].time, 1.5);
  EXPECT_EQ(good->path[0].p_W, Vector3d(0.01, 0, -0.02));
  EXPECT_TRUE(good->buttons.empty());
  for (const char* bad :
       {"0 0 0 0\n0 0 0 0", "0 0 0 0\n1 0 0", "0 0 0 0\n1 0 0 0 0 0", "0 0 0 0\n1 0 0 0 1.5",
        "0 0 0 0\n1 0 0 0 -1", "0 0 0 0\n1 0 0 0 65536", "0 0 0 0\n1 0 0 0 a", "0 0 0 0\n1 0 0 nan",
        "0 0 0 0\n1 0 0 3", "0 0 0 0\n-1 0 0 0"}) {
    const auto refused = read(bad);
    ASSERT_FALSE(refused) << bad;
    EXPECT_NE(refused.error().message.find("hand_path.txt:2: expected"), std::string::npos);
  }
  EXPECT_FALSE(read("# nothing\n"));
  EXPECT_FALSE(read_hand_path("/nonexistent/path"));
}

TEST(CompatCore, HandFileHasButtonsInTheFifthColumn) {
  const std::string file = support::scratch_folder() / "hand_buttons.txt";
  std::ofstream(file) << "0 0 0 0\n0.1 0 0 0 3\n0.2 0 0 0\n0.3 0 0 0 2\n";
  const auto hand = read_hand_path(file);
  ASSERT_TRUE(hand) << hand.error().message;
  scene::ButtonPlan plan(hand->buttons);
  for (const auto& [time, buttons] :
       {std::pair(0.05, 0), {0.1, 3}, {0.15, 3}, {0.2, 0}, {0.35, 2}, {99.0, 2}}) {
    EXPECT_EQ(plan.at(time), buttons) << time;
  }
}

TEST(CompatCore, ProgramSeesPressesOfSimulatedButtons) {
  ExecOptions options = in_step();
  options.presses = {{.begin = 0.05, .duration = 0.02, .buttons = 1},
                     {.begin = 0.06, .duration = 0.03, .buttons = 4}};
  ExecRig rig(options);
  ASSERT_EQ(arms::open(0, "test"), "");
  ArmReading reading;
  arms::read(0, reading);
  const std::int64_t begin_ns = reading.time_ns;
  int seen[5] = {};
  for (int tick = 0; tick < 120; ++tick) {
    ExecRig::wait(0, 1);
    arms::read(0, reading);
    ASSERT_LE(reading.buttons, 5);
    ASSERT_GE(reading.time_ns, begin_ns);
    ++seen[reading.buttons == 5 ? 2 : reading.buttons];
  }
  EXPECT_EQ(seen[1], 10) << "only the first: 50 to 60 ms";
  EXPECT_EQ(seen[2], 10) << "both: 60 to 70 ms";
  EXPECT_EQ(seen[4], 20) << "only the third: 70 to 90 ms";
}

TEST(CompatCore, RefusesUnknownAndClosedArms) {
  ExecRig rig;
  ArmReading reading;
  for (const int arm : {-1, 0, 1, kArmsMax, 1'000'000}) {
    EXPECT_FALSE(arms::read(arm, reading));
    EXPECT_FALSE(arms::ask_force(arm, {}));
    EXPECT_FALSE(arms::wait_until_taken(arm));
    EXPECT_FALSE(arms::wait_for_tick(arm, 0));
    EXPECT_FALSE(arms::enable_force(arm, true));
    EXPECT_FALSE(arms::force_enabled(arm));
    EXPECT_FALSE(arms::is_open(arm));
    EXPECT_FALSE(arms::is_running(arm));
    EXPECT_FALSE(arms::close(arm));
  }
  EXPECT_NE(arms::open(1, "test"), "");
  EXPECT_NE(arms::open(-1, "test"), "");
}

TEST(CompatCore, WaitsEndWithTheRun) {
  ExecRig rig;
  ASSERT_EQ(arms::open(0, "test"), "");
  std::atomic<int> turns{0};
  std::atomic<bool> enough{false};
  std::thread program([&] {
    while (!enough.load()) {
      arms::ask_force(0, {});
      arms::wait_until_taken(0);
      ++turns;
    }
  });
  ExecRig::wait(0, 20);
  rig.end();
  const int before = turns.load();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const int after = turns.load();
  enough.store(true);
  program.join();
  EXPECT_GT(after, before) << "it hangs";
  EXPECT_LT(after - before, 400) << "it spins";
  EXPECT_FALSE(arms::is_running(0));
  EXPECT_TRUE(arms::close(0));
  use_channel(nullptr);
  EXPECT_EQ(arms::count(), 0);
}

/// Another program of the same `thimble exec`, in a separate process.
class OtherProgram {
 public:
  /// Starts the process. `work` begins when `go` is called; its return value is the exit code.
  template <class Work>
  OtherProgram(ExecRig& rig, Work work) {
    if (pipe(go_) != 0 || pipe(done_) != 0) throw std::runtime_error("no pipe");
    process_ = fork();
    if (process_ != 0) return;
    close(go_[1]);
    char byte = 0;
    if (read(go_[0], &byte, 1) != 1) _exit(90);
    use_channel(&rig.channel(), rig.address());
    const int result = work();
    if (write(done_[1], "d", 1) != 1) _exit(91);
    // It keeps its locks until it is killed, or the test ends.
    if (result == kStays) static_cast<void>(read(go_[0], &byte, 1));
    _exit(result);
  }
  ~OtherProgram() {
    close(go_[1]);
    if (process_ > 0) waitpid(process_, nullptr, 0);
  }
  OtherProgram(const OtherProgram&) = delete;
  OtherProgram& operator=(const OtherProgram&) = delete;

  static constexpr int kStays = 80;

  /// Runs `work`, and waits for its end.
  void go() {
    char byte = 'g';
    EXPECT_EQ(write(go_[1], &byte, 1), 1);
    EXPECT_EQ(read(done_[0], &byte, 1), 1);
  }
  int end() {
    close(go_[1]);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void kill_it() {
    kill(process_, SIGKILL);
    end();
  }

 private:
  int go_[2] = {-1, -1}, done_[2] = {-1, -1};
  pid_t process_ = 0;
};

int refused_to_other() {
  return arms::open(0, "other").find("Another program") != std::string::npos ? 0 : 1;
}

TEST(CompatCore, SecondProgramIsRefused) {
  ExecRig rig;
  OtherProgram other(rig, refused_to_other);
  ASSERT_EQ(arms::open(0, "test"), "");
  other.go();
  EXPECT_EQ(other.end(), 0);
}

TEST(CompatCore, ArmIsTakenOnlyForOtherPrograms) {
  ExecRig rig;
  OtherProgram other(rig, [] { return arms::is_taken(0) ? 0 : 1; });
  EXPECT_FALSE(arms::is_taken(0));
  ASSERT_EQ(arms::open(0, "test"), "");
  EXPECT_FALSE(arms::is_taken(0));
  other.go();
  EXPECT_EQ(other.end(), 0);
}

TEST(CompatCore, OneLibraryOfAProcessListsTheArms) {
  ExecRig rig;
  OtherProgram other(rig, [] { return arms::listed("hdPhantom") == 1 ? 0 : 1; });
  EXPECT_EQ(arms::listed("DHD"), 1);
  EXPECT_EQ(arms::listed("hdPhantom"), 0);
  EXPECT_EQ(arms::listed("HDAPI"), 0);
  EXPECT_EQ(arms::listed("DHD"), 1);
  other.go();
  EXPECT_EQ(other.end(), 0) << "another process has its own list";
}

TEST(CompatCore, BothInterfacesOfALibraryListTheArms) {
  ExecRig rig;
  ASSERT_EQ(arms::open(0, "DRD"), "");
  EXPECT_EQ(arms::listed("DHD"), 1);
  EXPECT_EQ(arms::listed("HDAPI"), 0);
}

TEST(CompatCore, FindsVendorsLibrariesOfOtherFolders) {
  const std::filesystem::path folder = support::scratch_folder();
  const std::filesystem::path library = folder / "libdrd.so.3.17";
  std::filesystem::copy_file(THIMBLE_A_LIBRARY, library,
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_TRUE(foreign_libraries(getpid(), folder).empty());
  void* const loaded = dlopen(library.c_str(), RTLD_NOW);
  ASSERT_NE(loaded, nullptr) << dlerror();
  const std::set<std::string> found = foreign_libraries(getpid(), "/nonexistent");
  EXPECT_EQ(found, std::set<std::string>{std::filesystem::canonical(library).string()});
  EXPECT_TRUE(foreign_libraries(getpid(), folder).empty()) << "the folder of our own libraries";
  EXPECT_TRUE(foreign_libraries(-1, folder).empty());
  const pid_t child = fork();
  if (child == 0) _exit(foreign_libraries(getppid(), "/nonexistent").empty() ? 1 : 0);
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  dlclose(loaded);
}

TEST(CompatCore, LibraryThatOpensAnArmListsTheArms) {
  ExecRig rig;
  ASSERT_EQ(arms::open(0, "HDAPI"), "");
  EXPECT_EQ(arms::listed("hdPhantom"), 0);
  EXPECT_EQ(arms::listed("HDAPI"), 1);
}

TEST(CompatCore, ArmsAreListedToMoreProcessesThanEntries) {
  ExecRig rig;
  for (std::atomic<std::uint64_t>& entry : rig.channel().listings) entry.store(0x100);
  EXPECT_EQ(arms::listed("DHD"), 1);
  EXPECT_EQ(arms::listed("hdPhantom"), 1);
}

TEST(CompatCore, SecondProgramChangesNoLimit) {
  ExecRig rig;
  OtherProgram other(rig, refused_to_other);
  ASSERT_EQ(arms::open(0, "test"), "");
  arms::enable_force(0, true);
  arms::set_force_limit(0, 0.5);
  arms::set_speed_limit(0, 0.1);
  arms::set_watchdog(0, 2'000'000);
  other.go();
  const ArmChannel& arm = rig.channel().arms[0];
  EXPECT_TRUE(arms::force_enabled(0));
  EXPECT_EQ(arm.force_limit.load(), 0.5);
  EXPECT_EQ(arm.speed_limit.load(), 0.1);
  EXPECT_EQ(arm.watchdog_ns.load(), 2'000'000);
  EXPECT_STREQ(arm.api.data(), "test");
}

TEST(CompatCore, ArmStaysOpenWhenRefusedProgramEnds) {
  ExecRig rig;
  OtherProgram other(rig, refused_to_other);
  ASSERT_EQ(arms::open(0, "test"), "");
  other.go();
  ASSERT_EQ(other.end(), 0);
  ExecRig::wait(0, 300);  // many checks by the server
  EXPECT_TRUE(arms::is_running(0));
}

TEST(CompatCore, ArmOfKilledProgramIsFree) {
  ExecRig rig;
  OtherProgram other(rig, [] { return arms::open(0, "other").empty() ? OtherProgram::kStays : 1; });
  other.go();
  EXPECT_NE(arms::open(0, "test"), "") << "the other program has it";
  other.kill_it();
  EXPECT_EQ(arms::open(0, "test"), "");
}

TEST(CompatCore, ArmIsFreeAfterProgramDiesDuringRequest) {
  ExecRig rig;
  OtherProgram other(rig, [&] {
    // The state of a program that is killed before the server has answered.
    if (!driver::lock_byte(channel_file(), kFirstOwnerByte)) return 1;
    rig.channel().arms[0].trouble[0] = 'x';
    rig.channel().arms[0].state.store(ChannelState::kFailed);
    return OtherProgram::kStays;
  });
  other.go();
  other.kill_it();
  EXPECT_EQ(arms::open(0, "test"), "");
}

}  // namespace
}  // namespace thimble::compat
