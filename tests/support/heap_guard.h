#pragma once

#include <utility>

namespace thimble::support {

/// Starts and ends counting of what this thread asks of the heap. A program that links
/// thimble_heap_guard has operator new and delete replaced by ones that count.
void begin_heap_guard();
int end_heap_guard();

/// Counts how often `work` asked the heap for memory or gave some back, on this thread.
template <class Work>
int heap_calls_of(Work&& work) {
  begin_heap_guard();
  std::forward<Work>(work)();
  return end_heap_guard();
}

}  // namespace thimble::support
