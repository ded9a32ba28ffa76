#include "studies/cost/instruction_count.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

namespace thimble::studies {
namespace {

// Counts the instructions of a whole run, from valgrind's final message: "Collected : 12345".
std::optional<double> instructions_of(const std::string& subject, int strokes) {
  std::error_code error;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe", error).string();
  if (error) return std::nullopt;
  const std::string command = "valgrind --tool=callgrind --callgrind-out-file=/dev/null '" +
                              program + "' cost-probe '" + subject + "' " +
                              std::to_string(strokes) + " 2>&1 >/dev/null";
  const auto close = [](std::FILE* pipe) { pclose(pipe); };
  const std::unique_ptr<std::FILE, decltype(close)> pipe(popen(command.c_str(), "re"), close);
  if (!pipe) return std::nullopt;
  std::optional<double> count;
  std::array<char, 512> line;
  while (std::fgets(line.data(), static_cast<int>(line.size()), pipe.get()) != nullptr) {
    const std::string text(line.data());
    const auto at = text.find("Collected : ");
    if (at != std::string::npos) count = std::strtod(text.c_str() + at + 12, nullptr);
  }
  return count;
}

}  // namespace

std::optional<double> instructions_per_tick(const std::string& subject) {
  constexpr int kFew = 1, kMany = 3;
  const auto few = instructions_of(subject, kFew);
  if (!few) return std::nullopt;
  const auto many = instructions_of(subject, kMany);
  if (!many) return std::nullopt;
  return (*many - *few) / ((kMany - kFew) * kStrokeTicks);
}

}  // namespace thimble::studies
