#pragma once

#include <yaml-cpp/yaml.h>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/output/file_lines.h"
#include "bringup/identify/output/identified_file.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Writes the links that were seen into the section `links` of `simulation`, or adds it before
/// `tip`. If links were searched for and none seen, the values of an existing section become zero.
/// Fails if its form cannot be changed. Real-time: never from the servo thread.
driver::Result<void> put_links(const YAML::Node& simulation, const ArmConstants& found,
                               const IdentifiedMark& mark, FileLines& lines);

/// Returns whether a file that was read back names the written links. Real-time: never from the
/// servo thread.
bool reads_links(const device_sim::LinkSettings& read, const ArmConstants& found);

}  // namespace thimble::bringup
