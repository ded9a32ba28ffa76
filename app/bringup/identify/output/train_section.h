#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <string>
#include <vector>

#include "bringup/estimate.h"
#include "bringup/identify/output/file_lines.h"
#include "bringup/identify/output/identified_file.h"

namespace thimble::bringup {

/// One key of the section `drive_train`: its value, and the comment after it.
struct TrainKey {
  std::string name, value, remark;

  /// Makes a key with a value for each motor or joint.
  static TrainKey of(const std::string& name, const std::string& unit,
                     const std::array<Estimate, 3>& values, const IdentifiedMark& mark);
};

/// Writes keys into the section `drive_train` of `simulation`, or adds it before `tip`. Returns
/// whether the file's form can be changed. Real-time: never from the servo thread.
bool put_train_keys(const YAML::Node& simulation, const std::vector<TrainKey>& keys,
                    FileLines& lines);

}  // namespace thimble::bringup
