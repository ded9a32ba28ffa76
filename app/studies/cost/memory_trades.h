#pragma once

#include <string>
#include <vector>

namespace thimble::studies {

/// One way to answer a question that a contact asks, with what it holds in memory for that.
struct MemoryTrade {
  std::string name;
  double bytes_per_triangle = 0;
  double build_us_per_triangle = 0;
  double ns_per_question = 0;
};

/// Measures memory against time, as the paper offers it [BP 3.1]: which way out is (OUT array or in
/// the cycle), who the neighbour is (array or in the cycle), what a free tip enters (each search),
/// on the ring of the cost subjects. Real-time: never from the servo thread.
std::vector<MemoryTrade> measure_memory_trades();

}  // namespace thimble::studies
