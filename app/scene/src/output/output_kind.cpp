#include "output/output_kind.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace thimble::output {
namespace {

using std::filesystem::path;

/// Reads the beginning of a file.
std::string beginning(const path& file, std::size_t size) {
  std::string text(size, '\0');
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return {};
  const ssize_t got = ::pread(descriptor, text.data(), size, 0);
  ::close(descriptor);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return text;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Returns the beginning of a text, without a byte order mark and leading space.
std::string first_text(const path& file, std::size_t size = 4096) {
  std::string text = beginning(file, size);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  text.erase(0, text.find_first_not_of(" \t\r\n"));
  return text;
}

bool is_text(std::string_view text) {
  return text.find('\0') == std::string_view::npos;
}

bool begins(const path& file, std::string_view with) {
  return beginning(file, with.size()) == with;
}

bool is_table(const path& file) {
  std::string text = beginning(file, 4096);
  while (text.starts_with('#') && text.find('\n') != std::string::npos) {
    text.erase(0, text.find('\n') + 1);
  }
  const std::string line = text.substr(0, text.find('\n'));
  if (line.empty() || !is_text(line)) return false;
  if (line.find_first_not_of("0123456789+-.eE ,;\t") == std::string::npos) return true;  // numbers
  // The first line of a YAML file may hold a comma as well.
  const bool other = line.find(": ") != std::string::npos || line.ends_with(':') ||
                     std::string_view("#%{[<\"'").find(line.front()) != std::string_view::npos;
  return !other && line.find(',') != std::string::npos;
}

bool is_sound(const path& file) {
  return begins(file, "RIFF");
}
bool is_png(const path& file) {
  return begins(file, "\x89PNG\r\n\x1a\n");
}
bool is_svg(const path& file) {
  const std::string text = lower(first_text(file));
  return text.starts_with("<svg") ||
         (text.starts_with("<?xml") && text.find("<svg") != std::string::npos);
}
bool is_animation(const path& file) {
  const std::string bytes = beginning(file, 12);
  return bytes.starts_with("GIF8") || (bytes.size() > 8 && bytes.compare(4, 4, "ftyp") == 0);
}
bool is_mesh(const path& file) {
  return first_text(file, 16).starts_with("OFF");
}
bool is_page_file(const path& file) {
  return begins(file, "THMBPAGE");  // render/src/disk_paging/page_file.cpp
}
bool is_json(const path& file) {
  const std::string text = first_text(file);
  return text.starts_with('{') || text.starts_with('[');
}
bool is_xml(const path& file) {
  return first_text(file).starts_with("<?xml");
}
bool is_web_page(const path& file) {
  const std::string text = lower(first_text(file));
  return text.starts_with("<!doctype html") && text.find("thimble") != std::string::npos;
}
bool is_nothing(const path&) {
  return false;
}
bool is_quality_table(const path& file) {
  return begins(file, "// Made by `thimble study accuracy --table");
}
bool is_motion_trace(const path& file) {
  return begins(file, "# frame reports ");
}
bool is_log(const path& file) {
  // 2026-01-31T12:00:00.000+00:00
  const std::string text = beginning(file, 24);
  constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:dd.ddd";
  if (text.size() < kForm.size()) return false;
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    const bool digit = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    if (kForm[i] == 'd' ? !digit : text[i] != kForm[i]) return false;
  }
  return true;
}
bool is_plain_text(const path& file) {
  return is_text(beginning(file, 4096));
}
bool is_anything(const path&) {
  return true;
}

}  // namespace

const OutputKind kTable{.name = "a table (CSV)", .matches = is_table};
const OutputKind kSound{.name = "a sound (WAV)", .matches = is_sound};
const OutputKind kPng{.name = "a picture (PNG)", .matches = is_png};
const OutputKind kSvg{.name = "a picture (SVG)", .matches = is_svg};
const OutputKind kAnimation{.name = "an animation (MP4 or GIF)", .matches = is_animation};
const OutputKind kMesh{.name = "a mesh (OFF)", .matches = is_mesh};
const OutputKind kPageFile{.name = "a page file", .matches = is_page_file, .needs_file = true};
const OutputKind kJson{.name = "JSON", .matches = is_json};
const OutputKind kXml{.name = "XML", .matches = is_xml};
const OutputKind kWebPage{.name = "a page of Thimble (HTML)", .matches = is_web_page};
const OutputKind kArmFile{
    .name = "a new arm file", .matches = is_nothing, .existing = Existing::kKeep};
const OutputKind kQualityTable{.name = "a table of qualities", .matches = is_quality_table};
const OutputKind kMotionTrace{.name = "a motion trace", .matches = is_motion_trace};
const OutputKind kLogFile{.name = "a log", .matches = is_log, .owner_only = true, .shared = true};
const OutputKind kPlainText{.name = "text", .matches = is_plain_text};
const OutputKind kPlotData{.name = "data of a plot", .matches = is_anything};

const OutputKind& kind_of_name(const path& file) {
  const std::string ending = lower(file.extension().string());
  const bool of_plots = ending == ".dat" || ending == ".gp" || ending == ".rgb";
  if (of_plots && file.parent_path().filename() == kDataFolder) return kPlotData;
  if (ending == ".csv") return kTable;
  if (ending == ".png") return kPng;
  if (ending == ".svg") return kSvg;
  if (ending == ".json") return kJson;
  if (ending == ".xml") return kXml;
  if (ending == ".html") return kWebPage;
  if (ending == ".off") return kMesh;
  return kPlainText;
}

}  // namespace thimble::output
