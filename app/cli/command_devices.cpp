#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "thimble/driver/discovery.h"
#include "transports/node_lock.h"

namespace thimble::cli {
namespace {

std::string state_of(const driver::FoundArm& arm, const std::string& root) {
  if (arm.certainty == driver::Certainty::kUnsupported) return "its protocol is not public";
  if (!arm.trouble.empty()) return "cannot be used: thimble doctor";
  if (arm.node.empty()) return "no kernel driver: thimble doctor";
  if (arm.board == driver::BoardKind::kHaplyService &&
      arm.certainty == driver::Certainty::kUnknown) {
    return "thimble exec --serve haply: no Inverse3";
  }
  if (arm.certainty == driver::Certainty::kUnknown) return "board of unknown kind: thimble doctor";
  if (!arm.accessible) return "no access: thimble doctor";
  if (const auto holder = driver::find_holder(arm.node, root)) {
    return "in use by " + holder->program + " (process " + std::to_string(holder->pid) + ")";
  }
  return "ready";
}

int list_devices(const std::string& root) {
  constexpr const char* kRow = "%-14s %-16s %-10s %-18s %-22s %s\n";
  scene::print_format(kRow, "name", "arm", "bus", "where", "node", "state");
  scene::print_format(kRow, "sim", "simulated arm", "-", "-", "-", "ready");
  const auto arms = driver::find_arms(root);
  if (!arms) {
    scene::print_format("%s\n", arms.error().message.c_str());
    return kExitDone;  // the simulated arm needs no USB
  }
  for (const driver::FoundArm& arm : *arms) {
    scene::print_format(kRow, arm.name().c_str(), arm.arm.c_str(), arm.bus.c_str(),
                        arm.address.c_str(), arm.node.empty() ? "-" : arm.node.c_str(),
                        state_of(arm, root).c_str());
  }
  if (arms->empty()) scene::print_format("No known arm is plugged in on USB.\n");
  return kExitDone;
}

}  // namespace

void add_devices_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("devices", "List the simulated arm and the arms that are plugged in");
  auto root = std::make_shared<std::string>("/");
  command->add_option("--root", *root, "Root folder of the system to examine")
      ->check(CLI::ExistingDirectory)
      ->capture_default_str();
  add_example(*command, "thimble devices");
  command->callback([root, &exit_code] { exit_code = list_devices(*root); });
}

}  // namespace thimble::cli
