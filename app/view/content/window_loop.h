#pragma once

#include <functional>

#include "thimble/driver/result.h"
#include "view/screen.h"
#include "view/window.h"

namespace thimble::view {

/// What the window does after a picture.
enum class AfterPicture {
  kMoves,  ///< The next picture follows at once.
  kStill,  ///< The next picture follows when there is input, or after 0.25 s.
  kClose,  ///< The window closes.
};

/// Draws one picture; `dt` is the time since the last one, s.
using DrawPicture = std::function<driver::Result<AfterPicture>(double dt)>;

/// Draws pictures until the user or `draw` closes the window, or until its time is over; the last
/// picture is then written if it was requested. Fails as `draw` does, or if the picture cannot be
/// written. Real-time: never from the servo thread.
driver::Result<void> draw_until_closed(Screen& screen, const WindowChoice& choice,
                                       const DrawPicture& draw);

}  // namespace thimble::view
