#include "mesh/file/folder_files.h"

#include <assimp/MemoryIOWrapper.h>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "system/regular_file.h"

namespace thimble::render {

FolderFiles::FolderFiles(const std::string& bytes, std::string name, std::filesystem::path folder)
    : bytes_(bytes), name_(std::move(name)), folder_(std::move(folder)) {}

bool FolderFiles::Exists(const char* file) const {
  return file == name_ || !find(file).empty();
}

Assimp::IOStream* FolderFiles::Open(const char* file, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr) return nullptr;
  if (file == name_) {
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()),
                                      bytes_.size());
  }
  const std::filesystem::path path = find(file);
  if (path.empty()) return nullptr;
  constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30;  // same as for the mesh file itself
  const auto read = driver::read_file(path, kMaxBytes);
  if (!read) return nullptr;
  auto* const owned = new std::uint8_t[read->size() + 1];
  std::copy(read->begin(), read->end(), owned);
  return new Assimp::MemoryIOStream(owned, read->size(), true);
}

std::filesystem::path FolderFiles::find(const std::string& file) const {
  std::string_view name = file;
  while (name.starts_with("./")) name.remove_prefix(2);  // Assimp's prefix for the same folder
  const std::filesystem::path relative(name);
  if (folder_.empty() || relative.empty() || relative.is_absolute()) return {};
  for (const auto& step : relative) {
    if (step == "..") return {};
  }
  const std::filesystem::path path = folder_ / relative;
  return driver::is_regular(path) ? path : std::filesystem::path();
}

}  // namespace thimble::render
