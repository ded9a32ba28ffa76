#include "support/heap_guard.h"

#include <cstdlib>
#include <new>

namespace {

thread_local bool guarded = false;
thread_local int heap_calls = 0;

void* taken(std::size_t size, std::size_t alignment) {
  if (guarded) ++heap_calls;
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, whole > 0 ? whole : alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void freed(void* memory) {
  if (guarded) ++heap_calls;
  std::free(memory);
}

constexpr std::size_t kDefault = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

}  // namespace

void* operator new(std::size_t size) {
  return taken(size, kDefault);
}
void* operator new[](std::size_t size) {
  return taken(size, kDefault);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return taken(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return taken(size, static_cast<std::size_t>(alignment));
}
// std::stable_sort requests its scratch memory in this form, and frees it with the ordinary delete.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return taken(size, kDefault);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return taken(size, kDefault);
}
void operator delete(void* memory) noexcept {
  freed(memory);
}
void operator delete[](void* memory) noexcept {
  freed(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  freed(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  freed(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  freed(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  freed(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  freed(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  freed(memory);
}

namespace thimble::support {

void begin_heap_guard() {
  heap_calls = 0;
  guarded = true;
}

int end_heap_guard() {
  guarded = false;
  return heap_calls;
}

}  // namespace thimble::support
