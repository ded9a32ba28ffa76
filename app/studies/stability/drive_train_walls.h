#pragma once

#include <filesystem>
#include <vector>

#include "stability/stability_laws.h"
#include "studies/stability/stability_plan.h"
#include "studies/stability/stability_tables.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

// What the drive train does to the largest stiffness: amplifiers that lag, and cables that stretch.
// The arm is that of case 1 [PHYSICS 7], free and linear. With a cable a part of its mass belongs
// to the motor, whose encoder the loop sees. Real-time: never from the servo thread.

/// The part of the tip's mass that is the motor's where a cable stretches [chosen: what the rotors
/// of such arms make of it is not published].
inline constexpr double kRotorShare = 0.3;

/// Adds the cells of both sweeps; those of the cable only for an arm of which one joint alone moves
/// the tip along a line at home, for the law is of one dimension.
void add_drive_train_walls(const StabilitySetup& setup, std::vector<StabilityCell>& cells);

/// Returns the linear loop of a cell of either sweep.
stability::SampledWall drive_train_wall(const StabilitySetup& setup, const StabilityCell& cell);

/// Finds the largest stiffness of the simulated arm, N/m. Fails as run_wall.
driver::Result<double> drive_train_edge(const StabilitySetup& setup, const StabilityCell& cell);

/// Draws both, law and simulation side by side.
driver::Result<void> draw_drive_train_walls(const StabilitySetup& setup,
                                            const std::vector<StabilityRow>& rows,
                                            const std::filesystem::path& folder);

}  // namespace thimble::studies
