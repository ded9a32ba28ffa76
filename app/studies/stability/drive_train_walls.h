#pragma once

#include <filesystem>
#include <vector>

#include "stability/stability_laws.h"
#include "studies/stability/stability_plan.h"
#include "studies/stability/stability_tables.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

// Effects of the drive train on the largest stiffness: amplifier lag and elastic cables. The arm is
// that of case 1 [PHYSICS 7], free and linear. With a cable, a part of its mass belongs to the
// motor, whose encoder the loop reads. Real-time: never from the servo thread.

/// The motor's fraction of the tip's mass with an elastic cable [chosen: values of such arms are
/// not published].
inline constexpr double kRotorShare = 0.3;

/// Adds the cells of both sweeps. Those of the cable are added only for an arm with a single joint
/// that moves the tip along a line at home, because the law is one-dimensional.
void add_drive_train_walls(const StabilitySetup& setup, std::vector<StabilityCell>& cells);

/// Returns the linear loop of a cell of either sweep.
stability::SampledWall drive_train_wall(const StabilitySetup& setup, const StabilityCell& cell);

/// Returns the largest stiffness of the simulated arm, N/m. Fails like run_wall.
driver::Result<double> drive_train_edge(const StabilitySetup& setup, const StabilityCell& cell);

/// Draws law and simulation of both.
driver::Result<void> draw_drive_train_walls(const StabilitySetup& setup,
                                            const std::vector<StabilityRow>& rows,
                                            const std::filesystem::path& folder);

}  // namespace thimble::studies
