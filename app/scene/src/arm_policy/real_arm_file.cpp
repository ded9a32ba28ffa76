#include "thimble/scene/real_arm_file.h"

#include <optional>
#include <string_view>
#include <utility>

#include "arm/calibration.h"
#include "arm_policy/board_model.h"
#include "arm_policy/limits_policy.h"
#include "arm_table.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/shipped_files.h"
#include "user_folders.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;
using driver::ArmKind;
using driver::Error;
using driver::FoundArm;
using driver::Result;

/// Installed file, and the reason why it was chosen.
struct Choice {
  fs::path path;
  std::string why;
};

/// Returns the names of the installed arm files that fit an arm, as part of a sentence.
std::string fitting_names(const FoundArm& arm) {
  std::string names;
  for (const ShippedFile& installed : installed_arms()) {
    const auto file = load_arm(installed.path);
    if (file && check_fits(*file, arm)) names += (names.empty() ? "" : ", ") + installed.name;
  }
  return names.empty() ? "none is installed that fits it" : "installed are: " + names;
}

Error error_arm_file_unknown(const FoundArm& arm, const std::string& because) {
  return Error{because + " Choose its arm file: thimble calibrate --device " + arm.name() +
               " --arm NAME stores it for all later runs, --arm NAME applies to one run (" +
               fitting_names(arm) + ")."};
}

/// Returns the error for an arm behind a library. It is not calibrated here, so each run must name
/// its file.
Error error_library_needs_arm_file(const FoundArm& arm) {
  return Error{"The library of " + arm.arm + " " + arm.name() +
               " drives several arms. Name the arm file in each run: --arm NAME (" +
               fitting_names(arm) + ")."};
}

Result<Choice> installed_named(const std::string& name, const std::string& why) {
  for (const ShippedFile& installed : installed_arms()) {
    if (installed.name == name) return Choice{installed.path, why};
  }
  return Error{"No installed arm file is called " + name + ", which is needed (" + why +
               "). Put it into " + own_arm_folder().string() + ", or name another with --arm."};
}

Result<Choice> installed_for_model(const FoundArm& arm, int model) {
  const std::string number = std::to_string(model);
  std::optional<Choice> found;
  for (const ShippedFile& installed : installed_arms()) {
    const auto file = load_arm(installed.path);
    if (!file || file->board_model != model || !check_fits(*file, arm)) continue;
    if (found) {
      return error_arm_file_unknown(arm, "The board " + arm.name() + " reports model " + number +
                                             ", for which several arm files are installed.");
    }
    found = Choice{installed.path, "its board reports model " + number};
  }
  if (found) return *found;
  return error_arm_file_unknown(arm, "The board " + arm.name() + " reports model " + number +
                                         ", for which no arm file is installed.");
}

/// Finds the installed file of an arm if the user did not name one.
Result<Choice> choose_by_arm(const FoundArm& arm, const Calibration* calibration,
                             const RealArmSearch& search) {
  if (calibration != nullptr && !calibration->arm_file.empty()) {
    return installed_named(calibration->arm_file, "stored with its calibration in " +
                                                      calibration_file(arm.name()).string());
  }
  if (arm.kind == ArmKind::kDescribed) {
    return installed_named(arm.arm_file, "it describes the board " + arm.name());
  }
  const driver::ArmRow* row = driver::row_of(arm.kind);
  if (row != nullptr && !row->own_file.empty()) {
    return installed_named(std::string(row->own_file), "the arm is a " + arm.arm);
  }
  if (row != nullptr && row->has_own_link()) {
    return error_library_needs_arm_file(arm);
  }
  if (arm.kind != ArmKind::kHfabLine) {
    return error_arm_file_unknown(arm,
                                  "The arm " + arm.name() + " does not report its model over USB.");
  }
  const auto model = search.ask_model ? search.ask_model(arm) : ask_board_model(arm);
  if (!model) return error_arm_file_unknown(arm, model.error().message);
  return installed_for_model(arm, *model);
}

/// Finds the installed file that limits a file from another folder: that of an arm of the same
/// name, or else that of the arm itself.
Result<Choice> choose_for(const ArmFile& other, const FoundArm& arm, const Calibration* calibration,
                          const RealArmSearch& search) {
  for (const ShippedFile& installed : installed_arms()) {
    const auto file = load_arm(installed.path);
    if (file && file->name == other.name) {
      return Choice{installed.path, "the installed file of the arm that --arm describes"};
    }
  }
  auto own = choose_by_arm(arm, calibration, search);
  if (own) return own;
  const std::string folder = own_arm_folder().string();
  return Error{
      search.arm_file.string() +
      ": a real arm gets its limits from an installed arm file, and there is none for an arm "
      "called " +
      other.name + ". If you have checked this file for exactly this arm: mkdir -p " + folder +
      " && cp " + search.arm_file.string() + " " + folder + "/"};
}

Error differs(const fs::path& file, const char* section, const fs::path& installed) {
  const std::string folder = own_arm_folder().string();
  return Error{
      file.string() + ": its section \"" + section + "\" differs from that of " +
      installed.string() +
      ". The properties of a real arm come from an installed arm file; another file may only "
      "tighten its limits. If you have checked it for exactly this arm: mkdir -p " +
      folder + " && cp " + file.string() + " " + folder + "/"};
}

}  // namespace

Result<RealArmFile> find_real_arm_file(const FoundArm& arm, const RealArmSearch& search) {
  auto calibration = load_calibration(arm.name());
  if (!calibration && !search.for_calibration) return calibration.error();
  const Calibration* known = calibration && *calibration ? &**calibration : nullptr;

  const bool named = !search.arm_file.empty();
  const bool from_elsewhere = named && !is_installed_arm(search.arm_file);
  std::optional<ArmFile> other;
  if (from_elsewhere) {
    auto read = load_arm(search.arm_file);
    if (!read) return read.error();
    other = std::move(read).value();
  }
  auto choice = from_elsewhere ? choose_for(*other, arm, known, search)
                : named        ? Result<Choice>(Choice{search.arm_file, "named by --arm"})
                               : choose_by_arm(arm, known, search);
  if (!choice) return choice.error();

  auto file = load_arm(choice->path);
  if (!file) return file.error();
  RealArmFile found{
      .path = choice->path, .file = std::move(file).value(), .why = choice->why, .warnings = {}};
  if (auto fits = check_fits(found.file, arm); !fits) return fits.error();
  if (other) {
    if (const char* section = differing_section(found.file, *other)) {
      return differs(search.arm_file, section, found.path);
    }
    found.warnings = tighten(found.file, found.path, *other, search.arm_file);
  }
  if (known == nullptr || search.for_calibration) return found;
  const std::string name = found.path.stem().string();
  if (!known->arm_file.empty() && known->arm_file != name) {
    return Error{"The calibration of " + arm.name() + " (" + calibration_file(arm.name()).string() +
                 ") was made with the arm file " + known->arm_file + ", not with " + name +
                 ". Calibrate again: thimble calibrate "
                 "--device " +
                 arm.name() + " --arm " + name};
  }
  apply(*known, found.file);
  return found;
}

}  // namespace thimble::scene
