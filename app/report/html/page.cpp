#include "report/html/page.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "output/output_file.h"
#include "report/html/page_block.h"
#include "report/html/page_libraries.h"
#include "report/html/page_parts.h"
#include "report/html/page_scene.h"
#include "report/json_text.h"

namespace thimble::report {
namespace {

using Json = nlohmann::ordered_json;

// Escapes a script so that it does not end its own element.
std::string script_text(std::string text) {
  for (std::size_t at = text.find("</script"); at != std::string::npos;
       at = text.find("</script", at + 4)) {
    text.replace(at, 2, "<\\/");
  }
  return text;
}

// Returns JSON for use within a script.
std::string script_json(const Json& json) {
  std::string safe;
  for (const char c : json_text(json)) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

// Replaces the placeholders between two @; inserted text is not searched again.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& values) {
  std::string page;
  while (!text.empty()) {
    const std::size_t at = text.find('@');
    const std::size_t end = at == text.npos ? text.npos : text.find('@', at + 1);
    if (end == text.npos) break;
    page += text.substr(0, at);
    const auto value = values.find(text.substr(at + 1, end - at - 1));
    if (value == values.end()) {
      page += text.substr(at, end - at);
      text.remove_prefix(end);
    } else {
      page += value->second;
      text.remove_prefix(end + 1);
    }
  }
  return page += text;
}

Json about(const PageTouch& touch, PageBlock& block) {
  Json json{{"title", touch.title},
            {"subtitle", touch.subtitle},
            {"program", touch.program},
            {"rate", touch.rate},
            {"tip_radius", touch.scene.tip_radius},
            {"virtual", touch.virtual_time},
            {"replayed", touch.replayed}};
  json["objects"] = page_objects(touch, block);
  json["bodies"] = page_bodies(touch, block);
  json["dents"] = page_dents(touch, block);
  if (draws_all(touch.scene)) json["shapes"] = page_shapes(touch.shapes, block);
  json["arms"] = Json::array();
  for (std::size_t i = 0; i < touch.arms.size(); ++i) {
    json["arms"].push_back(page_arm(touch, i, block));
  }
  json["arrays"] = block.arrays();
  json["numbers_bytes"] = block.bytes().size();
  return json;
}

Json live_part(const PageTouch& touch, const PageSource& source) {
  Json knobs = Json::array();
  for (const session::SharedScene::Knob& knob : touch.scene.knobs) {
    knobs.push_back({{"name", knob.name},
                     {"unit", knob.unit},
                     {"least", knob.min},
                     {"most", knob.max},
                     {"initial", knob.initial}});
  }
  return {{"rows", source.rows},
          {"run", source.run},
          {"knobs", knobs},
          {"no_restart", source.no_restart},
          {"no_step", source.no_step}};
}

}  // namespace

driver::Result<std::string> page_text(const PageTouch& touch, const PageSource* source) {
  const auto libraries = read_page_libraries();
  if (!libraries) return libraries.error();
  std::string scripts, styles, licences;
  for (const PageLibrary& library : *libraries) {
    scripts += "<script>" + script_text(library.script) + "</script>\n";
    styles += library.style + "\n";
    licences +=
        "<h3>" + html_text(library.name) + "</h3>\n<pre>" + html_text(library.licence) + "</pre>\n";
  }
  PageBlock block;
  Json json = about(touch, block);
  std::string connect;
  if (source != nullptr) {
    json["live"] = live_part(touch, *source);
    connect = "; connect-src";
    for (const char* from :
         {" ws://127.0.0.1:", " ws://localhost:", " http://127.0.0.1:", " http://localhost:"}) {
      connect += from + std::to_string(source->port);
    }
  }
  return filled(kPageHtml, {{"TITLE", html_text(touch.title)},
                            {"CONNECT", connect},
                            {"LIBRARY_STYLES", styles},
                            {"STYLE", std::string(kPageStyle)},
                            {"LICENCES", licences},
                            {"ABOUT", script_json(json)},
                            {"NUMBERS", base64(deflated(block.bytes()))},
                            {"LIBRARIES", scripts},
                            {"SCRIPT", script_text(std::string(kPageScript))}});
}

driver::Result<void> write_page(const PageTouch& touch, const std::filesystem::path& file) {
  const auto text = page_text(touch);
  if (!text) return text.error();
  return output::write_file(file, output::kWebPage, *text);
}

}  // namespace thimble::report
