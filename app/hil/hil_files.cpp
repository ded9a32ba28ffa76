#include "hil/hil_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "output/output_file.h"
#include "report/figure_json.h"

namespace thimble::app {
namespace {

using Json = nlohmann::ordered_json;

/// Returns a text as XML carries it; control characters, which it cannot carry, are question marks.
std::string in_xml(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\n':
        safe += "&#10;";
        break;
      case '\t':
        safe += "&#9;";
        break;
      default:
        safe += byte < 0x20 ? '?' : c;
    }
  }
  return safe;
}

}  // namespace

std::string outcome_name(HilOutcome outcome) {
  switch (outcome) {
    case HilOutcome::kPassed:
      return "passed";
    case HilOutcome::kFailed:
      return "failed";
    case HilOutcome::kSkipped:
      return "skipped";
  }
  return "skipped";
}

driver::Result<void> write_hil_json(const HilRecord& record, const std::vector<HilResult>& results,
                                    const std::filesystem::path& file) {
  Json checks = Json::array();
  for (const HilResult& result : results) {
    checks.push_back(Json{{"name", result.name},
                          {"outcome", outcome_name(result.outcome)},
                          {"text", result.text},
                          {"seconds", result.seconds},
                          {"figures", figures_json(result.figures)}});
  }
  const Json whole{
      {"arm", record.arm},     {"arm_file", record.arm_file}, {"simulated", record.simulated},
      {"suite", record.suite}, {"time", record.time},         {"checks", std::move(checks)}};
  return output::write_file(file, output::kJson,
                            whole.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
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
      "<testsuite name=\"thimble.hil.{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\" "
      "time=\"{:.3f}\" timestamp=\"{}\">\n",
      record.suite, results.size(), count(HilOutcome::kFailed), count(HilOutcome::kSkipped),
      seconds, record.time);
  for (const HilResult& result : results) {
    text += fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">\n",
                        in_xml(record.arm + " " + record.arm_file), in_xml(result.name),
                        result.seconds);
    if (!result.figures.empty()) text += "    <properties>\n";
    for (const Figure& figure : result.figures) {
      text += fmt::format("      <property name=\"{}\" value=\"{:.6g} {}\"/>\n",
                          in_xml(figure.name), figure.value, in_xml(figure.unit));
    }
    if (!result.figures.empty()) text += "    </properties>\n";
    if (result.outcome == HilOutcome::kFailed) {
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

}  // namespace thimble::app
