#include <fmt/format.h>
#include <yaml-cpp/exceptions.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <mutex>
#include <set>
#include <utility>

#include "log/logger.h"
#include "system/regular_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {
namespace {

constexpr std::uintmax_t kFileSizeMax = 16u << 20;  // [chosen: 150,000 objects of a line each]

/// Warns the user once per process of each warning, because studies read a scene often.
void warn_once(const std::string& warning) {
  static std::mutex mutex;
  static std::set<std::string> warned;
  const std::lock_guard lock(mutex);
  if (warned.insert(warning).second) logger().warn(warning);
}

}  // namespace

std::string YamlMistakes::place_of(int line) const {
  if (!places_.empty()) {
    const auto at = static_cast<std::size_t>(std::max(line, 0));
    return places_[at < places_.size() ? at : 0];
  }
  return line > 0 ? file_name_ + ":" + std::to_string(line) : file_name_;
}

std::string YamlMistakes::in_place(int line, const std::string& sentence) const {
  return place_of(line) + ": " + sentence + ".";
}

void YamlMistakes::add_to(Kind& kind, int line, const std::string& sentence) {
  ++kind.count;
  if (kind.sentences.size() < kKept) kind.sentences.push_back(in_place(line, sentence));
}

void YamlMistakes::add_flaw(const TextFlaw& flaw) {
  const std::string sentence =
      fmt::format("{}:{}:{}: {}.", file_name_, flaw.line, flaw.column, flaw.what);
  flaws_explain_all_ = flaws_explain_all_ || flaw.indents;
  const auto& known = flaws_.sentences;
  if (std::find(known.begin(), known.end(), sentence) != known.end()) return;
  ++flaws_.count;
  if (known.size() < kKept) flaws_.sentences.push_back(sentence);
}

void YamlMistakes::add(int line, const std::string& sentence) {
  const auto flaw = std::find_if(misplaced_.begin(), misplaced_.end(),
                                 [line](const TextFlaw& one) { return one.line == line; });
  if (flaw == misplaced_.end()) {
    add_to(values_, line, sentence);
  } else {
    add_flaw(*flaw);
  }
}

void YamlMistakes::add_syntax_error(int line, const std::string& sentence) {
  for (const TextFlaw& flaw : misplaced_) {
    if (line > 0 && flaw.line > line) break;
    add_flaw(flaw);
    flaws_explain_all_ = true;
  }
  if (!flaws_explain_all_) add_to(values_, line, sentence);
}

void YamlMistakes::add_check(int line, const std::string& sentence) {
  add_to(checks_, line, sentence);
}

void YamlMistakes::warn(int line, const std::string& sentence) {
  warnings_.push_back(in_place(line, sentence));
}

void YamlMistakes::note_file(const std::filesystem::path& file) {
  if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(file);
}

std::string YamlMistakes::text() const {
  std::string text;
  std::size_t kept = 0, count = 0;
  const auto append = [&](const Kind& kind) {
    for (const std::string& sentence : kind.sentences) {
      if (kept == kKept) break;
      text += (text.empty() ? "" : "\n") + sentence;
      ++kept;
    }
    count += kind.count;
  };
  append(flaws_);
  if (!flaws_explain_all_) append(values_);
  if (count == 0 && !checks_ignored_) append(checks_);
  if (count > kept) {
    text += fmt::format("\n{} more mistake{}.", count - kept,
                        count - kept == 1 ? " follows" : "s follow");
  }
  return text;
}

driver::Result<YamlFile> YamlFile::load(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  const auto text = driver::read_file(file, kFileSizeMax);
  if (!text) {
    std::error_code status;
    if (driver::is_regular(file) && std::filesystem::file_size(file, status) > kFileSizeMax) {
      return driver::Error{name +
                           ": is larger than 16 MB, so it cannot be a scene or an arm file."};
    }
    return driver::Error{file.string() + ": " + text.error().message};
  }
  return parse(*text, name);
}

driver::Result<YamlFile> YamlFile::parse(const std::string& text, const std::string& name,
                                         KeyLog* keys, std::vector<std::string> places) {
  auto mistakes = std::make_shared<YamlMistakes>(name, keys);
  const bool from_program = !places.empty();
  mistakes->set_places(std::move(places));
  if (const auto flaw = find_invalid_utf8(text)) {
    if (from_program) {
      mistakes->add(flaw->line, "a text is not UTF-8; encode it as UTF-8");
      return driver::Error{mistakes->text()};
    }
    return driver::Error{fmt::format("{}:{}:{}: {}.", name, flaw->line, flaw->column, flaw->what)};
  }
  mistakes->set_misplaced(find_misplaced_blanks(text));
  try {
    const YamlDocument document = read_yaml(text);
    if (document.second_begins_at > 0) {
      mistakes->add(document.second_begins_at,
                    "expected one document, found a second one; remove it");
    } else if (document.root.is_null()) {
      mistakes->add(1, "is empty; expected a map of keys and values");
    } else {
      YamlMap root(document.root, "", 1, mistakes);
      if (mistakes->empty()) return YamlFile(std::move(root), mistakes);
    }
  } catch (const YAML::Exception& problem) {
    mistakes->add_syntax_error(problem.mark.is_null() ? 0 : problem.mark.line + 1,
                               "is not valid YAML (" + problem.msg + ")");
  } catch (const std::exception& problem) {
    mistakes->add(0, std::string("cannot be read (") + problem.what() + ")");
  }
  return driver::Error{mistakes->text()};
}

driver::Result<void> YamlFile::finish() const {
  for (const std::string& warning : mistakes_->warnings()) warn_once(warning);
  if (mistakes_->empty()) return {};
  return driver::Error{mistakes_->text()};
}

}  // namespace thimble::scene
