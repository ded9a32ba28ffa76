#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "studies/stability/stability_plan.h"
#include "studies/sweep/sweep.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// One cell with what was measured and what the laws say of it.
struct StabilityRow {
  StabilityCell cell;
  std::vector<double> found;
  double law = 0;    ///< In the unit of found[0]; NaN where no law speaks.
  double exact = 0;  ///< Of the linear arm's exact map, where there is one; else NaN.
};

/// Puts the numbers of a sweep beside their laws.
std::vector<StabilityRow> stability_rows(const StabilitySetup& setup, const CellNumbers& numbers);

/// Returns the rows of one sweep.
std::vector<StabilityRow> part_of(const std::vector<StabilityRow>& rows, StabilityPart part);

/// What the region of the K-B map measures [PHYSICS 1.6].
struct ZWidth {
  double area = 0;           ///< Under the edge, N/m times N s/m.
  double stiffness_max = 0;  ///< N/m
  double damping_at = 0;     ///< Where that is reached, N s/m.
  double decades = 0;        ///< log10(K_max / K_JND).
};

/// The least stiffness that a hand can tell from none, N/m: it answers a press of 10 mm by the
/// 20 mN that a hand can just feel [PHYSICS 6; the way is chosen: as far as a finger presses].
inline constexpr double kStiffnessJnd = 2;

/// Measures the region under an edge.
ZWidth z_width(const std::vector<StabilityRow>& edge);

/// Writes one CSV for each kind of sweep. Fails if a file cannot be written.
driver::Result<void> write_stability_tables(const StabilitySetup& setup,
                                            const std::vector<StabilityRow>& rows,
                                            const std::filesystem::path& folder);

/// Returns how well laws and simulation agree, with the tolerances of [PHYSICS 1 and 7].
std::vector<session::Figure> stability_figures(const StabilitySetup& setup,
                                               const std::vector<StabilityRow>& rows);

}  // namespace thimble::studies
