#include "studies/ring_pages.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <utility>

#include "disk_paging/paged_contact.h"
#include "disk_paging/paged_surface.h"
#include "search/tree_search.h"
#include "studies/resident_memory.h"
#include "support/contact_walk.h"
#include "support/long_form.h"
#include "support/random.h"
#include "support/scratch.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;
using render::PackedTriangle;

constexpr BumpyRing kRing;

std::filesystem::path ring_of(std::int64_t triangles) {
  const auto file = support::scratch_folder() / (std::to_string(triangles) + ".pages");
  if (!std::filesystem::exists(file)) {
    EXPECT_TRUE(write_ring(kRing, ring_grid(kRing, triangles), file).ok());
  }
  return file;
}

std::array<std::int32_t, 3> corner(const PackedTriangle& t, std::size_t k) {
  return {t.x[k], t.y[k], t.z[k]};
}

/// Returns whether the edge from corner k of `t` runs in reverse along an edge of `other` whose
/// neighbour is `number`, with the same normals at its ends.
bool shares_edge(const PackedTriangle& t, std::size_t k, std::int32_t number,
                 const PackedTriangle& other) {
  for (std::size_t m = 0; m < 3; ++m) {
    if (other.neighbours[m] == number && corner(other, m) == corner(t, (k + 1) % 3) &&
        corner(other, (m + 1) % 3) == corner(t, k) && other.normals[m] == t.normals[(k + 1) % 3] &&
        other.normals[(m + 1) % 3] == t.normals[k]) {
      return true;
    }
  }
  return false;
}

TEST(RingPages, FormAClosedSurface) {
  for (const std::int64_t triangles : {1024, 20'000, 100'000}) {
    const auto file = render::PageFile::open(ring_of(triangles));
    ASSERT_TRUE(file.ok()) << file.error().message;
    const auto wanted = static_cast<double>(triangles);
    EXPECT_NEAR(file->triangle_count(), wanted, 0.25 * wanted + 100);
    std::vector<PackedTriangle> all;
    std::vector<PackedTriangle> page(render::kPageTriangles);
    for (std::size_t p = 0; p < file->boxes().size(); ++p) {
      ASSERT_EQ(file->read_page(static_cast<std::int32_t>(p), page), render::kPageTriangles);
      const render::PageBox around = render::box_of(page);
      EXPECT_EQ(around.min, file->boxes()[p].min);
      EXPECT_EQ(around.max, file->boxes()[p].max);
      all.insert(all.end(), page.begin(), page.end());
    }
    for (std::size_t t = 0; t < all.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_TRUE(shares_edge(all[t], k, static_cast<std::int32_t>(t),
                                all[static_cast<std::size_t>(all[t].neighbours[k])]))
            << "triangle " << t << ", edge " << k;
      }
      const Vector3d face = (all[t].corner(1) - all[t].corner(0))
                                .cross(all[t].corner(2) - all[t].corner(0))
                                .normalized();
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_GT(face.dot(render::unpack_normal(all[t].normals[k])),
                  triangles > 2000 ? 0.95 : 0.6);
      }
    }
  }
}

TEST(RingPages, EqualPagesOfTheSameMesh) {
  const auto file = ring_of(20'000);
  const auto pages = render::PageFile::open(file);
  ASSERT_TRUE(pages.ok());
  render::TriangleMesh mesh;
  std::map<std::array<std::int32_t, 3>, std::int32_t> vertices;
  std::vector<PackedTriangle> page(render::kPageTriangles);
  for (std::size_t p = 0; p < pages->boxes().size(); ++p) {
    ASSERT_GT(pages->read_page(static_cast<std::int32_t>(p), page), 0);
    for (const PackedTriangle& t : page) {
      std::array<std::int32_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [place, is_new] =
            vertices.try_emplace(corner(t, k), static_cast<std::int32_t>(mesh.vertices.size()));
        if (is_new) mesh.vertices.push_back(pages->lattice().position(t, k));
        corners[k] = place->second;
      }
      mesh.triangles.push_back(corners);
    }
  }
  const auto surface = render::PackedSurface::build(mesh);
  ASSERT_TRUE(surface.ok()) << surface.error().message;
  const render::TreeSearch<render::PackedSurface> tree(*surface);
  // Corner normals of the mesh are averages; those of the ring are exact.
  for (std::int32_t t = 0; t < surface->triangle_count(); ++t) {
    const std::int32_t source = surface->source(t);
    if (source / render::kPageTriangles != 3) continue;
    ASSERT_GT(pages->read_page(3, page), 0);
    const PackedTriangle& ours = page[static_cast<std::size_t>(source % render::kPageTriangles)];
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_GT(render::unpack_normal(ours.normals[k])
                    .dot(render::unpack_normal(surface->triangle(t).normals[k])),
                0.999);
    }
  }
  auto paged = render::PagedSurface::open(file, {.frames = 64, .reach = 1, .horizon = 0});
  ASSERT_TRUE(paged.ok());
  (*paged)->begin_tick({0, 0, 0}, {0, 0, 0});
  (*paged)->end_tick();
  while ((*paged)->serve() > 0) {
  }
  support::Random random(3);
  int entries = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d from = random.in_box(0.06), to = random.in_box(0.06);
    const render::Entry expected = tree.first_entry(from, to);
    const auto found = (*paged)->first_entry(from, to);
    const render::Entry& entry = found.entry;
    EXPECT_TRUE(found.complete);
    ASSERT_EQ(entry.triangle, expected.triangle < 0 ? -1 : surface->source(expected.triangle));
    entries += entry.triangle >= 0;
  }
  EXPECT_GT(entries, 500);
}

TEST(RingPages, NormalIsThatOfTheSurface) {
  support::Random random(4);
  for (int i = 0; i < 200; ++i) {
    const double u = random.uniform(0, 7), v = random.uniform(0, 7);
    constexpr double kStep = 1e-5;
    const Vector3d du = kRing.at(u + kStep, v) - kRing.at(u - kStep, v);
    const Vector3d dv = kRing.at(u, v + kStep) - kRing.at(u, v - kStep);
    EXPECT_LT((kRing.normal(u, v) - du.cross(dv).normalized()).norm(), 1e-7);
    EXPECT_LE(kRing.at(u, v).cwiseAbs().maxCoeff(), kRing.half_size());
  }
}

TEST(RingPages, WritingNeedsConstantMemory) {
  if (!support::long_form()) GTEST_SKIP() << "writes 640 MB: only with THIMBLE_LONG=1";
  ring_of(1'000'000);
  const std::size_t before = resident_memory().peak;
  const auto file = ring_of(10'000'000);
  EXPECT_LT(resident_memory().peak, before + (4u << 20));
  std::filesystem::remove(file);
}

// A tip slides at 0.5 m/s over a ring of 10^7 triangles on disk (10^5 in the short form), with 16
// MiB (4) of it in memory. The depth is known in closed form, every page is loaded in time, and
// memory does not grow with the mesh.
TEST(RingPages, TenMillionTrianglesFitTheFrames) {
  const auto file = ring_of(support::long_form() ? 10'000'000 : 100'000);
  const std::size_t frames = support::long_form() ? 256 : 64;
  const std::size_t before = resident_memory().now;
  auto opened =
      render::PagedSurface::open(file, {.frames = frames, .reach = 0.003, .horizon = 0.01});
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  render::PagedContact contact(std::move(opened).value());
  constexpr double kTick = 1e-3, kSpeed = 0.5, kPressed = 5e-4;
  const auto at = [](double turn, double height) {
    // Winds around the tube while it moves around the ring.
    return Vector3d(kRing.at(turn, 3.7 * turn) + height * kRing.normal(turn, 3.7 * turn));
  };
  driver::DeviceState state;
  state.dt = kTick;
  const auto move = [&](const Vector3d& p) {
    state.v_WT = state.tick++ > 0 ? Vector3d((p - state.p_WT) / kTick) : Vector3d::Zero();
    state.p_WT = p;
    const render::ContactState& felt = contact.update(state);
    while (contact.surface().serve() > 0) {
    }
    return felt;
  };
  for (int i = 0; i <= 100; ++i) move(at(0, 2e-3 - (2e-3 + kPressed) * i / 100));
  double turn = 0, worst = 0;
  std::size_t most = 0;
  const int ticks = support::long_form() ? 20'000 : 4000;
  for (int i = 0; i < ticks; ++i) {
    constexpr double kStep = 1e-6;
    turn += kSpeed * kTick * 2 * kStep /
            (at(turn + kStep, -kPressed) - at(turn - kStep, -kPressed)).norm();
    const render::ContactState felt = move(at(turn, -kPressed));
    ASSERT_TRUE(felt.touching) << i;
    worst = std::max(worst, std::abs(felt.depth - kPressed));
    if (i % 1000 == 0) most = std::max(most, resident_memory().now);
  }
  std::printf("  depth off by %.3g um, %.1f MiB more memory, %d pages read\n", 1e6 * worst,
              static_cast<double>(most - before) / (1 << 20),
              static_cast<int>(contact.surface().counters().loads));
  EXPECT_EQ(contact.misses(), 0u);
  EXPECT_LT(worst, 1e-6);
  EXPECT_LT(most, before + (48u << 20));
  EXPECT_GT(contact.surface().counters().loads, frames) << "the whole ring was in memory";
}

TEST(RingPages, SayWhenTheyCannotBeWritten) {
  EXPECT_FALSE(write_ring(kRing, ring_grid(kRing, 1024), "/no/such/folder/ring.pages").ok());
}

}  // namespace
}  // namespace thimble::studies
