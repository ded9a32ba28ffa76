#pragma once

#include <vector>

#include "thimble/driver/discovery.h"

namespace thimble::driver {

/// Makes an arm of each board on USB whose maker's library is on this computer: a board of Force
/// Dimension's with libdrd (vendors/dhd/dhd_library.h), a Touch with libHD
/// (vendors/hd/hd_library.h). Others stay as they are. Opens a library only where such a board is;
/// asks nothing of the arm. Real-time: never from the servo thread.
void link_boards(std::vector<FoundArm>& found);

/// Lists the arms that are reached by a vendor's service on this computer, as far as one listens
/// there (vendors/haply/haply_link.h). Real-time: never from the servo thread.
std::vector<FoundArm> find_linked_arms();

}  // namespace thimble::driver
