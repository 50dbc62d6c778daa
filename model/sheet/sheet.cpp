#include "model/sheet/sheet.hpp"

namespace drape::model {

Spectrum Relaxation::spectrum() const {
  if (quality > 0) return constant_quality(quality, band);
  return series.empty() ? maxwell : relaxation_of_series(series);
}

}  // namespace drape::model
