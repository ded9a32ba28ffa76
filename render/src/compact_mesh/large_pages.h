#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <utility>

namespace thimble::render {

/// Allocates arrays with random access in memory pages of 2 MiB if the system has them. Then a
/// distant packed triangle costs one cache miss and no walk through page tables. Real-time: never
/// from the servo thread.
template <class T>
struct LargePages {
  using value_type = T;  ///< Element type.

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) noexcept {}  ///< Copies nothing.

  /// Returns memory for `count` elements; throws std::bad_alloc.
  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kPage) return static_cast<T*>(::operator new(bytes, std::align_val_t(alignof(T))));
    void* memory = ::operator new(bytes, std::align_val_t(kPage));
    // Only a hint: without large pages all works, a little slower.
    (void)madvise(memory, bytes / kPage * kPage, MADV_HUGEPAGE);
    return static_cast<T*>(memory);
  }
  /// Frees memory.
  void deallocate(T* memory, std::size_t count) noexcept {
    const std::size_t align = count * sizeof(T) < kPage ? alignof(T) : kPage;
    ::operator delete(memory, std::align_val_t(align));
  }
  /// Makes an element without setting it to zero, unless its type does so itself. After a resize to
  /// 64 MB, all of it is written anyway.
  template <class U>
  void construct(U* element) noexcept(noexcept(U())) {
    ::new (static_cast<void*>(element)) U;
  }
  /// Makes an element from others.
  template <class U, class... From>
  requires(sizeof...(From) > 0) void construct(U* element, From&&... from) {
    ::new (static_cast<void*>(element)) U(std::forward<From>(from)...);
  }
  friend bool operator==(const LargePages&, const LargePages&) noexcept { return true; }

 private:
  static constexpr std::size_t kPage = std::size_t{2} << 20;
};

}  // namespace thimble::render
