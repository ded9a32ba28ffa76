#pragma once

#include <cstddef>

namespace thimble::session {

/// Prefetches the memory of an object that is written later, so that the write does not wait. The
/// stored ticks of a run exceed the cache, and each tick is written to new memory. Real-time: safe;
/// does not wait. (Inlined by force: GCC 12 treats a function that does nothing else as one without
/// effect and drops the call.)
template <class Object>
[[gnu::always_inline]] inline void prefetch_to_write(const Object& object) noexcept {
  constexpr std::size_t kLine = 64;  // Cache line, bytes.
  const auto* const bytes = reinterpret_cast<const std::byte*>(&object);
  for (std::size_t i = 0; i < sizeof(Object); i += kLine) __builtin_prefetch(bytes + i, 1);
  __builtin_prefetch(bytes + sizeof(Object) - 1, 1);
}

}  // namespace thimble::session
