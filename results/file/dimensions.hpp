#pragma once

#include <cstdint>

#include "results/file/hdf5.hpp"

/// Scales of dimensions [HDF5 Dimension Scale Specification]: by them other programs, as xarray, name the dimensions of the
/// datasets. Nothing is read from them.
namespace drape::results {

/// Datasets for the dimensions of what has a row for each particle: `particle`, which counts them, and `axis`.
void write_particle_scales(const hdf5::Handle& group, std::uint64_t particles);

/// The dataset `row`, which counts the rows of a table, unless one of its columns is called so.
void write_row_scale(const hdf5::Handle& table, std::uint64_t rows);

/// Names the dimensions of what has been written of a run, of a table, and of all that is in a file.
void name_dimensions_of_run(const hdf5::Handle& run);
void name_dimensions_of_table(const hdf5::Handle& table);
void name_dimensions(const hdf5::Handle& file);

}  // namespace drape::results
