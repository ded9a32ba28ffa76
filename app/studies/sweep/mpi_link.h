#pragma once

#include <cstdint>

// What libthimble_mpi.so offers: the few calls of MPI that a sweep needs, in plain C, so that the
// program itself neither links nor needs MPI. From the thread that called thimble_mpi_begin alone.
extern "C" {

/// Begins MPI; 0 if all is well.
int thimble_mpi_begin();
/// Returns the number of this process and how many there are.
int thimble_mpi_rank();
int thimble_mpi_size();
/// Sends `count` numbers.
void thimble_mpi_send(int to, const std::uint64_t* words, int count);
/// Looks for a message from `*from`, or from anybody if that is negative, and tells from whom; with
/// `wait` until one is there. Tells how many numbers it has; -1 if there is none.
int thimble_mpi_probe(int* from, int wait);
/// Takes the message that was found.
void thimble_mpi_take(int from, std::uint64_t* words, int count);
/// Ends MPI.
void thimble_mpi_end();
}
