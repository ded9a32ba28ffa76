#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "support/elephant.h"

// Counts what the heap is asked for while a guard is up. The guard covers a whole tick of the
// demo's scene: simulated arm, codec, kinematics, contact, gate, snapshot, statistics and trace.

namespace {

thread_local bool guarded = false;
std::atomic<int> heap_calls{0};

void* counted(std::size_t size) {
  if (guarded) heap_calls.fetch_add(1);
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}

void* counted(std::size_t size, std::align_val_t alignment) {
  if (guarded) heap_calls.fetch_add(1);
  const auto align = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}

void released(void* memory) {
  if (guarded) heap_calls.fetch_add(1);
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void* operator new(std::size_t size, std::align_val_t align) {
  return counted(size, align);
}
void* operator new[](std::size_t size, std::align_val_t align) {
  return counted(size, align);
}
void operator delete(void* memory) noexcept {
  released(memory);
}
void operator delete[](void* memory) noexcept {
  released(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  released(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  released(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  released(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  released(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  released(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  released(memory);
}

namespace thimble {
namespace {

template <class Work>
int heap_calls_of(Work work) {
  heap_calls.store(0);
  guarded = true;
  work();
  guarded = false;
  return heap_calls.load();
}

TEST(ServoPath, AsksTheHeapForNothingInTenSecondsOfTouch) {
  THIMBLE_NEEDS_MESHES();
  const auto session = support::open_elephant();
  ASSERT_TRUE(session);
  const std::atomic<bool> stop{false};
  driver::ServoEnd end{};
  EXPECT_EQ(heap_calls_of([&] { end = session->run(stop); }), 0);
  EXPECT_EQ(end, driver::ServoEnd::kDone);
  EXPECT_GT(session->statistics().contacts(), 0u);
}

TEST(ServoPath, IsWatchedByAGuardThatNoticesOneAllocation) {
  // The negative control: a force law that allocates once, in one tick of many.
  int ticks = 0;
  const auto sloppy = [&](const driver::DeviceState&) noexcept {
    if (++ticks == 50) {
      int* volatile memory = new int(1);  // volatile: or the compiler leaves the pair out
      delete memory;
    }
    return driver::ForceCommand{};
  };
  EXPECT_EQ(heap_calls_of([&] {
              const driver::ForceLaw law(sloppy);
              for (int k = 0; k < 100; ++k) law(driver::DeviceState());
            }),
            2);  // one new, one delete
}

}  // namespace
}  // namespace thimble
