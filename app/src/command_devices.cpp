#include <cstdio>

#include "commands.h"
#include "exit_code.h"
#include "thimble/driver/discovery.h"

namespace thimble::app {
namespace {

int list_devices() {
  std::printf("%-10s %-16s %-10s %-22s %s\n", "name", "arm", "bus", "where", "state");
  std::printf("%-10s %-16s %-10s %-22s %s\n", "sim", "simulated arm", "-", "-", "ready");
  const auto arms = driver::find_arms();
  if (!arms) {
    std::fprintf(stderr, "thimble: %s\n", arms.error().message.c_str());
    return kExitTrouble;
  }
  for (const driver::FoundArm& arm : *arms) {
    std::printf("%-10s %-16s %-10s %-22s %s\n", "-", arm.arm.c_str(), arm.bus.c_str(),
                arm.address.c_str(), "plugged in; this version drives the simulated arm only");
  }
  if (arms->empty()) std::printf("No arm that Thimble knows is plugged in on USB.\n");
  return kExitDone;
}

}  // namespace

void add_devices_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("devices", "List the arms: simulated, and plugged in");
  command->callback([&exit_code] { exit_code = list_devices(); });
}

}  // namespace thimble::app
