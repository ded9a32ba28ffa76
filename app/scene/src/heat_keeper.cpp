#include "heat_keeper.h"

#include <chrono>
#include <cmath>
#include <fstream>
#include <system_error>
#include <utility>

#include "log/logger.h"
#include "math/elementary.h"
#include "user_folders.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

void warn_not_saved(const std::string& name) {
  logger().warn(
      "Cannot save the motor temperatures to {}, so the next run assumes cold motors. Let them "
      "cool before it, and make the folder writable.",
      heat_file(name).string());
}

}  // namespace

fs::path heat_file(const std::string& name) {
  return state_folder() / "heat" / (as_file_name(name) + ".yaml");
}

double world_time() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

KnownHeat load_heat(const std::string& name, const driver::HeatSettings& settings, double now) {
  const fs::path file = heat_file(name);
  std::error_code missing;
  KnownHeat known;
  const fs::file_status status = fs::status(file, missing);
  if (status.type() == fs::file_type::not_found) return known;
  known.heat.fill(1);
  if (status.type() != fs::file_type::regular) {
    known.note = "The motors are assumed to be hot: " + file.string() +
                 " is not a regular file. If they are cold, delete it.";
    return known;
  }
  auto yaml = YamlFile::load(file);
  bool sound = false, running = false;
  double kept_at = 0;
  Eigen::Vector3d heat(0, 0, 0);
  if (yaml) {
    YamlMap& root = yaml->root();
    heat = root.require_vector3("heat", "", 0, 1);
    kept_at = root.require_number("time", "s since 1970", 0, 1e12);
    running = root.require_choice("running", {"no", "yes"}) == 1;
    root.finish();
    sound = yaml->finish().ok();
  }
  if (!sound) {
    known.note = "The motors are assumed to be hot: " + file.string() +
                 " is not a valid record. If they are cold, delete it.";
    return known;
  }
  if (running) {
    known.note =
        "The motors are assumed to be hot: the last run with this arm did not end properly. If "
        "they are cold, delete " +
        file.string() + ".";
    return known;
  }
  const double passed = std::max(0.0, now - kept_at);
  for (std::size_t i = 0; i < 3; ++i) {
    known.heat[i] =
        heat[static_cast<Eigen::Index>(i)] * math::exp(-passed / settings.time_constant[i]);
  }
  return known;
}

bool save_heat(const std::string& name, const std::array<double, 3>& heat, double now,
               bool running) {
  const fs::path file = heat_file(name);
  const fs::path fresh = file.string() + ".new";
  std::error_code trouble;
  fs::create_directories(file.parent_path(), trouble);
  fs::remove(fresh, trouble);  // opening a pipe of that name would block
  std::ofstream stream(fresh);
  stream.precision(17);
  stream << "# Heat of the motors of " << name << " after a run: 0 is the temperature of the room, "
         << "1 the limit of the winding.\nheat: [" << heat[0] << ", " << heat[1] << ", " << heat[2]
         << "]\ntime: " << now << "\nrunning: \"" << (running ? "yes" : "no") << "\"\n";
  stream.close();
  if (stream) fs::rename(fresh, file, trouble);
  return stream && !trouble;
}

HeatKeeper::HeatKeeper(std::string name, const driver::Device& device)
    : name_(std::move(name)), device_(device) {
  if (!save_heat(name_, device_.heat().heat(), world_time(), true)) warn_not_saved(name_);
}

HeatKeeper::~HeatKeeper() {
  if (!save_heat(name_, device_.heat().heat(), world_time(), false)) warn_not_saved(name_);
}

}  // namespace thimble::scene
