#include "studies/cost/memory_trades.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <utility>

#include "mesh/adjacency.h"
#include "mesh/contact_mesh.h"
#include "mesh/repair/out_array.h"
#include "search/make_search.h"
#include "studies/cost/cost_subjects.h"
#include "studies/cost/ring_surface.h"
#include "thimble/render/contact_choice.h"

namespace thimble::studies {
namespace {

using Clock = std::chrono::steady_clock;

// Sum of all answers, so that the compiler removes no query.
volatile double answers = 0;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Repeats the query until the time is long enough to measure, and returns ns per query: the median
/// of several rounds.
template <class Ask>
double time_of_question(Ask ask) {
  constexpr int kRounds = 9;
  constexpr double kLongEnough = 1e-3;  // s
  std::vector<double> rounds;
  std::size_t i = 0;
  for (int round = 0; round < kRounds; ++round) {
    const auto begin = Clock::now();
    double sum = 0, time = 0;
    std::size_t asked = 0;
    while (time < kLongEnough) {
      for (int k = 0; k < 64; ++k) sum += ask(i++);
      asked += 64;
      time = seconds_since(begin);
    }
    answers = answers + sum;
    rounds.push_back(1e9 * time / static_cast<double>(asked));
  }
  std::sort(rounds.begin(), rounds.end());
  return rounds[kRounds / 2];
}

// Runs `build` once and returns its duration, us per triangle.
template <class Build>
auto timed(Build build, std::size_t triangles, double& us) {
  const auto begin = Clock::now();
  auto built = build();
  us = 1e6 * seconds_since(begin) / static_cast<double>(triangles);
  return built;
}

}  // namespace

std::vector<MemoryTrade> measure_memory_trades() {
  const render::TriangleMesh mesh = kCostRing.mesh(kCostAround, kCostAcross);
  const std::size_t count = mesh.triangles.size();
  // A large odd step, so that queries jump over the mesh.
  const auto some = [count](std::size_t i) { return (i * 2654435761U) % count; };
  std::vector<MemoryTrade> trades;

  MemoryTrade out{"out: array", sizeof(std::int8_t)};
  const render::OutArray array =
      timed([&] { return render::compute_out_array(mesh); }, count, out.build_us_per_triangle);
  out.ns_per_question =
      time_of_question([&](std::size_t i) { return static_cast<double>(array[some(i)]); });
  trades.push_back(out);

  MemoryTrade in_cycle{"out: in the cycle"};
  const render::OutFinder finder =
      timed([&] { return render::OutFinder(mesh); }, count, in_cycle.build_us_per_triangle);
  in_cycle.ns_per_question = time_of_question([&](std::size_t i) {
    return static_cast<double>(finder.find(static_cast<std::int32_t>(some(i))));
  });
  trades.push_back(in_cycle);

  MemoryTrade neighbours{"neighbour: array", 12};
  const auto adjacency =
      timed([&] { return render::find_adjacency(mesh); }, count, neighbours.build_us_per_triangle);
  neighbours.ns_per_question = time_of_question(
      [&](std::size_t i) { return static_cast<double>((*adjacency)[some(i)][i % 3]); });
  trades.push_back(neighbours);
  MemoryTrade found{"neighbour: in the cycle"};
  found.ns_per_question = time_of_question([&](std::size_t i) {
    return static_cast<double>(
        render::find_neighbour(mesh, static_cast<std::int32_t>(some(i)), i % 3));
  });
  trades.push_back(found);

  const auto contact_mesh = render::ContactMesh::build(mesh);
  for (std::size_t k = 0; k < render::kSearchNames.size(); ++k) {
    MemoryTrade trade;
    trade.name = "search: ";
    trade.name += render::kSearchNames[k];
    const auto search = timed(
        [&] { return render::make_search(*contact_mesh, static_cast<render::SearchChoice>(k)); },
        count, trade.build_us_per_triangle);
    trade.bytes_per_triangle = static_cast<double>(search->bytes()) / static_cast<double>(count);
    // Free ticks of a hand at 0.3 m/s, some tenths of a millimetre above the ring.
    trade.ns_per_question = time_of_question([&](std::size_t i) {
      const double way = 0.01 * static_cast<double>(some(i));
      const Eigen::Vector3d p = kCostRing.at(way, 3 * way, 5e-4);
      const Eigen::Vector3d q = kCostRing.at(way + 0.004, 3 * way, 3e-4);
      return search->first_entry(p, q).parameter;
    });
    trades.push_back(trade);
  }
  return trades;
}

}  // namespace thimble::studies
