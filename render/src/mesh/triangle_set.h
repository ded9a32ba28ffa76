#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace thimble::render {

/// A small set of triangles in the order in which they were added: those visited by a walk, or a
/// patch that grows around a place. All is Real-time: safe; time grows with the size.
template <std::size_t kMax>
class TriangleSet {
 public:
  /// Returns whether a triangle is in the set.
  bool has(std::int32_t triangle) const noexcept {
    const auto end = triangles_.begin() + static_cast<std::ptrdiff_t>(size_);
    return std::find(triangles_.begin(), end, triangle) != end;
  }

  /// Adds a triangle, unless it is in the set or the set is full.
  void add(std::int32_t triangle) noexcept {
    if (!full() && !has(triangle)) triangles_[size_++] = triangle;
  }

  bool full() const noexcept { return size_ == kMax; }  ///< Returns whether the set is full.
  std::size_t size() const noexcept { return size_; }   ///< Returns the number of triangles.
  /// Precondition: i < size().
  std::int32_t operator[](std::size_t i) const noexcept { return triangles_[i]; }

 private:
  std::array<std::int32_t, kMax> triangles_;
  std::size_t size_ = 0;
};

}  // namespace thimble::render
