#pragma once

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Rubs a free tip over an even surface with the default friction, stops, and listens: what is sent
/// above 50 Hz must stay below what a hand feels (kRestFelt), and the tip must stand still. The
/// surface's own force is not sent; the tip is led by a weak spring. Real-time: never from the
/// servo thread.
HilResult check_friction_at_rest(const HilRig& rig);

}  // namespace thimble::hil
