// Replaces the reader and the writer of bags in builds without SQLite.
#include "bag/read_bag.h"
#include "bag/write_bag.h"

namespace thimble::bag {
namespace {

driver::Error none(const std::filesystem::path& path) {
  return {path.string() +
          ": ROS bags are not part of this build. Install libsqlite3-dev and build again with "
          "-D THIMBLE_BAGS=ON."};
}

}  // namespace

bool is_bag(const std::filesystem::path& path) {
  const std::string end = path.extension().string();
  return end == ".db3" || end == ".mcap" || std::filesystem::is_directory(path);
}

driver::Result<BagTopic> read_bag(const std::filesystem::path& path, BagKind /*kind*/,
                                  const std::string& /*topic*/, BagClock /*clock*/) {
  return none(path);
}

driver::Result<void> write_bag(const std::filesystem::path& folder,
                               const std::vector<BagTrack>& /*tracks*/,
                               const std::function<void(double)>& /*share_written*/) {
  return none(folder);
}

}  // namespace thimble::bag
