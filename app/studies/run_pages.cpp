#include "studies/run_pages.h"

#include <system_error>
#include <utility>

#include "report/figure_output.h"
#include "report/html/page_block.h"
#include "report/html/page_libraries.h"
#include "report/html/touch_page.h"
#include "thimble/scene/build_info.h"

namespace thimble::studies {
namespace {

constexpr const char* kStyle =
    "body{font:16px/1.5 system-ui,\"DejaVu Sans\",sans-serif;color:#22262c;background:#fff;"
    "margin:0 auto;padding:1rem;max-width:60rem}h1{font-size:1.5rem}li{margin:.5rem 0}"
    "a{color:#005a8c}small{color:#555c66}";

std::string link(const std::string& file, const std::string& words) {
  return "<a href=\"" + report::html_text(file) + "\">" + report::html_text(words) + "</a>";
}

/// Runs a scene and writes its page; the error says why there is none.
driver::Result<void> write_run(const std::filesystem::path& scene,
                               const session::SessionOptions& options,
                               const std::filesystem::path& file) {
  auto opened = session::Session::open(scene, options);
  if (!opened) return opened.error();
  report::RunPage page(**opened);
  (*opened)->run();
  return page.write({}, file);
}

}  // namespace

RunPages::RunPages(std::filesystem::path folder, const std::string& title, const std::string& words)
    : folder_(std::move(folder)),
      text_(
          "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
          "<meta name=\"viewport\" content=\"width=device-width\"><title>" +
          report::html_text(title) + " - Thimble</title>\n<style>" + kStyle +
          "</style></head><body>\n" + "<h1>" + report::html_text(title) + "</h1>\n<p>" +
          report::html_text(words) + "</p>\n<ul>\n") {}

driver::Result<void> RunPages::add(const std::filesystem::path& scene, const std::string& name,
                                   const std::string& words,
                                   const session::SessionOptions& options) {
  const std::filesystem::path page = folder_ / (name + ".html");
  std::string why;
  if (const auto libraries = report::read_page_libraries(); !libraries)
    why = libraries.error().message;
  if (why.empty() && bytes_ >= kBytesMax)
    why = "The total size of the pages has reached its limit.";
  if (why.empty()) {
    if (auto written = write_run(scene, options, page); !written) why = written.error().message;
  }
  std::error_code absent;
  const std::uintmax_t size = std::filesystem::file_size(page, absent);
  if (why.empty() && absent) {
    return driver::Error{page.string() + " cannot be written: " + absent.message() + "."};
  }
  if (why.empty()) bytes_ += size;
  text_ += "<li>" + (why.empty() ? link(name + ".html", name) : report::html_text(name)) + ": " +
           report::html_text(words);
  if (!why.empty()) text_ += " <small>No page: " + report::html_text(why) + "</small>";
  text_ += "</li>\n";
  return {};
}

void RunPages::list(const std::string& file, const std::string& words) {
  text_ += "<li>" + link(file, file) + ": " + report::html_text(words) + "</li>\n";
}

driver::Result<void> RunPages::write() const {
  return report::write_text(text_ + "</ul>\n<p><small>" + report::html_text(scene::program_name()) +
                                ".</small></p>\n</body></html>\n",
                            folder_ / "index.html");
}

}  // namespace thimble::studies
