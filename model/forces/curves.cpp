#include "model/forces/remembered_stresses.hpp"

namespace drape::model {

/// Stresses by measured curves with branches [Etzmuß 2002, 2.1.3]. Those of tension take the place of k1 and k2, and K takes
/// the slopes of their branches. Those of shear and bending add to the linear forces of G, B1 and B2 what a curve has more than
/// its first slope.
std::optional<Term> make_curves(const Sheet& sheet) {
  const Material& m = sheet.material;
  const auto stresses = std::make_shared<RememberedStresses>();
  const auto law = [&](const StressCurve& curve, bool odd, double linear) -> std::shared_ptr<const StressLaw> {
    if (!curve.given()) return {};
    return std::make_shared<CurveLaw>(m.curve_form == CurveForm::smooth ? curve.smoothed() : curve, odd, linear);
  };

  const auto weft = law(m.weft_curve, false, 0), warp = law(m.warp_curve, false, 0);
  if (weft || warp)
    for (const Edge& edge : edges(sheet.grid))
      if (const auto& along_edge = edge.weft ? weft : warp) stresses->add(Strain::of_edge(edge), along_edge, true);
  if (const auto shear = law(m.shear_curve, true, m.shear)) add_shear(sheet.grid, shear, *stresses);
  add_bending(sheet.grid, law(m.weft_bend_curve, true, m.bend.weft), law(m.warp_bend_curve, true, m.bend.warp), *stresses);
  return remembering_term(stresses);
}

}  // namespace drape::model
