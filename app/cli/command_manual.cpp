#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "thimble/scene/build_info.h"

namespace thimble::cli {
namespace {

/// Escapes text for roff: dashes remain dashes, no line begins as a request, and lists without
/// blanks can be broken after commas.
std::string roff(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c != ' ' && !safe.empty() && safe.back() == ',') safe += "\\:";
    if (c == '-' || c == '\\') safe += '\\';
    if ((c == '.' || c == '\'') && (safe.empty() || safe.back() == '\n')) safe += "\\&";
    safe += c;
  }
  return safe;
}

void print_option(const CLI::Option& option, bool is_positional) {
  const std::string name = is_positional ? option.get_name(true) : option.get_name(false, true);
  scene::print_format(".TP\n\\fB%s\\fR", roff(name).c_str());
  if (const std::string value = value_text(option); !value.empty() && !is_positional) {
    scene::print_format(" \\fI%s\\fR", roff(value).c_str());
  }
  std::string about = option.get_description();
  if (const std::string limits = limits_text(option); !limits.empty()) about += " " + limits;
  scene::print_format("\n%s\n", roff(about).c_str());
}

/// Prints the arguments of a command, then its options by topic.
void print_options(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_group().empty() && option->get_positional()) print_option(*option, true);
  }
  const std::vector<HelpTopic> topics = help_topics(command);
  for (const HelpTopic& topic : topics) {
    if (topics.size() > 1) scene::print_format(".PP\n\\fI%s:\\fR\n", roff(topic.title).c_str());
    for (const CLI::Option* option : topic.options) print_option(*option, false);
  }
}

/// Returns the example and the notes of a command: its footer without that of the program.
std::string notes_of(const CLI::App& command) {
  const CLI::App* program = &command;
  while (program->get_parent() != nullptr) program = program->get_parent();
  std::string notes = command.get_footer();
  const std::string inherited = program->get_footer();
  if (notes.ends_with(inherited)) notes.resize(notes.size() - inherited.size());
  while (notes.ends_with('\n')) notes.pop_back();
  return notes;
}

void print_commands(const CLI::App& above, const std::string& prefix) {
  for (const CLI::App* command : above.get_subcommands([](const CLI::App*) { return true; })) {
    // Internal commands have no group, option groups no name.
    if (command->get_group().empty() || command->get_name().empty()) continue;
    const std::string name = prefix + command->get_name();
    scene::print_format(".SS %s\n%s\n", roff(name).c_str(),
                        roff(command->get_description()).c_str());
    if (command->get_help_ptr() == nullptr) {  // command of another program with the options
      scene::print_format("%s\n", roff(command->get_footer()).c_str());
      continue;
    }
    print_options(*command);
    if (const std::string notes = notes_of(*command); !notes.empty()) {
      scene::print_format(".PP\n.nf\n%s\n.fi\n", roff(notes).c_str());
    }
    print_commands(*command, name + " ");
  }
}

/// Prints the example of each command, with what the command does.
void print_examples(const CLI::App& above) {
  constexpr std::string_view kBegin = "Example: ";
  for (const CLI::App* command : above.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_group().empty() || command->get_name().empty()) continue;
    const std::string footer = command->get_footer();
    if (footer.starts_with(kBegin)) {
      const std::string example = footer.substr(kBegin.size(), footer.find('\n') - kBegin.size());
      scene::print_format(".TP\n.B %s\n%s\n", roff(example).c_str(),
                          roff(command->get_description()).c_str());
    }
    print_examples(*command);
  }
}

/// Prints the manual page of a program, with the text of `--help`.
void print_manual(const CLI::App& program, const std::string& name, const std::string& about) {
  std::string heading = name;
  std::transform(heading.begin(), heading.end(), heading.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  scene::print_format(".TH %s 1 \"\" \"thimble %s\" \"User Commands\"\n", roff(heading).c_str(),
                      std::string(scene::build_info().version).c_str());
  scene::print_format(".SH NAME\n%s \\- %s\n", roff(name).c_str(), roff(about).c_str());
  scene::print_format(".SH SYNOPSIS\n.B thimble\n.I COMMAND\n.RI [ OPTIONS ]\n");
  scene::print_format(".SH DESCRIPTION\n%s\n", roff(program.get_description()).c_str());
  scene::print_format(
      "The installed scenes and arms are in the folder share/thimble, next to the\n");
  scene::print_format(
      "folder of the program.\n.SH OPTIONS\nThe program and all commands have these options:\n");
  print_options(program);
  scene::print_format(".SH COMMANDS\n");
  print_commands(program, "");
  scene::print_format(".SH EXAMPLES\n");
  print_examples(program);
  scene::print_format(".SH NOTES\n.nf\n%s\n.fi\n", roff(program.get_footer()).c_str());
}

}  // namespace

void add_manual_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about) {
  CLI::App* command = app.add_subcommand("manual", "Print the manual page (roff)");
  command->group("");  // for the installation; hidden
  command->callback([&app, &exit_code, name, about] {
    print_manual(app, name, about);
    exit_code = kExitDone;
  });
}

}  // namespace thimble::cli
