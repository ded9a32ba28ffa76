#pragma once

#include <vector>

namespace thimble::hil {

/// The median of what was measured, and where the true one lies.
struct MedianInterval {
  double median = 0;
  double low = 0, high = 0;  ///< Holds the true median in 95 % of cases, whatever the distribution.
};

/// Fewest values of which an interval is known: of five, the true median lies outside of all in
/// 6 % of cases.
inline constexpr int kMedianLeast = 6;

/// Returns the median of independent values and its interval by order statistics: a value lies
/// below the true median with a chance of one half, so the k-th least and the k-th greatest hold
/// it between them unless fewer than k fall on one side, which is binomial [Conover]. Takes
/// `kMedianLeast` values or more for 95 %; of fewer the interval is from the least to the greatest.
/// Of no values all are 0.
MedianInterval median_interval(std::vector<double> values);

}  // namespace thimble::hil
