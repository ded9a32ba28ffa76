#pragma once

#include <vector>

#include "thimble/driver/discovery.h"

namespace thimble::driver {

/// Lists the arms that are reached by a vendor's service on this computer, as far as one listens
/// there (links/haply/haply_link.h). Real-time: never from the servo thread.
std::vector<FoundArm> find_linked_arms();

}  // namespace thimble::driver
