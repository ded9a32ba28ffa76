#pragma once

#include <cstddef>

namespace thimble::session {

/// Asks for the memory of an object that is written later, so that nobody waits for it then: what a
/// run keeps of its ticks grows beyond the cache, and each tick is written where none was before.
/// Real-time: safe; it waits for nothing. (Inlined by force: GCC 12 takes a function that does
/// nothing else for one without effect and drops the call.)
template <class Object>
[[gnu::always_inline]] inline void prefetch_to_write(const Object& object) noexcept {
  constexpr std::size_t kLine = 64;  // of the cache, bytes
  const auto* const bytes = reinterpret_cast<const std::byte*>(&object);
  for (std::size_t i = 0; i < sizeof(Object); i += kLine) __builtin_prefetch(bytes + i, 1);
  __builtin_prefetch(bytes + sizeof(Object) - 1, 1);
}

}  // namespace thimble::session
