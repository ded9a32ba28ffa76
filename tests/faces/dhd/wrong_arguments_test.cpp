// Each function with each argument that is wrong, and each name that is not answered.
#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "faces/dhd/dhd_test.h"

namespace thimble::faces {
namespace {

double number[40];
int whole[8];
unsigned short small_number;

// A call with one null pointer or one wrong number; the number of the arm is the caller's.
struct Call {
  std::string name;
  std::function<int(char)> call;
  int error = DHD_ERROR_NULL_ARGUMENT;
};

// Calls of a function of so many pointers to real numbers, each with another of them null.
template <class Function, std::size_t... I>
void add_nulls(std::vector<Call>& calls, const char* name, Function function,
               std::index_sequence<I...>) {
  for (std::size_t null = 0; null < sizeof...(I); ++null) {
    calls.push_back(
        {name, [=](char id) { return function((I == null ? nullptr : &number[I])..., id); }});
  }
}
#define NULLS(function, count)                                        \
  add_nulls(                                                          \
      calls, #function, [](auto... all) { return function(all...); }, \
      std::make_index_sequence<count>())

std::vector<Call> calls_with_null() {
  std::vector<Call> calls;
  NULLS(dhdGetPosition, 3);
  NULLS(dhdGetLinearVelocity, 3);
  NULLS(dhdGetAngularVelocityRad, 3);
  NULLS(dhdGetAngularVelocityDeg, 3);
  NULLS(dhdGetOrientationRad, 3);
  NULLS(dhdGetOrientationDeg, 3);
  NULLS(dhdGetPositionAndOrientationRad, 6);
  NULLS(dhdGetPositionAndOrientationDeg, 6);
  NULLS(dhdGetForce, 3);
  NULLS(dhdGetForceAndTorque, 6);
  NULLS(dhdGetForceAndTorqueAndGripperForce, 7);
  NULLS(dhdGetGripperThumbPos, 3);
  NULLS(dhdGetGripperFingerPos, 3);
  NULLS(dhdGetGripperAngleRad, 1);
  NULLS(dhdGetGripperAngleDeg, 1);
  NULLS(dhdGetGripperGap, 1);
  NULLS(dhdGetGripperLinearVelocity, 1);
  NULLS(dhdGetGripperAngularVelocityRad, 1);
  NULLS(dhdGetGripperAngularVelocityDeg, 1);
  NULLS(dhdGetEffectorMass, 1);
  NULLS(dhdGetDeviceAngleRad, 1);
  NULLS(dhdGetDeviceAngleDeg, 1);
  NULLS(dhdGetBaseAngleXRad, 1);
  NULLS(dhdGetBaseAngleXDeg, 1);
  NULLS(dhdGetBaseAngleZRad, 1);
  NULLS(dhdGetBaseAngleZDeg, 1);
  NULLS(dhdGetJointAngles, 1);
  NULLS(dhdGetJointVelocities, 1);
  NULLS(drdGetVelocity, 7);
  NULLS(drdGetPosMoveParam, 3);
  NULLS(drdGetPosTrackParam, 3);
  const auto add = [&](const char* name, std::function<int(char)> call) {
    calls.push_back({name, std::move(call)});
  };
  static double rows[3][3], wide[6][6];
  add("dhdGetSerialNumber", [](char id) { return dhdGetSerialNumber(nullptr, id); });
  add("dhdGetStatus", [](char id) { return dhdGetStatus(nullptr, id); });
  add("dhdGetWatchdog", [](char id) { return dhdGetWatchdog(nullptr, id); });
  add("dhdGetVelocityThreshold", [](char id) { return dhdGetVelocityThreshold(nullptr, id); });
  add("dhdGetOrientationFrame", [](char id) { return dhdGetOrientationFrame(nullptr, id); });
  add("dhdGetDeltaJacobian", [](char id) { return dhdGetDeltaJacobian(nullptr, id); });
  add("dhdGetEnc", [](char id) { return dhdGetEnc(nullptr, 0xff, id); });
  add("dhdSetJointTorques", [](char id) { return dhdSetJointTorques(nullptr, 0xff, id); });
  for (int null = 0; null < 4; ++null) {
    add("dhdGetPositionAndOrientationFrame", [=](char id) {
      return dhdGetPositionAndOrientationFrame(
          null == 0 ? nullptr : number, null == 1 ? nullptr : number, null == 2 ? nullptr : number,
          null == 3 ? nullptr : rows, id);
    });
  }
  for (int null = 0; null < 8; ++null) {
    add("drdGetPositionAndOrientation", [=](char id) {
      const auto or_null = [&](int i) { return null == i ? nullptr : number; };
      return drdGetPositionAndOrientation(or_null(0), or_null(1), or_null(2), or_null(3),
                                          or_null(4), or_null(5), or_null(6),
                                          null == 7 ? nullptr : rows, id);
    });
  }
  for (int null = 0; null < 2; ++null) {
    add("dhdJointAnglesToInertiaMatrix", [=](char id) {
      return dhdJointAnglesToInertiaMatrix(null == 0 ? nullptr : number, null == 1 ? nullptr : wide,
                                           id);
    });
    add("dhdJointAnglesToGravityJointTorques", [=](char id) {
      return dhdJointAnglesToGravityJointTorques(null == 0 ? nullptr : number,
                                                 null == 1 ? nullptr : number, 0xff, id);
    });
  }
  return calls;
}

std::vector<Call> calls_with_bad_numbers() {
  std::vector<Call> calls;
  const auto add = [&](const char* name, std::function<int(char)> call,
                       int error = DHD_ERROR_INVALID) {
    calls.push_back({name, std::move(call), error});
  };
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (const auto& [name, set] : std::map<const char*, int (*)(double, char)>{
             {"dhdSetEffectorMass", dhdSetEffectorMass},
             {"dhdSetDeviceAngleRad", dhdSetDeviceAngleRad},
             {"dhdSetDeviceAngleDeg", dhdSetDeviceAngleDeg},
             {"dhdSetBaseAngleXRad", dhdSetBaseAngleXRad},
             {"dhdSetBaseAngleXDeg", dhdSetBaseAngleXDeg},
             {"dhdSetBaseAngleZRad", dhdSetBaseAngleZRad},
             {"dhdSetBaseAngleZDeg", dhdSetBaseAngleZDeg},
             {"dhdSetMaxForce", dhdSetMaxForce},
             {"drdSetMotRatioMax", drdSetMotRatioMax}}) {
      add(name, [set = set, bad](char id) { return set(bad, id); });
    }
    add("dhdSetVibration", [=](char id) { return dhdSetVibration(bad, 1, 0, id); });
    add("dhdSetVibration", [=](char id) { return dhdSetVibration(1, bad, 0, id); });
    for (int i = 0; i < 3; ++i) {
      const auto n = [=](int k) { return k == i ? bad : 1.0; };
      add("drdSetPosMoveParam", [=](char id) { return drdSetPosMoveParam(n(0), n(1), n(2), id); });
      add("drdSetPosTrackParam",
          [=](char id) { return drdSetPosTrackParam(n(0), n(1), n(2), id); });
      add("dhdSetForce", [=](char id) { return dhdSetForce(n(0), n(1), n(2), id); });
    }
    for (int i = 0; i < 7; ++i) {
      const auto n = [=](int k) { return k == i ? bad : 0.1; };
      add("dhdSetForceAndTorqueAndGripperForce", [=](char id) {
        return dhdSetForceAndTorqueAndGripperForce(n(0), n(1), n(2), n(3), n(4), n(5), n(6), id);
      });
    }
  }
  add(
      "dhdGetButton", [](char id) { return dhdGetButton(16, id); }, DHD_ERROR_INVALID_INDEX);
  add(
      "dhdGetButton", [](char id) { return dhdGetButton(-1, id); }, DHD_ERROR_INVALID_INDEX);
  add("dhdWaitForReset", [](char id) { return dhdWaitForReset(-1, id); });
  add(
      "dhdPreset", [](char id) { return dhdPreset(whole, 0xff, id); }, DHD_ERROR_NOT_AVAILABLE);
  add(
      "dhdSetMot", [](char id) { return dhdSetMot(&small_number, 1, id); },
      DHD_ERROR_NOT_AVAILABLE);
  add(
      "drdMoveToPos", [](char id) { return drdMoveToPos(0, 0, 0, true, id); },
      DHD_ERROR_NO_REGULATION);
  add(
      "drdTrackPos", [](char id) { return drdTrackPos(0, 0, 0, id); }, DHD_ERROR_NO_REGULATION);
  add(
      "drdHold", [](char id) { return drdHold(id); }, DHD_ERROR_NO_REGULATION);
  add(
      "drdWaitForTick", [](char id) { return drdWaitForTick(id); }, DHD_ERROR_NO_REGULATION);
  add(
      "dhdGetWristJacobian", [](char id) { return dhdGetWristJacobian(nullptr, id); },
      DHD_ERROR_NOT_AVAILABLE);
  add(
      "dhdGetEncVelocities", [](char id) { return dhdGetEncVelocities(nullptr, id); },
      DHD_ERROR_NOT_AVAILABLE);
  add(
      "dhdGetJointAngleRange", [](char id) { return dhdGetJointAngleRange(nullptr, nullptr, id); },
      DHD_ERROR_NOT_AVAILABLE);
  return calls;
}

// What wants nothing but an arm that is open.
std::vector<Call> calls_of_an_arm() {
  std::vector<Call> calls;
  const auto add = [&](const char* name, std::function<int(char)> call) {
    calls.push_back({name, std::move(call)});
  };
#define OF_ARM(function, ...) \
  add(#function, [](char id) { return static_cast<int>(function(__VA_ARGS__ __VA_OPT__(, ) id)); })
  OF_ARM(dhdClose);
  OF_ARM(drdClose);
  OF_ARM(dhdSetDevice);
  OF_ARM(drdSetDevice);
  OF_ARM(dhdStop);
  OF_ARM(dhdEnableForce, 1);
  OF_ARM(dhdEnableForce, 0);
  OF_ARM(dhdGetSystemType);
  OF_ARM(dhdReset);
  OF_ARM(dhdWaitForReset, 1);
  OF_ARM(dhdSetGravityCompensation, 1);
  OF_ARM(dhdSetBrakes, 1);
  OF_ARM(dhdSetEffectorMass, 1);
  OF_ARM(dhdSetMaxForce, 1);
  OF_ARM(dhdGetMaxForce);
  OF_ARM(dhdGetComFreq);
  OF_ARM(dhdEmulateButton, 1);
  OF_ARM(dhdGetButton, 0);
  OF_ARM(dhdSetVibration, 1, 1, 1);
  OF_ARM(dhdSetWatchdog, 100);
  OF_ARM(dhdSetVelocityThreshold, 1);
  OF_ARM(dhdSetForceAndTorque, 1, 0, 0, 0, 0, 0);
  OF_ARM(dhdSetForceAndGripperForce, 1, 0, 0, 0);
  OF_ARM(drdAutoInit);
  OF_ARM(drdCheckInit);
  OF_ARM(drdPrecisionInit);
  OF_ARM(drdStart);
  OF_ARM(drdStop, true);
  OF_ARM(drdRegulatePos, true);
  OF_ARM(drdRegulateRot, true);
  OF_ARM(drdRegulateGrip, true);
  OF_ARM(drdEnableFilter, true);
  OF_ARM(drdGetCtrlFreq);
  OF_ARM(drdGetMotRatioMax);
  OF_ARM(drdMoveTo, number, true);
  OF_ARM(drdTrack, number);
  OF_ARM(drdSetForceAndTorqueAndGripperForce, number);
  return calls;
}

std::vector<Call> all_calls() {
  std::vector<Call> all = calls_with_null();
  for (const auto& more : {calls_with_bad_numbers(), calls_of_an_arm()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST_F(DhdFace, ANullPointerIsAnErrorAndIsCounted) {
  begin_and_open({});
  for (const Call& call : calls_with_null()) {
    const std::size_t wrong = fake::wrong_calls().size();
    EXPECT_EQ(call.call(0), -1) << call.name;
    EXPECT_EQ(dhdErrorGetLast(), call.error) << call.name;
    ASSERT_EQ(fake::wrong_calls().size(), wrong + 1) << call.name;
    EXPECT_EQ(fake::wrong_calls().back(), call.name);
  }
}

TEST_F(DhdFace, ANumberOutOfBoundsIsAnErrorAndIsCounted) {
  for (const Call& call : calls_with_bad_numbers()) {
    begin_and_open({});
    EXPECT_EQ(call.call(0), -1) << call.name;
    EXPECT_EQ(dhdErrorGetLast(), call.error) << call.name;
    EXPECT_EQ(fake::wrong_calls().back(), call.name);
    EXPECT_TRUE(fake::f_sent_W(0).isZero(0)) << call.name;
  }
}

TEST_F(DhdFace, AnArmThatIsNotOpenOrNotThereIsAnErrorToEachFunction) {
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

TEST_F(DhdFace, WhatWantsNoArmTakesWrongArgumentsToo) {
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

TEST_F(DhdFace, AnErrorBelongsToTheThreadThatMadeIt) {
  EXPECT_EQ(dhdOpenID(9), -1);
  std::thread([] { EXPECT_EQ(dhdErrorGetLast(), DHD_NO_ERROR); }).join();
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_INVALID_INDEX);
}

TEST_F(DhdFace, StartsAThreadOfTheProgram) {
  static std::atomic<int> seen{0};
  static int told = 7;
  ASSERT_EQ(
      dhdStartThread(
          [](void* argument) -> void* { return seen = *static_cast<int*>(argument), nullptr; },
          &told, 1),
      0);
  for (int i = 0; i < 1000 && seen == 0; ++i) dhdSleep(0.01);
  EXPECT_EQ(seen, 7);
}

TEST_F(DhdFace, ReadsKeysFromWhereverTheyCome) {
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

TEST_F(DhdFace, EachOtherNameIsThereAndSaysThatItIsNotAnswered) {
  std::ifstream file(THIMBLE_SOURCE_DIR "/app/faces/dhd/symbols.txt");
  std::string line;
  bool answered = true;
  int names = 0, refused = 0;
  while (std::getline(file, line)) {
    if (line.starts_with("# Answer -1")) answered = false;
    if (line.empty() || line[0] == '#') continue;
    ++names;
    void* const symbol = dlsym(RTLD_DEFAULT, line.c_str());
    ASSERT_NE(symbol, nullptr) << line;
    if (answered) continue;
    ++refused;
    const std::size_t wrong = fake::wrong_calls().size();
    const bool real = line.ends_with("Gain") && line.starts_with("drdGet");
    if (real || line == "dhdGetMaxTorque" || line == "dhdGetMaxGripperForce") {
      EXPECT_EQ(reinterpret_cast<double (*)()>(symbol)(), -1.0) << line;
    } else {
      EXPECT_EQ(reinterpret_cast<int (*)()>(symbol)(), -1) << line;
    }
    EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NOT_IMPLEMENTED) << line;
    ASSERT_EQ(fake::wrong_calls().size(), wrong + 1);
    EXPECT_EQ(fake::wrong_calls().back(), line);
  }
  EXPECT_EQ(names, 233);
  EXPECT_EQ(refused, 96);
}

// Functions in any order with any arguments, from three threads at once: nothing crashes or hangs,
// and no force is beyond what the gate lets through. What the sanitizers see counts as well.
TEST_F(DhdFace, AnyOrderOfCallsFromAnyThreadEndsWell) {
  begin({.arms = 3, .held = false});
  const std::vector<Call> calls = all_calls();
  const auto caller = [&](unsigned seed) {
    std::mt19937 random(seed);
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
}  // namespace thimble::faces
