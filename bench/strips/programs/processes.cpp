#include "bench/strips/programs/processes.hpp"

#include <HYPRE.h>
#include <HYPRE_utilities.h>
#include <mpi.h>

#include <cstddef>

namespace drape::bench::strips {

Processes::Processes(int* argc, char*** argv) {
  MPI_Init(argc, argv);
  HYPRE_Init();
}

Processes::~Processes() {
  HYPRE_Finalize();
  MPI_Finalize();
}

int Processes::rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int Processes::count() {
  int count = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  return count;
}

double Processes::largest(double here) {
  double all = here;
  MPI_Allreduce(&here, &all, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return all;
}

void Processes::add_up(std::span<double> sums) {
  const std::vector<double> all = gathered(sums);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    sums[k] = 0;
    for (std::size_t place = k; place < all.size(); place += sums.size()) sums[k] += all[place];
  }
}

std::vector<double> Processes::gathered(std::span<const double> here) {
  const int size = static_cast<int>(here.size());
  std::vector<double> all(here.size() * static_cast<std::size_t>(count()));
  MPI_Allgather(here.data(), size, MPI_DOUBLE, all.data(), size, MPI_DOUBLE, MPI_COMM_WORLD);
  return all;
}

}  // namespace drape::bench::strips
