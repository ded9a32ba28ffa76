#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "disk_paging/paged_surface.h"
#include "mesh/closest_point.h"
#include "search/tree_search.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/scratch.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

bool same(const PackedTriangle& a, const PackedTriangle& b) {
  return std::memcmp(&a, &b, sizeof(PackedTriangle)) == 0;
}

/// A bumpy sphere of 0.1 m and 20,480 triangles: 20 pages.
const PackedSurface& bumpy() {
  static const PackedSurface surface =
      PackedSurface::build(support::bumpy_sphere(5, 0.05, 0.1, 6)).value();
  return surface;
}

std::filesystem::path page_file() {
  static const std::filesystem::path file = [] {
    const auto path = support::scratch_folder() / "bumpy.pages";
    EXPECT_TRUE(write_page_file(bumpy(), path).ok());
    return path;
  }();
  return file;
}

std::unique_ptr<PagedSurface> open(const PagingSettings& settings = {}) {
  auto opened = PagedSurface::open(page_file(), settings);
  EXPECT_TRUE(opened.ok()) << (opened ? "" : opened.error().message);
  return std::move(opened).value();
}

double distance_to(std::int32_t t, const Vector3d& p) {
  const Vector3d q =
      closest_point(p, bumpy().position(t, 0), bumpy().position(t, 1), bumpy().position(t, 2));
  return (q - p).norm();
}

void tick(PagedSurface& surface, const Vector3d& p_W, const Vector3d& v_W = {0, 0, 0}) {
  surface.begin_tick(p_W, v_W);
  surface.end_tick();
}

void serve_all(PagedSurface& surface) {
  while (surface.serve() > 0) {
  }
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Opens a file of these bytes and returns the error.
std::string refusal(const std::string& bytes) {
  const auto path = support::scratch_folder() / "damaged.pages";
  std::ofstream(path, std::ios::binary) << bytes;
  const auto opened = PageFile::open(path);
  return opened ? "" : opened.error().message;
}

TEST(PageFile, ReturnsEveryRecordAndABoxPerPage) {
  const auto file = PageFile::open(page_file());
  ASSERT_TRUE(file.ok()) << file.error().message;
  ASSERT_EQ(file->triangle_count(), bumpy().triangle_count());
  EXPECT_GT(file->rise(), 0);
  EXPECT_EQ(file->rise(), bumpy().rise());
  std::vector<PackedTriangle> triangles(kPageTriangles);
  std::int32_t next = 0;
  for (std::size_t page = 0; page < file->boxes().size(); ++page) {
    const std::int32_t count = file->read_page(static_cast<std::int32_t>(page), triangles);
    ASSERT_GT(count, 0);
    for (std::int32_t i = 0; i < count; ++i, ++next) {
      const PackedTriangle& packed = triangles[static_cast<std::size_t>(i)];
      EXPECT_TRUE(same(packed, bumpy().triangle(next)));
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d x = packed.corner(k);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_LE(file->boxes()[page].min[axis], x[static_cast<Eigen::Index>(axis)]);
          EXPECT_GE(file->boxes()[page].max[axis], x[static_cast<Eigen::Index>(axis)]);
        }
        EXPECT_EQ(file->lattice().position(packed, k), bumpy().position(next, k));
      }
    }
  }
  EXPECT_EQ(next, bumpy().triangle_count());
  EXPECT_EQ(file->read_page(static_cast<std::int32_t>(file->boxes().size()), triangles), 0);
  EXPECT_EQ(file->read_page(-1, triangles), 0);
}

TEST(PageFile, ForeignOrDamagedFileIsRefusedWithAReason) {
  const std::string good = bytes_of(page_file());
  EXPECT_EQ(refusal(good), "");
  EXPECT_NE(refusal("").find("not a page file"), std::string::npos);
  EXPECT_NE(refusal("OFF\n4 4 0\n" + std::string(200, ' ')).find("not a page file"),
            std::string::npos);
  EXPECT_NE(refusal(good.substr(0, good.size() - 1)).find("it ends after"), std::string::npos);
  std::string other = good;
  other[8] = 9;
  EXPECT_NE(refusal(other).find("another version"), std::string::npos);
  other = good;
  other[24] = other[25] = other[26] = other[27] = '\x7f';
  EXPECT_NE(refusal(other), "");
  EXPECT_NE(PageFile::open("no_such.pages").error().message.find("no such file"),
            std::string::npos);
  EXPECT_NE(PageFile::open(testing::TempDir()).error().message.find("not a file"),
            std::string::npos);
}

TEST(PageFile, DamagedPagesAreNotReturned) {
  support::Random random(5);
  const std::string good = bytes_of(page_file());
  const std::size_t records_at =
      good.size() - static_cast<std::size_t>(bumpy().triangle_count()) * sizeof(PackedTriangle);
  for (int k = 0; k < 200; ++k) {
    std::string damaged = good;
    const std::size_t at = random.bits() % (64 * 1024);
    damaged[records_at + at] =
        static_cast<char>(damaged[records_at + at] ^ (1 << (random.bits() % 8)));
    const auto path = support::scratch_folder() / "damaged.pages";
    std::ofstream(path, std::ios::binary) << damaged;
    const auto file = PageFile::open(path);
    ASSERT_TRUE(file.ok());
    std::vector<PackedTriangle> triangles(kPageTriangles);
    EXPECT_EQ(file->read_page(0, triangles), 0) << "byte " << at;
    EXPECT_GT(file->read_page(1, triangles), 0);
  }
}

TEST(PageFile, IsRefusedWhenAnyBitBeforeItsPagesIsDamaged) {
  support::Random random(6);
  const std::string good = bytes_of(page_file());
  const std::size_t used = 64 + (24 + 8) * PageFile::open(page_file())->boxes().size();
  for (int k = 0; k < 300; ++k) {
    std::string damaged = good;
    const std::size_t at = k < 64 ? static_cast<std::size_t>(k) : random.bits() % used;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random.bits() % 8)));
    EXPECT_NE(refusal(damaged), "") << "byte " << at;
  }
}

TEST(PageFile, RefusesAWrongNumberOfTriangles) {
  const auto path = support::scratch_folder() / "short.pages";
  auto writer = PageFileWriter::create(path, {{0, 0, 0}, 1}, 10);
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE(writer->append(bumpy().triangles().first(9)).ok());
  const auto done = writer->finish();
  ASSERT_FALSE(done.ok());
  EXPECT_NE(done.error().message.find("9 triangles were written, but 10 were announced"),
            std::string::npos);
  EXPECT_FALSE(PageFile::open(path).ok());
  EXPECT_FALSE(PageFileWriter::create(path, {{0, 0, 0}, 1}, 0).ok());
  EXPECT_FALSE(PageFileWriter::create("/no/such/folder/x.pages", {{0, 0, 0}, 1}, 1).ok());
}

TEST(PagedSurface, LoadsPagesWithinReachAndAhead) {
  const PagingSettings settings{.frames = 12, .reach = 0.004, .horizon = 0.02};
  const auto surface = open(settings);
  support::Random random(6);
  for (int step = 0; step < 300; ++step) {
    // A spiral from pole to pole, so that every page is loaded and discarded.
    const double down = 0.01 * step, around = 0.3 * step;
    const Vector3d p_W = 0.05 * Vector3d(std::sin(down) * std::cos(around),
                                         std::sin(down) * std::sin(around), std::cos(down));
    const Vector3d v_W = 0.3 * random.direction();
    tick(*surface, p_W, v_W);
    serve_all(*surface);
    for (std::int32_t t = 0; t < bumpy().triangle_count(); t += 7) {
      for (const double ahead : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Vector3d place = p_W + ahead * settings.horizon * v_W;
        if ((bumpy().position(t, 0) - place).norm() > settings.reach) continue;
        const PackedTriangle* found = surface->find(t);
        ASSERT_TRUE(found) << "triangle " << t << " in step " << step;
        EXPECT_TRUE(same(*found, bumpy().triangle(t)));
      }
    }
  }
  EXPECT_GT(surface->counters().evictions, 0u);
  EXPECT_EQ(surface->counters().short_of_frames, 0u);
  EXPECT_EQ(surface->counters().failures, 0u);
}

TEST(PagedSurface, PagesWithinReachArePresentAfterSmallMoves) {
  // Steps shorter than the distance for which pages were loaded in advance; the tip, the place and
  // the velocity move in turn while the others rest.
  const PagingSettings settings{.frames = 12, .reach = 0.004, .horizon = 0.02};
  const auto surface = open(settings);
  support::Random random(303);
  constexpr int kSteps = 100;
  std::uint64_t idle = 0;
  for (int block = 0; block < 30; ++block) {
    const Vector3d begin = 0.05 * random.direction(), heading = random.direction();
    for (int step = 0; step < kSteps; ++step) {
      const Vector3d moved = 0.05 * (begin + 0.0004 * step * heading).normalized();
      const Vector3d p_tip = block % 3 == 0 ? moved : begin;
      const Vector3d p_place = block % 3 == 1 ? moved : begin;
      const Vector3d way = block % 3 == 2 ? Vector3d(moved - begin) : Vector3d(0, 0, 0);
      const Vector3d v_W = way / settings.horizon;
      surface->begin_tick(p_tip, p_place, v_W);
      surface->end_tick();
      const std::uint64_t before = surface->counters().loads;
      serve_all(*surface);
      if (surface->counters().loads == before) ++idle;
      for (std::int32_t t = 0; t < bumpy().triangle_count(); t += 3) {
        const Vector3d p = bumpy().position(t, 0);
        for (const Vector3d& path :
             {Vector3d(0.5 * (p_tip + p_place)), p_tip, p_place, Vector3d(p_tip + way)}) {
          if ((p - path).norm() > settings.reach) continue;
          ASSERT_TRUE(surface->find(t))
              << "triangle " << t << " in step " << step << " of " << block;
        }
      }
    }
  }
  EXPECT_GT(idle, 1000u);
  EXPECT_EQ(surface->counters().short_of_frames, 0u);
}

TEST(PagedSurface, LoadsAheadOfItsReachWhereItHasRoom) {
  const auto loads = [](std::size_t frames) {
    const auto surface = open({.frames = frames, .reach = 0.02, .horizon = 0});
    tick(*surface, {0, 0, 0.05});
    serve_all(*surface);
    EXPECT_EQ(surface->counters().short_of_frames, 0u) << frames;
    return surface->counters().loads;
  };
  const std::uint64_t roomy = loads(20);
  std::uint64_t tight = 0;  // loaded by the smallest number of frames that suffices
  for (std::size_t frames = roomy - 1; frames > 0; --frames) {
    const auto surface = open({.frames = frames, .reach = 0.02, .horizon = 0});
    tick(*surface, {0, 0, 0.05});
    serve_all(*surface);
    if (surface->counters().short_of_frames > 0) break;
    tight = surface->counters().loads;
    EXPECT_LE(tight, frames);
  }
  EXPECT_GT(tight, 0u);
  EXPECT_LT(tight, roomy);
}

TEST(PagedSurface, EvictsThePageThatWasWantedLeastRecently) {
  // Two places in turn, and a third one: the pages of the first, wanted again, stay.
  const auto surface = open({.frames = 6, .reach = 0.002, .horizon = 0});
  const auto visit = [&](const Vector3d& p_W) {
    tick(*surface, p_W);
    serve_all(*surface);
  };
  const TreeSearch<PackedSurface> tree(bumpy());
  const auto at = [&tree](const Vector3d& p_W) { return tree.closest(p_W, 1).triangle; };
  const Vector3d a(0, 0, 0.05), b(0, 0.05, 0), c(0.05, 0, 0), d(-0.05, 0, 0);
  visit(a);
  visit(b);
  for (int step = 0; step < 100; ++step) {
    visit(a);
    visit(step % 2 == 0 ? c : d);
    ASSERT_TRUE(surface->find(at(a))) << step;
  }
  EXPECT_FALSE(surface->find(at(b)));
  EXPECT_GT(surface->counters().evictions, 0u);
}

TEST(PagedSurface, KeepsTheNearestPagesWhenItHasTooFewFrames) {
  const auto surface = open({.frames = 2, .reach = 0.2, .horizon = 0});
  tick(*surface, {0, 0, 0.05});
  serve_all(*surface);
  EXPECT_GT(surface->counters().short_of_frames, 0u);
  EXPECT_EQ(surface->counters().loads, 2u);
  const SurfacePoint under = TreeSearch<PackedSurface>(bumpy()).closest({0, 0, 0.05}, 1);
  ASSERT_GE(under.triangle, 0);
  EXPECT_TRUE(surface->find(under.triangle));
}

TEST(PagedSurface, FindsTheEntriesOfATreeInMemory) {
  const auto surface = open({.frames = 64, .reach = 1, .horizon = 0});
  const TreeSearch<PackedSurface> tree(bumpy());
  support::Random random(7);
  EXPECT_FALSE(surface->first_entry({0, 0, 0.08}, {0, 0, 0.03}).complete);  // nothing is loaded yet
  tick(*surface, {0, 0, 0.05});
  serve_all(*surface);
  int entries = 0;
  for (int k = 0; k < 20'000; ++k) {
    const Vector3d from = 0.07 * random.direction();
    const Vector3d to =
        k % 2 == 0 ? Vector3d(random.in_box(0.05)) : Vector3d(from * 0.6 + random.in_box(0.003));
    const Entry expected = tree.first_entry(from, to);
    const auto [entry, complete, leaves] = surface->first_entry(from, to);
    EXPECT_TRUE(complete);
    EXPECT_EQ(leaves, tree.inside(from) == tree.inside(to));
    EXPECT_EQ(entry.triangle, expected.triangle);
    if (entry.triangle < 0) continue;
    ++entries;
    EXPECT_NEAR(entry.parameter, expected.parameter, 1e-9);
  }
  EXPECT_GT(entries, 10'000);
}

TEST(PagedSurface, MatchesInsideAndNearestOfATreeInMemory) {
  const auto surface = open({.frames = 64, .reach = 1, .horizon = 0});
  const TreeSearch<PackedSurface> tree(bumpy());
  support::Random random(9);
  bool complete = true;
  surface->inside({0, 0, 0}, complete);
  EXPECT_FALSE(complete);
  EXPECT_EQ(surface->closest({0, 0, 0}, 1, complete), -1);
  EXPECT_FALSE(complete);
  tick(*surface, {0, 0, 0.05});
  serve_all(*surface);
  int within = 0;
  for (int k = 0; k < 5'000; ++k) {
    const auto t = static_cast<std::int32_t>(random.bits() % 20'480);
    // Corners, midpoints of edges, places near the surface and anywhere.
    Vector3d p = random.in_box(0.06);
    if (k % 4 == 0) p = bumpy().position(t, 0);
    if (k % 4 == 1) p = 0.5 * (bumpy().position(t, 0) + bumpy().position(t, 1));
    if (k % 4 == 2) p = bumpy().position(t, 0) + random.in_box(1e-4);
    const bool inside = surface->inside(p, complete);
    EXPECT_TRUE(complete);
    EXPECT_EQ(inside, tree.inside(p)) << k;
    if (k < 200) {
      EXPECT_EQ(surface->inside_by_reading(p), inside) << k;
    }
    within += inside;
    const SurfacePoint nearest = tree.closest(p, 0.002);
    const std::int32_t found = surface->closest(p, 0.002, complete);
    EXPECT_TRUE(complete);
    ASSERT_EQ(found < 0, nearest.triangle < 0) << k;
    if (found >= 0) {
      EXPECT_NEAR(distance_to(found, p), nearest.distance, 1e-12) << k;
    }
  }
  EXPECT_GT(within, 1000);
  EXPECT_LT(within, 4000);
}

TEST(PagedSurface, ReportsUnknownInsteadOfAWrongAnswer) {
  // A few of many pages: every answer that claims to be complete must be correct.
  const auto surface = open({.frames = 5, .reach = 0.0048, .horizon = 0});
  const TreeSearch<PackedSurface> tree(bumpy());
  support::Random random(10);
  int known = 0, unknown = 0;
  for (int place = 0; place < 40; ++place) {
    const Vector3d around = 0.05 * random.direction();
    tick(*surface, around);
    serve_all(*surface);
    for (int k = 0; k < 200; ++k) {
      const Vector3d p = around + random.in_box(0.008), to = around + random.in_box(0.008);
      bool complete = false;
      const bool inside = surface->inside(p, complete);
      if (complete) {
        EXPECT_EQ(inside, tree.inside(p));
      }
      if (!complete) {
        EXPECT_FALSE(inside);
      }
      complete ? ++known : ++unknown;
      const FoundEntry found = surface->first_entry(p, to);
      if (found.complete) {
        EXPECT_EQ(found.entry.triangle, tree.first_entry(p, to).triangle);
      }
      const std::int32_t nearest = surface->closest(p, 0.01, complete);
      if (complete) {
        const SurfacePoint expected = tree.closest(p, 0.01);
        ASSERT_EQ(nearest < 0, expected.triangle < 0);
        // Equally near triangles share an edge or a corner; rounding decides which one is returned.
        if (nearest >= 0) {
          EXPECT_NEAR(distance_to(nearest, p), expected.distance, 1e-12);
        }
      }
    }
  }
  EXPECT_GT(known, 1000);
  EXPECT_GT(unknown, 1000);
}

TEST(PagedSurface, LoadingNeverShowsAWrongRecord) {
  // A fast tip, few frames, and a servo that reads packed triangles for a whole tick. The thread
  // sanitizer and the comparison would detect a frame that is reused too early.
  const auto surface = open({.frames = 6, .reach = 0.003, .horizon = 0.01});
  surface->start_loader();
  support::Random random(8);
  Vector3d direction(0, 0, 1);
  std::size_t seen = 0, wrong = 0;
  for (int step = 0; step < 4000; ++step) {
    direction = (direction + 0.1 * random.direction()).normalized();
    surface->begin_tick(0.05 * direction, {0, 0, 0});
    for (int look = 0; look < 200; ++look) {
      const auto t = static_cast<std::int32_t>(
          random.bits() % static_cast<std::uint64_t>(bumpy().triangle_count()));
      const PackedTriangle* found = surface->find(t);
      if (!found) continue;
      ++seen;
      if (!same(*found, bumpy().triangle(t))) ++wrong;
    }
    surface->end_tick();
    if (step % 16 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(seen, 1000u);
  EXPECT_GT(surface->counters().evictions, 10u);
}

}  // namespace
}  // namespace thimble::render
