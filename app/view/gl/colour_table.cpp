#include "view/gl/colour_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <unordered_map>

namespace thimble::view {
namespace {

constexpr std::size_t kMax = 256;
constexpr int kBits = 6;  // of each channel, for the lookup of the nearest colour
constexpr int kDrop = 8 - kBits;

/// A colour and its number of pixels.
struct Counted {
  ColourTable::Rgb rgb;
  std::uint64_t count;
};

/// A box of colours: a range of the list.
struct Box {
  std::size_t begin, end;
  std::size_t axis = 0;  // the longest axis
  double cost = 0;       // approximate gain of splitting it
};

void measure(const std::vector<Counted>& list, Box& box) {
  box.cost = 0;
  std::array<double, 3> sum{};
  std::array<double, 3> square{};
  double count = 0;
  for (std::size_t i = box.begin; i < box.end; ++i) {
    const auto weight = static_cast<double>(list[i].count);
    count += weight;
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += weight * list[i].rgb[k];
      square[k] += weight * list[i].rgb[k] * list[i].rgb[k];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double spread = square[k] - sum[k] * sum[k] / count;
    if (spread > box.cost) {
      box.cost = spread;
      box.axis = k;
    }
  }
  if (box.end - box.begin < 2) box.cost = 0;
}

}  // namespace

ColourTable::ColourTable(const std::vector<const Picture*>& pictures)
    : known_(std::size_t{1} << (3 * kBits), -1) {
  std::unordered_map<std::uint32_t, std::uint64_t> counts;
  for (const Picture* picture : pictures) {
    for (std::size_t i = 0; i + 2 < picture->rgb.size(); i += 3) {
      ++counts[(static_cast<std::uint32_t>(picture->rgb[i]) << 16U) |
               (static_cast<std::uint32_t>(picture->rgb[i + 1]) << 8U) | picture->rgb[i + 2]];
    }
  }
  std::vector<Counted> list;
  list.reserve(counts.size());
  for (const auto& [rgb, count] : counts) {
    list.push_back({{static_cast<std::uint8_t>(rgb >> 16U), static_cast<std::uint8_t>(rgb >> 8U),
                     static_cast<std::uint8_t>(rgb)},
                    count});
  }
  // The order of a hash map is undefined, but the same picture must give the same file.
  std::sort(list.begin(), list.end(),
            [](const Counted& a, const Counted& b) { return a.rgb < b.rgb; });
  std::vector<Box> boxes = {{0, list.size()}};
  measure(list, boxes[0]);
  while (boxes.size() < kMax) {
    const auto widest = std::max_element(
        boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.cost < b.cost; });
    if (!(widest->cost > 0)) break;
    Box low = *widest;
    const std::size_t axis = low.axis;
    const auto begin = list.begin() + static_cast<std::ptrdiff_t>(low.begin);
    const auto end = list.begin() + static_cast<std::ptrdiff_t>(low.end);
    std::stable_sort(begin, end, [axis](const Counted& a, const Counted& b) {
      return a.rgb[axis] < b.rgb[axis];
    });
    // Split at the mean: half of the spread on each side.
    double sum = 0;
    double count = 0;
    for (auto i = begin; i != end; ++i) {
      sum += static_cast<double>(i->count) * i->rgb[axis];
      count += static_cast<double>(i->count);
    }
    std::size_t cut = low.begin + 1;
    while (cut + 1 < low.end && list[cut].rgb[axis] <= sum / count) ++cut;
    Box high = {cut, low.end};
    low.end = cut;
    measure(list, low);
    measure(list, high);
    *widest = low;
    boxes.push_back(high);
  }
  for (const Box& box : boxes) {
    std::array<double, 3> sum{};
    double count = 0;
    for (std::size_t i = box.begin; i < box.end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] += static_cast<double>(list[i].count) * list[i].rgb[k];
      }
      count += static_cast<double>(list[i].count);
    }
    if (count == 0) continue;
    const auto mean = [&](std::size_t k) {
      return static_cast<std::uint8_t>(std::lround(sum[k] / count));
    };
    colours_.push_back({mean(0), mean(1), mean(2)});
  }
}

std::uint8_t ColourTable::nearest(int r, int g, int b) const {
  const auto key = static_cast<std::size_t>(((r >> kDrop) << (2 * kBits)) |
                                            ((g >> kDrop) << kBits) | (b >> kDrop));
  if (known_[key] >= 0) return static_cast<std::uint8_t>(known_[key]);
  int best = 0;
  int min = std::numeric_limits<int>::max();
  const auto middle = [](int c) { return (c >> kDrop << kDrop) + (1 << kDrop) / 2; };
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    // People distinguish greens best, and reds better than blues.
    const int d_r = middle(r) - colours_[i][0];
    const int d_g = middle(g) - colours_[i][1];
    const int d_b = middle(b) - colours_[i][2];
    const int distance = 2 * d_r * d_r + 4 * d_g * d_g + d_b * d_b;
    if (distance < min) {
      min = distance;
      best = static_cast<int>(i);
    }
  }
  known_[key] = static_cast<std::int16_t>(best);
  return static_cast<std::uint8_t>(best);
}

std::vector<std::uint8_t> ColourTable::numbers(const Picture& picture) const {
  // Bayer's pattern, with steps that cover the resolution of `nearest`.
  constexpr std::array<std::array<int, 4>, 4> kPattern = {
      {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}}};
  std::vector<std::uint8_t> result;
  result.reserve(picture.rgb.size() / 3);
  std::size_t i = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x, i += 3) {
      const int push = kPattern[static_cast<std::size_t>(y & 3)][static_cast<std::size_t>(x & 3)];
      const auto pushed = [&](std::size_t k) {
        return std::clamp((2 * picture.rgb[i + k] + (push - 7) / 2) / 2, 0, 255);
      };
      result.push_back(nearest(pushed(0), pushed(1), pushed(2)));
    }
  }
  return result;
}

}  // namespace thimble::view
