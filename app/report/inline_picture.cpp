#include "report/inline_picture.h"

#include <fstream>
#include <sstream>

namespace thimble::report {

std::string inline_picture(const std::filesystem::path& file, const std::string& mark) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  std::string svg = text.str();
  const auto begin = svg.find("<svg");
  if (begin == std::string::npos) return {};
  svg.erase(0, begin);
  for (const std::string& key :
       {std::string("id=\""), std::string("xlink:href=\"#"), std::string("xlink:href='#"),
        std::string("id='"), std::string("url(#")}) {
    for (auto at = svg.find(key); at != std::string::npos;
         at = svg.find(key, at + key.size() + mark.size())) {
      svg.insert(at + key.size(), mark);
    }
  }
  return svg;
}

}  // namespace thimble::report
