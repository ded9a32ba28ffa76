#include "view/feedback/sound_card.h"

#include <alsa/asoundlib.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "view/feedback/touch_sound.h"
#include "view/feedback/wav_file.h"

namespace thimble::view {
namespace {

constexpr unsigned kLatency = 80'000;  // us, buffer of the card; chosen: four steps of the player
// Silence written first, samples: the card plays it while the next step is late. Chosen.
constexpr std::size_t kAhead = TouchSound::kRate / 1000 * 40;

/// An open card.
class AlsaCard final : public SoundOutput {
 public:
  explicit AlsaCard(snd_pcm_t* card) : card_(card) { begin(); }
  AlsaCard(const AlsaCard&) = delete;
  AlsaCard& operator=(const AlsaCard&) = delete;
  ~AlsaCard() override { snd_pcm_close(card_); }

  void play(std::span<const float> samples) override {
    const std::vector<std::int16_t> whole = sixteen_bits(samples);
    if (write(whole) != -EPIPE) return;
    // The card ran out of samples. Start again with silence before the new ones.
    begin();
    write(whole);
  }

 private:
  void begin() {
    snd_pcm_prepare(card_);
    write(std::vector<std::int16_t>(kAhead, 0));
  }
  /// Writes the samples that fit; drops the rest.
  int write(const std::vector<std::int16_t>& samples) {
    return static_cast<int>(snd_pcm_writei(card_, samples.data(), samples.size()));
  }

  snd_pcm_t* card_;
};

/// Suppresses ALSA's messages on the terminal.
void ignore_message(const char* /*file*/, int /*line*/, const char* /*function*/, int /*error*/,
                    const char* /*format*/, ...) {}

}  // namespace

driver::Result<std::unique_ptr<SoundOutput>> open_sound_card() {
  snd_lib_error_set_handler(ignore_message);
  snd_pcm_t* card = nullptr;
  int status = snd_pcm_open(&card, "default", SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
  if (status >= 0) {
    status = snd_pcm_set_params(card, SND_PCM_FORMAT_S16, SND_PCM_ACCESS_RW_INTERLEAVED, 1,
                                TouchSound::kRate, 1, kLatency);
    if (status < 0) snd_pcm_close(card);
  }
  if (status < 0) {
    return driver::Error{std::string("No sound: ALSA's device \"default\" cannot be opened (") +
                         snd_strerror(status) + "). Test it with `speaker-test` (alsa-utils)."};
  }
  return std::unique_ptr<SoundOutput>(std::make_unique<AlsaCard>(card));
}

}  // namespace thimble::view
