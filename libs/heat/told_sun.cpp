#include "heat/told_sun.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

constexpr uint32_t kStride = 8;        // moments from knot to knot
constexpr double kLeastCosine = 0.02;  // of a knot: what is over the cosine is no number at none

}  // namespace

ToldSun::ToldSun(const SunCourse& course, const std::vector<Frame>& suns, std::vector<uint32_t> sunny, uint32_t points)
    : course_(course), suns_(suns), sunny_(std::move(sunny)) {
  const auto n = static_cast<uint32_t>(sunny_.size());
  for (uint32_t k = 0; k < n; ++k) {
    const Dir d = suns[sunny_[k]].z;
    x_.push_back(static_cast<float>(d.x)), y_.push_back(static_cast<float>(d.y)), z_.push_back(static_cast<float>(d.z));
    if (k % kStride == 0 || k + 1 == n) knots_.push_back({k, {}, {}});
  }
  along_.resize(n, 0.0f);
  for (size_t k = 0; k + 1 < knots_.size(); ++k)
    for (uint32_t m = knots_[k].sunny; m < knots_[k + 1].sunny; ++m)
      along_[m] = static_cast<float>(m - knots_[k].sunny) / static_cast<float>(knots_[k + 1].sunny - knots_[k].sunny);
  if (!course.beam.empty()) w_.resize(course.beam.front().size());
  // As if half a point more had been lit and half a one dark: what all or none of the points see is not certain.
  for (size_t lit = 0; lit < asked_.size(); ++lit) {
    const double share = (static_cast<double>(lit) / 255 * points + 0.5) / (1.0 + points);
    asked_[lit] = 2 * std::sqrt(share * (1 - share));
  }
}

void ToldSun::tell(const Interaction& at, Dir out, std::span<const float> T, const uint8_t* lit, const uint8_t* beyond,
                   std::span<float> told) {
  std::ranges::fill(told, 0.0f);
  const ScatterModel& model = *at.baked->model;
  const bool opaque = model.opaque() || !beyond;
  const double up = out.z > 0 ? 1 : -1;
  for (Knot& knot : knots_) {
    const uint32_t moment = sunny_[knot.sunny];
    const Dir in = at.frame.to_local(suns_[moment].z);
    const size_t side = in.z * up > 0 ? 0 : 1;
    knot.known[0] = knot.known[1] = false;
    if (std::fabs(in.z) < kLeastCosine || (side == 0 ? !lit : opaque)) continue;
    const std::vector<float>& beam = course_.beam[moment];
    float sum = 0;
    if (const auto f = model.factored(out, in)) {
      for (size_t i = 0; i < T.size(); ++i) sum += T[i] * f->spectrum[i] * beam[i];
      sum *= f->scale;
    } else {
      model.eval(out, in, w_);
      for (size_t i = 0; i < T.size(); ++i) sum += T[i] * w_[i] * beam[i];
    }
    knot.known[side] = true, knot.sends[side] = sum / static_cast<float>(std::fabs(in.z));
  }
  if (lit && fill(0)) add(at.frame.z * up, 0, lit, told);
  if (!opaque && fill(1)) add(at.frame.z * -up, 1, beyond, told);
}

// Knots at which the sun is on the other side have what the next one has. False: all of them.
bool ToldSun::fill(size_t side) {
  const auto pass = [side](auto begin, auto end) {
    for (auto k = begin; k != end; ++k)
      if (auto next = k + 1; k->known[side] && next != end && !next->known[side])
        next->known[side] = true, next->sends[side] = k->sends[side];
  };
  pass(knots_.begin(), knots_.end());
  pass(knots_.rbegin(), knots_.rend());
  return !knots_.empty() && knots_.front().known[side];
}

void ToldSun::add(const Vec3& normal, size_t side, const uint8_t* lit, std::span<float> told) const {
  const auto nx = static_cast<float>(normal.x), ny = static_cast<float>(normal.y), nz = static_cast<float>(normal.z);
  for (size_t k = 0; k < knots_.size(); ++k) {
    const float from = knots_[k].sends[side] / 255;
    const bool last = k + 1 == knots_.size();
    const float more = last ? 0 : knots_[k + 1].sends[side] / 255 - from;
    const uint32_t end = last ? static_cast<uint32_t>(sunny_.size()) : knots_[k + 1].sunny;
    for (uint32_t m = knots_[k].sunny; m < end; ++m) {
      const float cosine = nx * x_[m] + ny * y_[m] + nz * z_[m];
      told[m] += static_cast<float>(lit[m]) * std::max(0.0f, cosine) * (from + more * along_[m]);
    }
  }
}

}  // namespace suite
