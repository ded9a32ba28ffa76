#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "support/long_form.h"
#include "support/random.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/mesh_file.h"
#include "track/mesh_contact.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
namespace fs = std::filesystem;

const fs::path kFolder = THIMBLE_MESHES;
constexpr double kSize = 0.1;           // longest side of every mesh, m
constexpr double kStiffness = 1000;     // N/m, hard surface of [PHYSICS 6]
constexpr double kForceMax = 5;         // N
constexpr double kStep = 0.0002;        // m per tick
constexpr double kStartAbove = 1e-5;    // m
constexpr double kDepthMean = 0.00065;  // m
constexpr double kDepthWave = 0.00035;  // m

int ticks_per_mesh() {
  return support::long_form() ? 10000 : 1000;
}

// Results of a walk over one mesh.
struct Stroke {
  int in_contact = 0;
  int starts = 0;
  int left = 0;
  int lost = 0;
  int not_finite = 0;
  int jumps = 0;  // ticks whose depth grew by more than the tip moved
  double depth_max = 0;
  double jump_max = 0;  // m, beyond the tip's motion
  TrackerCounters counters;
};

// Walks over the whole surface along a wandering path. Restarts at a random triangle now and then,
// and if the path leaves the surface.
Stroke stroke(MeshContact& contact, int ticks) {
  support::Random random(21);
  Stroke result;
  const ContactMesh& mesh = contact.mesh();
  const auto move = [&contact](const Vector3d& p) -> const ContactState& {
    driver::DeviceState state;
    state.p_WT = p;
    return contact.update(state);
  };
  const auto is_lost = [&contact](const Vector3d& p) {
    return !contact.state().touching && contact.search().inside(p);
  };
  Vector3d p(0, 0, 0);
  Vector3d heading(1, 0, 0);
  for (int tick = 0; tick < ticks; ++tick) {
    if (!contact.state().touching || tick % 500 == 0) {
      const auto t = static_cast<std::int32_t>(random.bits() %
                                               static_cast<std::uint64_t>(mesh.triangle_count()));
      const Vector3d middle = (mesh.position(t, 0) + mesh.position(t, 1) + mesh.position(t, 2)) / 3;
      const Vector3d above = middle + kStartAbove * mesh.cell(t).face.n;
      // A tip with an invalid position for a tick loses any contact.
      move(Vector3d::Constant(std::nan("")));
      move(above);
      p = middle - kStartAbove * mesh.cell(t).face.n;
      const bool entered = !contact.search().inside(above) && contact.search().inside(p);
      move(p);
      result.lost += entered && is_lost(p);
      heading = random.direction();
      ++result.starts;
      continue;
    }
    const ContactState before = contact.state();
    heading += 0.4 * random.in_box(1);
    heading = (heading - heading.dot(before.n_W) * before.n_W).normalized();
    const Vector3d p_before = p;
    const double wanted = kDepthMean + kDepthWave * std::sin(0.01 * tick);
    p += kStep * heading + 0.5 * (before.depth - wanted) * before.n_W;
    const ContactState& state = move(p);
    if (!state.touching) {
      ++result.left;
      result.lost += is_lost(p);
      continue;
    }
    ++result.in_contact;
    result.not_finite += !(state.n_W.allFinite() && state.p_WP.allFinite() &&
                           std::isfinite(state.depth) && state.n_W.norm() > 0.999);
    result.depth_max = std::max(result.depth_max, state.depth);
    const double jump = state.depth - before.depth - (p - p_before).norm();
    result.jumps += jump > mesh.depth_rounding();
    result.jump_max = std::max(result.jump_max, jump);
  }
  result.counters = contact.counters();
  return result;
}

TriangleMesh scaled(const TriangleMesh& mesh) {
  const MeshFindings found = check_mesh(mesh);
  const double side = (found.box_max - found.box_min).maxCoeff();
  return placed(mesh, side > 0 ? kSize / side : 1, Eigen::Matrix3d::Identity(), {0, 0, 0});
}

std::string csv_text(std::string text) {
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) {
    text.insert(at, 1, '"');
  }
  return '"' + text + '"';
}

// Returns whether an error names one of the faults, by two words of describe().
bool names_a_fault(const std::string& reason) {
  for (const char* words :
       {"has a hole", "more than two triangles", "share nothing else", "no area", "repeat",
        "only one side", "cannot be read", "truncated", "no face with three corners", "wound"}) {
    if (reason.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(MeshCollection, EveryMeshIsTouchableOrRefused) {
  if (!fs::exists(kFolder / "elephant.off")) {
    GTEST_SKIP() << "The scanned meshes are not here: run app/fetch_meshes.sh to unpack them.";
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".off" || ending == ".ply" || ending == ".stl") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  const int ticks = ticks_per_mesh();
  std::ofstream table("mesh_collection.csv");
  table << "mesh,triangles,verdict,ticks,in contact,left,lost,depth max (mm),jumps,jump max "
           "(mm),cycles,found near,"
           "found far,long walks,reason\n";
  int stroked = 0, refused = 0;
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    const auto mesh = load_mesh(file);
    std::string reason;
    std::optional<MeshContact> contact;
    if (!mesh) {
      reason = mesh.error().message;
    } else if (auto built = MeshContact::build(scaled(*mesh)); built) {
      contact.emplace(std::move(built).value());
      if (contact->mesh().orientation().turned_triangles > 0) {
        reason = describe(contact->mesh().orientation());
      }
    } else {
      reason = built.error().message;
    }
    const std::size_t triangles = mesh ? mesh->triangles.size() : 0;
    if (!contact) {
      ++refused;
      EXPECT_TRUE(names_a_fault(reason)) << name << ": " << reason;
      table << csv_text(name) << ',' << triangles << ",refused,,,,,,,,,,,," << csv_text(reason)
            << '\n';
      continue;
    }
    ++stroked;
    const Stroke done = stroke(*contact, ticks);
    EXPECT_EQ(done.lost, 0) << name;
    EXPECT_EQ(done.not_finite, 0) << name;
    EXPECT_LE(kStiffness * done.depth_max, kForceMax) << name;
    EXPECT_GT(done.in_contact, ticks / 2) << name;
    table << csv_text(name) << ',' << triangles << ",stroked," << ticks << ',' << done.in_contact
          << ',' << done.left << ',' << done.lost << ',' << 1000 * done.depth_max << ','
          << done.jumps << ',' << 1000 * done.jump_max << ',' << done.counters.cycles << ','
          << done.counters.found_near << ',' << done.counters.found_far << ','
          << done.counters.long_walks << ',' << csv_text(reason) << '\n';
  }
  std::printf("%d meshes stroked for %d ticks each, %d refused with a reason; table: %s\n", stroked,
              ticks, refused, fs::absolute("mesh_collection.csv").c_str());
  EXPECT_EQ(stroked + refused, static_cast<int>(files.size()));
  EXPECT_GE(stroked, 85);
}

// Cells of large thin faces overlap: a walk that ended in the wrong one reported a depth of 60 mm
// instead of 0.7 mm.
TEST(SurfaceTracker, DoesNotJumpIntoTheCellOfAFaceFarAway) {
  if (!fs::exists(kFolder / "mpi_triang.off")) {
    GTEST_SKIP() << "The scanned meshes are not here: run app/fetch_meshes.sh to unpack them.";
  }
  for (const char* name : {"mpi_triang.off", "part.off", "3torus.off"}) {
    MeshContact contact = MeshContact::build(scaled(load_mesh(kFolder / name).value())).value();
    const Stroke done = stroke(contact, 50000);
    std::printf("%-16s %d jumps, at most %.3f mm, called back %llu\n", name, done.jumps,
                1000 * done.jump_max,
                static_cast<unsigned long long>(contact.counters().called_back));
    EXPECT_EQ(done.lost, 0) << name;
    EXPECT_LE(done.jump_max, 0.0005) << name;
  }
}

}  // namespace
}  // namespace thimble::render
