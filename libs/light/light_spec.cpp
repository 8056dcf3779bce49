#include "light/light_spec.h"

namespace suite {

void add_curve(std::string name, const Curve& curve, std::vector<LightSpectra>& to) {
  if (!curve.value().empty())
    to.push_back({{std::move(name)},
                  [&curve](const SpectralState& s) { return std::vector<std::vector<float>>{s.sample(curve)}; }});
}

void LightSpec::settle(SourceSpecs&, size_t, std::vector<std::string>&) const {}

}  // namespace suite
