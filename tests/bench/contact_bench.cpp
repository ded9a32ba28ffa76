#include <malloc.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/peers.h"
#include "report/figure_output.h"
#include "search/make_search.h"
#include "support/meshes/bench_meshes.h"
#include "support/random.h"
#include "thimble/driver/real_time.h"
#include "thimble/render/build_object_touch.h"
#include "track/packed_contact_in_memory.h"

// Contact on closed shapes of 0.1 m with 10^3 to 10^7 triangles, compared with other libraries in
// the same run. Every time is the minimum of several rounds. The contenders take turns on each
// stretch of a path, because the machine is seldom undisturbed for a whole path.

namespace thimble::bench {
namespace {

using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

constexpr double kPressed = 0.5e-3;  // m below the surface
constexpr std::size_t kTicks = 100000;
constexpr std::size_t kStretch = 1000;  // ticks
constexpr int kRounds = 5;

// Returns the bytes that the program has allocated on the heap.
std::size_t allocated() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

struct Path {
  std::vector<Vector3d> tips;  // one per tick, m
  Vector3d start;              // outside, above the first
};

// Winds around a ball in steps of equal length. `radius` is that of the tip, m; 0: a point.
Path path_over(const support::BumpyBall& ball, double step, std::size_t ticks, double radius = 0) {
  Path path;
  support::Random random(7);
  Vector3d at = Vector3d(0.3, 0.5, 0.8).normalized();
  Vector3d axis = Vector3d(0.1, 0.9, -0.2);
  path.start = ball.at(at) + (2e-3 + radius) * ball.normal(at);
  for (std::size_t i = 0; i < ticks; ++i) {
    const Vector3d p = ball.at(at);
    path.tips.push_back(p + (radius - kPressed) * ball.normal(at));
    axis = (axis + 0.003 * at.cross(axis) + 0.002 * random.direction()).normalized();
    at = (at + step / p.norm() * axis.cross(at).normalized()).normalized();
  }
  return path;
}

// Winds around a torus in steps of nearly equal length.
Path path_over(const support::Ring& ring, double step, std::size_t ticks) {
  Path path;
  path.start = ring.at(0, 0) + 2e-3 * ring.normal(0, 0);
  for (std::size_t i = 0; i < ticks; ++i) {
    const double way = step * static_cast<double>(i);
    const double around = 0.6 * way / ring.ring_radius;
    const double across = 0.8 * way / ring.tube_radius;
    path.tips.push_back(ring.at(around, across) - kPressed * ring.normal(around, across));
  }
  return path;
}

// Contender: returns the depth at a tip, NaN without contact.
using Follow = std::function<double(const Vector3d&)>;

struct Followed {
  std::vector<double> stretches;  // minimum of each, s
  double ns = 0;                  // per tick
  double error_mm = 0;            // mean of |depth - truth|
  std::size_t lost = 0;           // ticks
};

template <class F>
void follow_hot(const Path& path, F&& follow, Followed& result) {
  follow(path.start);
  follow(path.tips.front());
  double error = 0;
  std::size_t lost = 0;
  result.stretches.resize(path.tips.size() / kStretch, INFINITY);
  double sum = 0;
  for (std::size_t stretch = 0; stretch < result.stretches.size(); ++stretch) {
    const auto begin = Clock::now();
    for (std::size_t i = stretch * kStretch; i < (stretch + 1) * kStretch; ++i) {
      const double depth = follow(path.tips[i]);
      if (depth > 0) {
        error += std::abs(depth - kPressed);
      } else {
        ++lost;
      }
    }
    double& best = result.stretches[stretch];
    best = std::min(best, seconds_since(begin));
    sum += best;
  }
  const auto ticks = static_cast<double>(path.tips.size());
  result.ns = sum * 1e9 / ticks;
  result.error_mm = error * 1e3 / std::max(ticks - static_cast<double>(lost), 1.0);
  result.lost = lost;
}

// Measures ticks of a 1 kHz loop that sleeps, on a thread with real-time priority like the servo's
// (if the kernel refuses it, its reason is printed). Returns {mean, 99th percentile} of the
// contact's time in ns. `prepare` is called in the time left before a tick, with the expected
// position of the tip.
template <class F, class G>
std::pair<double, double> follow_in_loop(const Path& path, F&& follow, G&& prepare) {
  std::vector<double> ns;
  ns.reserve(path.tips.size());
  std::thread([&] {
    const driver::RealTimeGrant grant = driver::enter_real_time();
    if (!grant.fifo) std::fprintf(stderr, "%s\n", grant.advice.c_str());
    follow(path.start);
    Vector3d last = path.start, before = path.start;
    auto next = Clock::now();
    for (const Vector3d& p : path.tips) {
      next += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(next);
      prepare(2 * last - before);
      const auto begin = Clock::now();
      follow(p);
      ns.push_back(seconds_since(begin) * 1e9);
      before = last;
      last = p;
    }
  }).join();
  double sum = 0;
  for (const double v : ns) sum += v;
  std::sort(ns.begin(), ns.end());
  return {sum / static_cast<double>(ns.size()), ns[ns.size() * 99 / 100]};
}

class Bench {
 public:
  Bench(bool hot, bool cold) : hot_(hot), cold_(cold) {}

  void run(const std::string& size, std::size_t triangles) {
    const support::BumpyBall ball;
    const support::Ring ring;
    run_shape("ball " + size, support::bench_ball(ball, triangles), ball, triangles);
    run_shape("torus " + size, support::bench_ring(ring, triangles), ring, triangles);
  }

  // Measures the time and the memory to build a contact as a scene does.
  void run_build(const std::string& size, std::size_t triangles) {
    build_shape("ball " + size, support::bench_ball(support::BumpyBall(), triangles), triangles);
    build_shape("torus " + size, support::bench_ring(support::Ring(), triangles), triangles);
  }

  // Measures a tip of 0.5 mm radius, and a point followed by the same law, on a fast slide.
  void run_tip(const std::string& size, std::size_t triangles) {
    const support::BumpyBall ball;
    const render::TriangleMesh mesh = support::bench_ball(ball, triangles);
    for (const double radius : {0.0, 0.5e-3}) {
      const auto touch = render::build_object_touch(
          mesh, {.tracker = render::TrackerChoice::kGodObject, .tip_radius = radius}, {});
      if (!touch) return (void)std::fprintf(stderr, "%s\n", touch.error().message.c_str());
      driver::DeviceState state;
      const auto follow = [&](const Vector3d& p) {
        state.p_WT = p;
        const driver::TouchInfo touched = (*touch)->update(state).touch;
        return touched.in_contact ? touched.depth : NAN;
      };
      const Path path = path_over(ball, 0.3e-3, kTicks, radius);
      Followed found;
      for (int round = 0; round < kRounds; ++round) follow_hot(path, follow, found);
      const std::string name = "ball " + size + (radius > 0 ? ": tip of 0.5 mm" : ": point");
      add(name + ", fast slide hot", found.ns, "ns");
      add(name + ", depth error", found.error_mm, "mm");
      // The path is below the smooth surface: coarse triangles may be below the tip.
      add(name + ", contact lost", static_cast<double>(found.lost), "ticks",
          triangles > 1000 ? "== 0" : "");
    }
  }

  const std::vector<session::Figure>& figures() const { return figures_; }

 private:
  void build_shape(const std::string& name, const render::TriangleMesh& mesh,
                   std::size_t triangles) {
    struct Way {
      const char* name;
      render::TrackerChoice tracker;
      const char* bytes;  // goal at 10^6
    };
    for (const Way& way : {Way{"compact", render::TrackerChoice::kPacked, "<= 64"},
                           Way{"edge_planes", render::TrackerChoice::kEdgePlanes, "<= 128"},
                           Way{"god_object", render::TrackerChoice::kGodObject, "<= 128"}}) {
      render::ContactChoice choice;
      choice.tracker = way.tracker;
      double least = INFINITY, processor = INFINITY, bytes = 0;
      for (int round = 0; round < 3; ++round) {
        const std::size_t before = allocated();
        const auto begin = Clock::now();
        const std::clock_t worked = std::clock();
        const auto touch = render::build_object_touch(mesh, choice, {});
        least = std::min(least, seconds_since(begin));
        processor =
            std::min(processor, static_cast<double>(std::clock() - worked) / CLOCKS_PER_SEC);
        if (!touch) return (void)std::fprintf(stderr, "%s\n", touch.error().message.c_str());
        bytes = static_cast<double>(allocated() - before);
      }
      const char* goal = triangles == 1000000 ? "<= 0.6" : triangles == 10000000 ? "<= 7" : "";
      add(name + ": build contact, " + way.name, least, "s", goal);
      // Processor time of all threads, which does not depend on other load.
      add(name + ": build contact, " + way.name + ", processor", processor, "s");
      add(name + ": memory of contact, " + way.name,
          bytes / static_cast<double>(mesh.triangles.size()), "B per triangle",
          triangles == 1000000 ? way.bytes : "");
    }
  }

  void add(const std::string& name, double value, const std::string& unit,
           const std::string& goal = {}) {
    figures_.push_back({.name = name, .value = value, .unit = unit, .goal = goal});
    std::printf("%s", report::figure_table({figures_.back()}).c_str());
    std::fflush(stdout);
  }

  template <class Shape>
  void run_shape(const std::string& name, const render::TriangleMesh& mesh, const Shape& shape,
                 std::size_t triangles) {
    const auto begin = Clock::now();
    auto surface = render::PackedSurface::build(mesh);
    if (!surface) {
      std::fprintf(stderr, "%s\n", surface.error().message.c_str());
      return;
    }
    const std::size_t surface_bytes = surface.value().bytes();
    render::InMemoryContact contact(std::move(surface).value());
    add(name + ": build", seconds_since(begin), "s", triangles == 1000000 ? "<= 0.5" : "");
    add(name + ": memory",
        static_cast<double>(surface_bytes + contact.search().bytes()) /
            static_cast<double>(mesh.triangles.size()),
        "B per triangle", triangles == 1000000 ? "<= 96" : "");
    std::unique_ptr<Peer> embree;
    if constexpr (THIMBLE_HAVE_EMBREE) embree = make_embree(mesh);
    if (!hot_) return run_cold(name, mesh, contact.surface(), embree.get(), triangles);
    driver::DeviceState state;
    const auto ours = [&](const Vector3d& p) {
      state.p_WT = p;
      const render::ContactState& touched = contact.update(state);
      return touched.touching ? touched.depth : NAN;
    };
    const auto theirs = [&](const Vector3d& p) { return embree->follow(p); };
    const bool coarse = triangles <= 10000;
    const bool large = triangles > 1000000;
    for (const bool fast : {false, true}) {
      const std::string way = name + (fast ? ": fast slide" : ": stroke");
      const Path path = path_over(shape, fast ? 0.3e-3 : 0.03e-3, kTicks);
      Followed us, them;
      for (int round = 0; round < kRounds; ++round) {
        follow_hot(path, ours, us);
        if (embree) follow_hot(path, theirs, them);
      }
      const char* most = !fast                 ? "<= 25"
                         : coarse              ? "<= 40"
                         : triangles <= 100000 ? "<= 60"
                         : large               ? "<= 300"
                                               : "<= 110";
      add(way + " hot", us.ns, "ns", most);
      add(way + ", depth error", us.error_mm, "mm", "<= 0.01");
      add(way + ", contact lost", static_cast<double>(us.lost), "ticks", "== 0");
      if (embree) {
        add(way + " hot, embree", them.ns, "ns");
        add(way + ", depth error, embree", them.error_mm, "mm");
        add(way + ", contact lost, embree", static_cast<double>(them.lost), "ticks");
        add(way + " hot, embree / ours", them.ns / us.ns, "");
      }
      if (!fast) continue;
      const Path slow = path_over(shape, 0.3e-3, 1000);
      // As the servo loop does in real time (ServoSettings::prepare_ns): the query uses a copy.
      const auto prepare = [&](const Vector3d& expected) {
        render::InMemoryContact guess = contact;
        driver::DeviceState there;
        there.p_WT = expected;
        guess.update(there);
      };
      const auto unprepared = [](const Vector3d&) {};
      const std::string loop = way + " in the loop";
      const auto tell = [&](const std::string& who, const std::pair<double, double>& ns) {
        add(loop + ", mean" + who, ns.first, "ns");
        add(loop + ", p99" + who, ns.second, "ns");
        return ns.first;
      };
      const double mean = tell("", follow_in_loop(slow, ours, prepare));
      tell(", unprepared", follow_in_loop(slow, ours, unprepared));
      if (!embree) continue;
      const double theirs_mean = tell(", embree", follow_in_loop(slow, theirs, unprepared));
      add(loop + ", embree / ours", theirs_mean / mean, "", ">= 2");
    }
    if (cold_) run_cold(name, mesh, contact.surface(), embree.get(), triangles);
  }

  void run_cold(const std::string& name, const render::TriangleMesh& mesh,
                const render::PackedSurface& surface, Peer* embree, std::size_t triangles) {
    constexpr std::size_t kQueries = 20000;
    support::Random random(9);
    std::vector<Vector3d> from, to, near;
    for (std::size_t i = 0; i < kQueries; ++i) {
      const auto t = random.bits() % mesh.triangles.size();
      const Vector3d& on =
          mesh.vertices[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(t)][0])];
      from.push_back(on + random.in_box(0.25e-3));
      to.push_back(from.back() + 0.5e-3 * random.direction());
      near.push_back(on + random.uniform(0, 1e-3) * random.direction());
    }
    using Question = std::function<double(std::size_t)>;
    struct Contender {
      std::string name;
      Question segment, closest;
    };
    std::vector<Contender> contenders;
    std::vector<std::shared_ptr<const render::ContactSearch>> searches;
    std::vector<std::unique_ptr<Peer>> peers;
    const auto add_search = [&](const std::string& kind,
                                std::optional<render::SearchChoice> choice) {
      const auto begin = Clock::now();
      const auto search = render::make_search(surface, choice);
      if (choice) add(name + ": build, " + kind, seconds_since(begin), "s");
      if (choice) {
        add(name + ": memory, " + kind,
            static_cast<double>(search->bytes()) / static_cast<double>(mesh.triangles.size()),
            "B per triangle");
      }
      searches.push_back(search);
      const render::ContactSearch& s = *search;
      contenders.push_back(
          {kind, [&](std::size_t i) { return s.first_entry(from[i], to[i]).parameter; },
           choice == render::SearchChoice::kLinear
               ? Question()  // 0.1 s for a thousand of them
               : [&](std::size_t i) { return s.closest(near[i], 1.01e-3).distance; }});
    };
    const auto add_peer = [&](Peer& peer) {
      contenders.push_back({peer.name(),
                            peer.has_first_hit()
                                ? [&](std::size_t i) { return peer.first_hit(from[i], to[i]); }
                                : Question(),
                            [&](std::size_t i) { return peer.closest(near[i], 1.01e-3); }});
    };
    add_search("ours", {});
    if (embree != nullptr) add_peer(*embree);
    add_search("tree", render::SearchChoice::kTree);
    add_search("grid", render::SearchChoice::kGrid);
    if (triangles <= 10000) add_search("linear", render::SearchChoice::kLinear);
    // Much slower than Embree and large in memory, so it is measured only up to this size.
    if (triangles <= 100000) {
      if constexpr (THIMBLE_HAVE_CGAL) peers.push_back(make_cgal(mesh));
      if constexpr (THIMBLE_HAVE_FCL) peers.push_back(make_fcl(mesh));
    }
    for (const auto& peer : peers) add_peer(*peer);

    double sum = 0;  // read below, so that no query is optimised away
    // Takes turns in batches that are short enough to fit between two interruptions, and adds up
    // the minimum time of each batch. Between two rounds of a batch, all others are run.
    const auto take_turns = [&](Question Contender::*question) {
      constexpr std::size_t kBatch = 500;
      std::vector<double> ns(contenders.size(), 0);
      std::vector<std::vector<double>> least(contenders.size(),
                                             std::vector<double>(kQueries / kBatch, INFINITY));
      for (int round = 0; round < 2 * kRounds; ++round) {
        for (std::size_t c = 0; c < contenders.size(); ++c) {
          const Question& ask = contenders[c].*question;
          if (!ask) continue;
          for (std::size_t batch = 0; batch < kQueries / kBatch; ++batch) {
            const auto begin = Clock::now();
            for (std::size_t i = batch * kBatch; i < (batch + 1) * kBatch; ++i) sum += ask(i);
            least[c][batch] = std::min(least[c][batch], seconds_since(begin));
          }
        }
      }
      for (std::size_t c = 0; c < contenders.size(); ++c) {
        for (const double seconds : least[c]) ns[c] += seconds * 1e9 / kQueries;
      }
      return ns;
    };
    const std::vector<double> segment = take_turns(&Contender::segment);
    const std::vector<double> closest = take_turns(&Contender::closest);
    double best = INFINITY;  // of the peers
    for (std::size_t c = 0; c < contenders.size(); ++c) {
      const std::string who = c == 0 ? "" : ", " + contenders[c].name;
      if (std::isfinite(segment[c])) add(name + ": cold segment" + who, segment[c], "ns");
      if (std::isfinite(closest[c])) add(name + ": cold closest point" + who, closest[c], "ns");
      const bool is_peer = (c == 1 && embree != nullptr) || c >= contenders.size() - peers.size();
      if (is_peer) best = std::min(best, closest[c]);
    }
    if (embree != nullptr) {
      add(name + ": cold segment, ours / embree", segment[0] / segment[1], "", "<= 1");
    }
    if (std::isfinite(best)) {
      add(name + ": cold closest point, best peer / ours", best / closest[0], "", ">= 2");
    }
    if (sum == -1) std::printf("never\n");
  }

  bool hot_, cold_;
  std::vector<session::Figure> figures_;
};

}  // namespace
}  // namespace thimble::bench

int main(int argc, char** argv) {
  // --figures=FILE writes the figures, --min=N begins at N triangles, --max=N stops there (default
  // 1e6), --long continues to 10^7, --contact skips the cold queries, --cold runs only them,
  // --build only builds, --tip only measures a tip with a radius.
  std::string figures_file;
  double least = 0, most = 1e6;
  bool hot = true, cold = true, touch = true, tip = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], "--figures=", 10) == 0) {
      figures_file = argv[i] + 10;
    } else if (std::strncmp(argv[i], "--max=", 6) == 0) {
      most = std::atof(argv[i] + 6);
    } else if (std::strncmp(argv[i], "--min=", 6) == 0) {
      least = std::atof(argv[i] + 6);
    } else if (std::strcmp(argv[i], "--contact") == 0) {
      cold = false;
    } else if (std::strcmp(argv[i], "--long") == 0) {
      most = 1e7;
    } else if (std::strcmp(argv[i], "--cold") == 0) {
      hot = false;
    } else if (std::strcmp(argv[i], "--tip") == 0) {
      tip = true;
    } else if (std::strcmp(argv[i], "--build") == 0) {
      touch = false;
    } else {
      std::fprintf(stderr,
                   "Unknown option %s. Options: --figures=FILE --min=N --max=N --long --contact "
                   "--cold --build --tip\n",
                   argv[i]);
      return 2;
    }
  }
  thimble::bench::Bench bench(hot, cold);
  std::size_t triangles = 1000;
  for (int power = 3; power <= 7 && static_cast<double>(triangles) <= most; ++power) {
    const std::string size = "10^" + std::to_string(power);
    if (static_cast<double>(triangles) >= least) {
      if (tip) {
        bench.run_tip(size, triangles);
      } else {
        if (power > 5) bench.run_build(size, triangles);
        if (touch) bench.run(size, triangles);
      }
    }
    triangles *= 10;
  }
  std::printf("\n%s", thimble::report::figure_table(bench.figures()).c_str());
  if (!figures_file.empty()) {
    const auto written = thimble::report::write_figures(bench.figures(), figures_file);
    if (!written) {
      std::fprintf(stderr, "%s\n", written.error().message.c_str());
      return 1;
    }
  }
  return 0;
}
