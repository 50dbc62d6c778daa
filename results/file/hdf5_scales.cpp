#include <hdf5_hl.h>

#include "results/file/hdf5_library.hpp"

namespace drape::results::hdf5 {

void name_dimension(const Handle& group, const std::string& dataset, unsigned dimension, const std::string& scale) {
  const Handle named(H5Dopen2(group.id(), dataset.c_str(), H5P_DEFAULT), dataset),
      by(H5Dopen2(group.id(), scale.c_str(), H5P_DEFAULT), scale);
  if (check(H5DSis_scale(by.id()), scale) == 0) check(H5DSset_scale(by.id(), scale.c_str()), scale);
  check(H5DSattach_scale(named.id(), by.id(), dimension), dataset);
}

}  // namespace drape::results::hdf5
