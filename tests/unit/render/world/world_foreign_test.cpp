// Scenes of several meshes of other makers: nothing is lost, crossed or jumps.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "support/long_form.h"
#include "support/meshes/foreign_scenes.h"
#include "support/meshes/solid_triangles.h"
#include "support/random.h"
#include "support/tip_at.h"
#include "support/tracker_names.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/scene_touch.h"
#include "track/path_bounded.h"
#include "world/contact_world.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::ForeignMesh;
using support::ForeignObject;
using support::Random;
namespace fs = std::filesystem;

constexpr double kBound = 1 + ProxyFilter::kPathRatio;  // of |df| / (K |dp|)
constexpr double kTick = 1e-3;                          // s

/// What touches the scene: a point by a tracker, or a ball.
struct Way {
  const char* name;
  ContactChoice choice;
  /// The surface of the tracker is not that of the triangles.
  bool smooth = false;
};
const std::array kWays{
    Way{"god_object", {.tracker = TrackerChoice::kGodObject}},
    Way{"edge_planes", {.tracker = TrackerChoice::kEdgePlanes}},
    Way{"compact", {.tracker = TrackerChoice::kPacked}, true},
    Way{"offset", {.tracker = TrackerChoice::kOffset}, true},
    Way{"ball", {.tracker = TrackerChoice::kGodObject, .tip_radius = 0.002}},
};

/// A row of the table.
struct Row {
  int scenes = 0, strokes = 0;
  long ticks = 0, contact = 0, several = 0, unsettled = 0;
  int lost = 0;       ///< Ticks without contact and with the tip inside.
  int jumps = 0;      ///< Ticks in which the force changed by more than the bound.
  int crossings = 0;  ///< Ticks with the proxy inside, or in which it went through a wall.
  int not_finite = 0;
  double ratio = 0;    ///< Greatest |df| / (K |dp|).
  double deepest = 0;  ///< Greatest depth of a proxy inside, m.
  double longest = 0;  ///< Longest tick, s of processor time.

  void add(const Row& one) {
    scenes += one.scenes, strokes += one.strokes, ticks += one.ticks, contact += one.contact;
    several += one.several, unsettled += one.unsettled, lost += one.lost, jumps += one.jumps;
    crossings += one.crossings, not_finite += one.not_finite;
    ratio = std::max(ratio, one.ratio), deepest = std::max(deepest, one.deepest);
    longest = std::max(longest, one.longest);
  }
  void print(const char* name) const {
    std::printf("  %-12s %6d %7d %9ld %9ld %9ld %5d %5d %9d %9ld %6.3f %8.1e %8.0f\n", name, scenes,
                strokes, ticks, contact, several, lost, jumps, crossings, unsettled, ratio, deepest,
                1e6 * longest);
  }
};

double processor_time() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Strokes through one scene.
class Strokes {
 public:
  Strokes(const std::vector<ForeignObject>& objects, const Way& way, std::uint64_t seed)
      : objects_(objects),
        way_(way),
        random_(seed),
        scene_(scene_of(objects, way)),
        triangles_(meshes_) {
    for (const ForeignObject& object : objects) {
      stiffest_ = std::max(stiffest_, object.stiffness);
    }
    row_.scenes = 1;
  }

  bool is_world() const { return scene_.world() != nullptr; }
  const Row& row() const { return row_; }
  const std::vector<std::string>& faults() const { return faults_; }

  /// From outside of all solids to a random triangle, then along a curved path through the scene
  /// (`deep`), or over the surface at some depth.
  void stroke(int ticks, bool deep) {
    ++row_.strokes;
    const double radius = way_.choice.tip_radius;
    const Eigen::AlignedBox3d& box = triangles_.box();
    const Vector3d middle = box.center();
    p_ = middle + (box.diagonal().norm() / 2 + radius + 0.001) * random_.direction();
    scene_(support::tip_at(Vector3d::Constant(std::nan(""))));
    force_before_ = scene_(support::tip_at(p_)).f_T_W;
    was_touching_ = false;
    Vector3d goal = on_a_triangle();
    for (int i = 0; i < 1000 && !was_touching_ && (goal - p_).norm() > 1e-4; ++i) {
      move(std::min(3e-4, (goal - p_).norm()) * (goal - p_).normalized());
    }
    const double step = kTick * 0.5 * std::pow(0.02, random_.uniform(0, 1));
    const double wanted = random_.uniform(2e-4, 3e-3);
    Vector3d heading = random_.direction();
    for (int tick = 0; tick < ticks; ++tick) {
      if (deep || !was_touching_) {
        if ((goal - p_).norm() < 0.002 || random_.uniform(0, 1) < 0.003) goal = somewhere();
        heading =
            (heading + 0.15 * random_.direction() + 0.05 * (goal - p_).normalized()).normalized();
        move(step * heading);
        continue;
      }
      heading += 0.3 * random_.in_box(1);
      const Vector3d n = touch_.n_W.norm() > 0 ? touch_.n_W : Vector3d(0, 0, 1);
      heading = (heading - heading.dot(n) * n).normalized();
      const double back = std::clamp(0.5 * (touch_.depth - wanted), -step, step);
      move(step * heading + back * n);
    }
  }

 private:
  SceneTouch scene_of(const std::vector<ForeignObject>& objects, const Way& way) {
    std::vector<std::unique_ptr<ObjectTouch>> touches;
    for (const ForeignObject& object : objects) {
      meshes_.push_back(object.mesh());
      touches.push_back(build_object_touch(meshes_.back(), way.choice,
                                           {.spring = {.stiffness = object.stiffness}})
                            .value());
    }
    return SceneTouch(std::move(touches));
  }

  Vector3d on_a_triangle() {
    const TriangleMesh& mesh = meshes_[random_.bits() % meshes_.size()];
    const auto& t = mesh.triangles[random_.bits() % mesh.triangles.size()];
    return (mesh.vertices[static_cast<std::size_t>(t[0])] +
            mesh.vertices[static_cast<std::size_t>(t[1])] +
            mesh.vertices[static_cast<std::size_t>(t[2])]) /
           3;
  }
  Vector3d somewhere() {
    if (random_.uniform(0, 1) < 0.3) return on_a_triangle();
    const Eigen::AlignedBox3d& box = triangles_.box();
    return box.center() + 0.6 * box.sizes().cwiseProduct(random_.in_box(1));
  }

  void fault(const char* what, double value) {
    if (faults_.size() >= 10) return;
    const ContactWorld& world = *scene_.world();
    const Vector3d& q = world.proxy();
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(),
                  "%s, R = %.17g: %s (%.3g), stroke %d, tick %ld, %zu active, tip %.17g %.17g "
                  "%.17g, proxy %.17g %.17g %.17g",
                  way_.name, way_.choice.tip_radius, what, value, row_.strokes, row_.ticks,
                  world.active_count(), p_.x(), p_.y(), p_.z(), q.x(), q.y(), q.z());
    faults_.emplace_back(text.data());
  }

  void move(const Vector3d& step) {
    const ContactWorld& world = *scene_.world();
    const Vector3d before = p_, proxy_before = world.proxy();
    const auto unsettled = world.counters().unsettled;
    p_ += step;
    const double begin = processor_time();
    const driver::ForceCommand command = scene_(support::tip_at(p_));
    row_.longest = std::max(row_.longest, processor_time() - begin);
    touch_ = command.touch;
    const Vector3d& f = command.f_T_W;
    const Vector3d q = world.proxy();
    const bool touching = world.active_count() > 0;
    ++row_.ticks;
    row_.contact += touching ? 1 : 0;
    row_.several += world.active_count() > 1 ? 1 : 0;
    row_.unsettled += static_cast<long>(world.counters().unsettled - unsettled);
    if (!f.allFinite() || !q.allFinite()) {
      ++row_.not_finite;
      fault("not finite", 0);
    }
    // Where contact ends, the force may fall to zero at once.
    const double change = (f - force_before_).norm(), path = stiffest_ * (p_ - before).norm();
    if (touching) {
      row_.ratio = std::max(row_.ratio, change / path);
      if (!(change <= kBound * (1 + 1e-9) * path + 1e-9)) {
        ++row_.jumps;
        fault("jump", change / path);
      }
    }
    check_place(touching, proxy_before, q);
    force_before_ = f;
    was_touching_ = touching;
  }

  /// Returns how deep the centre of the tip is inside a solid, with the radius; m, 0 outside. Asks
  /// the triangles themselves where the searches find it inside, and in some of the other ticks.
  double depth_of(const Vector3d& q) const {
    const bool found = scene_.inside(q);
    const long seldom = triangles_.count() < 20'000 ? 32 : 512;
    if (!found && row_.ticks % seldom != 0) return 0;
    const double radius = way_.choice.tip_radius;
    const bool within = triangles_.inside(q);
    if (!within && radius == 0) return 0;
    const double distance = triangles_.distance(q);
    return std::max(0.0, within ? radius + distance : radius - distance);
  }

  void check_place(bool touching, const Vector3d& proxy_before, const Vector3d& q) {
    const double depth = depth_of(q);
    if (!touching) {
      if (depth > kRounding) {
        ++row_.lost;
        fault("lost contact", depth);
      }
      // Within one tick the proxy may slide around a corner that the straight way cuts.
      if (!was_touching_ && triangles_.crossed(proxy_before, q) &&
          !triangles_.slides(proxy_before, q)) {
        ++row_.crossings;
        fault("passed through a wall", 0);
      }
      return;
    }
    row_.deepest = std::max(row_.deepest, depth);
    // The proxy of a smooth surface is not on the triangles.
    if (depth > (way_.smooth ? kSmooth : kRounding)) {
      ++row_.crossings;
      fault("proxy inside", depth);
    }
  }

  static constexpr double kRounding = 1e-9;  // m
  static constexpr double kSmooth = 1e-3;    // m

  const std::vector<ForeignObject>& objects_;
  const Way& way_;
  Random random_;
  std::vector<TriangleMesh> meshes_;
  SceneTouch scene_;
  support::SolidTriangles triangles_;
  double stiffest_ = 0;
  Vector3d p_{0, 0, 0};
  Vector3d force_before_{0, 0, 0};
  driver::TouchInfo touch_;
  bool was_touching_ = false;
  Row row_;
  std::vector<std::string> faults_;
};

/// Size of a run.
struct Extent {
  std::size_t scenes = 0;
  int strokes = 0;                          ///< Per scene and way.
  int ticks = 0;                            ///< Per stroke.
  std::size_t mesh_max = 0, scene_max = 0;  ///< Triangles.
};

/// The numbers of an environment variable, separated by commas.
std::vector<std::size_t> numbers_from(const char* name) {
  std::vector<std::size_t> numbers;
  const char* const given = std::getenv(name);
  std::istringstream text(given != nullptr ? given : "");
  for (std::string one; std::getline(text, one, ',');) numbers.push_back(std::stoul(one));
  return numbers;
}

TEST(WorldForeign, NothingIsLostCrossedOrJumps) {
  const char* const given = std::getenv("THIMBLE_FOREIGN");
  const fs::path folder = given != nullptr ? given : THIMBLE_MESHES;
  if (!fs::exists(folder) || fs::is_empty(folder)) {
    GTEST_SKIP() << "The scanned meshes are not here: run app/fetch_meshes.sh to unpack them.";
  }
  const bool all = given != nullptr || support::long_form();
  const Extent extent =
      all ? Extent{.scenes = 400,
                   .strokes = 4,
                   .ticks = 600,
                   .mesh_max = 200'000,
                   .scene_max = 400'000}
          : Extent{.scenes = 20, .strokes = 2, .ticks = 400, .mesh_max = 3000, .scene_max = 10'000};
  const auto found = support::read_foreign_meshes(folder, extent.mesh_max);
  ASSERT_GT(found.meshes.size(), 0u);
  std::size_t parts = 0, repaired = 0, inverted = 0, triangles = 0;
  for (const ForeignMesh& mesh : found.meshes) {
    parts += mesh.parts > 1 ? 1 : 0;
    repaired += mesh.repaired ? 1 : 0;
    inverted += mesh.inverted ? 1 : 0;
    triangles += mesh.mesh.triangles.size();
  }
  std::printf(
      "%d files: %zu meshes accepted (%zu after a repair, %zu with several parts, %zu triangles; "
      "%zu "
      "with the outside behind some face), %d refused, %d with more than %zu triangles\n",
      found.files, found.meshes.size(), repaired, parts, triangles, inverted, found.refused,
      found.too_large, extent.mesh_max);
  const std::size_t count = std::min(extent.scenes, found.meshes.size());
  const std::vector<std::size_t> only = numbers_from("THIMBLE_FOREIGN_SCENE");
  std::array<Row, kWays.size()> rows;
  std::size_t scenes = 0, solids = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!only.empty() && std::find(only.begin(), only.end(), i) == only.end()) continue;
    // Each scene has its own seed, so that it can be repeated alone.
    Random random(support::seed_of(7000 + i));
    const ForeignMesh& first = found.meshes[i * found.meshes.size() / count];
    const auto objects = support::draw_foreign_scene(first, found.meshes, extent.scene_max, random);
    ++scenes;
    for (const ForeignObject& object : objects) solids += object.source->parts;
    std::vector<std::string> faults;
    // A point by one of the trackers in turn, and a ball; in the short form all.
    for (std::size_t w = 0; w < kWays.size(); ++w) {
      const bool chosen =
          !all || !only.empty() || w + 1 == kWays.size() || w == i % (kWays.size() - 1);
      if (!chosen) continue;
      Way way = kWays[w];
      if (way.choice.tip_radius > 0) way.choice.tip_radius = random.uniform(2e-4, 4e-3);
      Strokes strokes(objects, way, support::seed_of(7000 + i) + w);
      if (!strokes.is_world()) continue;
      for (int k = 0; k < extent.strokes; ++k) strokes.stroke(extent.ticks, k % 2 == 0);
      rows[w].add(strokes.row());
      faults.insert(faults.end(), strokes.faults().begin(), strokes.faults().end());
    }
    if (faults.empty()) continue;
    const std::string name = "foreign_scene_" + std::to_string(i) + ".yaml";
    std::ofstream file(name);
    for (const std::string& fault : faults) file << "# " << fault << '\n';
    file << "objects:\n";
    for (std::size_t k = 0; k < objects.size(); ++k) file << objects[k].yaml(k);
    std::printf("scene %zu (%s), %zu faults or more, in %s; first: %s\n", i,
                first.file.filename().c_str(), faults.size(), name.c_str(), faults[0].c_str());
  }
  std::printf("%zu scenes of %zu solids\n", scenes, solids);
  std::printf("  %-12s %6s %7s %9s %9s %9s %5s %5s %9s %9s %6s %8s %8s\n", "tip", "scenes",
              "strokes", "ticks", "contact", "several", "lost", "jumps", "crossings", "unsettled",
              "ratio", "inside m", "tick us");
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    const Row& row = rows[w];
    row.print(kWays[w].name);
    EXPECT_EQ(row.jumps, 0) << kWays[w].name;
    // Above coarse triangles, smooth cells leave room in which a tip touches nothing, and their
    // proxy is below the triangles of other solids.
    const double share = kWays[w].smooth ? 0.01 : 0;
    EXPECT_LE(row.lost, share * static_cast<double>(row.contact)) << kWays[w].name;
    EXPECT_LE(row.crossings, share * static_cast<double>(row.contact)) << kWays[w].name;
    EXPECT_EQ(row.not_finite, 0) << kWays[w].name;
    EXPECT_GT(row.contact, row.ticks / 4) << kWays[w].name;
    EXPECT_GT(row.several, row.ticks / 100) << kWays[w].name;
  }
}

}  // namespace
}  // namespace thimble::render
