#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <vector>

#include "support/meshes/reference_geometry.h"
#include "support/seed.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/mesh_file.h"
#include "track/mesh_contact.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
namespace fs = std::filesystem;

const fs::path kFolder = THIMBLE_MESHES;
constexpr const char* kAbsent =
    "The scanned meshes are not here: run app/fetch_meshes.sh to unpack them.";

TEST(ScannedMeshes, EachLoadsOrIsRefusedWithAReason) {
  if (!fs::exists(kFolder / "elephant.off")) GTEST_SKIP() << kAbsent;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".off") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  int touchable = 0;
  for (const fs::path& file : files) {
    std::string reason;
    const auto mesh = load_mesh(file);
    if (mesh) {
      const auto contact = ContactMesh::build(*mesh);
      if (contact) {
        ++touchable;
        EXPECT_GT(contact->triangle_count(), 0) << file;
      } else {
        reason = contact.error().message;
        EXPECT_FALSE(reason.empty()) << file;
      }
    } else {
      reason = mesh.error().message;
      EXPECT_EQ(reason.find(file.string()), 0u) << reason;
    }
    if (!reason.empty()) std::printf("%-32s %s\n", file.filename().c_str(), reason.c_str());
  }
  std::printf("%d of %zu meshes can be touched.\n", touchable, files.size());
  EXPECT_GT(touchable, 50);
}

TEST(ScannedMeshes, ElephantKeepsContactBelowItsSkin) {
  if (!fs::exists(kFolder / "elephant.off")) GTEST_SKIP() << kAbsent;
  const TriangleMesh file = load_mesh(kFolder / "elephant.off").value();
  const MeshFindings size = check_mesh(file);
  const double scale = 0.1 / (size.box_max - size.box_min).maxCoeff();
  const TriangleMesh mesh = placed(file, scale, Eigen::Matrix3d::Identity(), {0, 0, 0});
  MeshContact contact = MeshContact::build(mesh).value();
  std::mt19937_64 random(support::seed_of(21));
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<std::size_t> any_triangle(0, mesh.triangles.size() - 1);
  const auto move = [&contact](const Vector3d& p) -> const ContactState& {
    driver::DeviceState state;
    state.p_WT = p;
    return contact.update(state);
  };
  Vector3d p(0, 0, 0);
  Vector3d heading(1, 0, 0);
  int lost = 0, left = 0, starts = 0, inside_seen = 0, outside_cell = 0, in_contact = 0;
  for (int tick = 0; tick < 100000; ++tick) {
    if (!contact.state().touching) {
      const std::size_t t = any_triangle(random);
      const Vector3d middle = (support::corner(mesh, t, 0) + support::corner(mesh, t, 1) +
                               support::corner(mesh, t, 2)) /
                              3;
      move(middle + 1e-5 * support::outward_normal(mesh, t));
      p = middle - 1e-5 * support::outward_normal(mesh, t);
      move(p);
      ++starts;
      continue;
    }
    const ContactState before = contact.state();
    heading += 0.2 * Vector3d(normal(random), normal(random), normal(random));
    heading = (heading - heading.dot(before.n_W) * before.n_W).normalized();
    const double wanted = 0.00065 + 0.00035 * std::sin(0.01 * tick);
    p += 0.0002 * heading + 0.5 * (before.depth - wanted) * before.n_W;
    const TrackerCounters counters = contact.counters();
    const ContactState& state = move(p);
    if (!state.touching) {
      ++left;
      lost += support::is_inside(mesh, p);
      continue;
    }
    ++in_contact;
    if (tick % 200 == 0) inside_seen += support::is_inside(mesh, p);
    // Unless the tracker reports that no cell was found, or that another face of the fan is nearer,
    // the tip is in the active triangle's cell.
    const TrackerCounters& now = contact.counters();
    const bool settled = now.cycles != counters.cycles || now.long_walks != counters.long_walks ||
                         now.found_near != counters.found_near ||
                         now.found_far != counters.found_far || now.nearer != counters.nearer;
    if (!settled) {
      const auto t = static_cast<std::size_t>(state.triangle);
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d& a = support::corner(mesh, t, k);
        const Vector3d& b = support::corner(mesh, t, (k + 1) % 3);
        const auto other =
            static_cast<std::size_t>(contact.mesh().cell(state.triangle).neighbours[k]);
        const Vector3d average =
            support::outward_normal(mesh, t) + support::outward_normal(mesh, other);
        outside_cell += average.cross(b - a).normalized().dot(p - a) < -1e-12;
      }
    }
  }
  const TrackerCounters& counters = contact.counters();
  std::printf("starts %d, left %d, in contact %d, cycles %llu, found near %llu, far %llu\n", starts,
              left, in_contact, static_cast<unsigned long long>(counters.cycles),
              static_cast<unsigned long long>(counters.found_near),
              static_cast<unsigned long long>(counters.found_far));
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(outside_cell, 0);
  EXPECT_GT(in_contact, 80000);
  EXPECT_GT(inside_seen, 300);
}

}  // namespace
}  // namespace thimble::render
