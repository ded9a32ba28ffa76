#include "compat/dhd/wrong_calls.h"

#include <cmath>
#include <map>
#include <utility>

#include "drdc.h"

namespace thimble::compat {
namespace {

double number[40];
int whole[8];
unsigned short small_number;

// Returns calls of a function with N pointers to real numbers; in each call another one is null.
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

}  // namespace

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
  NULLS(drdGetRotMoveParam, 3);
  NULLS(drdGetRotTrackParam, 3);
  NULLS(drdGetGripMoveParam, 3);
  NULLS(drdGetGripTrackParam, 3);
  NULLS(drdGetEncMoveParam, 3);
  NULLS(drdGetEncTrackParam, 3);
  NULLS(dhdGetDeltaJointAngles, 3);
  NULLS(dhdGetWristJointAngles, 3);
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
  add("dhdDeltaJointAnglesToJacobian",
      [](char id) { return dhdDeltaJointAnglesToJacobian(0, 0, 0, nullptr, id); });
  for (int null = 0; null < 3; ++null) {
    add("dhdGetDeltaEncoders", [=](char id) {
      return dhdGetDeltaEncoders(null == 0 ? nullptr : whole, null == 1 ? nullptr : whole,
                                 null == 2 ? nullptr : whole, id);
    });
  }
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
             {"drdSetEncPGain", drdSetEncPGain},
             {"drdSetEncIGain", drdSetEncIGain},
             {"drdSetEncDGain", drdSetEncDGain},
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
      for (const auto& [name, set] : std::map<const char*, int (*)(double, double, double, char)>{
               {"drdSetRotMoveParam", drdSetRotMoveParam},
               {"drdSetRotTrackParam", drdSetRotTrackParam},
               {"drdSetGripMoveParam", drdSetGripMoveParam},
               {"drdSetGripTrackParam", drdSetGripTrackParam},
               {"drdSetEncMoveParam", drdSetEncMoveParam},
               {"drdSetEncTrackParam", drdSetEncTrackParam}}) {
        add(name, [=, set = set](char id) { return set(n(0), n(1), n(2), id); });
      }
      add(
          "dhdDeltaJointAnglesToJacobian",
          [=](char id) {
            double rows[3][3];
            return dhdDeltaJointAnglesToJacobian(n(0), n(1), n(2), rows, id);
          },
          DHD_ERROR_GEOMETRY);
      add("dhdSetForce", [=](char id) { return dhdSetForce(n(0), n(1), n(2), id); });
    }
    for (int i = 0; i < 7; ++i) {
      const auto n = [=](int k) { return k == i ? bad : 0.1; };
      add("dhdSetForceAndTorqueAndGripperForce", [=](char id) {
        return dhdSetForceAndTorqueAndGripperForce(n(0), n(1), n(2), n(3), n(4), n(5), n(6), id);
      });
      add("dhdSetForceAndWristJointTorquesAndGripperForce", [=](char id) {
        return dhdSetForceAndWristJointTorquesAndGripperForce(n(0), n(1), n(2), n(3), n(4), n(5),
                                                              n(6), id);
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
  for (const auto& [name, move] : std::map<const char*, int (*)(char)>{
           {"drdMoveToRot", [](char id) { return drdMoveToRot(0, 0, 0, true, id); }},
           {"drdTrackRot", [](char id) { return drdTrackRot(0, 0, 0, id); }},
           {"drdMoveToGrip", [](char id) { return drdMoveToGrip(0, true, id); }},
           {"drdTrackGrip", [](char id) { return drdTrackGrip(0, id); }},
           {"dhdWristJointAnglesToJacobian",
            [](char id) { return dhdWristJointAnglesToJacobian(0, 0, 0, nullptr, id); }}}) {
    add(name, move, DHD_ERROR_NOT_AVAILABLE);
  }
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
  OF_ARM(drdSetForceAndWristJointTorquesAndGripperForce, number);
  OF_ARM(dhdSetForceAndWristJointTorques, 1, 0, 0, 0, 0, 0);
  OF_ARM(drdGetEncPGain);
  OF_ARM(drdGetEncIGain);
  OF_ARM(drdGetEncDGain);
  return calls;
}

std::vector<Call> all_calls() {
  std::vector<Call> all = calls_with_null();
  for (const auto& more : {calls_with_bad_numbers(), calls_of_an_arm()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace thimble::compat
