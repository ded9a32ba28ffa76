#include "vendors/linked_arms.h"

#include <string>
#include <utility>

#include "board_identity.h"
#include "vendors/dhd/dhd_library.h"
#include "vendors/haply/haply_link.h"
#include "vendors/hd/hd_library.h"

namespace thimble::driver {

void link_boards(std::vector<FoundArm>& found) {
  for (FoundArm& arm : found) {
    // `thimble doctor` reports a missing library.
    if (arm.vendor_id == kForceDimension) {
      const auto library = dhd::library();
      if (!library) continue;
      arm.kind = ArmKind::kDhd;
      arm.board = BoardKind::kDhdLibrary;
      arm.software = "libdrd " + library->version;
    } else if (arm.vendor_id == kTouchMaker) {
      const auto library = hd::library();
      if (!library) continue;
      arm.kind = ArmKind::kHd;
      arm.board = BoardKind::kHdLibrary;
      arm.software = library->file;
    } else {
      continue;
    }
    arm.certainty = Certainty::kKnown;
  }
}

std::vector<FoundArm> find_linked_arms() {
  std::vector<FoundArm> found;
  const std::uint16_t port = haply::port_of_user();
  const auto arms = haply::find_arms(port);
  if (!arms) return found;  // `thimble doctor` reports the reason
  for (const haply::FoundInverse3& arm : *arms) {
    FoundArm one;
    one.kind = ArmKind::kHaply;
    one.board = BoardKind::kHaplyService;
    // Our own stand-in is an arm that Thimble already drives, so it is used only if it is named.
    one.certainty = arm.stand_in ? Certainty::kUnknown : Certainty::kProvesItself;
    one.arm = arm.stand_in ? "stand-in of Thimble" : "Haply Inverse3";
    one.bus = kServiceBus;
    one.address = "port " + std::to_string(port);
    one.node = "ws://localhost:" + std::to_string(port);
    one.serial = arm.device_id;
    one.software = arm.versions;
    one.trouble = arm.trouble;
    one.accessible = true;
    found.push_back(std::move(one));
  }
  return found;
}

}  // namespace thimble::driver
