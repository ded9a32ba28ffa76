#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>

namespace thimble::render {

/// Allocates arrays that are read here and there in pages of 2 MiB where the system has them, so
/// that a far packed triangle costs one miss and no walk through page tables beside it.
/// Real-time: never from the servo thread.
template <class T>
struct LargePages {
  using value_type = T;  ///< Of the array.

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) noexcept {}  ///< Takes nothing over.

  /// Returns memory for `count` elements; throws std::bad_alloc.
  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kPage) return static_cast<T*>(::operator new(bytes, std::align_val_t(alignof(T))));
    void* memory = ::operator new(bytes, std::align_val_t(kPage));
    // A hint: where it is not granted everything works, a little slower.
    (void)madvise(memory, bytes / kPage * kPage, MADV_HUGEPAGE);
    return static_cast<T*>(memory);
  }
  /// Takes memory back.
  void deallocate(T* memory, std::size_t count) noexcept {
    const std::size_t align = count * sizeof(T) < kPage ? alignof(T) : kPage;
    ::operator delete(memory, std::align_val_t(align));
  }
  friend bool operator==(const LargePages&, const LargePages&) noexcept { return true; }

 private:
  static constexpr std::size_t kPage = std::size_t{2} << 20;
};

}  // namespace thimble::render
