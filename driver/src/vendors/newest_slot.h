#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace thimble::driver {

/// The newest value that one thread passes to another, in three slots: one is written, one is read,
/// and one waits between them. Older values are dropped. Neither side ever waits. Real-time: safe,
/// both ways, if copying a T is.
template <class T>
class NewestSlot {
 public:
  /// Stores a value; replaces one that was not taken. Called by one thread.
  void put(const T& value) noexcept {
    places_[writing_] = value;
    writing_ = waiting_.exchange(writing_ | kFresh, std::memory_order_acq_rel) & kPlace;
  }

  /// Takes the newest value; false if there is none since the last. Called by one other thread.
  bool take(T& value) noexcept {
    if ((waiting_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    reading_ = waiting_.exchange(reading_, std::memory_order_acq_rel) & kPlace;
    value = places_[reading_];
    return true;
  }

 private:
  static constexpr std::uint32_t kPlace = 3, kFresh = 4;

  std::array<T, 3> places_{};
  std::uint32_t writing_ = 0;              // of the thread that puts
  std::uint32_t reading_ = 1;              // of the thread that takes
  std::atomic<std::uint32_t> waiting_{2};  // a slot, and whether it was taken
};

}  // namespace thimble::driver
