#pragma once

#include <vector>

#include "thimble/driver/discovery.h"

namespace thimble::driver {

/// Makes an arm of each board on USB whose vendor's library is on this computer: a board of Force
/// Dimension with libdrd (vendors/dhd/dhd_library.h), a Touch with libHD (vendors/hd/hd_library.h).
/// Other entries are unchanged. Opens a library only if such a board is present; does not access
/// the arm. Real-time: never from the servo thread.
void link_boards(std::vector<FoundArm>& found);

/// Lists the arms behind a vendor's service on this computer, if one listens
/// (vendors/haply/haply_link.h). Real-time: never from the servo thread.
std::vector<FoundArm> find_linked_arms();

}  // namespace thimble::driver
