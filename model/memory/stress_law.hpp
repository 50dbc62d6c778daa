#pragma once

#include "model/memory/curve.hpp"

namespace drape::model {

/// A stress and its derivative by the strain.
struct Stress {
  double value, slope;
};

/// A law of stress over strain with one internal variable z, 0 at the beginning. Within a step the strain goes in one
/// direction.
class StressLaw {
 public:
  virtual ~StressLaw() = default;

  /// At a strain that was reached from another, where z was.
  virtual Stress stress(double strain, double from, double z) const = 0;

  /// z there.
  virtual double carry(double strain, double from, double z) const = 0;

  /// dz/dt, and how it grows with the rate of the strain, about.
  virtual double rate(double strain, double strain_rate, double z) const = 0;
  virtual double variable_slope(double strain, double strain_rate, double z) const = 0;

  /// What can be got back, by area.
  virtual double energy(double strain, double z) const = 0;

  /// The branch on which a motion goes on from here: within one the stress is a smooth function of the strain, between two
  /// there is a kink. Strains that stand still stay on theirs.
  virtual int branch(double strain, double strain_rate, double z) const = 0;

  /// The stiffness that K takes: it changes from branch to branch.
  virtual double branch_slope(double strain, double z) const = 0;
};

/// By a curve, where z is the largest strain; or what it has more than a straight line.
class CurveLaw final : public StressLaw {
 public:
  /// `odd`: negative strains have the same stresses with the other sign; else they follow the first slope. `linear`: slope of
  /// the line.
  CurveLaw(StressCurve curve, bool odd, double linear) : curve_(std::move(curve)), odd_(odd), linear_(linear) {}

  Stress stress(double strain, double from, double z) const override;
  double carry(double strain, double from, double z) const override;
  double rate(double strain, double strain_rate, double z) const override;
  double variable_slope(double, double, double) const override { return 0; }
  double energy(double strain, double z) const override;
  int branch(double strain, double strain_rate, double z) const override;
  double branch_slope(double strain, double z) const override;

 private:
  double sign(double strain) const { return odd_ && strain < 0 ? -1 : 1; }

  StressCurve curve_;
  bool odd_;
  double linear_;
};

/// Friction between yarns, where z is its stress: at most `limit`. Up to there it is elastic with the slope limit/onset
/// [Jenkin 1922], or approaches it exponentially, dF/dε = (limit ∓ F)/onset with the sign of dε/dt [Dahl 1968].
class FrictionLaw : public StressLaw {
 public:
  FrictionLaw(double limit, double onset) : limit_(limit), onset_(onset) {}

  double carry(double strain, double from, double z) const final { return stress(strain, from, z).value; }
  double rate(double strain, double strain_rate, double z) const final;
  double branch_slope(double, double) const final { return 0; }

 protected:
  double limit() const { return limit_; }
  double onset() const { return onset_; }

 private:
  double limit_, onset_;
};

class JenkinLaw final : public FrictionLaw {
 public:
  using FrictionLaw::FrictionLaw;
  Stress stress(double strain, double from, double z) const override;
  double variable_slope(double strain, double strain_rate, double z) const override;
  double energy(double strain, double z) const override;
  int branch(double strain, double strain_rate, double z) const override;
};

class DahlLaw final : public FrictionLaw {
 public:
  using FrictionLaw::FrictionLaw;
  Stress stress(double strain, double from, double z) const override;
  double variable_slope(double strain, double strain_rate, double z) const override;
  double energy(double strain, double z) const override;
  int branch(double strain, double strain_rate, double z) const override;
};

}  // namespace drape::model
