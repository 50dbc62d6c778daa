// Calls of MPI that send, counted on their way to the library by its profiling interface: those of hypre and SUNDIALS as well.

#include <mpi.h>

#include <cstdint>

#include "bench/strips/programs/processes.hpp"

namespace drape::bench::strips {
namespace {

Traffic sent;

void count_message(int count, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  ++sent.messages;
  sent.bytes += static_cast<std::int64_t>(count) * size;
}

}  // namespace

Traffic traffic() { return sent; }

}  // namespace drape::bench::strips

extern "C" {

int MPI_Send(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm processes) {
  drape::bench::strips::count_message(count, type);
  return PMPI_Send(data, count, type, to, tag, processes);
}

int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm processes, MPI_Request* request) {
  drape::bench::strips::count_message(count, type);
  return PMPI_Isend(data, count, type, to, tag, processes, request);
}

int MPI_Allreduce(const void* data, void* result, int count, MPI_Datatype type, MPI_Op operation, MPI_Comm processes) {
  ++drape::bench::strips::sent.reductions;
  return PMPI_Allreduce(data, result, count, type, operation, processes);
}

int MPI_Allgather(const void* data, int count, MPI_Datatype type, void* result, int result_count, MPI_Datatype result_type,
                  MPI_Comm processes) {
  ++drape::bench::strips::sent.reductions;
  return PMPI_Allgather(data, count, type, result, result_count, result_type, processes);
}
}
