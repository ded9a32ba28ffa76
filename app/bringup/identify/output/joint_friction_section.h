#pragma once

#include <yaml-cpp/yaml.h>

#include <vector>

#include "bringup/identify/identify.h"
#include "bringup/identify/output/identified_file.h"
#include "bringup/identify/output/train_section.h"
#include "thimble/device_sim/settings.h"

namespace thimble::bringup {

/// Returns the keys for the friction of a rigid arm's joints. If it was searched for and none seen,
/// a file whose `train` names some gets zero. Real-time: never from the servo thread.
std::vector<TrainKey> joint_friction_keys(const YAML::Node& train, const Identified& found,
                                          const IdentifiedMark& mark);

/// Returns whether a file that was read back names the written values. Real-time: never from the
/// servo thread.
bool reads_joint_friction(const device_sim::DriveTrainSettings& read, const Identified& found);

}  // namespace thimble::bringup
