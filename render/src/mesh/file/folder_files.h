#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <filesystem>
#include <string>

namespace thimble::render {

/// The files that Assimp may access. These are the file being read, from memory under the name
/// `name`. If `folder` is not empty, they include plain files in it and below, by relative names
/// that do not leave it. Nothing can be written. The bytes must outlive it.
class FolderFiles final : public Assimp::IOSystem {
 public:
  FolderFiles(const std::string& bytes, std::string name, std::filesystem::path folder);

  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  // Returns the path of a named file; empty if access is not allowed.
  std::filesystem::path find(const std::string& file) const;

  const std::string& bytes_;
  const std::string name_;
  const std::filesystem::path folder_;
};

}  // namespace thimble::render
