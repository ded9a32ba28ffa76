#include "cli/plug_commands.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <sstream>
#include <utility>

#include "log/logger.h"
#include "system/regular_file.h"

namespace thimble::cli {
namespace {

/// Executes a command of the hand: `off`, `on`, or its position relative to the start.
bool move_hand(PluggedArm& plugged, const std::string& words) {
  if (words == "off" || words == "on") {
    plugged.arm.hold_tip(words == "on");
    return true;
  }
  std::istringstream numbers(words);
  Eigen::Vector3d away;
  std::string more;
  const bool read = static_cast<bool>(numbers >> away.x() >> away.y() >> away.z());
  if (!read || numbers >> more || !away.allFinite()) {
    scene::logger().error(
        "'hand {}' is invalid. Use 'hand X Y Z' (m, along the axes of the base, from the start of "
        "the hand), 'hand off' or 'hand on'.",
        words);
    return false;
  }
  plugged.arm.lead_hand(plugged.p_BH + away);
  return true;
}

/// Fixes a mass to the tip, kg.
bool set_mass(PluggedArm& plugged, const std::string& words) {
  std::istringstream numbers(words);
  double mass = 0;
  std::string more;
  if (!(numbers >> mass) || numbers >> more) {
    scene::logger().error("'mass {}' is invalid. Use 'mass KG', or 'mass 0' to remove the mass.",
                          words);
    return false;
  }
  if (!plugged.gravity_B) {
    scene::logger().error(
        "The direction of gravity is unknown. Pass the arm file with --arm FILE.");
    return false;
  }
  const auto fixed = plugged.arm.fix_mass(mass, *plugged.gravity_B);
  if (!fixed) scene::logger().error("{}", fixed.error().message);
  return fixed.ok();
}

}  // namespace

bool execute_line(PluggedArm& plugged, const std::string& line) {
  if (line.empty() || line[0] == '#') return true;
  if (line == "heal") {
    plugged.device.heal();
    return true;
  }
  if (line.starts_with("hand ")) return move_hand(plugged, line.substr(5));
  if (line.starts_with("mass ")) return set_mass(plugged, line.substr(5));
  const auto order = device_sim::usb::parse_fault(line);
  if (!order) {
    scene::logger().error("{}", order.error().message);
    return false;
  }
  plugged.device.order(*order);
  return true;
}

bool execute_file(PluggedArm& plugged, const std::string& path) {
  constexpr std::uint64_t kMaxBytes = 4'000'000;
  auto text = driver::read_file(path, kMaxBytes);
  if (!text) {
    scene::logger().error("--faults {}: {}", path, text.error().message);
    return false;
  }
  std::istringstream file(std::move(text).value());
  for (std::string line; std::getline(file, line);) {
    if (!execute_line(plugged, line)) return false;
  }
  return true;
}

CommandPipe::~CommandPipe() {
  if (file_ < 0) return;
  close(file_);
  unlink(path_.c_str());
}

bool CommandPipe::open(const std::string& path) {
  path_ = path;
  // Also open for writing, so that the pipe stays open when a writer closes it.
  if (mkfifo(path.c_str(), 0600) != 0) return false;
  file_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  struct stat status {};
  const bool own = file_ >= 0 && fstat(file_, &status) == 0 && S_ISFIFO(status.st_mode) &&
                   status.st_uid == geteuid();
  if (own) return true;
  if (file_ >= 0) close(file_);
  file_ = -1;
  return false;
}

void CommandPipe::poll(PluggedArm& plugged) {
  if (file_ < 0) return;
  std::array<char, 512> bytes;
  const ssize_t size = read(file_, bytes.data(), bytes.size());
  for (ssize_t i = 0; i < size; ++i) {
    const char letter = bytes[static_cast<std::size_t>(i)];
    if (letter != '\n') {
      line_ += letter;
    } else {
      execute_line(plugged, line_);
      line_.clear();
    }
  }
}

}  // namespace thimble::cli
