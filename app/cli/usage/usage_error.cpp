#include "cli/usage/usage_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>

#include "cli/options/old_names.h"
#include "text/nearest_word.h"

namespace thimble::cli {
namespace {

/// Returns the words that call a command: "thimble study friction".
std::string call_of(const CLI::App& command) {
  const CLI::App* above = command.get_parent();
  return (above != nullptr ? call_of(*above) + " " : "") + command.get_name();
}

/// Returns the innermost command on the command line.
const CLI::App& named_command(const CLI::App& program) {
  const CLI::App* command = &program;
  for (;;) {
    const auto named = command->get_subcommands();
    if (named.empty()) return *command;
    command = named.back();
  }
}

/// Returns the commands that a user may write after this one.
std::vector<std::string> commands_below(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    // Option groups have no name; commands without a group are internal.
    if (!below->get_name().empty() && !below->get_group().empty()) {
      names.push_back(below->get_name());
    }
  }
  return names;
}

/// Adds the names of the options of a command and of its option groups.
void add_option_names(const CLI::App& command, std::vector<std::string>& names) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group() == kOldNames) continue;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (below->get_name().empty()) add_option_names(*below, names);
  }
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* one = &command; one != nullptr; one = one->get_parent()) {
    add_option_names(*one, names);
  }
  return names;
}

std::string without_dashes(const std::string& option) {
  return option.substr(std::min(option.find_first_not_of('-'), option.size()));
}

/// Returns " Did you mean --duration?", or nothing. Dashes do not count: -z is no closer to -h than
/// any other letter, and -duration matches --duration.
std::string option_suggestion(const std::string& option, const std::vector<std::string>& known) {
  std::vector<std::string> names;
  for (const std::string& one : known) names.push_back(without_dashes(one));
  const auto near = scene::nearest_word(without_dashes(option), names);
  if (!near) return "";
  const auto place = std::find(names.begin(), names.end(), *near) - names.begin();
  return " Did you mean " + known[static_cast<std::size_t>(place)] + "?";
}

/// Adds the calls of all commands that have an option.
void add_calls_with(const CLI::App& command, const std::string& option,
                    std::vector<std::string>& calls) {
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    std::vector<std::string> names;
    add_option_names(*below, names);
    const bool has = std::find(names.begin(), names.end(), option) != names.end();
    if (has && !below->get_name().empty() && !below->get_group().empty()) {
      calls.push_back('`' + call_of(*below) + '`');
    }
    add_calls_with(*below, option, calls);
  }
}

std::string joined(const std::vector<std::string>& words, const char* last = " or ") {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? last : ", ") + words[i];
  }
  return text;
}

std::string see_help(const CLI::App& command) {
  return " See `" + call_of(command) + " --help`.";
}

std::vector<std::string> split(std::string_view text, std::string_view by) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t end = text.find(by);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + by.size());
  }
}

/// What an option accepts, as far as the library's type name shows.
struct Expectation {
  std::string words;                 ///< "a number from 0 to 1"; empty: any text.
  std::vector<std::string> choices;  ///< The accepted words, if it accepts words.
};

/// Parses the library's description of one check; empty for unknown checks.
Expectation expectation_of_check(std::string_view check, const std::string& number) {
  while (check.starts_with('(') && check.ends_with(')')) check = check.substr(1, check.size() - 2);
  const auto either = split(check, ") OR (");
  if (either.size() > 1) {
    std::vector<std::string> words;
    for (const std::string& one : either) {
      words.push_back(expectation_of_check(one, number).words);
    }
    return {.words = joined(words), .choices = {}};
  }
  if (check.starts_with('{') && check.ends_with('}')) {
    Expectation choice;
    choice.choices = split(check.substr(1, check.size() - 2), ",");
    choice.words = joined(choice.choices);
    return choice;
  }
  const std::size_t range = check.find(" in [");
  if (range != std::string_view::npos && check.ends_with(']')) {
    const auto bounds = split(check.substr(range + 5, check.size() - range - 6), " - ");
    if (bounds.size() == 2) {
      return {.words = number + " from " + bounds[0] + " to " + bounds[1], .choices = {}};
    }
  }
  if (check == "POSITIVE") return {.words = number + " above 0", .choices = {}};
  if (check == "NONNEGATIVE") return {.words = number + " of 0 or more", .choices = {}};
  return {};
}

/// Returns whether a text is a whole number, of any size, without a sign.
bool is_whole(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Returns what an option accepts, for the message about a rejected `value`.
Expectation expectation_of(const CLI::Option& option, std::string_view value = {}) {
  const auto parts = split(option.get_type_name(), ":");
  std::string number;
  if (parts.front() == "INT" || parts.front() == "UINT") number = "a whole number";
  if (parts.front() == "FLOAT") number = "a number";
  for (std::size_t i = 1; i < parts.size(); ++i) {
    auto found = expectation_of_check(parts[i], number.empty() ? "a number" : number);
    if (!found.words.empty()) return found;
  }
  if (parts.front() == "UINT") {
    // A whole number that was rejected is too large.
    number += is_whole(value)
                  ? fmt::format(" from 0 to {}", std::numeric_limits<std::uint64_t>::max())
                  : " of 0 or more";
  }
  return {.words = number, .choices = {}};
}

/// Returns an option by the library's name of it, from a command or one above.
const CLI::Option* find_option(const CLI::App& command, const std::string& name) {
  for (const CLI::App* one = &command; one != nullptr; one = one->get_parent()) {
    if (const CLI::Option* option = one->get_option_no_throw(name)) return option;
  }
  return nullptr;
}

/// Returns the value of an option that a message of the library names.
std::string value_in(const CLI::Option& option, std::string_view message) {
  const auto& given = option.results();
  for (const std::string& value : given) {
    if (!value.empty() && message.find(value) != std::string_view::npos) return value;
  }
  return given.empty() ? std::string() : given.front();
}

std::string expected_for(const CLI::Option& option, const std::string& value) {
  const Expectation expected = expectation_of(option, value);
  return fmt::format("{}: expected {}, found \"{}\".{}", option.get_name(),
                     expected.words.empty() ? "another value" : expected.words, value,
                     suggestion(value, expected.choices));
}

/// Returns the sentence for a value that a check of an option rejected with `message`.
std::string refused_value(const CLI::Option* option, const std::string& name,
                          const std::string& message) {
  const auto full = [&name](std::string sentence) {
    if (!sentence.ends_with('.') && !sentence.ends_with('?')) sentence += '.';
    return name + ": " + sentence;
  };
  if (option == nullptr) return full(message);
  const std::string value = value_in(*option, message);
  if (message.starts_with("File does not exist") || message.starts_with("Directory does not")) {
    return full("there is no " + std::string(message[0] == 'F' ? "file " : "folder ") + value);
  }
  if (message.starts_with("File is actually") || message.starts_with("Directory is actually")) {
    return full(value + (message[0] == 'F' ? " is a folder, expected a file"
                                           : " is a file, expected a folder"));
  }
  // Our checks return a sentence; the library's return a description.
  const bool ours = message.find("expected ") != std::string::npos ||
                    message.find("there is no ") != std::string::npos;
  if (ours || expectation_of(*option).words.empty()) return full(message);
  return expected_for(*option, value);
}

/// Returns the sentence for a missing argument.
std::string missing(const CLI::App& command, const CLI::Option* option, const std::string& name) {
  std::string text = name + " is missing.";
  if (option != nullptr && option->get_positional() && name == "SCENE") {
    text += " `thimble run --list` lists the scenes.";
  }
  return text + see_help(command);
}

/// Returns the sentence for a command without its required sub-command or arguments.
std::string incomplete(const CLI::App& command) {
  const auto known = commands_below(command);
  return fmt::format("`{}` requires a command: {}.{}", call_of(command), joined(known),
                     see_help(command));
}

/// Returns the name before a text in a message of the library.
std::string before(const std::string& message, std::string_view text) {
  const std::size_t end = message.find(text);
  return end == std::string::npos ? std::string() : message.substr(0, end);
}

/// Returns whether the whole text is a decimal number of the type.
template <class Number>
bool is_decimal(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number number{};
  const char* const last = text.data() + text.size();
  const auto [end, status] = std::from_chars(text.data(), last, number);
  return status == std::errc() && end == last && std::isfinite(static_cast<double>(number));
}

/// Returns whether a text is valid for an option of a type: a finite number, or an integer within
/// range.
bool is_number_of(std::string_view type, std::string_view text) {
  if (type == "UINT") return is_decimal<std::uint64_t>(text);
  return type == "INT" ? is_decimal<std::int64_t>(text) : is_decimal<double>(text);
}

}  // namespace

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const auto near = scene::nearest_word(word, known);
  return near ? " Did you mean " + *near + "?" : "";
}

std::vector<std::string> without_separator(const CLI::App& program,
                                           std::vector<std::string> words) {
  const auto commands = program.get_subcommands([&words](const CLI::App* command) {
    return !words.empty() && command->get_name() == words.front() && command->get_prefix_command();
  });
  if (commands.empty()) return words;
  const CLI::App* const command = commands.front();
  for (std::size_t i = 1; i < words.size() && words[i].starts_with('-'); ++i) {
    if (words[i] == "--") {
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    const CLI::Option* const option = command->get_option_no_throw(words[i]);
    if (option != nullptr && option->get_items_expected_min() > 0) ++i;  // its value
  }
  return words;
}

std::string unknown_word(const CLI::App& command, const std::string& word) {
  const std::string call = call_of(command);
  if (word.starts_with('-') && word.size() > 1) {
    const std::string name = word.substr(0, word.find('='));
    std::vector<std::string> calls;
    add_calls_with(command, name, calls);
    if (!calls.empty()) {
      return fmt::format("{} is an option of {}, not of `{}`. Write it after the command.{}", name,
                         joined(calls, " and "), call, see_help(command));
    }
    return fmt::format("{} is not an option of `{}`.{}{}", name, call,
                       option_suggestion(name, options_of(command)), see_help(command));
  }
  const auto known = commands_below(command);
  const auto options = command.get_options();
  const bool takes_arguments =
      std::any_of(options.begin(), options.end(),
                  [](const CLI::Option* option) { return option->get_positional(); });
  if (!known.empty() && !takes_arguments) {
    return fmt::format("{} is not a command of `{}`.{} Commands: {}.{}", word, call,
                       suggestion(word, known), joined(known, " and "), see_help(command));
  }
  return fmt::format("\"{}\" is an unexpected argument of `{}`.{}{}", word, call,
                     suggestion(word, options_of(command)), see_help(command));
}

std::string usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& command = named_command(program);
  const std::string message = error.what();
  if (!command.get_prefix_command()) {  // a prefix command passes its words to another program
    for (const std::string& word : program.remaining(true)) {
      if (word != "--") return unknown_word(command, word);
    }
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::size_t word = message.rfind(": ");
    if (word != std::string::npos) return unknown_word(command, message.substr(word + 2));
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    if (message == "A subcommand is required") return incomplete(command);
    const std::string name = before(message, " is required");
    if (const std::size_t list = message.find('['); list != std::string::npos) {
      auto names = split(message.substr(list + 1, message.rfind(']') - list - 1), ",");
      std::erase(names, "");  // options that only show help
      return fmt::format("`{}` requires {}.{}", call_of(command), joined(names), see_help(command));
    }
    return missing(command, find_option(command, name), name);
  }
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr) {
    const std::string name = before(message, " requires ");
    return fmt::format("{} requires {}. Add it.{}", name, message.substr(name.size() + 10),
                       see_help(command));
  }
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr) {
    const std::string name = before(message, " excludes ");
    return fmt::format("{} cannot be used with {}. Remove one of them.{}", name,
                       message.substr(name.size() + 10), see_help(command));
  }
  if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr) {
    const std::string name = before(message, ": ");
    return refused_value(find_option(command, name), name,
                         name.empty() ? message : message.substr(name.size() + 2));
  }
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    std::string name = before(message, " = ");
    name = name.starts_with("Could not convert: ") ? name.substr(19) : before(message, ": ");
    if (const CLI::Option* option = find_option(command, name)) {
      return expected_for(*option, value_in(*option, message));
    }
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    std::string name = before(message, ": ");
    if (name.empty()) {  // Expected exactly 3 arguments to --direction, got 2
      const std::size_t to = message.find(" to ");
      name = to == std::string::npos ? name : before(message.substr(to + 4), ", got");
    }
    if (const CLI::Option* option = find_option(command, name)) {
      const Expectation expected = expectation_of(*option);
      const int count = option->get_items_expected_min();
      if (count == 1 && option->results().size() > 1) {
        return fmt::format("{}: expected once, found {} times.{}", name, option->results().size(),
                           see_help(command));
      }
      return fmt::format(
          "{}: {}.{}", name,
          count > 1 || !option->results().empty()
              ? fmt::format("expected {} values, found {}", count, option->results().size())
              : "the value is missing" +
                    (expected.words.empty() ? std::string() : "; expected " + expected.words),
          see_help(command));
    }
  }
  return message + (message.ends_with('.') ? "" : ".") + see_help(command);
}

void check_numbers(CLI::App& program) {
  for (CLI::Option* option : program.get_options([](CLI::Option*) { return true; })) {
    const std::string type = split(option->get_type_name(), ":").front();
    if (type != "INT" && type != "UINT" && type != "FLOAT") continue;
    if (option->get_items_expected_max() == 0) continue;  // a flag that counts
    option->check(CLI::Validator(
        [option, type](const std::string& text) {
          if (is_number_of(type, text)) return std::string();
          const auto words = expectation_of(*option, text).words;
          return fmt::format("expected {}, found \"{}\"", words, text);
        },
        ""));
  }
  for (CLI::App* below : program.get_subcommands([](CLI::App*) { return true; })) {
    check_numbers(*below);
  }
}

void check_texts(CLI::App& program) {
  for (CLI::Option* option : program.get_options([](CLI::Option*) { return true; })) {
    if (!option->get_type_name().starts_with("TEXT") || option->get_positional()) continue;
    if (option->get_items_expected_max() == 0) continue;  // a flag
    option->check(CLI::Validator(
        [](const std::string& text) {
          return text.empty() ? std::string("the value is empty. Add a value, or remove the option")
                              : std::string();
        },
        ""));
  }
  for (CLI::App* below : program.get_subcommands([](CLI::App*) { return true; })) {
    check_texts(*below);
  }
}

}  // namespace thimble::cli
