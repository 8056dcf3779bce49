#include "optics/models/rough_interface.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "optics/fresnel.h"
#include "optics/models/microsurface_walk.h"
#include "optics/models/shared_tables.h"

namespace suite {

namespace {

constexpr size_t kPoints = 8192, kWalksThroughInterface = 1024;
// Rows of the upper side, even in the root of the cosine; of the lower side before the critical angle, even in the root
// of the cosine of the refracted direction; and beyond it, dense at both ends.
constexpr double kUpper = 128, kRefracted = 96, kTotal = 96;

size_t rows_of(int side) { return static_cast<size_t>(side == 0 ? kUpper : kRefracted + kTotal) + 1; }

struct At {
  size_t row;
  double t;
};
At at(double place, int side) {
  const size_t row = std::min(rows_of(side) - 2, static_cast<size_t>(place));
  return {row, place - static_cast<double>(row)};
}
double between(const std::vector<float>& rows, At a) { return rows[a.row] * (1 - a.t) + rows[a.row + 1] * a.t; }

}  // namespace

std::shared_ptr<const RoughInterface> RoughInterface::of(Kind kind) {
  static SharedTables<Kind, RoughInterface> tables;
  return tables.get(kind);
}

// Eight to an octave of index - 1.
double RoughInterface::node(int n) { return 1 + std::exp2(n / 8.0); }
int RoughInterface::node_below(double index) {
  int n = static_cast<int>(std::floor(8 * std::log2(index - 1)));
  while (node(n) > index) --n;
  while (node(n + 1) <= index) ++n;
  return n;
}

double RoughInterface::place(int side, double mu, double index) const {
  if (side == 0) return kUpper * (1 - std::sqrt(mu));
  const double sine2 = (1 - mu) * (1 + mu) * index * index;  // of the refracted direction
  if (sine2 < 1) return kRefracted * (1 - std::sqrt(std::sqrt(1 - sine2)));
  const double y = std::min(1.0, mu * mu / (1 - 1 / (index * index)));
  return kRefracted + kTotal * (2 / kPi) * std::acos(std::sqrt(std::sqrt(y)));
}

double RoughInterface::cosine(int side, double place) const {
  if (side == 0) return (1 - place / kUpper) * (1 - place / kUpper);
  if (place <= kRefracted) {
    const double root = 1 - place / kRefracted, c = root * root;
    return std::sqrt(1 - (1 - c) * (1 + c) / (index_ * index_));
  }
  const double c = std::cos(kPi / 2 * std::min(1.0, (place - kRefracted) / kTotal));
  return c * c * std::sqrt(1 - 1 / (index_ * index_));
}

RoughInterface::RoughInterface(Kind kind) : facets_{kind.roughness, kind.roughness}, index_(kind.index) {
  Rows rows;
  for (const int side : {0, 1}) {
    std::vector<Row>& mine = rows[static_cast<size_t>(side)];
    mine.resize(rows_of(side));
    parallel_for(0, mine.size(), 4, [&](size_t begin, size_t end) {
      // The last row stands just above the horizon.
      for (size_t r = begin; r < end; ++r)
        mine[r] = make_row(side, std::max(1e-6, cosine(side, static_cast<double>(r))), r);
    });
  }
  close(rows);
}

RoughInterface::Row RoughInterface::make_row(int side, double mu, size_t number) const {
  static const auto samples = baking_samples<Ggx>(kPoints);
  const Dir o{std::sqrt((1 - mu) * (1 + mu)), 0, mu};
  const double eta = side == 0 ? index_ : 1 / index_, masking = facets_.masking(o);
  Row row;
  const Ggx::View view(facets_, o);
  for (const Ggx::Sample& sample : samples) {
    const Dir h = view.normal(sample);
    const double c = std::min(1.0, dot(o, h));
    if (!(c > 0)) continue;
    const Fresnel f = fresnel_dielectric(c, eta);
    const Dir r = h * (2 * c) - o, t = h * (c / eta - f.cos_transmitted) - o / eta;
    if (r.z > 0) row.reflected_once += f.reflectance * facets_.shadowing(o, r) / masking / kPoints;
    if (!(f.transmittance > 0 && t.z < 0)) continue;
    const Shadowing s = shadowing_across(facets_, o, {t.x, t.y, -t.z});
    row.passed_walked += f.transmittance * s.walked / masking / kPoints;
    row.passed_most += f.transmittance * s.most / masking / kPoints;
  }
  walk(side, o, 2 * number + static_cast<uint64_t>(side), row);
  return row;
}

void RoughInterface::walk(int side, Dir out, uint64_t seed, Row& row) const {
  Pcg32 random(seed, 0x726f7567);
  for (size_t n = 0; n < kWalksThroughInterface; ++n) {
    MicrosurfaceWalk light(facets_, out);
    int met = 0, passed = 0;
    for (; met < kMostFacets; ++met) {
      const auto h = light.next(random);
      if (!h) break;
      const bool lower = (side == 1) != (passed % 2 == 1);
      const double eta = lower ? 1 / index_ : index_;
      const Fresnel f = fresnel_dielectric(light.cosine(*h), eta);
      if (random.uniform() < f.reflectance || f.transmittance == 0)
        light.reflect(*h);
      else
        light.refract(*h, eta, f.cos_transmitted), ++passed;
    }
    if (met < 2) continue;
    row.again += 1.0 / kWalksThroughInterface;
    if (passed % 2 == 0) row.again_reflected += 1.0 / kWalksThroughInterface;
    if (passed == met && passed % 2 == 1) row.refracted_only += 1.0 / kWalksThroughInterface;
  }
}

template <class F>
double RoughInterface::integral(int side, const F& of_row) const {
  constexpr int steps = 8;
  double sum = 0;
  for (size_t r = 0; r + 1 < rows_of(side); ++r)
    for (int s = 0; s < steps; ++s) {
      const double t = static_cast<double>(s) / steps, high = cosine(side, static_cast<double>(r) + t),
                   low = cosine(side, static_cast<double>(r) + t + 1.0 / steps), middle = t + 0.5 / steps;
      sum += kPi * (high - low) * (high + low) * (of_row(r) * (1 - middle) + of_row(r + 1) * middle);
    }
  return sum;
}

// Chooses `straight`, divides what is missing into what is reflected and what passes, and makes the passages of both
// sides equal.
void RoughInterface::close(const Rows& rows) {
  double refracted = 0, room = 0;
  for (const int side : {0, 1}) {
    const std::vector<Row>& mine = rows[static_cast<size_t>(side)];
    const double scale = side == 0 ? 1 : index_ * index_;
    refracted += scale * integral(side, [&](size_t r) { return mine[r].refracted_only; });
    room += scale * integral(side, [&](size_t r) { return mine[r].passed_most - mine[r].passed_walked; });
  }
  straight_ = room > 0 ? std::min(1.0, refracted / room) : 1;

  std::array<double, 2> passage{};
  for (const size_t side : {0, 1}) {
    const std::vector<Row>& mine = rows[side];
    for (size_t r = 0; r < mine.size(); ++r) {
      // The walks' share of reflection, smoothed over neighbouring rows.
      constexpr int reach = 8;
      double again = 0, back = 0;
      for (int k = -reach; k <= reach; ++k) {
        const auto n = std::clamp<long>(static_cast<long>(r) + k, 0, static_cast<long>(mine.size()) - 1);
        const double weight = reach + 1 - std::abs(k);
        again += weight * mine[static_cast<size_t>(n)].again;
        back += weight * mine[static_cast<size_t>(n)].again_reflected;
      }
      const Row& row = mine[r];
      const double walked = 1 - row.reflected_once - row.passed_walked,
                   missed = std::max(0.0, walked - straight_ * (row.passed_most - row.passed_walked)),
                   reflected = std::min(missed, again > 0 ? walked * back / again : 0);
      missed_[side].push_back(static_cast<float>(missed));
      through_[side].push_back(static_cast<float>((missed - reflected) * (side == 0 ? 1 : index_ * index_)));
    }
    passage[side] = integral(static_cast<int>(side), [&](size_t r) { return through_[side][r]; });
    missed_integral_[side] = integral(static_cast<int>(side), [&](size_t r) { return missed_[side][r]; });
  }
  through_integral_ = std::min(passage[0], passage[1]);
  for (const size_t side : {0, 1})
    for (size_t r = 0; r < rows[side].size(); ++r) {
      float& through = through_[side][r];
      if (passage[side] > 0) through *= static_cast<float>(through_integral_ / passage[side]);
      const double scale = side == 0 ? 1 : index_ * index_;
      reflected_[side].push_back(static_cast<float>(rows[side][r].reflected_once + missed_[side][r] - through / scale));
    }
}

double RoughInterface::reflected(int side, double mu, double index) const {
  return between(reflected_[static_cast<size_t>(side)], at(place(side, mu, index), side));
}

RoughInterface::Again RoughInterface::again(int side, double mu) const {
  const At a = at(place(side, mu, index_), side);
  return {between(missed_[static_cast<size_t>(side)], a), between(through_[static_cast<size_t>(side)], a)};
}

}  // namespace suite
