// Two simulated arms in one scene: each hand holds one end of a beam, and both lift it. Prints the
// part of the weight that each hand carries.
#include <cstdio>

#include "thimble/scene/scene_builder.h"
#include "thimble/session/session.h"

namespace driver = thimble::driver;
using thimble::scene::SceneMap;

int complain(const driver::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

int main() {
  constexpr double kMass = 0.15;  // kg
  thimble::scene::SceneBuilder lift("lift");
  lift.duration(4).seed(1).gravity({0, 0, -9.81});  // s; m/s^2
  // Each arm has its own place in the world, gate and hand. The right one is turned around.
  lift.add_arm("left", "vintage_phantom")
      .at({0, -0.06, 0})
      .hand()
      .at(0, {0, -0.045, -0.03})
      .at(2, {0, -0.045, 0.02}, true)
      .at(4, {0, -0.045, 0.02});
  lift.add_arm("right", "vintage_phantom")
      .at({0, 0.06, 0}, 180)
      .hand()
      .at(0, {0, 0.045, -0.03})
      .at(2, {0, 0.045, 0.02}, true)
      .at(4, {0, 0.045, 0.02});
  lift.object("beam")
      .box({0.02, 0.12, 0.02})  // m
      .position({0, 0, -0.03})
      .stiffness(700)  // N/m
      .damping(2)      // N s/m
      .body({{"motion", SceneMap{{"kind", "rigid"},
                                 {"mass", kMass},
                                 {"floor", -0.04},  // m
                                 {"damping", 0.2},
                                 {"angular_damping", 0.0002},
                                 {"hold", 400},  // N/m, of each hand's grip
                                 {"hold_damping", 3},
                                 {"hold_force", 4}}}});  // N: above it the beam slips

  auto run = thimble::session::Session::open(lift, {.several_arms = true});
  if (!run) return complain(run.error());
  thimble::session::Session& both = **run;
  both.run();  // or `step`: one tick of each arm, then of the beam
  double carried = 0;
  for (std::size_t arm = 0; arm < both.arms(); ++arm) {
    const driver::TickRecord& last = both.ticks(arm).back();
    std::printf("%s: %.2f N\n", both.arm_name(arm).c_str(), -last.f_sent_W[2]);
    carried -= last.f_sent_W[2];
  }
  std::printf("Both hands carry %.2f N of %.2f N.\n", carried, kMass * 9.81);
  return carried > 0.9 * kMass * 9.81 && carried < 1.1 * kMass * 9.81 ? 0 : 1;
}
