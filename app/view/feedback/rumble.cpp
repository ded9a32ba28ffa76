#include "view/feedback/rumble.h"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace thimble::view {
namespace {

constexpr std::size_t kWordBits = 8 * sizeof(unsigned long);

/// Returns whether an event file belongs to a device that can rumble.
/// [S] Linux, Documentation/input/ff.rst, "Querying device capabilities".
bool can_rumble(int file) {
  std::array<unsigned long, FF_CNT / kWordBits + 1> bits{};
  if (ioctl(file, EVIOCGBIT(EV_FF, sizeof bits), bits.data()) < 0) return false;
  return (bits[FF_RUMBLE / kWordBits] >> (FF_RUMBLE % kWordBits) & 1U) != 0;
}

std::uint16_t magnitude(double share) {
  return static_cast<std::uint16_t>(std::lround(0xffff * share));
}

/// An open gamepad. The kernel removes its effect when the file is closed.
/// [S] Linux, Documentation/input/ff.rst, "Uploading effects", "Controlling playback".
class EvdevRumble final : public RumbleOutput {
 public:
  explicit EvdevRumble(int file) : file_(file) {
    effect_.type = FF_RUMBLE;
    effect_.id = -1;  // a new effect; the kernel writes its number here
    effect_.replay.length = static_cast<std::uint16_t>(1e3 * kRumbleMax);  // ms
  }
  EvdevRumble(const EvdevRumble&) = delete;
  EvdevRumble& operator=(const EvdevRumble&) = delete;
  ~EvdevRumble() override {
    play(0);
    close(file_);
  }

  void rumble(const RumbleLevel& level) override {
    if (level == RumbleLevel{}) return play(0);
    effect_.u.rumble.strong_magnitude = magnitude(level.strong);
    effect_.u.rumble.weak_magnitude = magnitude(level.weak);
    if (ioctl(file_, EVIOCSFF, &effect_) < 0) return;  // it was pulled out: nothing to stop
    play(1);
  }

 private:
  void play(int times) {
    if (effect_.id < 0) return;
    input_event event{};
    event.type = EV_FF;
    event.code = static_cast<std::uint16_t>(effect_.id);
    event.value = times;
    // If this fails, the gamepad is gone or the kernel ends the effect in time.
    [[maybe_unused]] const ssize_t written = write(file_, &event, sizeof event);
  }

  int file_;
  ff_effect effect_{};
};

}  // namespace

driver::Result<std::unique_ptr<RumbleOutput>> open_rumble(const std::filesystem::path& folder) {
  bool refused = false;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (!entry.path().filename().string().starts_with("event")) continue;
    const int file = open(entry.path().c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) {
      refused = refused || errno == EACCES;
      continue;
    }
    if (can_rumble(file)) {
      return std::unique_ptr<RumbleOutput>(std::make_unique<EvdevRumble>(file));
    }
    close(file);
  }
  return driver::Error{
      std::string("No rumble: no gamepad with rumble is plugged in") +
      (refused ? ", or its file in /dev/input is not writable. The user logged in at the screen "
                 "and the group \"input\" have access."
               : ". Plug one in and start again.")};
}

}  // namespace thimble::view
