#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Rubs a free tip over an even surface with the default friction, stops, and measures. The force
/// sent above 50 Hz must stay below a hand's threshold (kRestFelt), and the tip must be at rest.
/// The surface's own force is not sent; a weak spring leads the tip. Real-time: never from the
/// servo thread.
HilResult check_friction_at_rest(const HilRig& rig);

}  // namespace thimble::hil
