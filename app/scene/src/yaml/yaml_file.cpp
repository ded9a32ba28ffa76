#include <yaml-cpp/eventhandler.h>

#include <exception>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

#include "log/logger.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {
namespace {

constexpr std::uintmax_t kFileSizeMax = 4u << 20;  // chosen: 1000 times our largest scene

/// Hears where documents begin, and nothing else.
class DocumentStarts final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override { line_ = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  int line() const { return line_; }

 private:
  int line_ = 0;
};

/// Tells in which line a second document begins; 0 if there is none. To load all would never end
/// where the parser stands still: before a comma outside of any list it finds one empty document
/// after the other. Throws what yaml-cpp throws.
int line_of_second_document(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStarts starts;
  for (int document = 0; document < 2; ++document) {
    if (!parser.HandleNextDocument(starts)) return 0;
  }
  return starts.line();
}

std::string in_file(const std::string& file, int line, const std::string& sentence) {
  const std::string place = line > 0 ? file + ":" + std::to_string(line) : file;
  return place + ": " + sentence + ".";
}

/// Warns the user, but not again of what this process has told him: studies read a scene often.
void tell_once(const std::string& warning) {
  static std::mutex mutex;
  static std::set<std::string> told;
  const std::lock_guard lock(mutex);
  if (told.insert(warning).second) logger().warn(warning);
}

}  // namespace

void YamlMistakes::add(int line, const std::string& sentence) {
  ++count_;
  if (sentences_.size() == kKept) return;
  sentences_.push_back(in_file(file_name_, line, sentence));
}

void YamlMistakes::warn(int line, const std::string& sentence) {
  warnings_.push_back(in_file(file_name_, line, sentence));
}

std::string YamlMistakes::text() const {
  std::string text;
  for (const std::string& sentence : sentences_) text += (text.empty() ? "" : "\n") + sentence;
  if (count_ > sentences_.size()) {
    text.append("\n").append(std::to_string(count_ - sentences_.size()));
    text.append(" more mistakes follow.");
  }
  return text;
}

driver::Result<YamlFile> YamlFile::load(const std::filesystem::path& file) {
  std::error_code status;
  const std::string name = file.filename().string();
  if (!std::filesystem::is_regular_file(file, status)) {
    return driver::Error{file.string() + ": there is no such file."};
  }
  if (!(std::filesystem::file_size(file, status) <= kFileSizeMax)) {
    return driver::Error{name + ": is larger than 4 MB, so it cannot be a scene or an arm."};
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  // Streaming an empty file sets failbit on `text`, not on `stream`.
  text << stream.rdbuf();
  if (!stream) {
    return driver::Error{file.string() + ": cannot be read; check its permissions."};
  }
  return parse(text.str(), name);
}

driver::Result<YamlFile> YamlFile::parse(const std::string& text, const std::string& name,
                                         KeyLog* keys) {
  auto mistakes = std::make_shared<YamlMistakes>(name, keys);
  try {
    const int second = line_of_second_document(text);
    const YAML::Node document = second > 0 ? YAML::Node() : YAML::Load(text);
    if (second > 0) {
      mistakes->add(second, "expected one document, found a second one");
    } else if (document.IsNull()) {
      mistakes->add(0, "is empty; expected a map of keys and values");
    } else {
      YamlMap root(document, "", 1, mistakes);
      if (mistakes->empty()) return YamlFile(std::move(root), mistakes);
    }
  } catch (const YAML::Exception& problem) {
    mistakes->add(problem.mark.is_null() ? 0 : problem.mark.line + 1,
                  "is not proper YAML (" + problem.msg + ")");
  } catch (const std::exception& problem) {
    mistakes->add(0, std::string("cannot be read (") + problem.what() + ")");
  }
  return driver::Error{mistakes->text()};
}

driver::Result<void> YamlFile::finish() const {
  for (const std::string& warning : mistakes_->warnings()) tell_once(warning);
  if (mistakes_->empty()) return {};
  return driver::Error{mistakes_->text()};
}

}  // namespace thimble::scene
