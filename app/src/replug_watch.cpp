#include "replug_watch.h"

#include <cstdio>
#include <string>
#include <utility>

#include "enter_key.h"
#include "real_arm.h"

namespace thimble::app {
ReplugWatch::ReplugWatch(Session& session, const driver::FoundArm& arm,
                         std::filesystem::path firmware)
    : session_(session), arm_(arm), firmware_(std::move(firmware)) {}

void ReplugWatch::step() {
  driver::TickRecord record;
  if (!session_.snapshot().load(record)) return;
  if (record.fault == driver::Fault::kNone) {
    told_ = false;
    present_ = true;
    look_for_enter();  // an Enter of before must not count for a fault to come
    return;
  }
  if (!told_) {
    told_ = true;
    present_ = record.fault != driver::Fault::kTransportLost;
    std::fprintf(stderr, "\nForce is off (%s). %s\n", std::string(name(record.fault)).c_str(),
                 std::string(describe(record.fault)).c_str());
    if (present_) std::fprintf(stderr, "Press Enter to let forces through again.\n");
    look_for_enter();
  }
  if (!present_) {
    if (offered_ && record.fresh) {
      offered_ = false;
      present_ = true;
      std::fprintf(stderr,
                   "The arm is back. Hold it as before and press Enter to let forces "
                   "through.\n");
      look_for_enter();
    } else if (!offered_) {
      search();
    }
    return;
  }
  if (look_for_enter() == EnterKey::kPressed) session_.device().ask_to_activate();
}

void ReplugWatch::search() {
  constexpr int kStepsBetween = 5;
  if (pause_-- > 0) return;
  pause_ = kStepsBetween;
  const auto plugged_in = driver::find_arms();
  if (!plugged_in) return;
  const auto found = find_again(*plugged_in, arm_);
  if (!found) return;
  auto wire = open_wire(*found, session_.scene().arm, firmware_, session_.clock());
  if (!wire) return;  // it may still be starting up; the next search tries again
  arm_ = *found;
  session_.device().offer(std::move(wire).value());
  offered_ = true;
}

}  // namespace thimble::app
