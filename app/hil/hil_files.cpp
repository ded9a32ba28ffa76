#include "hil/hil_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "output/output_file.h"
#include "report/figure_json.h"
#include "report/json_text.h"
#include "text/utf8.h"

namespace thimble::hil {
namespace {

using Json = nlohmann::ordered_json;

/// Returns whether XML 1.0 allows a non-ASCII character of UTF-8: all but U+FFFE and U+FFFF.
bool fits_xml(std::string_view character) {
  return character != "\xEF\xBF\xBE" && character != "\xEF\xBF\xBF";
}

/// Escapes a text for XML. Invalid characters (control characters, U+FFFE and U+FFFF) become a
/// question mark, and a byte that is not UTF-8 becomes U+FFFD.
std::string in_xml(std::string_view text) {
  const std::string whole = scene::as_utf8(text);
  std::string safe;
  for (std::size_t i = 0; i < whole.size();) {
    const std::size_t length = scene::utf8_length(std::string_view(whole).substr(i));
    const std::string_view one =
        std::string_view(whole).substr(i, std::max<std::size_t>(length, 1));
    i += one.size();
    const auto byte = static_cast<unsigned char>(one[0]);
    if (one.size() > 1) {
      safe += fits_xml(one) ? one : "?";
    } else if (one == "&") {
      safe += "&amp;";
    } else if (one == "<") {
      safe += "&lt;";
    } else if (one == ">") {
      safe += "&gt;";
    } else if (one == "\"") {
      safe += "&quot;";
    } else if (one == "\n" || one == "\t" || one == "\r") {
      safe += fmt::format("&#{};", byte);
    } else {
      safe += byte < 0x20 ? "?" : one;
    }
  }
  return safe;
}

}  // namespace

Json hil_json(const HilRecord& record, const std::vector<HilResult>& results) {
  Json checks = Json::array();
  for (const HilResult& result : results) {
    checks.push_back(Json{{"name", result.name},
                          {"outcome", words_of(result.outcome).in_files},
                          {"text", result.text},
                          {"seconds", result.seconds},
                          {"figures", report::figures_json(result.figures)}});
  }
  return {{"arm", record.arm},
          {"arm_file", record.arm_file},
          {"simulated", record.simulated},
          {"suite", record.suite},
          {"time", record.time},
          {"end", record.end},
          {"exit_code", record.exit_code},
          {"not_tested", record.not_tested},
          {"checks", std::move(checks)}};
}

driver::Result<void> write_hil_json(const HilRecord& record, const std::vector<HilResult>& results,
                                    const std::filesystem::path& file) {
  return output::write_file(file, output::kJson,
                            report::json_text(hil_json(record, results), 2) + "\n");
}

driver::Result<void> write_hil_junit(const HilRecord& record, const std::vector<HilResult>& results,
                                     const std::filesystem::path& file) {
  const auto count = [&](HilOutcome outcome) {
    return std::count_if(results.begin(), results.end(),
                         [&](const HilResult& one) { return one.outcome == outcome; });
  };
  double seconds = 0;
  for (const HilResult& result : results) seconds += result.seconds;
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += fmt::format(
      "<testsuite name=\"thimble.hil.{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" "
      "skipped=\"{}\" "
      "time=\"{:.3f}\" timestamp=\"{}\">\n",
      in_xml(record.suite), results.size(), count(HilOutcome::kFailed), count(HilOutcome::kNotRun),
      count(HilOutcome::kSkipped), seconds, in_xml(record.time));
  for (const HilResult& result : results) {
    text += fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">\n",
                        in_xml(record.arm + " " + record.arm_file), in_xml(result.name),
                        result.seconds);
    if (!result.figures.empty()) text += "    <properties>\n";
    for (const session::Figure& figure : result.figures) {
      text +=
          fmt::format("      <property name=\"{}\" value=\"{:.6g}{}{}\"/>\n", in_xml(figure.name),
                      figure.value, figure.unit.empty() ? "" : " ", in_xml(figure.unit));
    }
    if (!result.figures.empty()) text += "    </properties>\n";
    if (result.outcome == HilOutcome::kNotRun) {
      text += fmt::format("    <error message=\"{}\"/>\n", in_xml(result.text));
    } else if (result.outcome == HilOutcome::kFailed) {
      text += fmt::format("    <failure message=\"{}\"/>\n", in_xml(result.text));
    } else if (result.outcome == HilOutcome::kSkipped) {
      text += fmt::format("    <skipped message=\"{}\"/>\n", in_xml(result.text));
    } else {
      text += fmt::format("    <system-out>{}</system-out>\n", in_xml(result.text));
    }
    text += "  </testcase>\n";
  }
  return output::write_file(file, output::kXml, text + "</testsuite>\n");
}

}  // namespace thimble::hil
