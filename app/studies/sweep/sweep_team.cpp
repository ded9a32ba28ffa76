#include "studies/sweep/sweep_team.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "studies/sweep/mpi_link.h"

namespace thimble::studies {
namespace {

/// A team that communicates by MPI.
class MpiTeam final : public SweepTeam {
 public:
  /// Resolves the functions of the loaded library; false if one is missing.
  bool find(void* library) {
    return find(library, "thimble_mpi_begin", begin_) && find(library, "thimble_mpi_rank", rank_) &&
           find(library, "thimble_mpi_size", size_) && find(library, "thimble_mpi_send", send_) &&
           find(library, "thimble_mpi_probe", probe_) && find(library, "thimble_mpi_take", take_) &&
           find(library, "thimble_mpi_end", end_);
  }
  bool begin() { return begun_ = begin_() == 0; }
  ~MpiTeam() override {
    if (begun_) end_();
  }

  int rank() const override { return rank_(); }
  int size() const override { return size_(); }
  void send(int to, const Message& message) override {
    send_(to, message.data(), static_cast<int>(message.size()));
  }
  bool poll(int& from, Message& message) override {
    from = -1;
    const int count = probe_(&from, 0);
    if (count < 0) return false;
    message = take(from, count);
    return true;
  }
  Message receive(int from) override {
    const int count = probe_(&from, 1);
    return take(from, count);
  }

 private:
  template <class Function>
  static bool find(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    return function != nullptr;
  }
  Message take(int from, int count) {
    Message message(static_cast<std::size_t>(count));
    take_(from, message.data(), count);
    return message;
  }

  bool begun_ = false;
  decltype(&thimble_mpi_begin) begin_ = nullptr;
  decltype(&thimble_mpi_rank) rank_ = nullptr;
  decltype(&thimble_mpi_size) size_ = nullptr;
  decltype(&thimble_mpi_send) send_ = nullptr;
  decltype(&thimble_mpi_probe) probe_ = nullptr;
  decltype(&thimble_mpi_take) take_ = nullptr;
  decltype(&thimble_mpi_end) end_ = nullptr;
};

/// Returns whether mpirun started this process: Open MPI and the launchers of MPICH set variables.
bool started_by_mpirun() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMI_SIZE") != nullptr;
}

}  // namespace

driver::Result<std::unique_ptr<SweepTeam>> SweepTeam::join() {
  if (!started_by_mpirun()) return std::unique_ptr<SweepTeam>();
  std::error_code status;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", status);
  const std::string file = (program.parent_path() / "libthimble_mpi.so").string();
  // Open MPI loads plugins that look for its symbols among the program's.
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  auto team = std::make_unique<MpiTeam>();
  if (library == nullptr || !team->find(library)) {
    return driver::Error{
        "This build has no MPI support. Install libopenmpi-dev, configure and build "
        "again, or start the sweep without mpirun."};
  }
  if (!team->begin()) return driver::Error{"MPI could not start. See the output of mpirun."};
  return std::unique_ptr<SweepTeam>(std::move(team));
}

}  // namespace thimble::studies
