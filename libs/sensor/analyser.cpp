#include "sensor/analyser.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

constexpr double kIdeal = 1e12;  // extinction that is none

double angle_of(const Params& p, const char* key) { return p.number_in(key, -360, 360, "degrees") * kDegree; }

Mueller read_polarizer(const Params& p) {
  const double extinction = p.number_in("extinction", 1, kIdeal, "", kIdeal);
  return polarizer(angle_of(p, "polarizer_deg"), p.find("extinction") ? 1 / extinction : 0);
}

OpticalElement read_matrix(const Params& p) {
  const std::vector<double> m = p.as_numbers();
  if (m.size() != 16) throw p.error(strf("a Mueller matrix has 16 numbers, row by row; here are %zu", m.size()));
  OpticalElement e;
  std::copy(m.begin(), m.end(), e.matrix.m.begin());
  if (!(e.matrix(0, 0) >= 0) || least_coherency(e.matrix) < -1e-6)
    throw p.error("no optics has this matrix: it would make light that is polarised by more than all of it",
                  "is it given row by row, in the order I, Q, U, V?");
  if (e.matrix(0, 0) + std::hypot(e.matrix(0, 1), e.matrix(0, 2), e.matrix(0, 3)) > 1 + 1e-6)
    throw p.error("this matrix passes more light than comes in", "at most 1 of any light");
  return e;
}

OpticalElement read_element(const Params& p) {
  OpticalElement e;
  if (p.has("polarizer_deg")) {
    e.matrix = read_polarizer(p);
  } else if (p.has("retarder_um")) {
    e.path_um = p.number_in("retarder_um", -1e5, 1e5, "um");
    e.axis = angle_of(p, "axis_deg");
  } else if (p.has("retarder_deg")) {
    e.matrix = retarder(angle_of(p, "axis_deg"), angle_of(p, "retarder_deg"));
  } else if (const auto matrix = p.find("mueller")) {
    return read_matrix(*matrix);
  } else if (p.has("transmission")) {
    e.matrix = Mueller::identity() * p.number_in("transmission", 0, 1, "");
  } else {
    throw p.error("this is no optical element", "polarizer_deg, retarder_deg, retarder_um, mueller or transmission");
  }
  return e;
}

// An angle, or a train.
AnalyserTrain read_cell(const Params& cell, const Params& around) {
  if (cell.kind() == Params::Kind::map) return read_train(cell);
  const double extinction = around.number_in("extinction", 1, kIdeal, "", kIdeal);
  const double tilt = around.number_in("tilt_deg", -360, 360, "degrees", 0);
  OpticalElement e;
  e.matrix = polarizer((cell.as_number_in(-360, 360, "degrees") + tilt) * kDegree,
                       around.find("extinction") ? 1 / extinction : 0);
  return AnalyserTrain({e});
}

}  // namespace

Mueller OpticalElement::at(double wavelength_um) const {
  return path_um != 0 ? retarder(axis, 2 * kPi * path_um / wavelength_um) : matrix;
}

Mueller AnalyserTrain::at(double wavelength_um) const {
  Mueller m = Mueller::identity();
  for (const OpticalElement& e : elements_) m = e.at(wavelength_um) * m;
  return m;
}

bool AnalyserTrain::follows_wavelength() const {
  return std::any_of(elements_.begin(), elements_.end(), [](const OpticalElement& e) { return e.path_um != 0; });
}

Stokes AnalyserTrain::row(const Band& band) const {
  const int steps = follows_wavelength() ? 256 : 1;
  Stokes sum{};
  double weight = 0;
  for (int i = 0; i < steps; ++i) {
    const double um =
        steps == 1 ? band.center_um : band.low_um() + (i + 0.5) / steps * (band.high_um() - band.low_um());
    const double share = steps == 1 ? 1 : band.response.at(um);
    const Mueller m = at(um);
    for (int k = 0; k < 4; ++k) sum[static_cast<size_t>(k)] += share * m(0, k);
    weight += share;
  }
  for (double& s : sum) s /= weight > 0 ? weight : 1;
  return sum;
}

AnalyserTrain read_train(const Params& p) {
  std::vector<OpticalElement> elements;
  if (const auto list = p.find("elements")) {
    for (const Params& item : list->items()) elements.push_back(read_element(item));
    if (elements.empty()) throw list->error("no elements", "leave the analyser out");
    return AnalyserTrain(std::move(elements));
  }
  OpticalElement polarizes;
  polarizes.matrix = read_polarizer(p);
  if (p.has("retarder_deg")) {
    OpticalElement delays;
    delays.matrix = retarder(angle_of(p, "axis_deg"), angle_of(p, "retarder_deg"));
    elements.push_back(delays);
  } else if (const auto axis = p.find("axis_deg")) {
    throw axis->error("there is no retarder", "give retarder_deg, too");
  }
  elements.push_back(polarizes);
  return AnalyserTrain(std::move(elements));
}

Analysers read_analysers(const Params& p) {
  Analysers a;
  if (const auto grid = p.find("grid")) {
    const std::vector<Params> rows = grid->items();
    a.rows = static_cast<uint32_t>(rows.size());
    a.columns = rows.empty() ? 0 : static_cast<uint32_t>(rows[0].items().size());
    if (a.columns == 0) throw grid->error("a grid without polarizers", "grid: [[90, 45], [135, 0]]");
    for (const Params& row : rows) {
      const std::vector<Params> cells = row.items();
      if (cells.size() != a.columns)
        throw row.error(strf("a row of %zu in a grid of %u columns", cells.size(), a.columns), "rows of one length");
      for (const Params& cell : cells) a.trains.push_back(read_cell(cell, p));
    }
  } else if (const auto wheel = p.find("wheel")) {
    a.wheel = true;
    for (const Params& cell : wheel->items()) a.trains.push_back(read_cell(cell, p));
    if (a.trains.empty()) throw wheel->error("a wheel without polarizers", "wheel: [0, 60, 120]");
  } else {
    a.trains.push_back(read_train(p));
  }
  return a;
}

}  // namespace suite
