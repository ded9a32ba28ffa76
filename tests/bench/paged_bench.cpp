#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "disk_paging/paged_contact.h"
#include "paged_slide.h"
#include "paged_ticks.h"
#include "report/figure_output.h"
#include "studies/resident_memory.h"
#include "studies/ring_pages.h"
#include "studies/tube_mesh.h"
#include "track/packed_contact_in_memory.h"

// A tip that slides at 0.5 m/s over a ring of 10^7 (--long: 10^8) triangles on disk, in a 1 kHz
// loop that sleeps, with a loader thread; compared with 10^6 triangles in memory, in turns. Before
// that, ticks of rings of 10^5 to 10^7 triangles with the loading between them (paged_ticks.h).

namespace thimble::bench {
namespace {

using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

constexpr int kTurns = 5;
constexpr int kTurnTicks = 2000;

// One contender on its path.
template <class Contact>
class Slide {
 public:
  explicit Slide(Contact& contact) : contact_(contact) { state_.dt = kTick; }

  // Moves from outside to the pressed depth within a tenth of a second.
  void approach() {
    for (int i = 0; i <= 100; ++i) {
      move(way_.at(2e-3 - (2e-3 + kPressed) * i / 100));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  void run(int ticks, Ticks& result) {
    auto next = Clock::now();
    for (int i = 0; i < ticks; ++i) {
      const Vector3d p = way_.next(kSpeed);
      next += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(next);
      const auto begin = Clock::now();
      const render::ContactState& felt = move(p);
      result.ns.push_back(seconds_since(begin) * 1e9);
      if (!felt.touching) continue;
      ++result.touching;
      result.error += std::abs(felt.depth - kPressed);
    }
  }

 private:
  const render::ContactState& move(const Vector3d& p) {
    state_.v_WT = state_.tick++ > 0 ? Vector3d((p - state_.p_WT) / kTick) : Vector3d::Zero();
    state_.p_WT = p;
    return contact_.update(state_);
  }

  Contact& contact_;
  Way way_;
  driver::DeviceState state_;
};

render::TriangleMesh ring_mesh(std::int64_t triangles) {
  const studies::RingGrid grid = studies::ring_grid(kRing, triangles);
  return studies::tube_mesh(grid.around, grid.across,
                            [](double u, double v) { return kRing.at(u, v); });
}

class Bench {
 public:
  // Returns false and prints an error to stderr if the file cannot be written.
  bool run(const std::string& size, std::int64_t triangles, const std::filesystem::path& folder) {
    const auto file = folder / ("ring_" + std::to_string(triangles) + ".pages");
    auto begin = Clock::now();
    const studies::RingGrid grid = studies::ring_grid(kRing, triangles);
    if (const auto written = studies::write_ring(kRing, grid, file); !written) {
      std::fprintf(stderr, "%s\n", written.error().message.c_str());
      return false;
    }
    add(size + ": generate", seconds_since(begin), "s");
    add(size + ": generate, memory", megabytes(studies::resident_memory().now), "MiB");
    add(size + ": page file", static_cast<double>(std::filesystem::file_size(file)) / 1e6, "MB");
    begin = Clock::now();
    auto reference = render::InMemoryContact::build(ring_mesh(1'000'000));
    if (!reference) return false;
    for (const bool cold : {false, true}) {
      if (!slide(size + (cold ? ", disk cache emptied" : ""), file, *reference, cold)) return false;
    }
    std::filesystem::remove(file);
    return true;
  }

  const std::vector<session::Figure>& figures() const { return figures_; }

 private:
  static double megabytes(std::size_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

  void add(const std::string& name, double value, const std::string& unit,
           const std::string& goal = {}) {
    figures_.push_back({.name = name, .value = value, .unit = unit, .goal = goal});
    std::printf("%s", report::figure_table({figures_.back()}).c_str());
    std::fflush(stdout);
  }

  bool slide(const std::string& name, const std::filesystem::path& file,
             render::InMemoryContact& reference, bool cold) {
    if (cold) forget(file);
    auto opened = render::PagedSurface::open(file);
    if (!opened) {
      std::fprintf(stderr, "%s\n", opened.error().message.c_str());
      return false;
    }
    const std::shared_ptr<render::PagedSurface> surface = std::move(opened).value();
    surface->start_loader();
    render::PagedContact paged(surface);
    Slide ours(paged);
    Slide theirs(reference);
    ours.approach();
    theirs.approach();
    Ticks on_disk, in_memory;
    for (int turn = 0; turn < kTurns; ++turn) {
      ours.run(kTurnTicks, on_disk);
      theirs.run(kTurnTicks, in_memory);
    }
    const auto ticks = static_cast<double>(on_disk.ns.size());
    add(name + ": page misses", static_cast<double>(paged.misses()), "ticks", "== 0");
    add(name + ": contact lost", ticks - static_cast<double>(on_disk.touching), "ticks", "== 0");
    add(name + ": depth error", on_disk.error * 1e3 / static_cast<double>(on_disk.touching), "mm",
        "<= 0.01");
    add(name + ": pages read", static_cast<double>(surface->counters().loads), "");
    add(name + ": pages read per s",
        static_cast<double>(surface->counters().loads) / (ticks * kTick), "1/s");
    add(name + ": hops cut short", static_cast<double>(paged.counters().long_walks), "ticks");
    add(name + ": memory, with the mesh of 10^6", megabytes(studies::resident_memory().now), "MiB",
        "< 1024");
    add(name + ": memory of the pages", megabytes(surface->bytes()), "MiB");
    add(name + ": tick in the loop, mean", on_disk.mean(), "ns");
    add(name + ": tick in the loop, p50", on_disk.percentile(0.5), "ns");
    add(name + ": tick in the loop, p99", on_disk.percentile(0.99), "ns");
    add(name + ": tick in the loop, 10^6 in memory, mean", in_memory.mean(), "ns");
    add(name + ": tick in the loop, 10^6 in memory, p50", in_memory.percentile(0.5), "ns");
    add(name + ": tick in the loop, 10^6 in memory, p99", in_memory.percentile(0.99), "ns");
    add(name + ": p99, pages / memory", on_disk.percentile(0.99) / in_memory.percentile(0.99), "",
        "<= 2");
    return true;
  }

  std::vector<session::Figure> figures_;
};

}  // namespace
}  // namespace thimble::bench

int main(int argc, char** argv) {
  // --figures=FILE writes the figures, --folder=FOLDER is the folder of the page files (default:
  // the folder for temporary files), --max=N stops at N triangles (default 1e7), --long continues
  // to 10^8 (6.4 GB of disk).
  std::string figures_file;
  std::filesystem::path folder = std::filesystem::temp_directory_path();
  double most = 1e7;
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], "--figures=", 10) == 0) {
      figures_file = argv[i] + 10;
    } else if (std::strncmp(argv[i], "--folder=", 9) == 0) {
      folder = argv[i] + 9;
    } else if (std::strncmp(argv[i], "--max=", 6) == 0) {
      most = std::atof(argv[i] + 6);
    } else if (std::strcmp(argv[i], "--long") == 0) {
      most = 1e8;
    } else {
      std::fprintf(stderr,
                   "Unknown option %s. Options: --figures=FILE --folder=FOLDER --max=N --long\n",
                   argv[i]);
      return 2;
    }
  }
  thimble::bench::Bench bench;
  std::vector<thimble::session::Figure> ticks;
  if (!thimble::bench::time_paged_ticks(folder, most, ticks)) return 1;
  std::int64_t triangles = 10'000'000;
  for (int power = 7; power <= 8 && static_cast<double>(triangles) <= most; ++power) {
    if (!bench.run("10^" + std::to_string(power), triangles, folder)) return 1;
    triangles *= 10;
  }
  ticks.insert(ticks.end(), bench.figures().begin(), bench.figures().end());
  std::printf("\n%s", thimble::report::figure_table(ticks).c_str());
  if (!figures_file.empty()) {
    const auto written = thimble::report::write_figures(ticks, figures_file);
    if (!written) {
      std::fprintf(stderr, "%s\n", written.error().message.c_str());
      return 1;
    }
  }
  return 0;
}
