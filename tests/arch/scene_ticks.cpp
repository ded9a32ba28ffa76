#include <cstdio>
#include <cstdlib>
#include <memory>

#include "thimble/session/session.h"

// Opens a scene on its simulated arm and runs its first ticks in virtual time, so that callgrind
// can count their instructions:
//   scene_ticks SCENE TICKS      prints the number of ticks in contact
int main(int argc, char** argv) {
  using namespace thimble;
  if (argc != 3) return 2;
  auto opened = session::Session::open(argv[1], {.mesh_folder = THIMBLE_MESHES});
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  session::Session& run = **opened;
  long contact = 0;
  const long ticks = std::atol(argv[2]);
  for (long tick = 0; tick < ticks; ++tick) {
    if (run.step()) return 1;
    contact += run.ticks().back().in_contact ? 1 : 0;
  }
  std::printf("%ld\n", contact);
  return 0;
}
