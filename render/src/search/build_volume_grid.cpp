#include "search/build_volume_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "search/volume_overlap.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

// Side of a volume in edges of the equilateral triangle with the mean area. Narrower costs memory,
// wider costs triangles per query. The narrow grid of more triangles than stated exceeds the
// second-level cache (measured; README.md).
constexpr double kSideInEdges = 0.8;
constexpr double kWideSideInEdges = 1.5;
constexpr std::size_t kWideTrianglesMin = 4000;

// Maximum words of the top and entries of lists per triangle, for any shape of surface.
constexpr double kTopMax = 1.5;
constexpr double kListedMax = 12;
constexpr double kTopMin = 4096;  // smaller savings are useless

template <class Surface>
Corners corners_of(const Surface& surface, const SearchFrame& frame, std::size_t i) {
  const auto t = static_cast<std::int32_t>(i);
  return {corner_in(frame, surface, t, 0), corner_in(frame, surface, t, 1),
          corner_in(frame, surface, t, 2)};
}

struct Extent {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  double area = 0;    // of all triangles
  double widest = 0;  // of one triangle along an axis
};

template <class Surface>
Extent extent_of(const Surface& surface, const SearchFrame& frame, std::size_t count) {
  Extent extent;
  for (std::size_t t = 0; t < count; ++t) {
    const Corners c = corners_of(surface, frame, t);
    const Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]);
    const Vector3d high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    extent.low = extent.low.cwiseMin(low);
    extent.high = extent.high.cwiseMax(high);
    extent.widest = std::max(extent.widest, (high - low).maxCoeff());
    extent.area += (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2;
  }
  return extent;
}

// Lays out blocks that cover the box, with a margin of half a volume.
void lay_out(VolumeGrid::Parts& parts, const Extent& extent, double side) {
  parts.side = side;
  parts.low = extent.low - Vector3d::Constant(side / 2);
  for (int i = 0; i < 3; ++i) {
    const double volumes = (extent.high[i] - parts.low[i]) / side + 0.5;
    parts.blocks[static_cast<std::size_t>(i)] =
        std::max(1, static_cast<std::int32_t>(std::ceil(volumes / 4)));
  }
}

// Estimates the total length of all lists from the boxes of a sample of the triangles.
template <class Surface>
double estimate_listed(const Surface& surface, const SearchFrame& frame, std::size_t count,
                       double side) {
  const std::size_t stride = count / 4096 + 1;
  double sum = 0;
  for (std::size_t t = 0; t < count; t += stride) {
    const Corners c = corners_of(surface, frame, t);
    const Vector3d size = c[0].cwiseMax(c[1]).cwiseMax(c[2]) - c[0].cwiseMin(c[1]).cwiseMin(c[2]);
    const Vector3d volumes = size / side + Vector3d::Ones();
    // A flat triangle meets about its own layer of its box.
    sum += volumes.prod() / std::max(volumes.minCoeff(), 1.0);
  }
  return sum * static_cast<double>(stride);
}

template <class Surface>
void choose_side(VolumeGrid::Parts& parts, const Surface& surface, const SearchFrame& frame,
                 std::size_t count, const Extent& extent) {
  const auto n = static_cast<double>(count);
  const double edge = std::sqrt(extent.area / n * (4 / std::sqrt(3.0)));
  const double widest = (extent.high - extent.low).maxCoeff();
  const double edges = count < kWideTrianglesMin ? kSideInEdges : kWideSideInEdges;
  double side = std::max(edges * edge, widest / (4 * VolumeGrid::kBlocksMax - 8));
  for (;;) {
    lay_out(parts, extent, side);
    const double top = static_cast<double>(parts.blocks[0]) * parts.blocks[1] * parts.blocks[2];
    const bool small_top = top <= std::max(kTopMax * n, kTopMin);
    if (small_top && estimate_listed(surface, frame, count, side) <= kListedMax * n) return;
    side *= 1.25;
  }
}

// Writes the distance to the nearest block that is not empty to every word of an empty block. Two
// sweeps over the thirteen neighbours before and behind are exact for distances along the farthest
// axis.
void measure_emptiness(VolumeGrid::Parts& parts) {
  const std::int32_t nx = parts.blocks[0], ny = parts.blocks[1], nz = parts.blocks[2];
  const auto width = static_cast<std::size_t>(nx);
  constexpr std::uint8_t kFar = VolumeGrid::kFarthest;
  std::vector<std::uint8_t> far(parts.top.size());
  for (std::size_t i = 0; i < far.size(); ++i) {
    far[i] = (parts.top[i] & VolumeGrid::kEmpty) != 0 ? kFar : 0;
  }
  const auto row = [&](std::int32_t y, std::int32_t z) {
    return far.data() + (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) +
                         static_cast<std::size_t>(y)) *
                            width;
  };
  std::vector<std::uint8_t> nearest(width + 2);
  const auto sweep = [&](std::int32_t y, std::int32_t z, std::int32_t back) {
    std::fill(nearest.begin(), nearest.end(), kFar);
    const auto add = [&](std::int32_t ay, std::int32_t az) {
      if (ay < 0 || ay >= ny || az < 0 || az >= nz) return;
      const std::uint8_t* const other = row(ay, az);
      for (std::size_t x = 0; x < width; ++x) {
        nearest[x + 1] = std::min(nearest[x + 1], other[x]);
      }
    };
    for (std::int32_t dy = -1; dy <= 1; ++dy) add(y + dy, z - back);
    add(y - back, z);
    std::uint8_t* const own = row(y, z);
    for (std::size_t x = 0; x < width; ++x) {
      const int least = std::min({nearest[x], nearest[x + 1], nearest[x + 2]});
      own[x] = static_cast<std::uint8_t>(std::min<int>(own[x], std::min(least + 1, int{kFar})));
    }
    const auto chain = [&](std::size_t x, std::size_t before) {
      own[x] = static_cast<std::uint8_t>(std::min<int>(own[x], own[before] + 1));
    };
    for (std::size_t x = 1; x < width; ++x) chain(x, x - 1);
    for (std::size_t x = width - 1; x > 0; --x) chain(x - 1, x);
  };
  for (std::int32_t z = 0; z < nz; ++z) {
    for (std::int32_t y = 0; y < ny; ++y) sweep(y, z, 1);
  }
  for (std::int32_t z = nz; z-- > 0;) {
    for (std::int32_t y = ny; y-- > 0;) sweep(y, z, -1);
  }
  for (std::size_t i = 0; i < far.size(); ++i) {
    if ((parts.top[i] & VolumeGrid::kEmpty) != 0) parts.top[i] = VolumeGrid::kEmpty | far[i];
  }
}

// A volume (block * 64 + bit) that lists a triangle.
struct Listed {
  std::uint32_t volume;
  std::int32_t triangle;
};

// Calls list(volume) for every volume that a triangle reaches into.
template <class List>
void visit_volumes(const VolumeGrid::Parts& parts, const Corners& c, List list) {
  const double room = kGridRoom * parts.side;
  const Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]) - Vector3d::Constant(room);
  const Vector3d high = c[0].cwiseMax(c[1]).cwiseMax(c[2]) + Vector3d::Constant(room);
  const double per_side = 1 / parts.side;
  std::array<std::int32_t, 3> first, last;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const auto place = [&](double u) {
      const auto v = static_cast<std::int32_t>(std::max((u - parts.low[axis]) * per_side, 0.0));
      return std::min(v, 4 * parts.blocks[i] - 1);
    };
    first[i] = place(low[axis]);
    last[i] = place(high[axis]);
  }
  if (first == last) {
    list(first);
    return;
  }
  const VolumeOverlap overlap(
      {Vector3d(c[0] - parts.low), Vector3d(c[1] - parts.low), Vector3d(c[2] - parts.low)},
      parts.side, room);
  for (std::int32_t z = first[2]; z <= last[2]; ++z) {
    for (std::int32_t y = first[1]; y <= last[1]; ++y) {
      for (std::int32_t x = first[0]; x <= last[0]; ++x) {
        if (overlap.reaches(parts.side * Vector3d(x + 0.5, y + 0.5, z + 0.5))) list({x, y, z});
      }
    }
  }
}

// Stores the corners of each list's triangles in groups of eight, relative to the middle of its
// volume. `widest` is the maximum width of a triangle along an axis.
template <class CornersOf>
void fill_lanes(VolumeGrid::Parts& parts, double widest, const CornersOf& corners_of_one) {
  constexpr std::size_t kCapacity = EightTriangles::kCapacity;
  const double farthest = parts.side * (0.5 + kGridRoom) + widest;
  parts.per_unit = EightTriangles::kFarthestUnit / farthest;
  std::uint32_t eights = 0;
  for (std::size_t v = 0; v + 1 < parts.begins.size(); ++v) {
    parts.begins[v].eight = eights;
    const std::uint32_t count = parts.begins[v + 1].triangle - parts.begins[v].triangle;
    eights += static_cast<std::uint32_t>((count + kCapacity - 1) / kCapacity);
  }
  parts.eights.resize(eights);
  const auto put = [&](std::size_t v, const Vector3d& middle) {
    const VolumeGrid::ListBegin begin = parts.begins[v];
    for (std::size_t i = 0; begin.triangle + i < parts.begins[v + 1].triangle; ++i) {
      Corners corners = corners_of_one(parts.triangles[begin.triangle + i]);
      for (Vector3d& corner : corners) corner = parts.per_unit * (corner - middle);
      parts.eights[begin.eight + i / kCapacity].set(i % kCapacity, corners);
    }
  };
  std::size_t place = 0;
  for (std::int32_t z = 0; z < parts.blocks[2]; ++z) {
    for (std::int32_t y = 0; y < parts.blocks[1]; ++y) {
      for (std::int32_t x = 0; x < parts.blocks[0]; ++x) {
        const std::uint32_t word = parts.top[place++];
        if ((word & VolumeGrid::kEmpty) != 0) continue;
        const VolumeGrid::Block& block = parts.all_blocks[word];
        std::size_t v = block.first_volume;
        for (std::int32_t i = 0; i < 64; ++i) {
          if (((block.occupied >> i) & 1u) == 0) continue;
          const Vector3d corner = VolumeGrid::corner_of(parts, x, y, z, i);
          put(v++, VolumeGrid::middle_of(parts, corner));
        }
      }
    }
  }
}

}  // namespace

template <class Surface>
VolumeGrid build_volume_grid(const Surface& surface, const SearchFrame& frame) {
  const auto count = static_cast<std::size_t>(surface.triangle_count());
  VolumeGrid::Parts parts;
  const Extent extent = extent_of(surface, frame, count);
  choose_side(parts, surface, frame, count, extent);
  const auto nx = static_cast<std::size_t>(parts.blocks[0]);
  const auto ny = static_cast<std::size_t>(parts.blocks[1]);
  parts.top.assign(nx * ny * static_cast<std::size_t>(parts.blocks[2]), VolumeGrid::kEmpty);

  // Blocks are numbered in the order of the triangles: neighbours in space are near in memory.
  std::vector<Listed> listed;
  listed.reserve(4 * count);
  for (std::size_t t = 0; t < count; ++t) {
    visit_volumes(parts, corners_of(surface, frame, t), [&](std::array<std::int32_t, 3> at) {
      const auto x = static_cast<std::size_t>(at[0]), y = static_cast<std::size_t>(at[1]),
                 z = static_cast<std::size_t>(at[2]);
      std::uint32_t& word = parts.top[((z >> 2) * ny + (y >> 2)) * nx + (x >> 2)];
      if ((word & VolumeGrid::kEmpty) != 0) {
        word = static_cast<std::uint32_t>(parts.all_blocks.size());
        parts.all_blocks.emplace_back();
      }
      const std::size_t bit = (x & 3) + 4 * (y & 3) + 16 * (z & 3);
      parts.all_blocks[word].occupied |= std::uint64_t{1} << bit;
      listed.push_back(
          {static_cast<std::uint32_t>(std::size_t{64} * word + bit), static_cast<std::int32_t>(t)});
    });
  }
  parts.all_blocks.shrink_to_fit();
  std::uint32_t volumes = 0;
  for (VolumeGrid::Block& block : parts.all_blocks) {
    block.first_volume = volumes;
    volumes += count_ones(block.occupied);
  }
  const auto place_of = [&parts](std::uint32_t volume) {
    const VolumeGrid::Block& block = parts.all_blocks[volume / 64];
    return block.first_volume +
           count_ones(block.occupied & ((std::uint64_t{1} << (volume % 64)) - 1));
  };
  // Counted, summed, and filled from the end of each list: afterwards the sums are the begins.
  parts.begins.assign(std::size_t{volumes} + 1, {});
  for (Listed& entry : listed) {
    entry.volume = place_of(entry.volume);
    ++parts.begins[entry.volume].triangle;
  }
  std::uint32_t sum = 0;
  for (VolumeGrid::ListBegin& begin : parts.begins) {
    sum += begin.triangle;
    begin.triangle = sum;
  }
  parts.triangles.resize(listed.size());
  for (auto entry = listed.rbegin(); entry != listed.rend(); ++entry) {
    parts.triangles[--parts.begins[entry->volume].triangle] = entry->triangle;
  }
  fill_lanes(parts, extent.widest, [&](std::int32_t t) {
    return corners_of(surface, frame, static_cast<std::size_t>(t));
  });
  measure_emptiness(parts);
  return VolumeGrid(std::move(parts));
}

template VolumeGrid build_volume_grid(const ContactMesh&, const SearchFrame&);
template VolumeGrid build_volume_grid(const PackedSurface&, const SearchFrame&);

}  // namespace thimble::render
