#include "view/feedback/sound_card.h"

namespace thimble::view {

driver::Result<std::unique_ptr<SoundOutput>> open_sound_card() {
  return driver::Error{
      "No sound: built without ALSA. Install libasound2-dev and build again. "
      "`thimble export REC.h5 --sound FILE.wav` works without ALSA."};
}

}  // namespace thimble::view
