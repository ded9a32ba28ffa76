#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::studies {

/// The processes that share a sweep, as started by `mpirun`; process 0 writes the journal and has
/// the numbers, the others help. Used only by the main thread.
class SweepTeam {
 public:
  /// A message between processes.
  using Message = std::vector<std::uint64_t>;

  /// Joins the team in which this process was started; nullptr if there is no team. Only then MPI
  /// is loaded, from libthimble_mpi.so next to the program. Fails if the program was built without
  /// it, because each process would do the whole work. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SweepTeam>> join();

  SweepTeam() = default;
  SweepTeam(const SweepTeam&) = delete;
  SweepTeam& operator=(const SweepTeam&) = delete;
  virtual ~SweepTeam() = default;

  /// Returns the number of this process; 0 is the leading one.
  virtual int rank() const = 0;
  /// Returns the number of processes.
  virtual int size() const = 0;
  /// Sends a message; on return the caller may discard it.
  virtual void send(int to, const Message& message) = 0;
  /// Receives a message from any process, if there is one.
  virtual bool poll(int& from, Message& message) = 0;
  /// Waits for a message from `from`.
  virtual Message receive(int from) = 0;
};

}  // namespace thimble::studies
