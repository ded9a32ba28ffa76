#include "cli/usage/help_text.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include "cli/options/old_names.h"

namespace thimble::cli {
namespace {

constexpr std::size_t kLineMax = 79;         // characters of a line
constexpr std::size_t kAboutColumn = 24;     // where descriptions of options begin
constexpr std::size_t kCommandColumn = 14;   // where descriptions of commands begin
constexpr const char* kGeneral = "Options";  // the library's topic of options without one

std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// Breaks the lines of a text that begins in `column` at blanks.
std::string broken_at_blanks(const std::string& text, std::size_t column) {
  const std::string indent(column, ' ');
  std::string lines;
  for (const std::string& line : parts_of(text, '\n')) {
    if (!lines.empty()) lines += '\n' + indent;
    std::size_t width = column;
    bool first = true;
    for (const std::string& word : parts_of(line, ' ')) {
      if (!first && width + 1 + word.size() > kLineMax) {
        lines += '\n' + indent;
        width = column;
      } else if (!first) {
        lines += ' ';
        ++width;
      }
      lines += word;
      width += word.size();
      first = false;
    }
  }
  return lines;
}

/// Breaks the name of an option with its choices after commas.
std::string broken_at_commas(const std::string& name) {
  std::string lines;
  std::size_t width = 2;
  for (std::size_t begin = 0; begin < name.size();) {
    const std::size_t comma = name.find(',', begin);
    const std::size_t end = comma == std::string::npos ? name.size() : comma + 1;
    if (width + end - begin > kLineMax) {
      lines += "\n      ";
      width = 6;
    }
    lines.append(name, begin, end - begin);
    width += end - begin;
    begin = end;
  }
  return lines;
}

/// Returns the limits "a to b" in the library's type of an option; empty if it has none.
std::string range_in(const std::string& type) {
  const std::size_t begin = type.find(" in [");
  const std::size_t end = begin == std::string::npos ? begin : type.find(']', begin);
  if (end == std::string::npos) return {};
  std::string range = type.substr(begin + 5, end - begin - 5);
  if (const std::size_t dash = range.find(" - "); dash != std::string::npos) {
    range.replace(dash, 3, " to ");
  }
  return range;
}

bool is_choice(const std::string& check) {
  return check.size() > 2 && check.front() == '{' && check.back() == '}';
}

}  // namespace

std::vector<HelpTopic> help_topics(const CLI::App& command) {
  std::vector<HelpTopic> topics;
  const auto is_option = [](const CLI::Option* option) { return option->nonpositional(); };
  for (const std::string& group : command.get_groups()) {
    if (group.empty() || group == kOldNames) continue;  // hidden options
    HelpTopic topic{group, command.get_options([&](const CLI::Option* option) {
                      return option->get_group() == group && is_option(option);
                    })};
    if (!topic.options.empty()) topics.push_back(std::move(topic));
  }
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (!below->get_name().empty() || below->get_group().empty()) continue;
    const bool required = below->get_require_option_min() > 0;
    const auto is_own_option = [&](const CLI::Option* option) {
      return is_option(option) && option != below->get_help_ptr();  // -h is in the general topic
    };
    topics.push_back({below->get_group() + (required ? " (at least one)" : ""),
                      below->get_options(is_own_option)});
  }
  const auto general = std::find_if(topics.begin(), topics.end(),
                                    [](const HelpTopic& topic) { return topic.title == kGeneral; });
  if (general != topics.end() && topics.size() > 1) {
    general->title = "General";
    std::rotate(general, general + 1, topics.end());
  }
  return topics;
}

std::string value_text(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};  // a flag
  if (!option.get_option_text().empty()) return option.get_option_text();
  const auto parts = parts_of(option.get_type_name(), ':');
  for (const std::string& check : parts) {
    if (is_choice(check)) return check;
  }
  if (parts.front() == "INT" || parts.front() == "UINT" || parts.front() == "FLOAT") return "N";
  for (const std::string& check : parts) {
    if (check == "FILE or NAME") return "NAME|FILE";
    if (check == "FILE" || check == "DIR" || check == "SECONDS") return check;
  }
  return parts.front();
}

std::string limits_text(const CLI::Option& option) {
  std::vector<std::string> limits;
  if (option.get_required() && option.nonpositional()) limits.emplace_back("required");
  const std::string range = range_in(option.get_type_name());
  if (!range.empty()) limits.push_back(range);
  std::string value = option.get_default_str();
  if (value.size() > 1 && value.front() == '[' && value.back() == ']') {
    value = value.substr(1, value.size() - 2);
  }
  if (!value.empty() && option.get_items_expected_max() > 0) limits.push_back("default " + value);
  std::string text;
  for (const std::string& limit : limits) text += (text.empty() ? "(" : ", ") + limit;
  return text.empty() ? text : text + ")";
}

void add_example(CLI::App& command, const std::string& example, const std::string& notes) {
  std::string footer = "Example: " + example + "\n\n";
  if (!notes.empty()) footer += notes + "\n\n";
  command.footer(footer + command.get_footer());
}

HelpFormatter::HelpFormatter() {
  label("Positionals", "Arguments");
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  std::string text =
      make_description(app) + make_usage(app, std::move(name)) + make_positionals(app);
  for (const HelpTopic& topic : help_topics(*app)) {
    text += make_group(topic.title, false, topic.options);
  }
  return text + make_subcommands(app, mode) + '\n' + make_footer(app);
}

std::string HelpFormatter::make_expanded(const CLI::App* sub) const {
  // help_topics contains the options of option groups, which have no name.
  return sub->get_name().empty() ? std::string() : CLI::Formatter::make_expanded(sub);
}

std::string HelpFormatter::make_subcommand(const CLI::App* sub) const {
  std::string line = "  " + sub->get_name();
  line.resize(std::max(line.size() + 1, kCommandColumn), ' ');
  return line + broken_at_blanks(sub->get_description(), kCommandColumn) + '\n';
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  std::string name = is_positional ? option->get_name(true) : option->get_name(false, true);
  constexpr std::string_view kNegated = "{false}";
  if (const std::size_t mark = name.find(kNegated); mark != std::string::npos) {
    name.erase(mark, kNegated.size());
  }
  const std::string value = value_text(*option);
  if (!value.empty() && (!is_positional || is_choice(value))) name += ' ' + value;
  std::string line = "  " + broken_at_commas(name);
  std::string about = option->get_description();
  const std::string limits = limits_text(*option);
  if (!limits.empty()) about += (about.empty() ? "" : " ") + limits;
  if (about.empty()) return line + '\n';
  if (line.size() + 2 > kAboutColumn) {
    line += '\n' + std::string(kAboutColumn, ' ');
  } else {
    line.resize(kAboutColumn, ' ');
  }
  return line + broken_at_blanks(about, kAboutColumn) + '\n';
}

}  // namespace thimble::cli
