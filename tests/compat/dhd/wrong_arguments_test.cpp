// Each function with each wrong argument, and each function that is not implemented.
#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "compat/dhd/dhd_test.h"
#include "compat/dhd/wrong_calls.h"
#include "support/seed.h"

namespace thimble::compat {
namespace {

TEST_F(CompatDhd, NullPointerIsAnErrorAndIsCounted) {
  begin_and_open({});
  for (const Call& call : calls_with_null()) {
    const std::size_t wrong = fake::wrong_calls().size();
    EXPECT_EQ(call.call(0), -1) << call.name;
    EXPECT_EQ(dhdErrorGetLast(), call.error) << call.name;
    ASSERT_EQ(fake::wrong_calls().size(), wrong + 1) << call.name;
    EXPECT_EQ(fake::wrong_calls().back(), call.name);
  }
}

TEST_F(CompatDhd, NumberOutOfBoundsIsAnErrorAndIsCounted) {
  for (const Call& call : calls_with_bad_numbers()) {
    begin_and_open({});
    EXPECT_EQ(call.call(0), -1) << call.name;
    EXPECT_EQ(dhdErrorGetLast(), call.error) << call.name;
    EXPECT_EQ(fake::wrong_calls().back(), call.name);
    EXPECT_TRUE(fake::f_sent_W(0).isZero(0)) << call.name;
  }
}

TEST_F(CompatDhd, UnknownOrClosedArmIsAnErrorInEachFunction) {
  for (const Call& call : all_calls()) {
    for (const auto& [id, error] : std::map<int, int>{{-1, DHD_ERROR_DEVICE_NOT_READY},
                                                      {0, DHD_ERROR_DEVICE_NOT_READY},
                                                      {3, DHD_ERROR_INVALID_INDEX},
                                                      {4, DHD_ERROR_INVALID_INDEX},
                                                      {127, DHD_ERROR_INVALID_INDEX},
                                                      {-128, DHD_ERROR_INVALID_INDEX},
                                                      {-2, DHD_ERROR_INVALID_INDEX}}) {
      EXPECT_EQ(call.call(static_cast<char>(id)), -1) << call.name << " of " << id;
      EXPECT_EQ(dhdErrorGetLast(), error) << call.name << " of " << id;
    }
  }
  for (const char id : {char(-1), char(0), char(9)}) {
    EXPECT_FALSE(dhdHasBase(id) || dhdHasWrist(id) || dhdHasActiveWrist(id) || dhdHasGripper(id) ||
                 dhdHasActiveGripper(id) || dhdIsLeftHanded(id) || drdIsSupported(id) ||
                 drdIsInitialized(id) || drdIsRunning(id) || drdIsMoving(id) || drdIsFiltering(id));
    EXPECT_EQ(dhdGetSystemName(id), nullptr);
    EXPECT_EQ(dhdGetButtonMask(id), 0u);
  }
}

TEST_F(CompatDhd, FunctionsWithoutAnArmCheckTheirArguments) {
  dhdGetSDKVersion(nullptr, nullptr, nullptr, nullptr);
  int major = 0;
  dhdGetSDKVersion(&major, nullptr, nullptr, nullptr);
  EXPECT_EQ(major, 3);
  EXPECT_EQ(dhdStartThread(nullptr, nullptr, 0), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NULL_ARGUMENT);
  dhdSleep(-1);
  dhdSleep(std::nan(""));
  const double before = dhdGetTime();
  dhdSleep(0.01);
  EXPECT_GE(dhdGetTime() - before, 0.01);
  dhdEnableSimulator(true);
}

TEST_F(CompatDhd, ErrorsArePerThread) {
  EXPECT_EQ(dhdOpenID(9), -1);
  std::thread([] { EXPECT_EQ(dhdErrorGetLast(), DHD_NO_ERROR); }).join();
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_INVALID_INDEX);
}

TEST_F(CompatDhd, StartsAThreadOfTheProgram) {
  static std::atomic<int> seen{0};
  static int value = 7;
  ASSERT_EQ(
      dhdStartThread(
          [](void* argument) -> void* { return seen = *static_cast<int*>(argument), nullptr; },
          &value, 1),
      0);
  for (int i = 0; i < 1000 && seen == 0; ++i) dhdSleep(0.01);
  EXPECT_EQ(seen, 7);
}

TEST_F(CompatDhd, ReadsKeysFromAPipe) {
  // In a child, whose input is a pipe.
  int pipes[2];
  ASSERT_EQ(pipe(pipes), 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(pipes[0], STDIN_FILENO);
    const bool early = dhdKbHit();
    if (write(pipes[1], "q", 1) != 1) _exit(9);
    const bool hit = dhdKbHit();
    const char key = dhdKbGet();
    close(pipes[1]);
    const char end = dhdKbGet();
    _exit(!early && hit && key == 'q' && end == '\0' ? 0 : 1);
  }
  int status = 1;
  close(pipes[1]);
  close(pipes[0]);
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST_F(CompatDhd, OtherFunctionsReturnNotImplemented) {
  std::ifstream file(THIMBLE_SOURCE_DIR "/app/compat/dhd/symbols.txt");
  std::string line;
  bool answered = true;
  int names = 0, refused = 0;
  while (std::getline(file, line)) {
    if (line.starts_with("# Not implemented")) answered = false;
    if (line.empty() || line[0] == '#') continue;
    ++names;
    void* const symbol = dlsym(RTLD_DEFAULT, line.c_str());
    ASSERT_NE(symbol, nullptr) << line;
    if (answered) continue;
    ++refused;
    const std::size_t wrong = fake::wrong_calls().size();
    if (line == "dhdGetMaxTorque" || line == "dhdGetMaxGripperForce") {
      EXPECT_EQ(reinterpret_cast<double (*)()>(symbol)(), -1.0) << line;
    } else {
      EXPECT_EQ(reinterpret_cast<int (*)()>(symbol)(), -1) << line;
    }
    EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NOT_IMPLEMENTED) << line;
    ASSERT_EQ(fake::wrong_calls().size(), wrong + 1);
    EXPECT_EQ(fake::wrong_calls().back(), line);
  }
  EXPECT_EQ(names, 233);
  EXPECT_EQ(refused, 66);
}

// Calls functions in random order with random arguments, from three threads at once. Nothing may
// crash or hang, and no force may exceed the gate's limit. Findings of the sanitizers count, too.
TEST_F(CompatDhd, SurvivesAnyOrderOfCallsFromSeveralThreads) {
  begin({.arms = 3, .held = false});
  const std::vector<Call> calls = all_calls();
  const auto caller = [&](unsigned seed) {
    std::mt19937 random(static_cast<std::uint32_t>(support::seed_of(seed)));
    double p[3] = {0, 0, 0};
    int status[DHD_MAX_STATUS];
    double rows[3][3];
    for (int i = 0; i < 20'000; ++i) {
      const char id = static_cast<char>(static_cast<int>(random() % 5) - 1);
      const double v = 1e-3 * static_cast<double>(random() % 10'000);
      switch (random() % 16) {
        case 0:
          dhdOpenID(id);
          break;
        case 1:
          dhdSetForce(v, -v, 0.1 * v, id);
          break;
        case 2:
          dhdGetPosition(&p[0], &p[1], &p[2], id);
          break;
        case 3:
          dhdGetOrientationFrame(rows, id);
          break;
        case 4:
          dhdGetStatus(status, id);
          break;
        case 5:
          drdMoveToPos(0.01 * v, 0, 0, false, id);
          break;
        case 6:
          drdTrackPos(0, -0.01 * v, 0, id);
          break;
        case 7:
          dhdEnableForce(i % 2 ? DHD_ON : DHD_OFF, id);
          break;
        case 8:
          dhdEnableExpertMode();
          break;
        case 9:
          dhdSetBaseAngleZRad(v, id);
          break;
        default:
          calls[random() % calls.size()].call(id);
          break;
      }
    }
  };
  std::thread first(caller, 1), second(caller, 2);
  caller(3);
  first.join();
  second.join();
  for (int arm = 0; arm < 3; ++arm) EXPECT_LE(fake::f_sent_W(arm).norm(), 5 + 1e-9);
}

}  // namespace
}  // namespace thimble::compat
