#pragma once

#include <utility>

namespace thimble::support {

/// Starts and ends counting of this thread's heap operations. In a program that links
/// thimble_heap_guard, operator new and delete are replaced by counting ones.
void begin_heap_guard();
int end_heap_guard();

/// Returns the number of heap allocations and deallocations of `work` on this thread.
template <class Work>
int heap_calls_of(Work&& work) {
  begin_heap_guard();
  std::forward<Work>(work)();
  return end_heap_guard();
}

}  // namespace thimble::support
