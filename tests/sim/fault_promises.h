#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "sim/fault_rig.h"
#include "support/boards/deaf_board.h"
#include "thimble/driver/fault.h"

namespace thimble::fault_test {

/// Promise for a fault.
enum class Promise {
  kOff,     ///< The driver detects it: the force goes off and stays off, and the cause is reported.
  kArmOff,  ///< The arm's own watchdog switches the motors off; the driver may not know.
  kBound,   ///< It looks like a touch: every force stays within the arm's limit. If the force goes
            ///< off, it stays off and the cause is reported.
  kNotKnown,  ///< Only the arm could switch its motors off, which is unknown. The driver reports
              ///< the cause if it detects one; nothing is promised for the motors.
};

/// Origin of a fault.
enum class Place { kCable, kWiring, kHost, kBoard };

/// One kind of fault.
struct TestedFault {
  std::string_view name;
  Place place = Place::kCable;
  std::string_view order;  ///< fault of the cable in the syntax of device_sim/usb/usb_fault.h
};
inline constexpr std::array<TestedFault, 35> kTestedFaults{{
    {"stall in", Place::kCable, "stall in"},
    {"stall out", Place::kCable, "stall out"},
    {"short in", Place::kCable, "short in"},
    {"short out", Place::kCable, "short out"},
    {"long in", Place::kCable, "long in"},
    {"long out", Place::kCable, "long out"},
    {"torn in", Place::kCable, "torn in"},
    {"torn out", Place::kCable, "torn out"},
    {"stale in", Place::kCable, "stale in"},
    {"stale out", Place::kCable, "stale out"},
    {"duplicate in", Place::kCable, "duplicate in"},
    {"duplicate out", Place::kCable, "duplicate out"},
    {"silence in", Place::kCable, "silence in"},
    {"silence out", Place::kCable, "silence out for=140"},
    {"bit errors in, 1 in 1000", Place::kCable, "bit_errors in rate=0.001"},
    {"bit errors in, 1 in 30", Place::kCable, "bit_errors in rate=0.03"},
    {"bit errors out, 1 in 100", Place::kCable, "bit_errors out rate=0.01"},
    {"unplug", Place::kCable, "unplug"},
    {"dead encoder", Place::kWiring, {}},
    {"encoder turned round", Place::kWiring, {}},
    {"dead motor", Place::kWiring, {}},
    {"motor turned round", Place::kWiring, {}},
    {"two motors swapped", Place::kWiring, {}},
    {"all motors turned round", Place::kWiring, {}},  // on a plate of 800 N/m
    {"force law without a number", Place::kHost, {}},
    {"host stands still for 50 ms", Place::kHost, {}},
    {"host stands still for 150 ms", Place::kHost, {}},
    {"host dies", Place::kHost, {}},
    {"lost in", Place::kCable, "lost in"},
    {"lost out", Place::kCable, "lost out"},
    {"clock steps back 10 ms", Place::kHost, {}},
    {"stall out of 30 ms at the end", Place::kHost, "stall out for=30"},
    {"stall out at the end", Place::kHost, "stall out"},
    {"board restarts within 60 ms", Place::kBoard, {}},
    {"computer sleeps for 2 s", Place::kHost, {}},
}};

/// The promise, and the time until the motors have no current, ms (= ticks).
struct Promised {
  Promise promise = Promise::kBound;
  int ticks = 0;
  driver::Fault cause = driver::Fault::kNone;  ///< kNone: any cause, or none
};

/// Returns the promise for a fault during a touch. `watchdog_ms`: watchdog time of the arm's board.
inline Promised promised(std::string_view fault, driver::ArmKind arm, Phase phase,
                         int watchdog_ms) {
  using driver::Fault;
  // 20 ms of silence, the tick that detects it, and two frames until the zero force has arrived.
  constexpr int kNoticed = 24;
  // The arm's watchdog after the last valid message, which may take three frames.
  const int watchdog = watchdog_ms + 4;
  const bool hid = arm == driver::ArmKind::kPolhem || arm == driver::ArmKind::kWoody;
  // An arm that sends only when asked does not answer a message that it did not receive.
  const bool answers = arm != driver::ArmKind::kWoody;
  if (arm == driver::ArmKind::kFalcon) {
    // It is unknown whether a Falcon has a watchdog; the rig's Falcon has none.
    if (fault == "stall out" || fault == "short out" || fault == "silence out" ||
        fault == "lost out") {
      return {Promise::kNotKnown, 0, Fault::kNoReports};
    }
    if (fault == "stall out at the end") return {Promise::kNotKnown, 0, Fault::kRefused};
    if (fault == "unplug") return {Promise::kNotKnown, 0, Fault::kTransportLost};
    if (fault == "host dies") return {Promise::kNotKnown, 0, Fault::kNone};
    if (fault == "computer sleeps for 2 s") return {Promise::kOff, 2000 + 3, Fault::kSuspended};
    // Zero force from the loop, two frames after it continues.
    if (fault == "host stands still for 150 ms") {
      return {Promise::kOff, 150 + 3, Fault::kLoopStalled};
    }
  }
  // Its motors are off at once. Its counters then start elsewhere, so the home pose is needed; a
  // Falcon has lost its firmware.
  if (fault == "board restarts within 60 ms") {
    return {Promise::kOff, kNoticed, Fault::kNoReports};
  }
  const Promised unheard{Promise::kOff, kNoticed, Fault::kNoReports};
  const Promised unknown{Promise::kArmOff, watchdog, Fault::kNone};
  const Promised deaf{Promise::kOff, watchdog, Fault::kNoReports};
  if (support::is_deaf(hid, answers, fault)) return deaf;
  if (fault == "stall in" || fault == "short in" || fault == "silence in" || fault == "lost in") {
    return unheard;
  }
  if (fault == "long in" && hid)
    return unheard;  // babble; a stream skips bytes that are no message
  // Its reports have numbers, so an old report is detected.
  const bool numbered = arm == driver::ArmKind::kWoody || arm == driver::ArmKind::kDescribed;
  if (fault == "stale in" && numbered) return unheard;
  // Its silence is detected a tick before the messages count as refused.
  const Promised unanswered{Promise::kOff, watchdog, Fault::kNoReports};
  if (answers && (fault == "stall out" || fault == "lost out")) return unanswered;
  // Text boards and the Falcon do not answer invalid messages either; a HID board answers a message
  // of any length.
  if (!hid && (fault == "short out" || fault == "silence out")) return unanswered;
  if (fault == "lost out") return unknown;
  if (fault == "stall out") return {Promise::kOff, watchdog, Fault::kRefused};
  if (fault == "short out") return unknown;
  if (fault == "long out" && hid) return unknown;
  if (fault == "silence out") {
    // A HID write blocks the loop until the arm accepts it. Meanwhile the arm's watchdog switches
    // the motors off. After 140 ms the arm accepts messages again; the blocked message moves the
    // motors until the loop's zero force arrives.
    return {Promise::kOff, 140 + 3, Fault::kLoopStalled};
  }
  // Nothing is promised for surfaces as soft as the hand's grip, or for one reversed motor of
  // three: the hand then holds the arm in place. On a stiff surface the fault is detected while the
  // hand goes in, before the phase begins.
  if (fault == "all motors turned round" && phase != Phase::kFree && phase != Phase::kDeforming) {
    return {Promise::kOff, 1, Fault::kMotorsReversed};
  }
  if (fault == "unplug") return {Promise::kOff, watchdog, Fault::kTransportLost};
  if (fault == "force law without a number") return {Promise::kOff, 3, Fault::kForceNotFinite};
  if (fault == "host stands still for 150 ms") {
    // If the board's watchdog is longer, the zero force of the loop arrives first.
    return {Promise::kOff, std::min(watchdog, 150 + 3), Fault::kLoopStalled};
  }
  if (fault == "host dies") return unknown;
  if (fault == "computer sleeps for 2 s") return {Promise::kOff, watchdog, Fault::kSuspended};
  if (fault == "clock steps back 10 ms") return {Promise::kOff, 3, Fault::kTimeNotMonotonic};
  // Zero force is sent again every millisecond, and accepted as soon as possible.
  if (fault == "stall out of 30 ms at the end") return {Promise::kOff, 30 + 3, Fault::kNone};
  if (fault == "stall out at the end") return {Promise::kArmOff, watchdog, Fault::kRefused};
  return {};
}

/// Returns whether opening an arm with this fault fails; empty if that depends on chance.
inline std::optional<bool> refused_at_opening(std::string_view fault, driver::ArmKind arm) {
  const bool hid = arm == driver::ArmKind::kPolhem || arm == driver::ArmKind::kWoody;
  if (fault == "stall in" || fault == "short in" || fault == "silence in") return true;
  if (fault == "unplug" || fault == "lost in") return true;
  if (fault == "bit errors in, 1 in 30") return std::nullopt;
  if (fault == "long in") return hid;
  // Without a first message there is no first answer.
  if (fault == "stall out" || fault == "lost out") return arm != driver::ArmKind::kWoody;
  if (fault == "short out") return !hid;
  return false;
}

}  // namespace thimble::fault_test
