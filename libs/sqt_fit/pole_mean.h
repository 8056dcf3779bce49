// Isotropic data seen exactly along the normal: there the azimuth of the light means nothing, but measured data depend
// on it. Values there are the mean over azimuths, negative ones taken as 0; elsewhere they are the data's.
#pragma once
#include "sqt/function.h"

namespace suite::sqt {

class PoleMean final : public Function {
 public:
  explicit PoleMean(const Function& function);  // must outlive this
  // The function itself where its values along the normal do not depend on azimuth, or may.
  const Function& function() const { return needed_ ? *this : function_; }

  const Info& info() const override { return function_.info(); }
  void value(Dir out, Dir in, std::span<double> f) const override;
  Dirac dirac() const override { return function_.dirac(); }
  void dirac_total(Dir out, std::span<double> W) const override { function_.dirac_total(out, W); }
  double dirac_core() const override { return function_.dirac_core(); }

 private:
  const Function& function_;
  bool needed_ = false;
};

}  // namespace suite::sqt
