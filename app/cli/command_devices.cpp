#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/options/json_option.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "thimble/driver/discovery.h"
#include "thimble/scene/real_arm.h"
#include "transports/node_lock.h"

namespace thimble::cli {
namespace {

constexpr const char* kReady = "ready";

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
  return kReady;
}

int list_devices(const std::string& root) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const auto add = [&list](const std::string& name, const std::string& arm, const std::string& bus,
                           const std::string& where, const std::string& node,
                           const std::string& state) {
    list.push_back({{"name", name},
                    {"arm", arm},
                    {"bus", bus},
                    {"where", where},
                    {"node", node},
                    {"ready", state == kReady},
                    {"state", state}});
  };
  add("sim", "simulated arm", "", "", "", kReady);
  constexpr const char* kRow = "%-14s %-16s %-10s %-18s %-22s %s\n";
  scene::print_format(kRow, "name", "arm", "bus", "where", "node", "state");
  scene::print_format(kRow, "sim", "simulated arm", "-", "-", "-", kReady);
  const auto arms = scene::find_arms(root);
  if (!arms) {
    scene::print_format("%s\n", arms.error().message.c_str());
    print_json("devices", {{"arms", list}, {"trouble", arms.error().message}});
    return kExitDone;  // the simulated arm needs no USB
  }
  for (const driver::FoundArm& arm : *arms) {
    const std::string state = state_of(arm, root);
    scene::print_format(kRow, arm.name().c_str(), arm.arm.c_str(), arm.bus.c_str(),
                        arm.address.c_str(), arm.node.empty() ? "-" : arm.node.c_str(),
                        state.c_str());
    add(arm.name(), arm.arm, arm.bus, arm.address, arm.node, state);
  }
  if (arms->empty()) scene::print_format("No known arm is plugged in on USB.\n");
  print_json("devices", {{"arms", list}});
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
  add_json_option(*command);
  add_example(*command, "thimble devices");
  command->callback([root, &exit_code] { exit_code = list_devices(*root); });
}

}  // namespace thimble::cli
