#pragma once

#include <span>
#include <string>

#include "model/cloth.hpp"
#include "model/fabric.hpp"

namespace drape::bench {

/// What an instrument does to a sample: positions for a strain, up to the largest, back, and as far to the other side if it
/// goes there. Strains of bending are curvatures [1/m].
struct Instrument {
  const char* name;
  double largest;
  bool to_both_sides;
  double model::WeftWarp::*bends;  ///< direction along which it bends; null: it does not
  solver::Vectors (*positions)(const model::Grid& grid, double strain);
};

/// Stretching along both directions, shear, bending along both, as Kawabata's instruments do it.
std::span<const Instrument> instruments();

/// A square of 8 mm of a fabric, by its tables if it has any, with bending forces in all directions.
model::Scene sample_of(const model::Fabric& fabric);

/// What an instrument holds.
class Sample {
 public:
  Sample(const model::Scene& scene, const Instrument& instrument);

  /// At a time, by its work for a change of the strain and by area: of the whole sheet, or of the particles that know a
  /// curvature [N/m]; of bending a moment by width [N].
  double stress(double t, double strain);

  /// The motion has come to this strain, evenly from where it was.
  void pass(double t, double strain);

  /// The motion begins there, all at once.
  void begin(double t, double strain);

 private:
  solver::Vectors at(double strain) const { return instrument_.positions(scene_.sheet.grid, strain); }

  model::Scene scene_;
  const Instrument& instrument_;
  model::Cloth cloth_;
  solver::State y_;
  solver::Vectors f_;
  double area_;
};

}  // namespace drape::bench
