#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace thimble::cli {

/// Options of a command that belong to one topic of its help.
struct HelpTopic {
  std::string title;
  std::vector<const CLI::Option*> options;
};

/// Returns the options of a command by topic, without arguments and hidden options. The general
/// options (`--help`, `--version`) come last.
std::vector<HelpTopic> help_topics(const CLI::App& command);

/// Returns the value of an option for its help: "N", "FILE" or "{on,off}"; empty for a flag.
std::string value_text(const CLI::Option& option);

/// Returns limits and default of an option for its help: "(0.1 to 4, default 1)"; may be empty.
std::string limits_text(const CLI::Option& option);

/// Adds an example, and optional notes, to the end of the help of a command.
void add_example(CLI::App& command, const std::string& example, const std::string& notes = {});

/// Formats the help of a program and of its commands: options by topic, in lines below 80
/// characters.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_expanded(const CLI::App* sub) const override;
  std::string make_subcommand(const CLI::App* sub) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
};

}  // namespace thimble::cli
