#pragma once

#include <yaml-cpp/yaml.h>

#include <vector>

#include "bringup/identify/identify.h"
#include "bringup/identify/output/identified_file.h"
#include "bringup/identify/output/train_section.h"
#include "thimble/device_sim/settings.h"

namespace thimble::bringup {

/// Returns what is written of the friction of a rigid arm's joints. Where it was looked for and
/// none was seen, a file whose `train` names some says zero. Real-time: never from the servo
/// thread.
std::vector<TrainKey> rubbing_keys(const YAML::Node& train, const Identified& found,
                                   const IdentifiedMark& mark);

/// Returns whether a file that was read again names what was put. Real-time: never from the servo
/// thread.
bool reads_rubbing(const device_sim::DriveTrainSettings& read, const Identified& found);

}  // namespace thimble::bringup
