#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include "studies/cost/cost_subjects.h"
#include "studies/cost/ring_surface.h"

namespace {

// Bytes requested from operator new and not freed. The size of the allocator's own memory would
// depend on its free blocks.
std::size_t held = 0;

// The requested size is stored in front of each block, at a distance that keeps it aligned.
std::size_t room_before(std::size_t alignment) {
  return std::max<std::size_t>(alignment, alignof(std::max_align_t));
}

void* take(std::size_t size, std::size_t alignment) {
  const std::size_t before = room_before(alignment);
  auto* const whole = static_cast<std::byte*>(
      std::aligned_alloc(before, (size + 2 * before - 1) / before * before));
  if (whole == nullptr) std::abort();
  std::memcpy(whole, &size, sizeof size);
  held += size;
  return whole + before;
}

void release(void* piece, std::size_t alignment) {
  if (piece == nullptr) return;
  std::byte* const whole = static_cast<std::byte*>(piece) - room_before(alignment);
  std::size_t size = 0;
  std::memcpy(&size, whole, sizeof size);
  held -= size;
  std::free(whole);
}

}  // namespace

void* operator new(std::size_t size) {
  return take(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return take(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* piece) noexcept {
  release(piece, 1);
}
void operator delete(void* piece, std::size_t) noexcept {
  release(piece, 1);
}
void operator delete(void* piece, std::align_val_t alignment) noexcept {
  release(piece, static_cast<std::size_t>(alignment));
}
void operator delete(void* piece, std::size_t, std::align_val_t alignment) noexcept {
  release(piece, static_cast<std::size_t>(alignment));
}

// Touches one cost subject for some strokes, so that callgrind can count the instructions of a
// tick:
//   effect_ticks SUBJECT STROKES      prints the bytes that the object holds
// Linked with all effects and with fewer (effect_table.cpp): the counts must be the same.
int main(int argc, char** argv) {
  using namespace thimble;
  if (argc != 3) return 2;
  const auto states = studies::ring_stroke(studies::kCostRing, 1000, 0.001);
  for (const studies::CostSubject& subject : studies::cost_subjects()) {
    if (subject.name != argv[1]) continue;
    const std::size_t before = held;
    const auto touch = subject.build();
    const std::size_t after = held;
    if (!touch) return 1;
    double sum = 0;
    for (int i = 0; i < std::atoi(argv[2]); ++i) {
      for (const auto& state : states) sum += (*touch)->update(state).f_T_W.norm();
    }
    std::fprintf(stderr, "force summed %g N\n", sum);
    std::printf("%zu\n", after - before);
    return sum > 0 ? 0 : 1;
  }
  return 2;
}
