#pragma once

#include <string>
#include <vector>

namespace thimble::studies {

/// One way to answer a query of a contact, with the memory that it needs.
struct MemoryTrade {
  std::string name;
  double bytes_per_triangle = 0;
  double build_us_per_triangle = 0;
  double ns_per_question = 0;
};

/// Measures memory against time, for the alternatives of the paper [BP 3.1], on the ring of the
/// cost subjects: which exit (OUT array or in the cycle), which neighbour (array or in the cycle),
/// and what a free tip enters (each search). Real-time: never from the servo thread.
std::vector<MemoryTrade> measure_memory_trades();

}  // namespace thimble::studies
