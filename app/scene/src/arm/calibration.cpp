#include "calibration.h"
#include "arm_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <ostream>
#include <system_error>

#include "arm_table.h"
#include "hand/place_text.h"
#include "user_folders.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

std::array<int, 3> read_signs(YamlMap& map, std::string_view key) {
  const auto signs = map.require_signs(key);
  return {static_cast<int>(signs[0]), static_cast<int>(signs[1]), static_cast<int>(signs[2])};
}

template <class Number>
void put(std::ostream& stream, const char* key, const std::array<Number, 3>& numbers) {
  stream << key << ": [" << numbers[0] << ", " << numbers[1] << ", " << numbers[2] << "]\n";
}

}  // namespace

fs::path calibration_file(const std::string& name) {
  return config_folder() / "arms" / (as_file_name(name) + ".yaml");
}

driver::Result<std::optional<Calibration>> load_calibration(const std::string& name) {
  const fs::path file = calibration_file(name);
  std::error_code missing;
  if (!fs::exists(file, missing)) return std::optional<Calibration>();
  auto yaml = YamlFile::load(file);
  if (!yaml) return yaml.error();
  YamlMap& root = yaml->root();
  Calibration calibration;
  const auto home = root.require_three_whole("home_counts", "counts", -1'000'000, 1'000'000);
  for (std::size_t i = 0; i < 3; ++i) {
    calibration.home_counts[i] = static_cast<std::int32_t>(home[i]);
  }
  calibration.encoder_sign = read_signs(root, "encoder_sign");
  calibration.motor_sign = read_signs(root, "motor_sign");
  calibration.arm_file = root.optional_string("arm_file", "");
  root.finish();
  if (auto done = yaml->finish(); !done) return done.error();
  return std::optional<Calibration>(calibration);
}

driver::Result<void> save_calibration(const std::string& name, const Calibration& calibration) {
  const fs::path file = calibration_file(name);
  const fs::path fresh = file.string() + ".new";
  std::error_code trouble;
  fs::create_directories(file.parent_path(), trouble);
  std::ofstream stream(fresh);
  stream << "# Calibration of the arm " << name << ", written by `thimble calibrate`.\n";
  put(stream, "home_counts", calibration.home_counts);
  put(stream, "encoder_sign", calibration.encoder_sign);
  put(stream, "motor_sign", calibration.motor_sign);
  if (!calibration.arm_file.empty()) {
    stream << "arm_file: " << std::quoted(calibration.arm_file) << "\n";
  }
  stream.close();
  if (stream) fs::rename(fresh, file, trouble);
  if (!stream || trouble) {
    return driver::Error{"Cannot write the calibration to " + file.string() +
                         ". Make the folder writable."};
  }
  return {};
}

void apply(const Calibration& calibration, ArmFile& file) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(file.motors()); ++i) {
    file.model.encoders[i].home_counts = calibration.home_counts[i];
    file.model.encoders[i].sign = calibration.encoder_sign[i];
    file.model.drives[i].sign = calibration.motor_sign[i];
  }
}

double calibration_move(const ArmFile& file, const Eigen::Vector3d& p_WHome, int axis) {
  constexpr double kMax = 0.05, kStep = 0.005;  // m [chosen: easy to estimate without a ruler]
  constexpr double kRoomMin = 0.01;  // m [chosen: with less, the home pose is at the edge]
  const double room = file.workspace.max_W[axis] - p_WHome[axis];
  const double width = file.workspace.max_W[axis] - file.workspace.min_W[axis];
  // Behind a home pose at or beyond the edge of the box is room outside of it.
  const double wanted = room > kRoomMin ? 0.8 * room : 0.4 * width;
  return std::clamp(kStep * std::floor(wanted / kStep), kStep, kMax);
}

driver::Result<Calibration> find_calibration(const ArmFile& file, driver::ArmKind kind,
                                             const driver::ArmReading& home,
                                             const std::array<driver::ArmReading, 3>& moved,
                                             const std::vector<int>& axes) {
  constexpr double kMoveMin = 0.4;  // of the requested distance [chosen: 20 of 50 mm]
  const auto motors = static_cast<std::size_t>(file.motors());
  if (axes.size() != motors) {
    return driver::Error{
        "The line or plane of the tip is not along axes of the world, so the motions cannot be "
        "asked for. Place it along them for the calibration (at in the arm file)."};
  }
  // With each set of signs (eight for three motors), the three motions have certain directions. The
  // correct set gives the directions that the user was asked for.
  const auto count = static_cast<double>(motors);
  double best = -1 - count, second = -1 - count;
  bool moved_enough = false;
  Calibration found;
  for (unsigned set = 0; set < 1U << motors; ++set) {
    Calibration tried;
    for (std::size_t i = 0; i < motors; ++i) {
      const int in_file = file.model.encoders[i].sign < 0 ? -1 : 1;
      const int flip = (set >> i) & 1U ? -1 : 1;
      tried.encoder_sign[i] = flip * in_file;
      tried.motor_sign[i] = flip * (file.model.drives[i].sign < 0 ? -1 : 1);
      // At the home pose the joint angle is that of the file, with either sign of the encoder.
      tried.home_counts[i] =
          static_cast<std::int32_t>(flip * file.model.encoders[i].home_counts - home.counts[i]);
    }
    ArmFile as_tried = file;
    apply(tried, as_tried);
    const auto arm = driver::make_arm(kind, as_tried.model, file.wire.get());
    const Eigen::Vector3d p_home = arm->pose(home).p_BT;
    const Eigen::Vector3d p_WHome = file.p_WB + file.R_WB * p_home;
    double score = 0;
    bool enough = true;
    for (std::size_t i = 0; i < motors; ++i) {
      const Eigen::Vector3d step = file.R_WB * (arm->pose(moved[i]).p_BT - p_home);
      if (!(step.norm() > kMoveMin * calibration_move(file, p_WHome, axes[i]))) enough = false;
      if (step.norm() > 0) score += step[axes[i]] / step.norm();
    }
    moved_enough = moved_enough || enough;
    if (!(score < HUGE_VAL)) continue;
    if (score > best) {
      second = best;
      best = score;
      found = tried;
    } else if (score > second) {
      second = score;
    }
  }
  if (!moved_enough) {
    return driver::Error{
        "The grip moved too little. Move it by the requested distance or more each time."};
  }
  // The motions are within 37 degrees of the requested ones, and fit clearly better than with any
  // other set.
  if (best < 0.8 * count || best - second < 0.5) {
    return driver::Error{
        motors < 3 ? "The motions do not determine the signs of the encoders. Start at the home "
                     "pose and move the grip straight in each requested direction, and back to "
                     "the home pose in between."
                   : "The motions do not determine the signs of the encoders. Start at the home "
                     "pose and move the grip straight towards you, to the right and up, and back "
                     "to the home pose in between."};
  }
  return found;
}

driver::Result<void> check_home(const ArmFile& file, driver::ArmKind kind,
                                const Calibration& calibration, const driver::ArmReading& there) {
  if (!file.home.check_p_WT) return {};
  ArmFile calibrated = file;
  apply(calibration, calibrated);
  const auto arm = driver::make_arm(kind, calibrated.model, file.wire.get());
  const Eigen::Vector3d p_WT = file.p_WB + file.R_WB * arm->pose(there).p_BT;
  const double away = (p_WT - *file.home.check_p_WT).norm();
  // Written so that NaN is too far.
  if (away <= file.home.within) return {};
  return driver::Error{fmt::format(
      "In the second pose the tip should be at {} m, but the encoders give {} m, {:.1f} mm away; "
      "home.within allows {:.1f} mm. Put the arm into its home pose exactly and repeat. If it "
      "stays "
      "so, correct home_counts, counts_per_motor_turn, ratio or the lengths in the arm file.",
      place_text(*file.home.check_p_WT, 3), place_text(p_WT, 3), 1e3 * away,
      1e3 * file.home.within)};
}

}  // namespace thimble::scene
