#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::studies {

/// The processes that share a sweep, as `mpirun` started them; process 0 keeps the journal and
/// has the numbers, the others help. Used by the main thread alone.
class SweepTeam {
 public:
  /// What processes tell each other.
  using Message = std::vector<std::uint64_t>;

  /// Joins the team that this process was started in; nullptr if it was started alone. MPI is
  /// loaded only here and only then, from libthimble_mpi.so beside the program. Fails if the
  /// program was built without it: then each process would do the whole work. Real-time: never from
  /// the servo thread.
  static driver::Result<std::unique_ptr<SweepTeam>> join();

  SweepTeam() = default;
  SweepTeam(const SweepTeam&) = delete;
  SweepTeam& operator=(const SweepTeam&) = delete;
  virtual ~SweepTeam() = default;

  /// Returns the number of this process; 0 is the one that leads.
  virtual int rank() const = 0;
  /// Returns how many processes there are.
  virtual int size() const = 0;
  /// Sends a message; returns when it may be forgotten.
  virtual void send(int to, const Message& message) = 0;
  /// Takes a message from anybody, if one is there.
  virtual bool poll(int& from, Message& message) = 0;
  /// Waits for a message from `from`.
  virtual Message receive(int from) = 0;
};

}  // namespace thimble::studies
