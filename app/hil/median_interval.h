#pragma once

#include <vector>

namespace thimble::hil {

/// The median of measured values, and an interval for the true one.
struct MedianInterval {
  double median = 0;
  double low = 0, high = 0;  ///< Holds the true median in 95 % of cases, for any distribution.
};

/// Min. number of values with a known interval: of five, the true median lies outside of all in 6 %
/// of cases.
inline constexpr int kMedianMin = 6;

/// Returns the median of independent values and its interval by order statistics. A value lies
/// below the true median with probability one half. So the k-th smallest and the k-th largest
/// enclose it unless fewer than k values are on one side, which is binomial [Conover]. 95 % need
/// `kMedianMin` values or more; for fewer the interval is from the smallest to the largest. For
/// no values all are 0.
MedianInterval median_interval(std::vector<double> values);

}  // namespace thimble::hil
