#include "links/linked_arms.h"

#include <string>
#include <utility>

#include "board_identity.h"
#include "links/haply/haply_link.h"

namespace thimble::driver {

std::vector<FoundArm> find_linked_arms() {
  std::vector<FoundArm> found;
  const std::uint16_t port = haply::port_of_user();
  const auto arms = haply::find_arms(port);
  if (!arms) return found;  // `thimble doctor` says why
  for (const haply::FoundInverse3& arm : *arms) {
    FoundArm one;
    one.kind = ArmKind::kHaply;
    one.board = BoardKind::kHaplyService;
    one.certainty = Certainty::kProvesItself;
    one.arm = "Haply Inverse3";
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
