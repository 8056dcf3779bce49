#include "sqt/mueller_table.h"

#include <algorithm>

#include "base/error.h"

namespace suite::sqt {

MuellerTable::MuellerTable(Data data) : data_(std::move(data)) {
  data_.grid.check();
  const std::vector<double>& um = data_.wavelength_um;
  if (um.empty()) throw Error("matrices without a wavelength");
  for (size_t i = 0; i < um.size(); ++i)
    if (!(um[i] > 0) || (i && !(um[i] > um[i - 1]))) throw Error("wavelengths of matrices must ascend from above 0");
  if (data_.elements.size() != data_.grid.nodes() * um.size() * kElements)
    throw Error(strf("%zu elements of matrices, %zu are wanted", data_.elements.size(),
                     data_.grid.nodes() * um.size() * kElements));
}

void MuellerTable::at(Dir out, Dir in, std::span<Mueller> m) const {
  const HalfGrid::Corners c = data_.grid.at(HalfAngles::of(out, in));
  const size_t row = data_.wavelength_um.size() * kElements;
  for (Mueller& x : m) x = Mueller::depolariser();
  for (size_t k = 0; k < 8; ++k) {
    if (!(c.weight[k] > 0)) continue;
    const int16_t* of = &data_.elements[c.node[k] * row];
    const double weight = c.weight[k] / kUnit;
    for (Mueller& x : m)
      for (size_t e = 1; e <= kElements; ++e) x.m[e] += weight * *of++;
  }
}

double MuellerTable::least() const {
  double least = 1;
  for (size_t i = 0; i < data_.elements.size(); i += kElements) {
    Mueller m = Mueller::depolariser();
    for (size_t e = 1; e <= kElements; ++e) m.m[e] = static_cast<double>(data_.elements[i + e - 1]) / kUnit;
    least = std::min(least, least_coherency(m));
  }
  return least;
}

}  // namespace suite::sqt
