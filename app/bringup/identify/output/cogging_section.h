#pragma once

#include <yaml-cpp/yaml.h>

#include <vector>

#include "bringup/identify/identify.h"
#include "bringup/identify/output/identified_file.h"
#include "bringup/identify/output/train_section.h"
#include "thimble/device_sim/settings.h"

namespace thimble::bringup {

/// Returns the keys for the cogging and ripple that were seen. If they were searched for and none
/// seen, a file whose `train` names some gets zero. Real-time: never from the servo thread.
std::vector<TrainKey> cogging_keys(const YAML::Node& train, const Identified& found,
                                   const IdentifiedMark& mark);

/// Returns whether a file that was read back names the written values. Real-time: never from the
/// servo thread.
bool reads_cogging(const device_sim::DriveTrainSettings& read, const Identified& found);

}  // namespace thimble::bringup
