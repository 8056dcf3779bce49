#include "sqt_fit/swapped.h"

#include <cmath>
#include <limits>

#include "base/error.h"

namespace suite::sqt {

namespace {

class Swapped : public Function {
 public:
  explicit Swapped(std::shared_ptr<const Function> function)
      : function_(std::move(function)), info_(function_->info()) {
    info_.source += ", directions exchanged";
  }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    if (in.z > 0) return function_->value(in, out, f);
    for (double& v : f) v = std::numeric_limits<double>::quiet_NaN();
  }

 private:
  std::shared_ptr<const Function> function_;
  Info info_;
};

}  // namespace

std::shared_ptr<const Function> swapped(std::shared_ptr<const Function> function) {
  const Function::Info& info = function->info();
  if (info.quantity != Quantity::bsdf || info.domain != Domain::hemisphere || function->dirac() != Dirac::none)
    throw Error("the two directions of '" + info.name + "' cannot be exchanged",
                "only those of reflectance data (BRDFs) can");
  return std::make_shared<Swapped>(std::move(function));
}

}  // namespace suite::sqt
