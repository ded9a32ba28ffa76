#include "compact_mesh/block_order.h"

#include <algorithm>
#include <cstddef>
#include <future>
#include <limits>
#include <tuple>

#include "compact_mesh/sse2.h"

namespace thimble::render {
namespace {

using Items = std::span<PlacedIndex>;

constexpr std::size_t kBlock = 8;
// Below this size sampling a pivot takes longer than what it saves.
constexpr std::size_t kFewItems = 48;
constexpr std::size_t kSamples = 9;
// Depth of cuts whose parts are processed in parallel. One part may be twice the other, and four
// parts balance two processors better than two.
constexpr int kForks = 2;
// Below, a thread costs more than it saves [measured: 10 us against 100 ns per item].
constexpr std::size_t kWorthAThread = 5000;

std::size_t longest_side(Items items) noexcept {
  __m128 low = _mm_set1_ps(std::numeric_limits<float>::infinity());
  __m128 high = _mm_sub_ps(_mm_setzero_ps(), low);
  for (const PlacedIndex& item : items) {
    const __m128 at = _mm_load_ps(item.at.data());
    low = _mm_min_ps(at, low);
    high = _mm_max_ps(at, high);
  }
  // The fourth lane is the number; as a float it may be denormal and slow, so it is masked.
  const __m128 three = _mm_castsi128_ps(_mm_setr_epi32(-1, -1, -1, 0));
  alignas(16) std::array<float, 4> side;
  _mm_store_ps(side.data(), _mm_sub_ps(_mm_and_ps(high, three), _mm_and_ps(low, three)));
  return static_cast<std::size_t>(std::max_element(side.begin(), side.begin() + 3) - side.begin());
}

template <std::size_t axis>
struct Before {
  bool operator()(const PlacedIndex& a, const PlacedIndex& b) const noexcept {
    const float u = a.at[axis], v = b.at[axis];
    // Bitwise: the comparison is not predictable.
    return static_cast<bool>(static_cast<int>(u < v) |
                             (static_cast<int>(u == v) & static_cast<int>(a.index < b.index)));
  }
};

// Moves the items before a pivot to the front without a branch, and returns their number.
template <std::size_t kAxis>
std::size_t part(Items items, const PlacedIndex& pivot) noexcept {
  PlacedIndex* const begin = items.data();
  PlacedIndex* const end = begin + items.size();
  PlacedIndex* front = begin;
  const float u = pivot.at[kAxis];
  const std::int32_t index = pivot.index;
  for (PlacedIndex* item = begin; item != end; ++item) {
    const bool before = static_cast<bool>(
        static_cast<int>(item->at[kAxis] < u) |
        (static_cast<int>(item->at[kAxis] == u) & static_cast<int>(item->index < index)));
    const __m128 one = _mm_load_ps(item->at.data());
    _mm_store_ps(item->at.data(), _mm_load_ps(front->at.data()));
    _mm_store_ps(front->at.data(), one);
    front += before;
  }
  return static_cast<std::size_t>(front - begin);
}

// Moves the `rank` least items to the front. Parts by pivots whose rank among a few samples is a
// little above or below the requested rank, so that the rest is short.
template <std::size_t kAxis>
void select(Items items, std::size_t rank) noexcept {
  constexpr Before<kAxis> before;
  for (int round = 0; round < 8 && items.size() > kFewItems; ++round) {
    std::array<PlacedIndex, kSamples> samples;
    for (std::size_t i = 0; i < kSamples; ++i) {
      samples[i] = items[(2 * i + 1) * items.size() / (2 * kSamples)];
    }
    const auto near = samples.begin() + static_cast<std::ptrdiff_t>(rank * kSamples / items.size());
    std::nth_element(samples.begin(), near, samples.end(), before);
    const std::size_t count = part<kAxis>(items, *near);
    if (count == rank) return;
    if (count < rank) {
      items = items.subspan(count);
      rank -= count;
    } else {
      items = items.first(count);
    }
  }
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(rank), items.end(),
                   before);
}

// Sorts; the parts of the first `forks` nested cuts are processed in parallel.
void order(Items items, int forks) {
  while (items.size() > kBlock) {
    std::size_t unit = kBlock;
    while (8 * unit < items.size()) unit *= 8;
    const std::size_t units = (items.size() + unit - 1) / unit;
    const std::size_t first = (units + 1) / 2 * unit;
    switch (longest_side(items)) {
      case 0:
        select<0>(items, first);
        break;
      case 1:
        select<1>(items, first);
        break;
      default:
        select<2>(items, first);
    }
    const Items left = items.first(first);
    items = items.subspan(first);
    if (forks == 0 || left.size() < kWorthAThread) {
      order(left, 0);
      continue;
    }
    auto beside = std::async(std::launch::async | std::launch::deferred,
                             [left, forks] { order(left, forks - 1); });
    order(items, forks - 1);
    return beside.get();
  }
}

}  // namespace

void order_in_blocks(Items items) {
  order(items, kForks);
}

}  // namespace thimble::render
