#include "arm_policy/feel_check_record.h"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <system_error>

#include "arm_table.h"
#include "text_file.h"
#include "thimble/driver/safety_gate.h"
#include "user_folders.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Non-cryptographic checksum of bytes: FNV-1a, 64 bits [Fowler, Noll, Vo].
class Checksum {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) add_byte(static_cast<unsigned char>(byte));
    add_byte(0);  // separates one text from the next
  }
  /// Adds a number rounded to 10^-9 of `unit`, so that another compiler gives the same checksum.
  void add(double number, double unit) {
    add(std::isfinite(number) ? fmt::format("{:.0f}", std::round(number / (1e-9 * unit))) : "none");
  }
  std::string text() const { return fmt::format("{:016x}", sum_); }

 private:
  void add_byte(unsigned char byte) { sum_ = (sum_ ^ byte) * 0x100000001b3u; }

  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

std::string content_of(const fs::path& file) {
  return text_of(file);
}

std::string checksum_of(const fs::path& file) {
  Checksum sum;
  sum.add(content_of(file));
  return sum.text();
}

/// Returns a checksum of the effect of an arm file in the driver: the tip for some counts, the
/// counts at the home pose, and the drive of each motor. It changes with the calibration, and with
/// geometry and signs that are code.
std::string checksum_of_data(const ArmFile& file, driver::ArmKind kind) {
  Checksum sum;
  const auto arm = driver::make_arm(kind, file.model, file.wire.get());
  if (arm == nullptr) {  // the rest is known only to the software of the vendor
    for (const double coordinate : file.p_WB) sum.add(coordinate, 1);
    for (const double entry : file.R_WB.reshaped()) sum.add(entry, 1);
    return sum.text();
  }
  for (int i = 0; i < 8; ++i) {
    driver::ArmReading reading;
    for (std::size_t k = 0; k < 3; ++k) reading.counts[k] = (i >> k) % 2 == 0 ? 0 : 500;
    const Eigen::Vector3d p_WT = file.p_WB + file.R_WB * arm->pose(reading).p_BT;
    for (const double coordinate : p_WT) sum.add(coordinate, 1);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const driver::MotorDrive& drive = arm->drives()[k];
    sum.add(drive.sign, 1);
    sum.add(drive.ratio, 1);
    sum.add(drive.torque_constant, 1);
    sum.add(drive.current_max, 1);
    sum.add(file.model.encoders[k].sign, 1);
    sum.add(static_cast<double>(file.model.encoders[k].home_counts), 1);
    sum.add(file.model.encoders[k].counts_per_motor_turn, 1);
  }
  return sum.text();
}

/// Returns the known properties of the firmware of an arm; empty if they are not enough to
/// recognise it.
std::string firmware_of(const driver::FoundArm& found, const fs::path& image) {
  if (!found.software.empty()) return std::string(name(found.board)) + ' ' + found.software;
  if (found.release == 0) return {};  // the board does not report a release
  std::string text = fmt::format("usb {:04x}:{:04x} device {:04x} \"", found.vendor_id,
                                 found.product_id, found.release) +
                     found.product + '"';
  if (found.kind != driver::ArmKind::kFalcon) return text;
  // The firmware of a Falcon is the image that was loaded last. Its USB properties are those of the
  // converter.
  std::error_code missing;
  if (image.empty() || !fs::is_regular_file(image, missing)) return {};
  return text + " image " + checksum_of(image);
}

std::string record_of(const CheckedArm& arm) {
  return "# Written by `thimble feel-check`, which this arm passed. Whatever is changed here or "
         "in\n"
         "# what is named here takes that back.\n"
         "arm: " +
         arm.name + "\narm_file: " + arm.arm_file + "\ndata: " + arm.data +
         "\nfirmware: " + arm.firmware + "\npassed: all\n";
}

/// Returns whether a file belongs to this user and is not writable by others.
bool is_owned_by_user(const fs::path& file) {
  struct stat status {};
  return ::stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
         status.st_uid == geteuid() && (status.st_mode & S_IWOTH) == 0;
}

}  // namespace

CheckedArm describe_checked(const driver::FoundArm& found, const RealArmFile& arm,
                            const fs::path& firmware) {
  return {.name = found.name(),
          .arm_file = arm.path.filename().string() + ' ' + checksum_of(arm.path),
          .data = checksum_of_data(arm.file, found.kind),
          .firmware = firmware_of(found, firmware)};
}

fs::path feel_check_file(const std::string& name) {
  return state_folder() / "feel_checks" / as_file_name(name);
}

bool has_passed(const CheckedArm& arm) {
  if (arm.firmware.empty()) return false;
  const fs::path file = feel_check_file(arm.name);
  return is_owned_by_user(file) && content_of(file) == record_of(arm);
}

driver::Result<void> save_feel_check(const CheckedArm& arm) {
  if (arm.firmware.empty()) {
    return driver::Error{
        "The firmware of the arm is not known, so this check is not recorded. For a Falcon, name "
        "the image with --firmware FILE, here and in each run."};
  }
  const fs::path file = feel_check_file(arm.name);
  const fs::path fresh = file.string() + ".new";
  std::error_code trouble;
  fs::create_directories(file.parent_path(), trouble);
  std::ofstream stream(fresh, std::ios::binary);
  stream << record_of(arm);
  stream.close();
  if (stream) fs::rename(fresh, file, trouble);
  if (!stream || trouble) {
    return driver::Error{"Cannot write the record of this check to " + file.string() +
                         ". Make the folder writable."};
  }
  return {};
}

driver::Result<void> remove_feel_check(const std::string& name) {
  const fs::path file = feel_check_file(name);
  std::error_code trouble;
  fs::remove(file, trouble);
  if (!trouble) return {};
  return driver::Error{"Cannot remove the record of an earlier check: " + file.string() +
                       ". Remove it yourself, because this arm has failed."};
}

}  // namespace thimble::scene
