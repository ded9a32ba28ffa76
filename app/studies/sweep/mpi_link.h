#pragma once

#include <cstdint>

// The interface of libthimble_mpi.so: the few MPI calls of a sweep, in plain C, so that the program
// itself neither links nor needs MPI. Only for the thread that called thimble_mpi_begin.
extern "C" {

/// Starts MPI; 0 on success.
int thimble_mpi_begin();
/// Returns the number of this process and the number of processes.
int thimble_mpi_rank();
int thimble_mpi_size();
/// Sends `count` numbers.
void thimble_mpi_send(int to, const std::uint64_t* words, int count);
/// Probes for a message from `*from`, or from any process if that is negative, and sets `*from` to
/// the sender; with `wait` waits for one. Returns its length in numbers; -1 if there is none.
int thimble_mpi_probe(int* from, int wait);
/// Receives the probed message.
void thimble_mpi_take(int from, std::uint64_t* words, int count);
/// Ends MPI.
void thimble_mpi_end();
}
