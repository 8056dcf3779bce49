#include "air/beam_table.h"

#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

// The shells of n r. Height zero keeps its name, so that the first ones differ little.
Shells straightened_shells(const Shells& shells, std::span<const double> refractivity) {
  if (refractivity.empty()) return shells;
  SUITE_CHECK_EQ(refractivity.size(), shells.heights().size());
  SUITE_CHECK(shells.curvature() > 0);
  const double radius = 1 / shells.curvature();
  std::vector<double> heights;
  for (size_t i = 0; i < refractivity.size(); ++i) {
    const double h = shells.heights()[i];
    heights.push_back(h + refractivity[i] * (radius + h));
    if (i > 0 && !(heights[i] > heights[i - 1]))
      throw Error(
          strf("above %g m the air thins out so fast that it leads light around the Earth", shells.heights()[i - 1]),
          "a smoother profile, or none of refraction");
  }
  return Shells::round({0, 0, -radius}, radius, std::move(heights));
}

}  // namespace

bool beam_depth(const Shells& shells, double ground, std::span<const float> extinction, Vec3 from, Dir to_source,
                std::span<double> depth) {
  const double inf = std::numeric_limits<double>::infinity();
  const bool rises = dot(shells.up(from), to_source) >= 0;
  if (shells.curvature() == 0 ? !(to_source.z > 0) : !rises && shells.lowest_height(from, to_source, inf) < ground)
    return false;
  std::fill(depth.begin(), depth.end(), 0.0);
  shells.walk(from, to_source, inf, [&](const Shells::Piece& p) {
    const float* e = &extinction[p.layer * depth.size()];
    for (size_t bin = 0; bin < depth.size(); ++bin) depth[bin] += p.length * static_cast<double>(e[bin]);
  });
  return true;
}

BeamTable::BeamTable(const Shells& shells, double ground, std::span<const float> extinction, size_t bins,
                     std::span<const double> refractivity, size_t nodes)
    : heights_(shells.heights().begin(), shells.heights().end()),
      shells_(straightened_shells(shells, refractivity)),
      bent_(!refractivity.empty()),
      ground_(straightened(ground)),
      bins_(bins + bent_),
      nodes_(nodes) {
  SUITE_CHECK_EQ(extinction.size(), shells.layers() * bins);
  SUITE_CHECK_LE(size_t{4}, nodes);
  if (!(1 + shells_.curvature() * ground_ > 0)) throw Error(strf("the ground lies at %g m, below the centre", ground));
  // Layers hold as much as before, and of bending -n' / n r n for a ray of n r sin(theta) = 1.
  for (size_t l = 0; l < shells.layers(); ++l) {
    const double thickness = shells_.heights()[l + 1] - shells_.heights()[l], dh = heights_[l + 1] - heights_[l];
    for (size_t bin = 0; bin < bins; ++bin)
      extinction_.push_back(static_cast<float>(extinction[l * bins + bin] * (dh / thickness)));
    if (!bent_) continue;
    const double n = 1 + 0.5 * (refractivity[l] + refractivity[l + 1]);
    const double x = 1 / shells_.curvature() + 0.5 * (shells_.heights()[l] + shells_.heights()[l + 1]);
    // Over the radius, so that it is no tiny number: n r sin(theta) is to be taken in it as well.
    extinction_.push_back(
        static_cast<float>((refractivity[l] - refractivity[l + 1]) / (n * thickness * x * shells_.curvature())));
  }
  tabulate();
}

void BeamTable::tabulate() {
  const bool round = shells_.curvature() > 0;
  up_.resize(shells_.layers() * nodes_ * bins_);
  low_.resize(round ? up_.size() : 0);
  // Points above height zero stand for their height anywhere.
  for (size_t k = 0; round && k < shells_.layers(); ++k) {
    scale_.push_back(std::sqrt(2 * shells_.curvature() * (shells_.heights()[k + 1] - shells_.heights()[k])));
    stretch_.push_back(1 / std::asinh(1 / scale_[k]));
  }
  scale_.resize(shells_.layers());
  std::vector<double> sums(bins_);
  const auto from = [&](double height, double sine, double cosine) {
    beam_depth(shells_, -std::numeric_limits<double>::infinity(), extinction_, shells_.above_zero(height),
               {sine, 0, cosine}, sums);
  };
  for (size_t k = 0; k < shells_.layers(); ++k)
    for (size_t i = 0; i < nodes_; ++i) {
      float* const node = &up_[(k * nodes_ + i) * bins_];
      const double x = static_cast<double>(i) / static_cast<double>(nodes_ - 1), s = scale_[k];
      const double cosine = round ? std::min(1.0, s * std::sinh(x / stretch_[k])) : 1;
      from(shells_.heights()[k], std::sqrt(1 - cosine * cosine), cosine);
      for (size_t bin = 0; bin < bins_; ++bin) node[bin] = static_cast<float>(sums[bin] * std::hypot(cosine, s));
      if (!round) continue;
      const double top = shells_.heights()[k + 1], height = top - x * x * (top - std::min(top, bottom(k)));
      from(height, 1, 0);
      std::copy(sums.begin(), sums.end(), &low_[(k * nodes_ + i) * bins_]);
    }
}

// Linear within each layer, as n r nearly is.
double BeamTable::straightened(double height) const {
  if (!bent_) return height;
  const std::span<const double> to = shells_.heights();
  const auto next = std::upper_bound(heights_.begin() + 1, heights_.end() - 1, height);
  const size_t i = static_cast<size_t>(next - heights_.begin());
  if (height >= heights_.back()) return to.back() + (height - heights_.back());
  return to[i - 1] + (height - heights_[i - 1]) * (to[i] - to[i - 1]) / (heights_[i] - heights_[i - 1]);
}

// The cubic through the four nodes about a place.
BeamTable::Nodes BeamTable::nodes_at(const std::vector<float>& table, size_t row, double x, double factor) const {
  const double at = std::clamp(x, 0.0, 1.0) * static_cast<double>(nodes_ - 1);
  const size_t first = std::clamp<size_t>(static_cast<size_t>(at), 1, nodes_ - 3) - 1;
  const double a = at - static_cast<double>(first), b = a - 1, c = a - 2, d = a - 3, f = factor / 6;
  return {&table[(row * nodes_ + first) * bins_],
          {static_cast<float>(-f * b * c * d), static_cast<float>(3 * f * a * c * d),
           static_cast<float>(-3 * f * a * b * d), static_cast<float>(f * a * b * c)}};
}

void BeamTable::add_nodes(const Nodes& nodes, Part part) const {
  const float* const a = nodes.first + part.first;
  const float *const b = a + bins_, *const c = b + bins_, *const d = c + bins_;
  const auto [wa, wb, wc, wd] = nodes.weight;
  float* __restrict const depth = part.depth.data();
  for (size_t bin = 0; bin < part.depth.size(); ++bin)
    depth[bin] += wa * a[bin] + wb * b[bin] + wc * c[bin] + wd * d[bin];
}

void BeamTable::add_up(double height, double cosine, float factor, Part part) const {
  const size_t l = shells_.layer_of(height);
  if (l == shells_.layers()) return;
  // To the layer's upper boundary, and the cosine there.
  const double k = shells_.curvature(), top = shells_.heights()[l + 1], slope = cosine * (1 + k * height);
  const double below = (top - height) * (1 + 0.5 * k * (top + height)), root = std::sqrt(slope * slope + 2 * k * below);
  const float way = factor * static_cast<float>(2 * below / (slope + root));
  const float* const e = &extinction_[l * bins_ + part.first];
  float* __restrict const depth = part.depth.data();
  for (size_t bin = 0; bin < part.depth.size(); ++bin) depth[bin] += way * e[bin];
  if (l + 1 == shells_.layers()) return;
  const double there = std::min(1.0, root / (1 + k * top)), s = scale_[l + 1];
  const double x = k > 0 ? std::asinh(there / s) * stretch_[l + 1] : 1;
  add_nodes(nodes_at(up_, l + 1, x, static_cast<double>(factor) / std::sqrt(there * there + s * s)), part);
}

void BeamTable::add_lowest(double height, float factor, Part part) const {
  const size_t l = shells_.layer_of(height);
  if (l == shells_.layers()) return;
  const double top = shells_.heights()[l + 1];
  const double x = std::sqrt((top - height) / (top - std::min(top, bottom(l))));
  add_nodes(nodes_at(low_, l, x, static_cast<double>(factor)), part);
}

bool BeamTable::straight_depth(double height, double cosine, Part part) const {
  const double k = shells_.curvature();
  double lowest = height;
  if (k == 0) {
    if (!(cosine > 0)) return false;
  } else if (cosine < 0) {
    const double level = height * (1 + 0.5 * k * height), slope = cosine * (1 + k * height);
    const double low = level - 0.5 * slope * slope / k;
    lowest = 2 * low / (1 + std::sqrt(std::max(0.0, 1 + 2 * k * low)));
    // Rounding must not hide what just touches the ground.
    if (lowest < ground_ - 1e-6) return false;
    lowest = std::max(lowest, std::min(ground_, height));
  }
  std::fill(part.depth.begin(), part.depth.end(), 0.0f);
  if (cosine < 0) add_lowest(lowest, 2, part);
  add_up(height, std::fabs(cosine), cosine < 0 ? -1.0f : 1.0f, part);
  return true;
}

double BeamTable::bending(double height, double zenith) const {
  float depth = 0;
  straight_depth(height, std::cos(zenith), {bins_ - 1, {&depth, 1}});
  return static_cast<double>(depth) * std::sin(zenith) * (1 + shells_.curvature() * height);
}

// The greatest angle, where the ray just touches the ground; a place below the ground sees nothing below the
// horizontal.
double BeamTable::horizon(double height) const {
  const double k = shells_.curvature();
  return height > ground_ ? kPi - std::asin(std::min(1.0, (1 + k * ground_) / (1 + k * height))) : kPi / 2;
}

std::optional<double> BeamTable::seen_from(double height, double cosine) const {
  const double zenith = std::acos(std::clamp(cosine, -1.0, 1.0));
  double low = 0, high = kPi / 2;
  if (cosine < 0) {
    high = horizon(height);
    if (high + bending(height, high) < zenith) return std::nullopt;
  }
  // Bending grows with the angle, by less than it: secants that stay between what is too low and too high.
  double a = std::min(zenith, high), before = a, off_before = 0;
  for (int i = 0; i < 40; ++i) {
    const double off = a + bending(height, a) - zenith;
    if (std::fabs(off) < 1e-7) break;
    (off > 0 ? high : low) = a;
    const double slope = i > 0 && a != before ? (off - off_before) / (a - before) : 1;
    const double next = slope > 0.5 ? a - off / slope : a - off;
    before = a, off_before = off;
    a = next > low && next < high ? next : 0.5 * (low + high);
  }
  return std::cos(a);
}

std::optional<double> BeamTable::seen(double height, double cosine) const {
  if (bent_) return seen_from(straightened(height), cosine);
  float none;
  return straight_depth(height, cosine, {0, {&none, 0}}) ? std::optional(cosine) : std::nullopt;
}

bool BeamTable::bent_depth(double height, double cosine, bool spread, std::span<float> depth) const {
  SUITE_CHECK_EQ(depth.size(), bins_ - bent_);
  if (!bent_) return straight_depth(height, cosine, {0, depth});
  const double h = straightened(height);
  const std::optional<double> direction = seen_from(h, cosine);
  if (!direction || !straight_depth(h, *direction, {0, depth})) return false;
  const double a = std::acos(*direction);
  constexpr double kStep = 2e-3, kHigh = 0.1;  // rad; below kHigh from the zenith nothing is spread
  if (!spread || a < kHigh) return true;
  const double low = a - kStep, high = std::min(a + kStep, horizon(h));
  const double slope = 1 + (bending(h, high) - bending(h, low)) / (high - low);
  const auto wider = static_cast<float>(std::log(slope * std::sin(a + bending(h, a)) / std::sin(a)));
  for (float& d : depth) d += wider;
  return true;
}

bool BeamTable::depth(double height, double cosine, std::span<float> depth) const {
  return bent_depth(height, cosine, false, depth);
}
bool BeamTable::spread_depth(double height, double cosine, std::span<float> depth) const {
  return bent_depth(height, cosine, true, depth);
}

}  // namespace suite
