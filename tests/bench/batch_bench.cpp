#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "report/figure_output.h"
#include "studies/resident_memory.h"
#include "support/meshes/bench_meshes.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/session/session_batch.h"

// Benchmark of many arms of one scene, stepped in turns on one core, compared with a single arm;
// and of several such processes. A hand strokes a bumpy ball of 10^5 triangles, or a sphere. Times
// are processor times, which depend little on other load, except where many arms share the cache
// with it; only the set-up is measured by the wall clock.
//
// bench_batch [--arms=1000] [--processes=8] [--figures=FILE]

namespace thimble::bench {
namespace {

constexpr int kRounds = 5;                        // in turns; medians are reported
constexpr std::uint32_t kTicksOfRound = 300'000;  // for all arms together

constexpr const char* kScene = R"(name: ball
arm: vintage_phantom
duration: 60
objects:
  - name: ball
    SHAPE
    position: [0, 0, -0.03]
    stiffness: 500
    damping: 1
hand:
  path:
    - {t: 0, at: [0, -0.02, 0.04]}
    - {t: 0.5, on: ball, near: [0, -0.02, 0.016], press: 0.005}
)";

/// Writes a scene: a hand that strokes a ball back and forth for a minute and never lifts off.
std::filesystem::path write_scene(const std::filesystem::path& folder, const std::string& name,
                                  const std::string& shape) {
  std::string scene = kScene;
  scene.replace(scene.find("SHAPE"), 5, shape);
  std::ofstream text(folder / name);
  text << scene;
  for (int k = 1; k < 100; ++k) {
    text << "    - {t: " << 0.5 + 0.59 * k << ", on: ball, near: [0, " << (k % 2 ? 0.02 : -0.02)
         << ", 0.016], press: 0.005}\n";
  }
  text.close();
  return text ? folder / name : std::filesystem::path();
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

using Batch = std::unique_ptr<session::SessionBatch>;

Batch open(const std::filesystem::path& scene, std::size_t arms) {
  auto opened = session::SessionBatch::open(scene, arms);
  if (opened) return std::move(opened).value();
  std::fprintf(stderr, "%s\n", opened.error().message.c_str());
  return nullptr;
}

/// Returns the ticks per processor second of one round.
double rate(session::SessionBatch& batch, std::uint32_t ticks_at_once, std::uint32_t ticks) {
  const auto turns =
      std::max<std::uint32_t>(1, ticks / static_cast<std::uint32_t>(batch.size()) / ticks_at_once);
  const double begin = processor_seconds();
  for (std::uint32_t k = 0; k < turns; ++k) batch.step(ticks_at_once);
  const double time = processor_seconds() - begin;
  return static_cast<double>(batch.size()) * turns * ticks_at_once / time;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

bool all_touch(const session::SessionBatch& batch) {
  return std::all_of(batch.newest().begin(), batch.newest().end(),
                     [](const driver::TickRecord& tick) { return tick.in_contact; });
}

/// Steps arms in several processes at the same time. Returns the ticks per processor second of each
/// process; empty if one failed.
std::vector<double> rates_of_processes(const std::filesystem::path& scene, int processes,
                                       std::size_t arms) {
  int pipes[2];
  if (pipe(pipes) != 0) return {};
  for (int i = 0; i < processes; ++i) {
    if (fork() != 0) continue;
    const Batch batch = open(scene, arms);
    if (!batch) _exit(1);
    batch->step(700);  // down to the ball
    const double found = rate(*batch, 10, 4 * kTicksOfRound);
    _exit(write(pipes[1], &found, sizeof found) == sizeof found ? 0 : 1);
  }
  close(pipes[1]);
  std::vector<double> rates;
  for (double one = 0; read(pipes[0], &one, sizeof one) == sizeof one;) rates.push_back(one);
  close(pipes[0]);
  while (wait(nullptr) > 0) {
  }
  if (rates.size() != static_cast<std::size_t>(processes)) return {};
  return rates;
}

class Bench {
 public:
  bool run(const std::filesystem::path& folder, std::size_t arms, int processes) {
    const auto mesh = support::bench_ball(support::BumpyBall(), 100'000);
    if (const auto saved = render::save_mesh(mesh, folder / "ball.off"); !saved) {
      std::fprintf(stderr, "%s\n", saved.error().message.c_str());
      return false;
    }
    const auto scene =
        write_scene(folder, "ball.yaml", "mesh: ball.off\n    contact: {tracker: compact}");
    const auto simple = write_scene(folder, "sphere.yaml", "sphere: {radius: 0.05}");
    if (scene.empty() || simple.empty()) return false;
    const auto each = std::max<std::size_t>(1, arms / static_cast<std::size_t>(processes));
    const std::vector<double> one = rates_of_processes(scene, 1, each);
    const std::vector<double> beside = rates_of_processes(scene, processes, each);
    if (one.empty() || beside.empty()) return false;
    const std::string all = std::to_string(arms) + " arms";
    if (!compare(scene, arms, all, "") || !compare(simple, arms, all + " on a sphere", ">= 1e6")) {
      return false;
    }
    add(std::to_string(processes) + " processes on " +
            std::to_string(std::thread::hardware_concurrency()) + " cores, each over one alone",
        median(beside) / one.front(), "", ">= 0.9");
    return true;
  }
  const std::vector<session::Figure>& figures() const { return figures_; }

 private:
  /// Compares the rate of many arms with that of one. `goal` is that of the rate with one tick at
  /// once.
  bool compare(const std::filesystem::path& scene, std::size_t arms, const std::string& all,
               const std::string& goal) {
    const Batch alone = open(scene, 1);
    if (!alone) return false;
    const std::size_t before = studies::resident_memory().now;
    const auto begin = std::chrono::steady_clock::now();
    const Batch many = open(scene, arms);
    if (!many) return false;
    const std::chrono::duration<double> made = std::chrono::steady_clock::now() - begin;
    add(all + ": made in", made.count(), "s");
    // A later batch also uses memory that an earlier one has freed.
    if (figures_.size() == 1) {
      add(all + ": memory of each",
          static_cast<double>(studies::resident_memory().now - before) / 1024 /
              static_cast<double>(arms),
          "KiB");
    }
    alone->step(700);
    many->step(700);
    if (!all_touch(*alone) || !all_touch(*many)) {
      std::fprintf(stderr, "Not every hand touches the ball.\n");
      return false;
    }
    for (const std::uint32_t at_once : {1U, 10U, 100U}) {
      std::vector<double> of_one, of_many, share;
      for (int round = 0; round < kRounds; ++round) {
        // A single run ends too soon for a round of the same length.
        of_one.push_back(rate(*alone, at_once, 3000));
        of_many.push_back(rate(*many, at_once, kTicksOfRound));
        share.push_back(of_many.back() / of_one.back());
      }
      const std::string turns = ", " + std::to_string(at_once) + " ticks at once";
      if (at_once == 10) add("one arm of " + all + turns, median(of_one), "1/s");
      add(all + turns, median(of_many), "1/s", at_once == 1 ? goal : "");
      add(all + turns + ", over one arm", median(share), "", ">= 0.9");
    }
    return true;
  }

  void add(const std::string& name, double value, const std::string& unit,
           const std::string& goal = "") {
    figures_.push_back({.name = name, .value = value, .unit = unit, .goal = goal});
    std::printf("%s: %g %s\n", name.c_str(), value, unit.c_str());
    std::fflush(stdout);
  }
  std::vector<session::Figure> figures_;
};

}  // namespace
}  // namespace thimble::bench

int main(int argc, char** argv) {
  std::string figures_file;
  std::size_t arms = 1000;
  int processes = 8;
  for (int i = 1; i < argc; ++i) {
    const auto value_of = [argument = argv[i]](const char* option) -> const char* {
      const std::size_t length = std::strlen(option);
      return std::strncmp(argument, option, length) == 0 ? argument + length : nullptr;
    };
    if (const char* file = value_of("--figures=")) {
      figures_file = std::filesystem::absolute(file).string();
    } else if (const char* count = value_of("--arms=")) {
      arms = static_cast<std::size_t>(std::max(1L, std::atol(count)));
    } else if (const char* some = value_of("--processes=")) {
      processes = std::max(1, std::atoi(some));
    } else {
      std::fprintf(stderr, "bench_batch [--arms=1000] [--processes=8] [--figures=FILE]\n");
      return 2;
    }
  }
  std::filesystem::current_path(THIMBLE_SOURCE_DIR);  // arms are found by name there
  const auto folder =
      std::filesystem::temp_directory_path() / ("thimble_batch_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  thimble::bench::Bench bench;
  const bool done = bench.run(folder, arms, processes);
  std::filesystem::remove_all(folder);
  if (!done) return 1;
  std::printf("\n%s", thimble::report::figure_table(bench.figures()).c_str());
  if (figures_file.empty()) return 0;
  const auto written = thimble::report::write_figures(bench.figures(), figures_file);
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return written ? 0 : 1;
}
