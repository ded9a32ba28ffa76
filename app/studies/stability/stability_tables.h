#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "studies/stability/stability_plan.h"
#include "studies/sweep/sweep.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// One cell with its measurements and the predictions of the laws.
struct StabilityRow {
  StabilityCell cell;
  std::vector<double> found;
  double law = 0;    ///< In the unit of found[0]; NaN without a law.
  double exact = 0;  ///< By the exact map of the linear arm, if there is one; otherwise NaN.
};

/// Returns the numbers of a sweep with their laws.
std::vector<StabilityRow> stability_rows(const StabilitySetup& setup, const CellNumbers& numbers);

/// Returns the rows of one sweep.
std::vector<StabilityRow> part_of(const std::vector<StabilityRow>& rows, StabilityPart part);

/// Measures of the stable region of the K-B map [PHYSICS 1.6].
struct ZWidth {
  double area = 0;           ///< Below the edge, N/m times N s/m.
  double stiffness_max = 0;  ///< N/m
  double damping_at = 0;     ///< Damping at that stiffness, N s/m.
  double decades = 0;        ///< log10(K_max / K_JND).
};

/// The smallest stiffness that a hand can feel, N/m: pressed by 10 mm it has the force of 20 mN
/// that a hand can just feel [PHYSICS 6; the distance is chosen: the range of a finger].
inline constexpr double kStiffnessJnd = 2;

/// Measures the region below an edge.
ZWidth z_width(const std::vector<StabilityRow>& edge);

/// Writes a CSV for each kind of sweep. Fails if a file cannot be written.
driver::Result<void> write_stability_tables(const StabilitySetup& setup,
                                            const std::vector<StabilityRow>& rows,
                                            const std::filesystem::path& folder);

/// Returns the agreement of laws and simulation, with the tolerances of [PHYSICS 1 and 7].
std::vector<session::Figure> stability_figures(const StabilitySetup& setup,
                                               const std::vector<StabilityRow>& rows);

}  // namespace thimble::studies
