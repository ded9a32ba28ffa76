// Runs a scene with half of its force, prints a summary, records every tick, and replays the
// recorded motion of the hand on the scene.
//   09_run_a_scene [SCENE] [FILE.h5]     a name or a path
#include <cstdio>

#include "thimble/render/scene_touch.h"
#include "thimble/session/session.h"

namespace driver = thimble::driver;
namespace session = thimble::session;

int complain(const driver::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

int main(int argc, char** argv) {
  const char* file = argc > 2 ? argv[2] : "touch.h5";
  // Without `overwrite` an existing recording is kept, and `open` fails.
  auto run =
      session::Session::open(argc > 1 ? argv[1] : "rubber", {.record = file, .overwrite = true});
  if (!run) return complain(run.error());
  session::Session& touch = **run;
  // Custom force law, called in each tick of virtual time. Without it the scene's own force is
  // used.
  auto softer = [&](const driver::DeviceState& state) noexcept {
    driver::ForceCommand command = touch.touch()(state);
    command.f_T_W *= 0.5;
    return command;
  };
  if (auto set = touch.set_law(driver::ForceLaw(softer)); !set) return complain(set.error());
  touch.run();  // or `step` for single ticks
  std::printf("%s", summary(touch.figures()).c_str());
  if (auto ended = touch.end_recording(); !ended) return complain(ended.error());

  auto recording = session::read_recording(file);
  if (!recording) return complain(recording.error());
  auto again = session::replay(*recording);  // with the scene's own law
  if (!again) return complain(again.error());
  std::printf("Replayed: %zu ticks, largest difference %.2f N.\n", again->felt.ticks.size(),
              again->compared.largest);
  return again->compared.largest > 0.1 ? 0 : 1;
}
