#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include "support/identify/watched_strokes.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/device_settings.h"
using namespace thimble;
using namespace thimble::support;
static const char* kNames[] = {"none",    "all",   "one",       "touch_all", "touch_one",
                               "doubled", "stuck", "one_sided", "late",      "frozen"};
StrokedArm load(const std::string& name) {
  auto file = scene::load_arm(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/" + name + ".yaml");
  if (!file) {
    std::fprintf(stderr, "%s\n", file.error().message.c_str());
    std::exit(1);
  }
  const auto s = scene::device_settings(*file, 1000, {});
  StrokedArm arm;
  arm.model = file->model;
  arm.has_motors = !file->is<driver::ToldArm>();
  arm.R_WB = s.R_WB;
  arm.p_WB = s.p_WB;
  arm.limits = s.limits;
  arm.energy = s.energy;
  arm.watch = s.motion;
  arm.plant = file->can_simulate ? file->simulated.plant
                                 : device_sim::PlantSettings{
                                       .mass = s.motion.mass, .viscous = 0.005, .coulomb = 0.1};
  arm.velocity_corner_frequency = s.velocity_corner_frequency;
  return arm;
}
int main(int argc, char** argv) {
  // study TROUBLE DIST ARM JOINT N SEED0
  std::string trouble = argv[1], dist = argv[2], armname = argv[3];
  int joint = atoi(argv[4]), n = atoi(argv[5]);
  std::uint64_t seed0 = argc > 6 ? atoll(argv[6]) : 0;
  double stiff = argc > 7 ? atof(argv[7]) : 800;
  int t = 0;
  while (trouble != kNames[t]) ++t;
  StrokedArm base = load(armname);
  int found = 0, shown = 0, early = 0, strokes = 0, faults = 0, before = 0;
  double deepest = 0, fastest = 0, strongest = 0, unseen = 0;
  std::map<std::string, int> names;
  std::vector<double> offs, bests;
  for (int i = 0; i < n; ++i) {
    StrokedArm arm = base;
    StrokeRun run;
    run.scene.stiffness = stiff;
    double duration = 4;
    if (dist == "any") {
      duration = 2;
      strokes += draw_any(run, arm, seed0 + i, duration);
    } else
      strokes += draw_strokes(run, seed0 + i, duration);
    run.trouble = static_cast<Trouble>(t);
    run.joint = joint < 0 ? (seed0 + i) % 3 : joint;
    run.begin = 0.7;
    run_strokes(arm, run, duration);
    const bool is = fault != "none" && fault != "over_speed";
    ++names[fault];
    if (t == 0) {
      if (is) {
        ++faults;
        std::printf("FALSE %s seed %d at %.3f\n", fault.c_str(), (int)(seed0 + i), run.end);
      }
      continue;
    }
    if (is && run.shown_at < 0) {
      ++before;
      continue;
    }
    if (run.shown_at >= 0) {
      ++shown;
      const bool ok = is && (run.off_since <= 0.005 || run.end - run.shown_at <= 0.030);
      if (getenv("V") && !ok)
        std::printf("MISS seed %d %s shown %.3f end %.3f off %.1f mm v %.2f f %.1f\n",
                    (int)(seed0 + i), fault.c_str(), run.shown_at, run.end, 1e3 * run.off_since,
                    run.speed, run.force_true);
      found += is;
      early += ok;
      if (is) offs.push_back(run.off_since);
      deepest = std::max(deepest, run.off_since);
      fastest = std::max(fastest, run.speed);
      strongest = std::max(strongest, run.force_true);
      unseen = std::max(unseen, run.unseen);
    }
  }
  std::sort(offs.begin(), offs.end());
  std::printf(
      "%-10s %-8s %-16s j%d: runs %d strokes %d shown %d found %d within %d (%.1f%%) early-before "
      "%d | off median %.1f max %.1f mm v %.2f F %.1f unseen %.1f |",
      trouble.c_str(), dist.c_str(), armname.c_str(), joint, n, strokes, shown, found, early,
      shown ? 100.0 * early / shown : 0, before, offs.empty() ? 0 : 1e3 * offs[offs.size() / 2],
      1e3 * deepest, fastest, strongest, 1e3 * unseen);
  for (auto& [k, v] : names) std::printf(" %s:%d", k.c_str(), v);
  std::sort(bests.rbegin(), bests.rend());
  if (t == 0) {
    std::printf(" best:");
    for (int i = 0; i < 6 && i < (int)bests.size(); ++i) std::printf(" %.2f", bests[i]);
  }
  std::printf("\n");
}
