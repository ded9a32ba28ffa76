#include <malloc.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "study/cost_subjects.h"
#include "study/ring_surface.h"

// Touches one cost subject for some strokes, so that somebody else can count what a tick executes:
//   effect_ticks SUBJECT STROKES      prints the bytes that the object holds
// Linked with all effects and with fewer (effect_table.cpp): the counts must be the same.
int main(int argc, char** argv) {
  using namespace thimble;
  if (argc != 3) return 2;
  const auto states = app::ring_stroke(app::kCostRing, 1000, 0.001);
  for (const app::CostSubject& subject : app::cost_subjects()) {
    if (subject.name != argv[1]) continue;
    const auto before = mallinfo2();
    const auto touch = subject.build();
    const auto after = mallinfo2();
    if (!touch) return 1;
    double sum = 0;
    for (int i = 0; i < std::atoi(argv[2]); ++i) {
      for (const auto& state : states) sum += (*touch)->update(state).f_T_W.norm();
    }
    std::fprintf(stderr, "force summed %g N\n", sum);
    std::printf("%zu\n", after.uordblks + after.hblkhd - before.uordblks - before.hblkhd);
    return sum > 0 ? 0 : 1;
  }
  return 2;
}
