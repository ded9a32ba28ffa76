#include "studies/ring_pages.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "disk_paging/page_file.h"
#include "log/progress.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kPatchAround = 32;
constexpr std::int32_t kPatchAcross = 16;
constexpr std::int32_t kPatchSquares = kPatchAround * kPatchAcross;
static_assert(2 * kPatchSquares == render::kPageTriangles);

/// Precomputed values of one angle: its sine and cosine, and those of its waves.
struct Turn {
  double cosine, sine, wave_cosine, wave_sine;
};

/// Returns the index of (row, column) in a table stored row by row.
std::size_t index(std::int32_t row, std::int32_t columns, std::int32_t column) noexcept {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(column);
}

Turn turn_of(double angle, int waves) noexcept {
  return {std::cos(angle), std::sin(angle), std::cos(waves * angle), std::sin(waves * angle)};
}

std::vector<Turn> turns(std::int32_t count, int waves) {
  std::vector<Turn> all;
  all.reserve(static_cast<std::size_t>(count));
  for (std::int32_t i = 0; i < count; ++i) {
    all.push_back(turn_of(2 * std::numbers::pi * i / count, waves));
  }
  return all;
}

double tube_at(const BumpyRing& ring, const Turn& u, const Turn& v) noexcept {
  return ring.tube_radius * (1 + ring.amplitude * u.wave_sine * v.wave_sine);
}

Vector3d point_at(const BumpyRing& ring, const Turn& u, const Turn& v) noexcept {
  const double tube = tube_at(ring, u, v);
  const double out = ring.ring_radius + tube * v.cosine;
  return {out * u.cosine, out * u.sine, tube * v.sine};
}

// Returns the cross product of the derivatives, in the frame that rotates with u: (outwards, along
// u, z).
Vector3d normal_at(const BumpyRing& ring, const Turn& u, const Turn& v) noexcept {
  const double tube = tube_at(ring, u, v);
  const double bump = ring.tube_radius * ring.amplitude;
  const double tube_u = bump * ring.waves_around * u.wave_cosine * v.wave_sine;
  const double tube_v = bump * ring.waves_across * u.wave_sine * v.wave_cosine;
  const Vector3d along_u(tube_u * v.cosine, ring.ring_radius + tube * v.cosine, tube_u * v.sine);
  const Vector3d along_v(tube_v * v.cosine - tube * v.sine, 0, tube_v * v.sine + tube * v.cosine);
  const Vector3d n = along_u.cross(along_v).normalized();
  return {u.cosine * n.x() - u.sine * n.y(), u.sine * n.x() + u.cosine * n.y(), n.z()};
}

// Inserts a zero bit between the bits of a number.
std::uint64_t spread(std::uint64_t v) noexcept {
  std::uint64_t spread = 0;
  for (unsigned bit = 0; bit < 16; ++bit) spread |= ((v >> bit) & 1u) << (3 * bit);
  return spread;
}

/// Numbers the triangles of a ring: the page of a patch, and the place of a square within it.
class RingNumbers {
 public:
  RingNumbers(const BumpyRing& ring, const RingGrid& grid)
      : grid_(grid), patches_across_(grid.across / kPatchAcross) {
    const std::int32_t patches = grid.around / kPatchAround * patches_across_;
    std::vector<std::uint64_t> keys;
    for (std::int32_t patch = 0; patch < patches; ++patch) {
      const std::int32_t row = patch / patches_across_;
      const double u = 2 * std::numbers::pi * (row + 0.5) * kPatchAround / grid.around;
      const double v =
          2 * std::numbers::pi * (patch % patches_across_ + 0.5) * kPatchAcross / grid.across;
      std::uint64_t key = 0;
      for (unsigned axis = 0; axis < 3; ++axis) {
        const double share = 0.5 + 0.5 * ring.at(u, v)[axis] / ring.half_size();
        key |= spread(static_cast<std::uint64_t>(std::clamp(65536 * share, 0.0, 65535.0))) << axis;
      }
      keys.push_back(key);
    }
    patch_of_page_.resize(keys.size());
    std::iota(patch_of_page_.begin(), patch_of_page_.end(), 0);
    std::stable_sort(patch_of_page_.begin(), patch_of_page_.end(),
                     [&keys](std::int32_t a, std::int32_t b) {
                       return keys[static_cast<std::size_t>(a)] < keys[static_cast<std::size_t>(b)];
                     });
    page_of_patch_.resize(keys.size());
    for (std::size_t page = 0; page < patch_of_page_.size(); ++page) {
      page_of_patch_[static_cast<std::size_t>(patch_of_page_[page])] =
          static_cast<std::int32_t>(page);
    }
    // Within a patch the bits of both indices are interleaved, those around the ring first.
    for (std::int32_t i = 0; i < kPatchAround; ++i) {
      for (std::int32_t j = 0; j < kPatchAcross; ++j) {
        std::int32_t place = 0;
        for (int bit = 0; bit < 5; ++bit) {
          place |= ((i >> bit) & 1) << (2 * bit);
          if (bit < 4) place |= ((j >> bit) & 1) << (2 * bit + 1);
        }
        place_[index(i, kPatchAcross, j)] = place;
      }
    }
  }

  std::int32_t pages() const { return static_cast<std::int32_t>(patch_of_page_.size()); }
  std::int32_t first_around(std::int32_t page) const {
    return patch_of_page_[static_cast<std::size_t>(page)] / patches_across_ * kPatchAround;
  }
  std::int32_t first_across(std::int32_t page) const {
    return patch_of_page_[static_cast<std::size_t>(page)] % patches_across_ * kPatchAcross;
  }

  /// Returns the number of square (i, j)'s triangle: the one below its diagonal, or above. Indices
  /// wrap around by one.
  std::int32_t triangle(std::int32_t i, std::int32_t j, bool above) const {
    i = (i + grid_.around) % grid_.around;
    j = (j + grid_.across) % grid_.across;
    const std::int32_t patch = i / kPatchAround * patches_across_ + j / kPatchAcross;
    return page_of_patch_[static_cast<std::size_t>(patch)] * render::kPageTriangles +
           2 * place(i % kPatchAround, j % kPatchAcross) + (above ? 1 : 0);
  }

  /// Returns the place of square (i, j) of a patch in its page.
  std::int32_t place(std::int32_t i, std::int32_t j) const {
    return place_[index(i, kPatchAcross, j)];
  }

 private:
  RingGrid grid_;
  std::int32_t patches_across_;
  std::vector<std::int32_t> patch_of_page_, page_of_patch_;
  std::array<std::int32_t, kPatchSquares> place_{};
};

/// A corner in the format of records.
struct Corner {
  std::array<std::int32_t, 3> position;
  std::uint32_t normal;
};

/// Returns a record without the neighbours.
render::PackedTriangle record_of(const Corner& a, const Corner& b, const Corner& c) {
  const std::array<const Corner*, 3> corners{&a, &b, &c};
  render::PackedTriangle record{};
  for (std::size_t k = 0; k < 3; ++k) {
    record.x[k] = corners[k]->position[0];
    record.y[k] = corners[k]->position[1];
    record.z[k] = corners[k]->position[2];
    record.normals[k] = corners[k]->normal;
  }
  return record;
}

}  // namespace

Vector3d BumpyRing::at(double u, double v) const noexcept {
  return point_at(*this, turn_of(u, waves_around), turn_of(v, waves_across));
}

Vector3d BumpyRing::normal(double u, double v) const noexcept {
  return normal_at(*this, turn_of(u, waves_around), turn_of(v, waves_across));
}

RingGrid ring_grid(const BumpyRing& ring, std::int64_t triangles) {
  const double squares = std::max(static_cast<double>(triangles) / 2, 1.0);
  const double ratio = ring.ring_radius / ring.tube_radius;  // of the two directions
  const auto patches = [](double cells, std::int32_t per_patch) {
    return per_patch * std::max(1, static_cast<std::int32_t>(std::lround(cells / per_patch)));
  };
  const std::int32_t across = patches(std::sqrt(squares / ratio), kPatchAcross);
  return {.around = patches(squares / across, kPatchAround), .across = across};
}

driver::Result<void> write_ring(const BumpyRing& ring, const RingGrid& grid,
                                const std::filesystem::path& file) {
  const render::Lattice lattice{{0, 0, 0}, ring.half_size() / render::kLatticeHalf};
  auto writer = render::PageFileWriter::create(file, lattice, grid.triangle_count());
  if (!writer) return writer.error();
  const RingNumbers numbers(ring, grid);
  // Patches compute a shared corner from the same numbers, so the results are bit-identical.
  const std::vector<Turn> around = turns(grid.around, ring.waves_around);
  const std::vector<Turn> across = turns(grid.across, ring.waves_across);
  constexpr std::int32_t kCornersAcross = kPatchAcross + 1;
  std::vector<Corner> corners(static_cast<std::size_t>((kPatchAround + 1) * kCornersAcross));
  const auto corner = [&corners](std::int32_t i, std::int32_t j) -> Corner& {
    return corners[index(i, kCornersAcross, j)];
  };
  std::vector<render::PackedTriangle> page(render::kPageTriangles);
  scene::Progress progress("mesh generate");
  for (std::int32_t number = 0; number < numbers.pages(); ++number) {
    progress.set_share(static_cast<std::size_t>(number) + 1,
                       static_cast<std::size_t>(numbers.pages()));
    const std::int32_t i0 = numbers.first_around(number), j0 = numbers.first_across(number);
    for (std::int32_t i = 0; i <= kPatchAround; ++i) {
      for (std::int32_t j = 0; j <= kPatchAcross; ++j) {
        const Turn& u = around[static_cast<std::size_t>((i0 + i) % grid.around)];
        const Turn& v = across[static_cast<std::size_t>((j0 + j) % grid.across)];
        const Vector3d p = point_at(ring, u, v) / lattice.step;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          corner(i, j).position[axis] =
              static_cast<std::int32_t>(std::lrint(p[static_cast<Eigen::Index>(axis)]));
        }
        corner(i, j).normal = render::pack_normal(normal_at(ring, u, v));
      }
    }
    for (std::int32_t i = 0; i < kPatchAround; ++i) {
      for (std::int32_t j = 0; j < kPatchAcross; ++j) {
        const auto at = 2 * static_cast<std::size_t>(numbers.place(i, j));
        const std::int32_t gi = i0 + i, gj = j0 + j;
        page[at] = record_of(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1));
        page[at].neighbours = {numbers.triangle(gi, gj - 1, true),
                               numbers.triangle(gi + 1, gj, true), numbers.triangle(gi, gj, true)};
        page[at + 1] = record_of(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
        page[at + 1].neighbours = {numbers.triangle(gi, gj, false),
                                   numbers.triangle(gi, gj + 1, false),
                                   numbers.triangle(gi - 1, gj, false)};
      }
    }
    // Numbers in the file that contacts report; there is no other file with numbers.
    for (std::size_t i = 0; i < page.size(); ++i) {
      page[i].flags =
          static_cast<std::uint32_t>(number * render::kPageTriangles + static_cast<std::int32_t>(i))
          << render::PackedTriangle::kSourceShift;
    }
    if (auto done = writer->append(page); !done) return done;
  }
  return writer->finish();
}

}  // namespace thimble::studies
