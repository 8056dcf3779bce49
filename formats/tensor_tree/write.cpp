#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/error.h"
#include "base/parallel.h"
#include "formats/tensor_tree/tensor_tree.h"

namespace suite {

namespace {

// Points of the unit square and of the unit disk (Shirley & Chiu, the quadrants cut along the diagonals).
std::array<double, 2> disk_of(double x, double y) {
  const double a = 2 * x - 1, b = 2 * y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = std::fabs(a) > std::fabs(b);
  const double r = wide ? a : b, phi = wide ? kPi / 4 * b / a : kPi / 2 - kPi / 4 * a / b;
  return {r * std::cos(phi), r * std::sin(phi)};
}
std::array<double, 2> square_of(double x, double y) {
  const double r = std::hypot(x, y);
  double phi = std::atan2(y, x);
  if (phi < -kPi / 4) phi += 2 * kPi;
  const int quarter = std::min(3, static_cast<int>((phi + kPi / 4) / (kPi / 2)));
  const double along = (phi - quarter * kPi / 2) * r / (kPi / 4);
  const double a = quarter == 0 ? r : quarter == 1 ? -along : quarter == 2 ? -r : along;
  const double b = quarter == 0 ? along : quarter == 1 ? r : quarter == 2 ? -along : -r;
  return {0.5 * (a + 1), 0.5 * (b + 1)};
}

Dir raised(const std::array<double, 2>& disk) {
  return {disk[0], disk[1], std::sqrt(std::max(0.0, 1 - disk[0] * disk[0] - disk[1] * disk[1]))};
}

// Of a pair at a position of the hypercube, rank 3: the incident direction at azimuth pi, (1 - sin theta) / 2 its
// coordinate.
std::pair<Dir, Dir> directions(const std::array<double, 4>& p, size_t rank) {
  if (rank == 3) {
    const double sine = std::min(1.0, 1 - 2 * p[0]);
    return {raised(disk_of(p[1], p[2])), raised({-sine, 0})};
  }
  const auto in = disk_of(p[0], p[1]);
  return {raised(disk_of(p[2], p[3])), raised({-in[0], -in[1]})};
}

}  // namespace

TensorTree::TensorTree(const sqt::Function& function, size_t channel, int levels, double merge)
    : info_(function.info()), rank_(info_.isotropic ? 3 : 4), side_(size_t{1} << levels) {
  if (info_.domain != sqt::Domain::hemisphere || info_.quantity != sqt::Quantity::bsdf)
    throw Error("'" + info_.name + "' is no BRDF over the hemisphere: a tensor tree is written of nothing else",
                "write .csv");
  info_.wavelength_um = {info_.wavelength_um.at(channel)};
  info_.channel_names.clear();
  size_t cells = 1;
  for (size_t i = 0; i < rank_; ++i) cells *= side_;
  cells_.assign(cells, 0);
  fill(function, channel);
  put({}, side_, merge);
}

size_t TensorTree::index(const Place& place) const {
  size_t at = 0;
  for (size_t i = 0; i < rank_; ++i) at = at * side_ + place[i];
  return at;
}

// Means of the function over cells, from 2^rank points of each; the half of rank 3 that no direction has stays 0.
void TensorTree::fill(const sqt::Function& function, size_t channel) {
  const size_t first = rank_ == 3 ? cells_.size() / 2 : cells_.size(), points = size_t{1} << rank_;
  parallel_for(0, first, 256, [&](size_t begin, size_t end) {
    std::vector<double> f(function.info().wavelength_um.size());
    for (size_t n = begin; n < end; ++n) {
      double sum = 0;
      for (size_t k = 0; k < points; ++k) {
        std::array<double, 4> p{};
        size_t rest = n;
        for (size_t i = rank_; i-- > 0; rest /= side_)
          p[i] = (static_cast<double>(rest % side_) + (k >> i & 1 ? 0.75 : 0.25)) / static_cast<double>(side_);
        const auto [out, in] = directions(p, rank_);
        function.value(out, in, f);
        if (f[channel] > 0) sum += f[channel];  // nan: no data
      }
      cells_[n] = sum / static_cast<double>(points);
    }
  });
}

void TensorTree::put(const Place& first, size_t width, double merge) {
  double low = INFINITY, high = 0, sum = 0;
  size_t count = 1;
  for (size_t i = 0; i < rank_; ++i) count *= width;
  auto cell = [&](size_t n) -> double& {
    Place place = first;
    for (size_t i = rank_; i-- > 0; n /= width) place[i] += n % width;
    return cells_[index(place)];
  };
  for (size_t n = 0; n < count; ++n) {
    const double v = cell(n);
    low = std::min(low, v), high = std::max(high, v), sum += v;
  }
  // What is written is what the tree has: six digits.
  auto written = [this](double v) {
    const std::string digits = strf("%.6g", v);
    text_ += digits, ++leaves_;
    return std::strtod(digits.c_str(), nullptr);
  };
  text_ += '{';
  if (high - low <= merge * high) {
    const double v = written(sum / static_cast<double>(count));
    for (size_t n = 0; n < count; ++n) cell(n) = v;
  } else if (width == 2) {
    for (size_t n = 0; n < count; ++n) {
      if (n) text_ += ' ';
      cell(n) = written(cell(n));
    }
  } else {
    for (size_t branch = 0; branch < size_t{1} << rank_; ++branch) {  // bit i: the upper half of coordinate i
      Place at = first;
      for (size_t i = 0; i < rank_; ++i) at[i] += (branch >> i & 1) * (width / 2);
      put(at, width / 2, merge);
    }
  }
  text_ += "}\n";
}

std::array<double, 4> TensorTree::position(Dir out, Dir in) const {
  if (rank_ == 4) {
    const auto i = square_of(-in.x, -in.y), o = square_of(out.x, out.y);
    return {i[0], i[1], o[0], o[1]};
  }
  // Turn both so that the incident direction has azimuth pi.
  const double sine = std::hypot(in.x, in.y), c = sine > 0 ? -in.x / sine : 1, s = sine > 0 ? -in.y / sine : 0;
  const auto o = square_of(c * out.x + s * out.y, c * out.y - s * out.x);
  return {std::max(0.0, 0.5 - 1e-6 - 0.5 * sine), o[0], o[1], 0};
}

void TensorTree::value(Dir out, Dir in, std::span<double> f) const {
  f[0] = 0;
  if (!(out.z > 0 && in.z > 0)) return;
  const std::array<double, 4> p = position(out, in);
  Place place{};
  for (size_t i = 0; i < rank_; ++i)
    place[i] = std::min(side_ - 1, static_cast<size_t>(std::max(0.0, p[i]) * static_cast<double>(side_)));
  f[0] = cells_[index(place)];
}

std::string TensorTree::xml(const std::string& comment) const {
  auto safe = [](std::string text) {
    std::string out;
    for (const char c : text)
      if (c == '&')
        out += "&amp;";
      else if (c == '<')
        out += "&lt;";
      else if (c == '-' && !out.empty() && out.back() == '-')
        out += " -";  // two hyphens end a comment
      else
        out += c;
    return out;
  };
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- " + safe(comment) +
         " -->\n<WindowElement xmlns=\"http://windows.lbl.gov\">\n<WindowElementType>System</WindowElementType>\n"
         "<Optical>\n<Layer>\n<Material><Name>" +
         safe(info_.name) +
         "</Name><Manufacturer>none</Manufacturer><DeviceType>Other</DeviceType></Material>\n"
         "<DataDefinition><IncidentDataStructure>TensorTree" +
         strf("%zu", rank_) +
         "</IncidentDataStructure></DataDefinition>\n<WavelengthData>\n<LayerNumber>System</LayerNumber>\n"
         "<Wavelength unit=\"Integral\">Visible</Wavelength>\n<WavelengthDataBlock>\n"
         "<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>\n"
         "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n<ScatteringDataType>BRDF</ScatteringDataType>\n"
         "<ScatteringData>\n" +
         text_ +
         "</ScatteringData>\n</WavelengthDataBlock>\n</WavelengthData>\n</Layer>\n</Optical>\n</WindowElement>\n";
}

}  // namespace suite
