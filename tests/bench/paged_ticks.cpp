#include "paged_ticks.h"

#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <string>
#include <utility>

#include "disk_paging/paged_contact.h"
#include "paged_slide.h"
#include "report/figure_output.h"
#include "thimble/session/session.h"

namespace thimble::bench {
namespace {

constexpr int kTicks = 8000;
constexpr int kRepetitions = 3;  // the fastest one counts: the machine is shared

void add(std::vector<session::Figure>& figures, const std::string& name, double value,
         const std::string& unit, const std::string& goal = {}) {
  figures.push_back({.name = name, .value = value, .unit = unit, .goal = goal});
  std::printf("%s", report::figure_table({figures.back()}).c_str());
  std::fflush(stdout);
}

/// Returns the processor time of this thread, ns: the machine may be shared.
double processor_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// Returns the processor time of a call of `processor_ns`.
double clock_ns() {
  constexpr int kCalls = 1000;
  const double begin = processor_ns();
  for (int i = 0; i < kCalls; ++i) processor_ns();
  return (processor_ns() - begin) / kCalls;
}

/// Ticks of one slide.
struct Slid {
  Ticks ticks;         // wall-clock times, with the loading after each
  double contact = 0;  // processor time of a tick without loading, ns
  double both = 0;     // and with it
  double pages = 0;    // read per tick
};

driver::Result<Slid> slide(const std::filesystem::path& file, double speed, bool cold) {
  if (cold) forget(file);
  auto opened = render::PagedSurface::open(file);
  if (!opened) return opened.error();
  const std::shared_ptr<render::PagedSurface> surface = std::move(opened).value();
  render::PagedContact contact(surface);
  Way way;
  driver::DeviceState state;
  state.dt = kTick;
  const auto move = [&](const Vector3d& p) {
    state.v_WT = state.tick++ > 0 ? Vector3d((p - state.p_WT) / kTick) : Vector3d::Zero();
    state.p_WT = p;
    contact.update(state);
  };
  const auto load = [&] {
    while (surface->serve() > 0) {
    }
  };
  for (int i = 0; i <= 100; ++i) {
    move(way.at(2e-3 - (2e-3 + kPressed) * i / 100));
    load();
  }
  Slid result;
  const auto before = static_cast<double>(surface->counters().loads);
  const double clock = clock_ns();
  for (int i = 0; i < kTicks; ++i) {
    const Vector3d p = way.next(speed);
    const auto begin = Clock::now();
    const double before_contact = processor_ns();
    move(p);
    const double after_contact = processor_ns();
    load();
    result.contact += (after_contact - before_contact - clock) / kTicks;
    result.both += (processor_ns() - before_contact - 2 * clock) / kTicks;
    result.ticks.ns.push_back(seconds_since(begin) * 1e9);
  }
  result.pages = (static_cast<double>(surface->counters().loads) - before) / kTicks;
  return result;
}

/// Writes a scene in which the hand strokes the ring, and returns the time of a tick of its run in
/// virtual time, ns: arm, contact, gate and loading. Processor time; wall-clock time if `cold`.
driver::Result<double> run_tick(const std::filesystem::path& file, bool cold) {
  if (cold) forget(file);
  const auto scene = file.parent_path() / "paged_bench.yaml";
  std::ofstream(scene) << "name: ring\narm: " THIMBLE_SOURCE_DIR
                          "/app/arms/vintage_phantom.yaml\nduration: 8\nseed: 1\nobjects:\n"
                          "  - {name: ring, mesh: "
                       << file.filename()
                       << ", size: 0.09, stiffness: 700, damping: 1}\nhand:\n  path:\n"
                          "    - {t: 0, at: [0.0317, 0, 0.035]}\n"
                          "    - {t: 0.8, at: [0.0317, 0, 0.009]}\n"
                          "    - {t: 1.8, at: [0, 0.0317, 0.009]}\n"
                          "    - {t: 2.8, at: [-0.0317, 0, 0.009]}\n"
                          "    - {t: 3.8, at: [0, -0.0317, 0.009]}\n"
                          "    - {t: 4.8, at: [0.0317, 0, 0.009]}\n"
                          "    - {t: 5.8, at: [0, 0.029, 0.009]}\n"
                          "    - {t: 6.8, at: [-0.029, 0, 0.009]}\n"
                          "    - {t: 8, at: [0, -0.029, 0.009]}\n";
  const auto opened = session::Session::open(scene, {});
  if (!opened) return opened.error();
  const auto begin = Clock::now();
  const double processor_begin = processor_ns();
  (*opened)->run();
  const double ns = cold ? seconds_since(begin) * 1e9 : processor_ns() - processor_begin;
  std::filesystem::remove(scene);
  return ns / static_cast<double>((*opened)->figures().statistics.ticks());
}

/// Measures one size and adds its figures; `small` has the means of the first size, in the order of
/// the measurements, and is filled by it.
driver::Result<void> measure(const std::string& size, const std::filesystem::path& file,
                             std::vector<double>& small, std::vector<session::Figure>& figures) {
  const bool first = small.empty();
  std::size_t next = 0;
  const auto add_mean = [&](const std::string& name, double ns) {
    add(figures, name, ns, "ns");
    if (first) {
      small.push_back(ns);
    } else {
      add(figures, name + " / 10^5", ns / small[next++], "", "<= 1.5");
    }
  };
  for (const bool cold : {false, true}) {
    // Without the cache the processor waits for the disk, and that counts.
    const std::string cache = cold ? ", disk cache emptied, wall clock" : "";
    double fastest = HUGE_VAL;
    for (int i = 0; i < kRepetitions; ++i) {
      const auto ns = run_tick(file, cold);
      if (!ns) return ns.error();
      fastest = std::min(fastest, *ns);
    }
    add_mean(size + cache + ": tick of a run with its loading, mean", fastest);
    for (const double speed : {0.1, 0.5}) {
      const std::string name = size + cache + (speed < 0.3 ? ", 0.1 m/s" : ", 0.5 m/s");
      Slid best;
      for (int i = 0; i < kRepetitions; ++i) {
        auto slid = slide(file, speed, cold);
        if (!slid) return slid.error();
        if (i == 0 || slid->ticks.mean() < best.ticks.mean()) best = std::move(slid).value();
      }
      add(figures, name + ": pages read per tick", best.pages, "");
      if (!cold) add_mean(name + ": contact, mean", best.contact);
      add_mean(name + ": contact and loading, mean", cold ? best.ticks.mean() : best.both);
      add(figures, name + ": contact and loading, p50", best.ticks.percentile(0.5), "ns");
      add(figures, name + ": contact and loading, p99", best.ticks.percentile(0.99), "ns");
    }
  }
  return {};
}

}  // namespace

bool time_paged_ticks(const std::filesystem::path& folder, double max,
                      std::vector<session::Figure>& figures) {
  std::vector<double> small;
  std::int64_t triangles = 100'000;
  for (int power = 5; power <= 7 && static_cast<double>(triangles) <= max; ++power) {
    const auto file = folder / ("ticks_" + std::to_string(triangles) + ".pages");
    auto done = studies::write_ring(kRing, studies::ring_grid(kRing, triangles), file);
    if (done) done = measure("10^" + std::to_string(power), file, small, figures);
    std::filesystem::remove(file);
    if (!done) {
      std::fprintf(stderr, "%s\n", done.error().message.c_str());
      return false;
    }
    triangles *= 10;
  }
  return true;
}

}  // namespace thimble::bench
