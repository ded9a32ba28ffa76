#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "arm/wire_bytes.h"
#include "arm/wire_section.h"
#include "bringup/wire_picture.h"
#include "cli/commands.h"
#include "cli/options/json_option.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "cli/wire/wire_port.h"
#include "cli/wire/wire_serve.h"
#include "log/printed_text.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::cli {
namespace {

using driver::WireTable;

struct CheckOptions {
  std::string file, capture, device;
};

/// Prints text that may contain percent signs.
void print(const std::string& text) {
  scene::print_format("%s", text.c_str());
}

std::string board_in_words(const WireTable& wire) {
  const driver::WireDescription& text = wire.text;
  constexpr std::array<const char*, 3> kTransports{"USB HID", "serial port", "USB bulk"};
  std::string words = kTransports[static_cast<std::size_t>(text.transport)];
  words += text.streams ? ", sends reports by itself" : ", answers each command";
  words += text.watchdog > 0 ? fmt::format(", motors off after {:g} s of silence", text.watchdog)
                             : ", no watchdog";
  return words +
         fmt::format("\nUSB {:04x}:{:04x}{}\n", text.identity.vendor_id, text.identity.product_id,
                     text.identity.product.empty() ? std::string()
                                                   : ", product \"" + text.identity.product + '"');
}

/// Lists what a description lacks.
std::string weaknesses_of(const WireTable& wire) {
  std::string list;
  const bool checked = wire.report.check_bytes > 0;
  if (!checked) list += "note: reports have no check value, so damaged ones may move the tip\n";
  if (wire.command.check_bytes == 0) {
    list += "note: commands have no check value, so damaged ones may turn the motors\n";
  }
  if (!wire.numbered && !wire.timed) {
    list += "note: reports have neither number nor time, so a repeated one is not detected\n";
  }
  if (wire.text.watchdog == 0) {
    list += "note: without a watchdog, the arm is limited to 0.5 N\n";
  }
  return list;
}

/// Damages valid reports at random and counts those that are still accepted.
nlohmann::ordered_json fuzz(const WireTable& wire) {
  constexpr int kRounds = 100'000;
  std::mt19937_64 random(53);
  int accepted = 0, moved = 0;
  for (int i = 0; i < kRounds; ++i) {
    driver::WireValues values;
    for (auto& count : values.encoders)
      count = static_cast<std::int32_t>(random() % 20'000) - 10'000;
    values.sequence = static_cast<std::int64_t>(random() % 256);
    std::array<std::byte, driver::kReportCapacity> bytes{};
    const std::size_t size = wire.report.write(values, bytes);
    driver::WireValues sent, got;
    if (!wire.report.read(std::span(bytes).first(size), sent)) continue;
    bytes[random() % size] ^= static_cast<std::byte>(1U << (random() % 8));
    if (!wire.report.read(std::span(bytes).first(size), got)) continue;
    ++accepted;
    if (got.encoders != sent.encoders) ++moved;
  }
  scene::print_format(
      "fuzzed: %d of %d reports with one wrong bit are accepted, %d of them with "
      "another position\n",
      accepted, kRounds, moved);
  return {{"damaged", kRounds}, {"accepted", accepted}, {"moved", moved}};
}

/// Measures the decoding of a report; returns its time, ns.
double time_decoding(const WireTable& wire) {
  using Clock = std::chrono::steady_clock;
  driver::WireValues values;
  values.encoders = {12345, -2345, 345};
  std::array<std::byte, driver::kReportCapacity> bytes{};
  const std::size_t size = wire.report.write(values, bytes);
  constexpr int kRounds = 100'000;
  std::int64_t sum = 0;
  const auto begin = Clock::now();
  for (int i = 0; i < kRounds; ++i) {
    driver::ArmReading reading;
    sum += wire.decode(std::span(bytes).first(size), reading) ? reading.counts[0] : 0;
  }
  const std::chrono::duration<double, std::nano> time = Clock::now() - begin;
  scene::print_format("decoding: %.0f ns per report%s\n", time.count() / kRounds,
                      sum == 0 ? " (never valid)" : "");
  return time.count() / kRounds;
}

/// Decodes captured bytes, as one message.
int decode(const WireTable& wire, const std::string& capture) {
  const auto parsed = scene::parse_wire_bytes(capture, false);
  if (!parsed) return report_error({"--capture: " + parsed.error().message}, kExitBadInput);
  const std::vector<std::byte>& bytes = parsed->bytes;
  driver::WireValues values;
  const driver::WireVerdict report = wire.report.read(bytes, values);
  const driver::WireVerdict command = wire.command.read(bytes, values);
  const bool is_command = command && !report;
  const driver::WireVerdict& verdict = is_command ? command : report;
  const char* const what = is_command ? "command" : "report";
  if (verdict || verdict.flaw == driver::WireFlaw::kErrors) {
    print(fmt::format("captured: a {} of {} bytes, {}\n", what, bytes.size(),
                      driver::describe(verdict.flaw)));
    print(is_command ? bringup::values_of(wire.command, wire.text.command, bytes)
                     : bringup::values_of(wire.report, wire.text.report, bytes));
    return kExitDone;
  }
  std::string place = fmt::format("byte {}", verdict.byte);
  if (verdict.flaw == driver::WireFlaw::kConstant || verdict.flaw == driver::WireFlaw::kDigit) {
    place += ", field " + wire.text.report.fields[verdict.field].name;
  }
  return report_error({fmt::format("--capture: {} bytes are no report: {} at {}. Compare them "
                                   "with the picture above.",
                                   bytes.size(), driver::describe(verdict.flaw), place)},
                      kExitUnmet);
}

int check(const CheckOptions& options) {
  const auto path = scene::find_arm_file(options.file);
  if (!path) return report_error(path.error(), kExitBadInput);
  const auto wire = scene::load_wire(*path);
  if (!wire) return report_error(wire.error(), kExitBadInput);
  print(board_in_words(**wire));
  print('\n' + bringup::picture_of((*wire)->report, "report"));
  print('\n' + bringup::picture_of((*wire)->command, "command") + '\n');
  print(weaknesses_of(**wire));
  nlohmann::ordered_json result{{"file", path->string()}};
  result["fuzz"] = fuzz(**wire);
  result["decoding_ns"] = time_decoding(**wire);
  if (!options.capture.empty()) {
    if (const int code = decode(**wire, options.capture); code != kExitDone) return code;
  }
  int code = kExitDone;
  if (!options.device.empty()) code = time_port(options.file, **wire, options.device, result);
  if (code == kExitDone || code == kExitUnmet) print_json("wire", result);
  return code;
}

}  // namespace

void add_wire_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("wire", "Check the described wire of an arm file");
  command->require_subcommand(1);
  CLI::App* checks =
      command->add_subcommand("check", "Draw and test the messages of a described wire");
  auto options = std::make_shared<CheckOptions>();
  checks->add_option("FILE", options->file, "Arm file with a section `wire`, or its name")
      ->required();
  checks
      ->add_option("--capture", options->capture,
                   "Decode bytes: two hexadecimal digits each, or 'text'")
      ->option_text("BYTES");
  checks->add_option("--device", options->device, "Measure the latency of a board, by NAME or port")
      ->option_text("PORT");
  add_json_option(*checks);
  add_example(*checks, "thimble wire check my_arm --capture \"aa 55 00 01\"");
  add_example(*checks, "thimble wire check my_arm --device /dev/ttyACM0");
  checks->callback([options, &exit_code] { exit_code = check(*options); });
  add_wire_serve_command(*command, exit_code);
  add_example(*command, "thimble wire check my_arm.yaml");
}

}  // namespace thimble::cli
