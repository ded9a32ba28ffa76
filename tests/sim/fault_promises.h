#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "sim/fault_rig.h"
#include "support/boards/deaf_board.h"
#include "thimble/driver/fault.h"

namespace thimble::fault_test {

/// What is promised of a fault.
enum class Promise {
  kOff,     ///< The driver sees it: the force goes off, stays off, and the cause is named.
  kArmOff,  ///< The arm's own watchdog switches the motors off; the driver may not know.
  kBound,   ///< It looks like a touch: every force stays within the arm's limit, and if it goes off
            ///< it stays off, with its cause.
  kNotKnown,  ///< Only the arm could switch its motors off, and nobody knows whether it does. The
              ///< driver names the cause if it can see one; of the motors nothing is promised.
};

/// Where a fault comes from.
enum class Place { kCable, kWiring, kHost, kBoard };

/// One kind of fault.
struct TestedFault {
  std::string_view name;
  Place place = Place::kCable;
  std::string_view order;  ///< for the cable: device_sim/usb/usb_fault.h says how it reads
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

/// What is promised, and in how many ms, which are ticks, the motors have no current.
struct Promised {
  Promise promise = Promise::kBound;
  int ticks = 0;
  driver::Fault cause = driver::Fault::kNone;  ///< kNone: any, or none
};

/// Finds what is promised of a fault that comes while an arm is touched. `watchdog_ms`: that of its
/// board.
inline Promised promised(std::string_view fault, driver::ArmKind arm, Phase phase,
                         int watchdog_ms) {
  using driver::Fault;
  // 20 ms of silence, the tick that notices it, two frames until the zero has come.
  constexpr int kNoticed = 24;
  // The arm's watchdog after the last good message, whose way may take three frames.
  const int watchdog = watchdog_ms + 4;
  const bool hid = arm == driver::ArmKind::kPolhem || arm == driver::ArmKind::kWoody;
  // An arm that answers only says nothing to a message that it did not hear.
  const bool answers = arm != driver::ArmKind::kWoody;
  if (arm == driver::ArmKind::kFalcon) {
    // Whether a Falcon has a watchdog is not known: the rig's has none.
    if (fault == "stall out" || fault == "short out" || fault == "silence out" ||
        fault == "lost out") {
      return {Promise::kNotKnown, 0, Fault::kNoReports};
    }
    if (fault == "stall out at the end") return {Promise::kNotKnown, 0, Fault::kRefused};
    if (fault == "unplug") return {Promise::kNotKnown, 0, Fault::kTransportLost};
    if (fault == "host dies") return {Promise::kNotKnown, 0, Fault::kNone};
    if (fault == "computer sleeps for 2 s") return {Promise::kOff, 2000 + 3, Fault::kSuspended};
    // The loop's own zero, two frames after it goes on.
    if (fault == "host stands still for 150 ms") {
      return {Promise::kOff, 150 + 3, Fault::kLoopStalled};
    }
  }
  // Its motors are off at once. It counts from elsewhere then, so that the home pose is needed; a
  // Falcon has no firmware any more.
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
  if (fault == "long in" && hid) return unheard;  // babble; a stream skips what is no message
  // Its reports are numbered, so that an old one is known.
  if (fault == "stale in" && arm == driver::ArmKind::kWoody) return unheard;
  // Its silence is noticed a tick before the messages count as refused.
  const Promised unanswered{Promise::kOff, watchdog, Fault::kNoReports};
  if (answers && (fault == "stall out" || fault == "lost out")) return unanswered;
  // To what they do not understand, text boards and the Falcon say nothing either; a HID board
  // answers a message of any length.
  if (!hid && (fault == "short out" || fault == "silence out")) return unanswered;
  if (fault == "lost out") return unknown;
  if (fault == "stall out") return {Promise::kOff, watchdog, Fault::kRefused};
  if (fault == "short out") return unknown;
  if (fault == "long out" && hid) return unknown;
  if (fault == "silence out") {
    // A HID write waits for the arm, and the loop with it. The arm's watchdog switches the motors
    // off meanwhile; when it takes messages again, after 140 ms, the one that waited moves them
    // until the zero of the loop that stood still has come.
    return {Promise::kOff, 140 + 3, Fault::kLoopStalled};
  }
  // Surfaces as soft as the hand's grip, and one motor of three, are no matter of promises: there a
  // reversed arm stays where the hand holds it. A stiff one is found while the hand goes in, before
  // the phase begins.
  if (fault == "all motors turned round" && phase != Phase::kFree && phase != Phase::kDeforming) {
    return {Promise::kOff, 1, Fault::kMotorsReversed};
  }
  if (fault == "unplug") return {Promise::kOff, watchdog, Fault::kTransportLost};
  if (fault == "force law without a number") return {Promise::kOff, 3, Fault::kForceNotFinite};
  if (fault == "host stands still for 150 ms") {
    // By a board that waits for longer the loop's own zero is the first.
    return {Promise::kOff, std::min(watchdog, 150 + 3), Fault::kLoopStalled};
  }
  if (fault == "host dies") return unknown;
  if (fault == "computer sleeps for 2 s") return {Promise::kOff, watchdog, Fault::kSuspended};
  if (fault == "clock steps back 10 ms") return {Promise::kOff, 3, Fault::kTimeNotMonotonic};
  // The zero is sent again each millisecond, and taken in the first in which it can be.
  if (fault == "stall out of 30 ms at the end") return {Promise::kOff, 30 + 3, Fault::kNone};
  if (fault == "stall out at the end") return {Promise::kArmOff, watchdog, Fault::kRefused};
  return {};
}

/// Returns whether an arm with this fault cannot be opened at all; nothing if that is a matter of
/// luck.
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
