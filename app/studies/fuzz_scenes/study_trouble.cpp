#include "studies/fuzz_scenes/study_trouble.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string>
#include <system_error>
#include <utility>

#include "studies/fuzz_scenes/random_scene.h"
#include "studies/fuzz_scenes/small_meshes.h"
#include "studies/fuzz_scenes/trouble_run.h"
#include "studies/run_pages.h"
#include "text_file.h"
#include "thimble/scene/build_info.h"

namespace thimble::studies {
namespace {

constexpr int kTries = 12;           // attempts: a scene rejected by the loader is replaced
constexpr std::size_t kWorst = 10;   // scenes kept
constexpr std::size_t kShown = 3;    // of them with a page; chosen: as many as a reader looks at
constexpr double kGivenMuch = 1e-3;  // J, reported

/// A folder for scene files of this process; the destructor removes it.
class SceneFolder {
 public:
  SceneFolder() {
    // A name that another user cannot guess. If the folder cannot be made, writing the first file
    // fails.
    std::string name = (std::filesystem::temp_directory_path() / "thimble-XXXXXX").string();
    path_ = mkdtemp(name.data()) != nullptr ? name : "/dev/null/no-temporary-folder";
  }
  ~SceneFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::uint64_t try_seed(std::uint64_t seed, std::size_t cell, int attempt) {
  return cell_seed(cell_seed(seed, cell), static_cast<std::size_t>(attempt));
}

std::string seed_name(std::uint64_t seed) {
  return fmt::format("{:016x}", seed);
}

/// Draws and runs scenes until the loader accepts one; adds the number of rejected scenes.
driver::Result<std::vector<double>> measure(std::size_t cell, std::uint64_t seed,
                                            const RandomSceneLimits& limits,
                                            const std::filesystem::path& folder) {
  TroubleFound found;
  int attempt = 0;
  for (; attempt < kTries; ++attempt) {
    const std::uint64_t drawn = try_seed(seed, cell, attempt);
    const RandomScene scene = random_scene(drawn, limits);
    const std::filesystem::path file = folder / (seed_name(drawn) + ".yaml");
    if (auto done = report::write_text(scene.text, file); !done) return done.error();
    found = run_for_trouble(file, scene);
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    if (!found.refused) break;
  }
  std::vector<double> numbers = numbers_of(found);
  numbers.push_back(attempt);
  return numbers;
}

std::string table_of(const CellNumbers& cells, std::uint64_t seed) {
  std::string csv =
      "cell,seed,refused,not_finite_ticks,fault,force_share,limit_cycle_N,speed_m_s,"
      "given_J,given_bound_J,contact_share,must_oscillate,unforetold\n";
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const TroubleFound f = trouble_of(cells[cell]);
    const auto attempt = static_cast<int>(cells[cell].back());
    csv += fmt::format("{},{},{},{:.17g},{:.17g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{}\n",
                       cell, seed_name(try_seed(seed, cell, attempt)), attempt, f.not_finite,
                       f.fault, f.force_share, f.limit_cycle, f.speed, f.given, f.given_bound,
                       f.contact, f.must_oscillate ? 1 : 0, f.unforetold ? 1 : 0);
  }
  return csv;
}

/// Writes the worst scenes with their results, so that they can be run separately, and pages of the
/// very worst.
driver::Result<void> keep_worst(const CellNumbers& cells, std::uint64_t seed,
                                RandomSceneLimits limits, const std::filesystem::path& folder) {
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return trouble_of(cells[a]).badness() > trouble_of(cells[b]).badness();
  });
  limits.mesh_path = "meshes";
  std::error_code status;
  std::filesystem::remove_all(folder, status);
  if (auto done = write_small_meshes(folder / "meshes"); !done) return done;
  order.resize(std::min(order.size(), kWorst));
  RunPages pages(folder, "The worst of the random scenes",
                 "Each is a scene file (thimble run FILE --view).");
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const std::size_t cell = order[rank];
    const TroubleFound f = trouble_of(cells[cell]);
    const std::uint64_t drawn = try_seed(seed, cell, static_cast<int>(cells[cell].back()));
    const RandomScene scene = random_scene(drawn, limits);
    const std::string showed = fmt::format(
        "limit cycle {:.3g} N, fault {:.0f}, {:.3g} times the arm's maximum force; "
        "{:.3g} J generated in one window, {:.3g} J allowed.",
        f.limit_cycle, f.fault, f.force_share, f.given, f.given_bound);
    const std::string heading =
        fmt::format("# own_energy: {:.9g} J; {}\n", scene.own_energy, showed);
    const std::string name = fmt::format("{:02}_{}", rank + 1, seed_name(drawn));
    const std::filesystem::path file = folder / (name + ".yaml");
    if (auto done = report::write_text(heading + scene.text, file); !done) return done;
    pages.list(name + ".yaml", showed);
    if (rank >= kShown) continue;
    if (auto done = pages.add(file, name, "its recorded run."); !done) return done;
  }
  return pages.write();
}

}  // namespace

driver::Result<TroubleReport> study_trouble(const TroubleOptions& options,
                                            const SweepOptions& sweep_options,
                                            const std::atomic<bool>& stop) {
  const auto arm = scene::load_arm(options.arm_file);
  if (!arm) return arm.error();
  if (!arm->can_simulate || arm->is<driver::DeltaArm>()) {
    return driver::Error{
        arm->name +
        ": the study needs a simulated arm whose board sends reports on its own. Use "
        "another arm file, for example vintage_phantom.yaml."};
  }
  const SceneFolder scratch;
  if (auto done = write_small_meshes(scratch.path() / "meshes"); !done) return done.error();
  const RandomSceneLimits limits{
      .arm = *arm,
      .arm_path = std::filesystem::absolute(options.arm_file).lexically_normal().string(),
      .mesh_path = "meshes"};
  const Sweep sweep{.name = "trouble",
                    .key = scene::program_name() + "\n" + scene::text_of(options.arm_file) + "\n" +
                           std::to_string(options.seed),
                    .cells = options.count,
                    .measure = [&](std::size_t cell) {
                      return measure(cell, options.seed, limits, scratch.path());
                    }};
  const auto result = run_sweep(sweep, sweep_options, stop);
  if (!result) return result.error();
  TroubleReport report{result->end, {}};
  if (report.end != SweepEnd::kDone) return report;

  double refused = 0, given_up = 0, not_finite = 0, faults = 0, over = 0, grown = 0;
  double given_scenes = 0, oscillating = 0, unforetold = 0;
  double given = 0, nearest = 0, share = 0, limit_cycle = 0, known = 0, contact = 0;
  for (const auto& cell : result->numbers) {
    const TroubleFound f = trouble_of(cell);
    refused += cell.back();
    given_up += f.refused ? 1 : 0;
    not_finite += f.not_finite > 0 ? 1 : 0;
    faults += f.fault > 0 ? 1 : 0;
    over += f.force_share > 1 + 1e-9 ? 1 : 0;
    grown += !f.refused && !(f.given <= f.given_bound) ? 1 : 0;
    if (!f.refused) nearest = std::max(nearest, f.given / f.given_bound);
    given = std::max(given, f.given);
    given_scenes += f.given > kGivenMuch ? 1 : 0;
    oscillating += !f.must_oscillate && f.limit_cycle > kLimitCycleMax ? 1 : 0;
    unforetold += f.unforetold ? 1 : 0;
    share = std::max(share, f.force_share);
    (f.must_oscillate ? known : limit_cycle) =
        std::max(f.must_oscillate ? known : limit_cycle, f.limit_cycle);
    contact += f.contact;
  }
  const auto count = static_cast<double>(options.count);
  report.figures = {{"scenes", count - given_up, "", ""},
                    {"scenes_refused_by_the_loader", refused, "", ""},
                    {"share_of_ticks_in_contact", contact / count, "", ">= 0.2"},
                    {"scenes_with_numbers_that_are_none", not_finite, "", "== 0"},
                    {"scenes_with_faults", faults, "", "== 0"},
                    {"scenes_above_the_arms_force", over, "", "== 0"},
                    {"scenes_that_gave_more_than_the_gate_lets_go", grown, "", "== 0"},
                    {"most_energy_given_of_what_the_gate_lets_go", nearest, "", ""},
                    {"most_energy_given_in_one_window", given, "J", ""},
                    {"scenes_whose_motors_gave_over_1_mJ", given_scenes, "", ""},
                    {"largest_force_share", share, "", ""},
                    {"largest_limit_cycle_at_rest", limit_cycle, "N", ""},
                    {"scenes_with_limit_cycles_at_rest_over_20_mN", oscillating, "", ""},
                    {"of_those_no_warning_foretold", unforetold, "", "== 0"},
                    {"largest_limit_cycle_of_naive_and_paper_friction", known, "N", ""}};
  const std::filesystem::path& folder = sweep_options.folder;
  if (auto done =
          report::write_text(table_of(result->numbers, options.seed), folder / "trouble.csv");
      !done) {
    return done.error();
  }
  if (auto done = keep_worst(result->numbers, options.seed, limits, folder / "worst"); !done) {
    return done.error();
  }
  return report;
}

}  // namespace thimble::studies
