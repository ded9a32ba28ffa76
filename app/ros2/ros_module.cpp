#include "ros2/ros_module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <string>

#include "thimble/version.h"

namespace thimble::ros2 {
namespace {

/// Returns the file with this code: the program, or a Python module.
std::filesystem::path own_file() {
  std::error_code status;
  Dl_info about{};
  static const char kHere = 0;
  if (dladdr(&kHere, &about) != 0 && about.dli_fname != nullptr) {
    const auto file = std::filesystem::canonical(about.dli_fname, status);
    if (!status && file.extension() == ".so") return file;
  }
  return std::filesystem::read_symlink("/proc/self/exe", status);
}

/// Returns the module's file next to this program, installed or in a build tree; empty if there is
/// none.
std::filesystem::path module_file() {
  std::error_code status;
  const std::filesystem::path folder = own_file().parent_path();
  // For the Python module: ../../ros2 in a build tree, and ../../../../bin if installed.
  const std::string installed = THIMBLE_ROS2_INSTALLED;
  for (const std::filesystem::path& place :
       {folder / "ros2", folder / "../ros2", folder / "../../ros2", folder / "../../app/ros2",
        folder / installed, folder / "../../../../bin" / installed,
        "/usr/bin" / std::filesystem::path(installed)}) {
    const std::filesystem::path file = (place / "thimble-ros2.so").lexically_normal();
    if (std::filesystem::exists(file, status)) return file;
  }
  return {};
}

/// The functions of the module.
struct RosModule {
  RosModuleOpen open = nullptr;  // makes a peer
  RosModuleEcho echo = nullptr;  // makes an answering peer
};

driver::Result<RosModule> load_module() {
  const std::filesystem::path file = module_file();
  if (file.empty()) {
    return driver::Error{
        "ROS 2 topics require the module thimble-ros2.so, which was not found. Install the package "
        "thimble-ros2. In a build from source, install cyclonedds-dev and cyclonedds-tools, run "
        "cmake again with -D THIMBLE_ROS2=ON, and build the target thimble_ros2."};
  }
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) {
    return driver::Error{fmt::format("{} cannot be loaded: {}. Install the package libddsc0debian.",
                                     file.string(), dlerror())};
  }
  // Never unloaded: threads of the DDS library outlive a peer.
  const auto* version = static_cast<const char*>(dlsym(module, kRosModuleVersion));
  void* open = dlsym(module, kRosModuleOpen);
  void* echo = dlsym(module, kRosModuleEcho);
  if (version == nullptr || open == nullptr || echo == nullptr ||
      std::strcmp(version, THIMBLE_VERSION) != 0) {
    return driver::Error{
        fmt::format("{} has version {}, but this program has {}. Install the same version of "
                    "thimble-ros2 and thimble.",
                    file.string(), version != nullptr ? version : "unknown", THIMBLE_VERSION)};
  }
  return RosModule{reinterpret_cast<RosModuleOpen>(open), reinterpret_cast<RosModuleEcho>(echo)};
}

/// Calls a function of the module that makes a peer; `make` takes the given arguments and the
/// buffer for an error.
template <class Make, class... Arguments>
driver::Result<std::unique_ptr<RosPeer>> made_by_module(Make RosModule::*make,
                                                        Arguments&... arguments) {
  const auto module = load_module();
  if (!module) return module.error();
  std::array<char, 400> error{};
  RosPeer* peer = ((*module).*make)(arguments..., error.data(), error.size());
  if (peer == nullptr) return driver::Error{error.data()};
  return std::unique_ptr<RosPeer>(peer);
}

}  // namespace

driver::Result<void> check_ros_module() {
  if (auto loaded = load_module(); !loaded) return loaded.error();
  return {};
}

driver::Result<std::unique_ptr<RosPeer>> open_ros_peer(const RosOptions& options,
                                                       const RosScene& scene, RosChannel& channel) {
  return made_by_module(&RosModule::open, options, scene, channel);
}

driver::Result<std::unique_ptr<RosPeer>> open_ros_echo(const RosOptions& options) {
  return made_by_module(&RosModule::echo, options);
}

}  // namespace thimble::ros2
