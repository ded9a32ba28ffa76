# Writes the files of a page as string literals of C++.
#   cmake -D FOLDER=parts -D OUTPUT=page_parts.cpp -D "SCRIPTS=a.js b.js" -P embed_parts.cmake
cmake_minimum_required(VERSION 3.25)
function(literal file text)
  file(READ "${FOLDER}/${file}" content)
  set(${text} "R\"thimble(${content})thimble\"" PARENT_SCOPE)
endfunction()
literal(page.html html)
literal(page.css style)
separate_arguments(SCRIPTS)
set(script "")
foreach(file ${SCRIPTS})
  literal(${file} one)
  string(APPEND script "\n    ${one}")
endforeach()
file(WRITE "${OUTPUT}" "#include \"report/html/page_parts.h\"

namespace thimble::report {

const std::string_view kPageHtml = ${html};
const std::string_view kPageStyle = ${style};
const std::string_view kPageScript = ${script};

}  // namespace thimble::report
")
