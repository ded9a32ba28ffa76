#pragma once

#include <yaml-cpp/yaml.h>

#include "bringup/identify/identify.h"
#include "bringup/identify/new_file/file_lines.h"
#include "bringup/identify/new_file/identified_file.h"
#include "thimble/device_sim/settings.h"

namespace thimble::app {

/// Puts cogging and ripple of the motors that were seen into the section `drive_train` of
/// `simulation`, or adds it before `tip`. Where they were looked for and none was seen, a file that
/// names some says zero. Answers whether the file's form can be changed. Real-time: never from the
/// servo thread.
bool put_waves(const YAML::Node& simulation, const Identified& found, const IdentifiedMark& mark,
               FileLines& lines);

/// Returns whether a file that was read again names what was put. Real-time: never from the servo
/// thread.
bool reads_waves(const device_sim::DriveTrainSettings& read, const Identified& found);

}  // namespace thimble::app
