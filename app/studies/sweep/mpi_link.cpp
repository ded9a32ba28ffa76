#include "studies/sweep/mpi_link.h"

#include <mpi.h>

extern "C" {

int thimble_mpi_begin() {
  int provided = 0;
  // Other threads measure, but only this one calls MPI.
  const int status = MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  return status == MPI_SUCCESS && provided >= MPI_THREAD_FUNNELED ? 0 : 1;
}

int thimble_mpi_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int thimble_mpi_size() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

void thimble_mpi_send(int to, const std::uint64_t* words, int count) {
  MPI_Send(words, count, MPI_UINT64_T, to, 0, MPI_COMM_WORLD);
}

int thimble_mpi_probe(int* from, int wait) {
  MPI_Status status;
  int there = 1;
  const int source = *from < 0 ? MPI_ANY_SOURCE : *from;
  if (wait != 0) {
    MPI_Probe(source, 0, MPI_COMM_WORLD, &status);
  } else {
    MPI_Iprobe(source, 0, MPI_COMM_WORLD, &there, &status);
  }
  if (there == 0) return -1;
  int count = 0;
  MPI_Get_count(&status, MPI_UINT64_T, &count);
  *from = status.MPI_SOURCE;
  return count;
}

void thimble_mpi_take(int from, std::uint64_t* words, int count) {
  MPI_Recv(words, count, MPI_UINT64_T, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void thimble_mpi_end() {
  MPI_Finalize();
}
}
