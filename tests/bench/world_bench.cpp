#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bench/world_peers.h"
#include "report/figure_output.h"
#include "studies/resident_memory.h"
#include "support/meshes/bench_meshes.h"
#include "support/random.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"

// Cost of a world of up to 10^5 objects: the touch of a tick, free and in contact, compared with a
// scene of one object; many moving objects; loading; and Bullet and FCL on the same objects and
// paths, if they are installed. Only the force law runs. Times are processor times, the minimum of
// many rounds in alternation, which excludes most other load of the machine.
//
// bench_world [--rounds=15] [--only=TEXT] [--figures=FILE]

namespace thimble::bench {
namespace {

using Eigen::Vector3d;

constexpr double kPitch = 0.01;            // m, between the cells of the grid
constexpr double kCorridor = 0.001;        // m, half width of the free space between two cells
constexpr double kStep = 1e-4;             // m; path of a tick: 0.1 m/s at 1 kHz
constexpr std::size_t kTicks = 20'000;     // of a round
constexpr std::size_t kMovingTicks = 500;  // of a round with many moving objects
constexpr double kPress = 3e-4;            // m, of the tip into the object at the centre

/// Contents of a scene.
enum class Kind {
  kShapes,  // sphere, box, capsule, cylinder, cone and torus in turn, turned at random
  kMeshes,  // bumpy balls of 500 triangles
  kBalls,   // balls and cubes along the axes in turn, which all libraries have
};

/// Returns the centres of the first `count` cells of a cubic grid around the origin, from the
/// middle outwards. So each scene contains all smaller ones.
std::vector<Vector3d> cells(std::size_t count) {
  const int side = 1 + 2 * static_cast<int>(std::ceil(std::cbrt(static_cast<double>(count)) / 1.5));
  std::vector<Eigen::Vector3i> all;
  for (int i = 0; i < side * side * side; ++i) {
    all.emplace_back(i % side - side / 2, i / side % side - side / 2, i / side / side - side / 2);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  std::vector<Vector3d> centres;
  for (std::size_t i = 0; i < count; ++i) centres.emplace_back(kPitch * all[i].cast<double>());
  return centres;
}

/// Returns balls and cubes at random within their cells; the first one is a ball at the origin.
std::vector<WorldItem> items(std::size_t count) {
  support::Random random(std::uint64_t{11});
  std::vector<WorldItem> all;
  for (const Vector3d& centre : cells(count)) {
    WorldItem item{.p_W = centre, .radius = 0.0035, .cube = all.size() % 2 == 1};
    if (!all.empty()) {
      item.radius = random.uniform(0.002, 0.0035);
      item.p_W += random.in_box(kPitch / 2 - kCorridor - item.radius);
    }
    all.push_back(item);
  }
  return all;
}

std::string shape_of(Kind kind, std::size_t i, const WorldItem& item) {
  const double r = item.radius;
  const auto text = [](const char* format, auto... numbers) {
    std::array<char, 160> line;
    std::snprintf(line.data(), line.size(), format, numbers...);
    return std::string(line.data());
  };
  if (kind == Kind::kMeshes) return text("mesh: ball.off, size: %.5f", 2 * r);
  if (kind == Kind::kBalls && item.cube) {
    return text("box: {sides: [%.5f, %.5f, %.5f]}", 2 * r, 2 * r, 2 * r);
  }
  // Within the ball of the radius r.
  switch (kind == Kind::kBalls ? 0 : i % 6) {
    case 1:
      return text("box: {sides: [%.5f, %.5f, %.5f]}", r, r, 1.2 * r);
    case 2:
      return text("capsule: {radius: %.5f, height: %.5f}", r / 2, r);
    case 3:
      return text("cylinder: {radius: %.5f, height: %.5f}", 0.7 * r, 1.2 * r);
    case 4:
      return text("cone: {radius: %.5f, height: %.5f}", 0.7 * r, 1.2 * r);
    case 5:
      return text("torus: {radius: %.5f, tube: %.5f}", 0.7 * r, 0.3 * r);
    default:
      return text("sphere: {radius: %.5f}", r);
  }
}

/// Writes a scene of which the first `moving` objects after the one at the origin move slowly.
std::filesystem::path write_scene(const std::filesystem::path& folder, Kind kind, std::size_t count,
                                  std::size_t moving) {
  support::Random random(std::uint64_t{12});
  const auto file = folder / "world.yaml";
  std::ofstream text(file);
  text.precision(4);
  text << "name: world\narm: vintage_phantom\nduration: 1\nhand:\n  path:\n"
          "    - {t: 0, at: [0, 0, 0.03]}\nobjects:\n";
  const std::vector<WorldItem> all = items(count);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Vector3d& p = all[i].p_W;
    // One short line each: a scene file has at most 16 MB.
    text << "  - {name: o" << i << ", " << shape_of(kind, i, all[i]) << ", position: [" << p.x()
         << ", " << p.y() << ", " << p.z() << "], stiffness: 500, damping: 1";
    if (kind == Kind::kShapes && i > 0) {
      text << ", rotate_degrees: [[x, " << random.bits() % 360 << "], [z, " << random.bits() % 360
           << "]]";
    }
    if (i > 0 && i <= moving) {
      const Vector3d v = 1e-5 * random.direction(), turn = 0.1 * random.direction();
      text << ", collision: {shape: none}, body: {motion: {kind: rigid, mass: 0.01, velocity: ["
           << v.x() << ", " << v.y() << ", " << v.z() << "], angular_velocity: [" << turn.x()
           << ", " << turn.y() << ", " << turn.z() << "]}}";
    }
    text << "}\n";
  }
  text.close();
  return text ? file : std::filesystem::path();
}

using Objects = std::unique_ptr<scene::SceneObjects>;
using Path = std::vector<Vector3d>;

/// Returns a walk over the edges of the grid, in the corridors between the objects.
Path free_path(std::size_t count) {
  support::Random random(std::uint64_t{13});
  // Half the side of a cube within the ball of all cells, in cells.
  const double half =
      std::cbrt(static_cast<double>(count) * 3 / (4 * std::numbers::pi)) / std::sqrt(3);
  const double far = kPitch * std::max(std::floor(half) - 0.5, 0.5);
  Path path;
  Vector3d at = Vector3d::Constant(kPitch / 2);
  while (path.size() < kTicks) {
    const auto axis = static_cast<Eigen::Index>(random.bits() % 3);
    Vector3d to = at;
    to[axis] += random.bits() % 2 == 0 ? kPitch : -kPitch;
    if (!(std::abs(to[axis]) <= far + 1e-9)) continue;
    for (int k = 1; k <= kPitch / kStep + 0.5; ++k)
      path.push_back(at + k * kStep / kPitch * (to - at));
    at = to;
  }
  return path;
}

/// Returns a stroke around the object at the origin, pressed in; its first points lead there from
/// the corridor.
Path contact_path() {
  const double radius = 0.0035 * std::sin(0.5), height = 0.0035 * std::cos(0.5);
  const double share = 1 - kPress / 0.0035;
  Path path;
  for (int k = 0; k <= 20; ++k)
    path.emplace_back(share * radius, 0, kPitch / 2 - (kPitch / 2 - share * height) * k / 20);
  while (path.size() < kTicks) {
    const double angle = kStep / radius * static_cast<double>(path.size());
    path.emplace_back(share * radius * std::cos(angle), share * radius * std::sin(angle),
                      share * height);
  }
  return path;
}

/// Returns a path through the objects along a row of the grid and back, 1 mm above their middles.
Path tour_path(std::size_t count) {
  const double far =
      kPitch * std::max(1.0, std::floor(std::cbrt(static_cast<double>(count)) / 2)) + kPitch / 2;
  Path path;
  double x = -far, way = kStep;
  while (path.size() < kTicks) {
    path.emplace_back(x, 0.0003, 0.001);
    x += way;
    if (std::abs(x) > far) way = -way;
  }
  return path;
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Runs the ticks of a path and returns their mean time, ns. Not inlined: to count its instructions
/// with `valgrind --tool=callgrind --toggle-collect='*run_ticks*'`.
[[gnu::noinline]] double run_ticks(render::SceneTouch& touch, const Path& path, std::size_t ticks,
                                   std::size_t& in_contact) {
  driver::DeviceState state;
  state.dt = 1e-3;
  in_contact = 0;
  // Ends the contact of the last round, so that the tip does not leap to the begin of the path.
  state.p_WT = Vector3d::Constant(NAN);
  touch(state);
  const double begin = processor_seconds();
  for (std::size_t i = 0; i < ticks; ++i) {
    state.tick = i;
    state.v_WT = (path[i] - path[i > 0 ? i - 1 : 0]) / state.dt;
    state.p_WT = path[i];
    in_contact += touch(state).touch.in_contact ? 1 : 0;
  }
  return 1e9 * (processor_seconds() - begin) / static_cast<double>(ticks);
}

[[gnu::noinline]] double run_peer(WorldPeer& peer, const Path& path, std::size_t ticks, bool moves,
                                  std::size_t& hits) {
  hits = 0;
  const double begin = processor_seconds();
  for (std::size_t i = 1; i < ticks; ++i) {
    if (moves) peer.move_all(Vector3d::Constant(1e-8 * static_cast<double>(i)));
    hits += std::isnan(peer.first_hit(path[i - 1], path[i])) ? 0 : 1;
  }
  return 1e9 * (processor_seconds() - begin) / static_cast<double>(ticks - 1);
}

driver::Result<Objects> load(const std::filesystem::path& file) {
  const auto read = scene::load_scene(file);
  if (!read) return read.error();
  return scene::SceneObjects::build(*read);
}

/// Result of loading a scene in a separate process.
struct Load {
  double read = 0;    // s
  double build = 0;   // s
  double memory = 0;  // bytes
};

class Bench {
 public:
  Bench(std::filesystem::path folder, int rounds, std::string only)
      : folder_(std::move(folder)), rounds_(rounds), only_(std::move(only)) {}

  bool run() {
    const auto ball = support::bench_ball(support::BumpyBall{.amplitude = 0.02}, 500);
    if (const auto saved = render::save_mesh(ball, folder_ / "ball.off"); !saved)
      return fail(saved.error());
    // Loading first, so that it finds no memory that other scenes have left.
    return loading(Kind::kShapes, "shapes", 100'000) && loading(Kind::kMeshes, "meshes", 1'000) &&
           resting(Kind::kShapes, "shapes", {2, 100, 10'000, 100'000}) &&
           resting(Kind::kMeshes, "meshes", {2, 100, 10'000}) && moving() && peers();
  }
  const std::vector<session::Figure>& figures() const { return figures_; }

 private:
  static bool fail(const driver::Error& error) {
    std::fprintf(stderr, "%s\n", error.message.c_str());
    return false;
  }
  bool skips(const std::string& name) const { return name.find(only_) == std::string::npos; }

  void add(const std::string& name, double value, const std::string& unit,
           const std::string& goal = "") {
    figures_.push_back({.name = name, .value = value, .unit = unit, .goal = goal});
    std::printf("%s: %g %s\n", name.c_str(), value, unit.c_str());
    std::fflush(stdout);
  }

  Objects open(Kind kind, std::size_t count, std::size_t moving) {
    auto loaded = load(write_scene(folder_, kind, count, moving));
    if (loaded) return std::move(loaded).value();
    fail(loaded.error());
    return nullptr;
  }

  /// Ticks of `many` and `one` along a path in turns: the minimum of each, ns.
  std::pair<double, double> least(scene::SceneObjects& many, scene::SceneObjects& one,
                                  const Path& path, std::size_t ticks, std::size_t& in_contact) {
    std::pair<double, double> least(1e300, 1e300);
    std::size_t of_one = 0;
    for (int round = 0; round < rounds_; ++round) {
      least.first = std::min(least.first, run_ticks(many.touch(), path, ticks, in_contact));
      least.second = std::min(least.second, run_ticks(one.touch(), path, ticks, of_one));
    }
    return least;
  }

  bool resting(Kind kind, const std::string& name, const std::vector<std::size_t>& counts) {
    Objects one;
    for (const std::size_t count : counts) {
      const std::string title = name + ", " + std::to_string(count);
      if (skips(title)) continue;
      if (!one && !(one = open(kind, 1, 0))) return false;
      const Objects many = open(kind, count, 0);
      if (!many) return false;
      std::size_t touching = 0;
      const auto free = least(*many, *one, free_path(count), kTicks, touching);
      if (touching > 0) return fail({"The free path of " + title + " touches an object."});
      add(title + ": free tick", free.first, "ns");
      add(title + ": free tick, more than with one object", free.first - free.second, "ns",
          count == 10'000 ? "< 50" : "");
      const auto contact = least(*many, *one, contact_path(), kTicks, touching);
      if (touching < kTicks * 99 / 100) return fail({"The stroke of " + title + " lifts off."});
      add(title + ": tick in contact", contact.first, "ns");
      add(title + ": tick in contact, more than with one object", contact.first - contact.second,
          "ns", count == 10'000 ? "< 100" : "");
      const auto tour = least(*many, *one, tour_path(count), kTicks, touching);
      add(title + ": tick through a row of objects", tour.first, "ns");
    }
    return true;
  }

  bool moving() {
    constexpr std::array<std::pair<std::size_t, std::size_t>, 4> kCases = {
        {{11, 10}, {257, 256}, {10'000, 10}, {10'000, 9'999}}};
    Objects one;
    for (const auto& [count, moves] : kCases) {
      const std::string title = "moving, " + std::to_string(moves) + " of " + std::to_string(count);
      if (skips(title)) continue;
      if (!one && !(one = open(Kind::kBalls, 1, 0))) return false;
      const Objects many = open(Kind::kBalls, count, moves);
      if (!many) return false;
      std::size_t touching = 0;
      const auto free = least(*many, *one, free_path(count), kMovingTicks, touching);
      if (touching > 0) return fail({"The free path of " + title + " touches an object."});
      add(title + ": free tick", free.first, "ns");
      add(title + ": free tick, per moving object", free.first / static_cast<double>(moves), "ns");
      const auto contact = least(*many, *one, contact_path(), kMovingTicks, touching);
      add(title + ": tick in contact", contact.first, "ns");
    }
    return true;
  }

  bool peers() {
    constexpr std::size_t kCount = 10'000;
    const std::string title = "balls and cubes, " + std::to_string(kCount);
    if (skips(title)) return true;
    const Objects many = open(Kind::kBalls, kCount, 0);
    if (!many) return false;
    const std::vector<WorldItem> all = items(kCount);
    std::vector<std::pair<std::unique_ptr<WorldPeer>, double>> others;  // and the time to build, s
    const auto take = [&]([[maybe_unused]] const auto& make) {
      const double begin = processor_seconds();
      auto peer = make();
      others.emplace_back(std::move(peer), processor_seconds() - begin);
    };
#if THIMBLE_HAVE_BULLET
    take([&] { return make_bullet_world(all, true); });
    take([&] { return make_bullet_world(all, false); });
#endif
#if THIMBLE_HAVE_FCL
    take([&] { return make_fcl_world(all); });
#endif
    const std::array<std::pair<std::string, Path>, 2> paths = {
        {{"free", free_path(kCount)}, {"through a row of objects", tour_path(kCount)}}};
    for (const auto& [where, path] : paths) {
      double own = 1e300;
      std::vector<double> least(others.size(), 1e300);
      std::size_t hits = 0;
      for (int round = 0; round < rounds_; ++round) {
        own = std::min(own, run_ticks(many->touch(), path, kTicks, hits));
        for (std::size_t i = 0; i < others.size(); ++i) {
          least[i] = std::min(least[i], run_peer(*others[i].first, path, kTicks / 10, false, hits));
          if (where == "free" && hits > 0 &&
              others[i].first->name().find("Broadphase") == std::string::npos) {
            return fail({others[i].first->name() + " finds an object on the free path."});
          }
        }
      }
      add(title + ", " + where + ": whole touch of a tick", own, "ns");
      for (std::size_t i = 0; i < others.size(); ++i) {
        add(title + ", " + where + ": " + others[i].first->name(), least[i], "ns");
      }
    }
    for (auto& [peer, built] : others) {
      add(title + ": " + peer->name() + ", built in", 1e6 * built / kCount, "us per object");
      std::size_t hits = 0;
      double moved = 1e300;
      for (int round = 0; round < std::min(rounds_, 5); ++round) {
        moved = std::min(moved, run_peer(*peer, paths[0].second, 20, true, hits));
      }
      add(title + ", all moving: " + peer->name() + ", per object", moved / kCount, "ns");
    }
    return true;
  }

  bool loading(Kind kind, const std::string& name, std::size_t count) {
    const std::string title = "loading, " + std::to_string(count) + " " + name;
    if (skips(title)) return true;
    const auto file = write_scene(folder_, kind, count, 0);
    Load least{1e300, 1e300, 1e300};
    for (int round = 0; round < std::min(rounds_, 3); ++round) {
      Load one;
      if (!load_apart(file, one)) return fail({title + " failed."});
      least.read = std::min(least.read, one.read);
      least.build = std::min(least.build, one.build);
      least.memory = std::min(least.memory, one.memory);
    }
    const bool shapes = kind == Kind::kShapes;
    const auto each = 1 / static_cast<double>(count);
    add(title + ": reading the file", least.read, "s");
    add(title + ": building the objects", least.build, "s");
    add(title + ": together", least.read + least.build, "s", shapes ? "< 2" : "");
    add(title + ": per object", 1e6 * (least.read + least.build) * each, "us",
        shapes ? "< 20" : "");
    add(title + ": memory per object", least.memory * each, "bytes", shapes ? "< 500" : "");
    return true;
  }

  static bool load_apart(const std::filesystem::path& file, Load& result) {
    int pipes[2];
    if (pipe(pipes) != 0) return false;
    if (fork() == 0) {
      Load one;
      const std::size_t before = studies::resident_memory().now;
      const double begin = processor_seconds();
      const auto read = scene::load_scene(file);
      one.read = processor_seconds() - begin;
      if (!read) _exit(1);
      const auto built = scene::SceneObjects::build(*read);
      one.build = processor_seconds() - begin - one.read;
      if (!built) _exit(1);
      one.memory = static_cast<double>(studies::resident_memory().now - before);
      _exit(write(pipes[1], &one, sizeof one) == sizeof one ? 0 : 1);
    }
    close(pipes[1]);
    const bool done = read(pipes[0], &result, sizeof result) == sizeof result;
    close(pipes[0]);
    wait(nullptr);
    return done;
  }

  std::filesystem::path folder_;
  int rounds_;
  std::string only_;
  std::vector<session::Figure> figures_;
};

}  // namespace
}  // namespace thimble::bench

int main(int argc, char** argv) {
  std::string figures_file, only;
  int rounds = 15;
  for (int i = 1; i < argc; ++i) {
    const auto value_of = [argument = argv[i]](const char* option) -> const char* {
      const std::size_t length = std::strlen(option);
      return std::strncmp(argument, option, length) == 0 ? argument + length : nullptr;
    };
    if (const char* file = value_of("--figures=")) {
      figures_file = std::filesystem::absolute(file).string();
    } else if (const char* text = value_of("--only=")) {
      only = text;
    } else if (const char* count = value_of("--rounds=")) {
      rounds = std::max(1, std::atoi(count));
    } else {
      std::fprintf(stderr, "bench_world [--rounds=15] [--only=TEXT] [--figures=FILE]\n");
      return 2;
    }
  }
  std::filesystem::current_path(THIMBLE_SOURCE_DIR);  // arms are found by name there
  const auto folder =
      std::filesystem::temp_directory_path() / ("thimble_world_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  thimble::bench::Bench bench(folder, rounds, only);
  const bool done = bench.run();
  std::filesystem::remove_all(folder);
  if (!done) return 1;
  std::printf("\n%s", thimble::report::figure_table(bench.figures()).c_str());
  if (figures_file.empty()) return 0;
  const auto written = thimble::report::write_figures(bench.figures(), figures_file);
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return written ? 0 : 1;
}
