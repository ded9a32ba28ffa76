#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace thimble::driver {

/// Publishes the newest value of one writer to any number of readers. The writer never waits;
/// readers retry while it writes.
///
/// A sequence lock whose words are lock-free atomics: free of data races by the C++ standard, and
/// usable in memory shared by processes. Real-time: `store` is safe; `load` is for observers.
template <class T>
class Snapshot {
  static_assert(std::is_trivially_copyable_v<T>, "A snapshot is copied word by word.");
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  /// Publishes a value. Call from one thread only.
  void store(const T& value) noexcept {
    // Odd while a value is written. It is odd already if the previous writer, another process, was
    // killed during a write.
    const std::uint64_t writing = sequence_.load(std::memory_order_relaxed) | 1;
    sequence_.store(writing, std::memory_order_relaxed);
    // Each release store below makes the odd sequence visible before the word it writes.
    store_words(value);
    sequence_.store(writing + 1, std::memory_order_release);
  }

  /// Copies the newest value. Returns false and leaves `value` unchanged if nothing was stored yet,
  /// or if the writer was faster `attempts` times in a row.
  bool load(T& value, int attempts = 1000) const noexcept {
    for (int attempt = 0; attempt < attempts; ++attempt) {
      const std::uint64_t before = sequence_.load(std::memory_order_acquire);
      if (before == 0) return false;
      if (before % 2 != 0) continue;
      std::array<std::uint64_t, kWords> words;
      for (std::size_t i = 0; i < kWords; ++i) {
        words[i] = words_[i].load(std::memory_order_acquire);
      }
      if (sequence_.load(std::memory_order_relaxed) == before) {
        std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
        return true;
      }
    }
    return false;
  }

  /// Returns the number of values stored so far.
  std::uint64_t count() const noexcept { return sequence_.load(std::memory_order_acquire) / 2; }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;

  // Copies words directly, without an intermediate copy. The record of a tick is unrolled to two
  // instructions per word; for thousands of words compilers cannot unroll.
  static constexpr std::size_t kListed = 128;
  static constexpr std::size_t kLast = sizeof(T) - 8 * (kWords - 1);  // Bytes of the last word.

  void store_words(const T& value) noexcept {
    if constexpr (kWords <= kListed) {
      store_listed(value, std::make_index_sequence<kWords>());
    } else {
      for (std::size_t i = 0; i + 1 < kWords; ++i) store_word<8>(value, i);
      store_word<kLast>(value, kWords - 1);
    }
  }
  template <std::size_t... I>
  void store_listed(const T& value, std::index_sequence<I...>) noexcept {
    (store_word<(I + 1 < kWords ? 8 : kLast)>(value, I), ...);
  }
  template <std::size_t kBytes>
  void store_word(const T& value, std::size_t i) noexcept {
    std::uint64_t word = 0;
    std::memcpy(&word, reinterpret_cast<const std::byte*>(&value) + 8 * i, kBytes);
    words_[i].store(word, std::memory_order_release);
  }

  std::atomic<std::uint64_t> sequence_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace thimble::driver
