#include "thimble/scene/build_info.h"

#include "thimble/version.h"

namespace thimble::scene {

BuildInfo build_info() {
  return {THIMBLE_VERSION, THIMBLE_COMPILER, THIMBLE_BUILD_TYPE, THIMBLE_REVISION};
}

std::string program_name() {
  const BuildInfo build = build_info();
  std::string name = "thimble";
  for (const std::string_view part : {build.version, build.revision, build.type, build.compiler}) {
    if (!part.empty()) name.append(" ").append(part);
  }
  return name;
}

}  // namespace thimble::scene
