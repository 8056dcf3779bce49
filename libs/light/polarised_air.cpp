#include "light/polarised_air.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "air/greek_matrix.h"
#include "light/air_loops.h"
#include "math/falling.h"

namespace suite {

using Row = std::vector<float>;

// What one thread needs for a way.
struct PolarisedAir::Scratch {
  // What a kind makes of a beam along the way, 1/sr; empty Q: nothing is known of it.
  struct Once {
    Row I, Q, U;
    bool known = false;
  };
  Row T, depth, keep, even, change, lit;
  Row near[4], far[4];      // source at both ends of a piece
  Row beam_near, beam_far;  // depths
  std::vector<Once> kinds;  // [beam][kind]
  std::vector<PlaneBlocks> blocks;
  double unknown = 0, all = 0;  // light scattered once

  void fit(size_t bins, size_t count) {
    if (T.size() == bins && kinds.size() == count) return;
    for (Row* row : {&T, &depth, &keep, &even, &change, &lit, &beam_near, &beam_far}) row->assign(bins, 0.0f);
    for (Row* rows : {near, far})
      for (size_t part = 0; part < 4; ++part) rows[part].assign(bins, 0.0f);
    kinds.assign(count, {Row(bins), Row(bins), Row(bins), false});
    blocks.resize(bins);
  }
};

PolarisedAir::PolarisedAir(const AirColumn& column, const std::vector<Beam>& beams, const BeamLight& once,
                           std::shared_ptr<const PolarisedSource> source)
    : column_(column),
      beams_(beams),
      once_(once),
      source_(std::move(source)),
      bins_(column.bins),
      parts_(source_ ? source_->shape().parts() : 3) {
  constexpr size_t kMostBins = 500;  // 40 MB a height
  if (beams_.empty() || bins_ > kMostBins) return;
  if (beams_.size() == 1) symmetric_ = azimuth(beams_[0].direction);
  sky_ = std::make_unique<SkyTable>(
      parts_ * bins_ + 1, false, symmetric_, 1000, [this](double height, Dir d, std::span<float> row) {
        const Light to{row.first(bins_), row.subspan(bins_, bins_), row.subspan(2 * bins_, bins_),
                       row.subspan(3 * bins_, tells_v() ? bins_ : 0)};
        row.back() = static_cast<float>(along({0, 0, height}, d, std::numeric_limits<double>::infinity(), to));
      });
}

PolarisedAir::Scratch& PolarisedAir::scratch() const {
  thread_local Scratch s;
  s.fit(bins_, beams_.size() * column_.kinds.size());
  return s;
}

float PolarisedAir::share(size_t l, double height) const {
  const std::span<const double> bounds = column_.shells.heights();
  return static_cast<float>(std::clamp((height - bounds[l]) / (bounds[l + 1] - bounds[l]), 0.0, 1.0));
}

// The matrices of single scattering along the way.
void PolarisedAir::begin(Dir d, Scratch& s) const {
  for (size_t b = 0; b < beams_.size(); ++b) {
    const Dir in = -beams_[b].direction;
    const double cosine = std::clamp(dot(in, -d), -1.0, 1.0);
    const ScatteringPlane plane(-d, -in);
    // Of unpolarised light: what the turn into the meridian makes of the plane's own Q.
    const Stokes turned = plane.matrix({0, 1, 0, 0, 0, 0}) * Stokes{1, 0, 0, 0};
    for (size_t k = 0; k < column_.kinds.size(); ++k) {
      const PhaseFunction& phase = *column_.kinds[k].phase;
      Scratch::Once& to = s.kinds[b * column_.kinds.size() + k];
      const bool uniform = phase.spectrally_uniform();
      phase.eval(cosine, uniform ? std::span(to.I).first(1) : std::span(to.I));
      if (uniform) std::fill(to.I.begin(), to.I.end(), to.I[0]);
      const auto of = phase.polarised(cosine, s.blocks);
      to.known = of.unknown == 0;
      for (size_t i = 0; i < bins_ && to.known; ++i) {
        const double across = double{to.I[i]} * s.blocks[of.grey ? 0 : i].b;
        to.Q[i] = static_cast<float>(turned[1] * across), to.U[i] = static_cast<float>(turned[2] * across);
      }
    }
  }
}

// What the layer has scattered more than once.
void PolarisedAir::pass_again(const Shells::Piece& piece, Vec3 middle, Dir d, Scratch& s, const Light& to) const {
  const size_t parts = to.V.empty() ? 3 : parts_;
  for (size_t part = 0; part < parts; ++part)
    std::fill(s.near[part].begin(), s.near[part].end(), 0.0f), std::fill(s.far[part].begin(), s.far[part].end(), 0.0f);
  const float near = share(piece.layer, piece.near_height), far = share(piece.layer, piece.far_height);
  const PolarisedSource::Place place = source_->place(std::clamp(dot(column_.shells.up(middle), d), -1.0, 1.0));
  for (size_t b = 0; b < beams_.size(); ++b) {
    const double turn = std::atan2(d.y, d.x) - std::atan2(beams_[b].direction.y, beams_[b].direction.x);
    for (size_t m = 0; m < source_->shape().orders; ++m)
      for (size_t part = 0; part < (m == 0 ? 2u : parts); ++part) {
        const double angle = static_cast<double>(m) * turn;
        const auto factor = static_cast<float>(part >= PolarisedSource::u ? std::sin(angle) : std::cos(angle));
        const auto of = static_cast<PolarisedSource::Part>(part);
        const float *rows[2][2], weight[2] = {factor * (1 - place.share), factor * place.share};
        for (size_t end = 0; end < 2; ++end)
          for (size_t c = 0; c < 2; ++c) rows[end][c] = source_->at(b, piece.layer, end, place.first + c, m, of);
        for (size_t i = 0; i < bins_; ++i) {
          const float low = weight[0] * rows[0][0][i] + weight[1] * rows[0][1][i],
                      high = weight[0] * rows[1][0][i] + weight[1] * rows[1][1][i];
          s.near[part][i] += low + near * (high - low), s.far[part][i] += low + far * (high - low);
        }
      }
  }
  const std::span<float> sums[4] = {to.I, to.Q, to.U, to.V};
  for (size_t part = 0; part < parts; ++part)
    for (size_t i = 0; i < bins_; ++i)
      sums[part][i] += s.T[i] * (s.near[part][i] * s.even[i] + (s.far[part][i] - s.near[part][i]) * s.change[i]);
}

// What it scatters of a beam.
void PolarisedAir::pass_once(size_t b, const Shells::Piece& piece, Vec3 from, Dir d, Scratch& s,
                             const Light& to) const {
  if (!once_.depth(b, from + d * piece.near, piece.near_height, s.beam_near) ||
      !once_.depth(b, from + d * piece.far, piece.far_height, s.beam_far))
    return;
  for (size_t i = 0; i < bins_; ++i) {
    const float near = exp_falling(s.beam_near[i]), far = exp_falling(s.beam_far[i] + s.depth[i]);
    const float mean = mean_of_change(near, far, s.beam_far[i] + s.depth[i] - s.beam_near[i]);
    s.lit[i] = s.T[i] * mean * beams_[b].irradiance[i] * static_cast<float>(piece.length);
  }
  for (size_t k = 0; k < column_.kinds.size(); ++k) {
    const Scratch::Once& once = s.kinds[b * column_.kinds.size() + k];
    const float* const scattering = &column_.kinds[k].scattering[piece.layer * bins_];
    double sum = 0;
    for (size_t i = 0; i < bins_; ++i) sum += double{s.lit[i]} * scattering[i] * once.I[i];
    s.all += sum;
    if (!once.known) {
      s.unknown += sum;
      continue;
    }
    for (size_t i = 0; i < bins_; ++i) {
      const float scattered = s.lit[i] * scattering[i];
      to.Q[i] += scattered * once.Q[i], to.U[i] += scattered * once.U[i];
    }
  }
}

double PolarisedAir::along(Vec3 from, Dir d, double distance, const Light& to) const {
  for (const std::span<float>& row : {to.I, to.Q, to.U, to.V}) std::fill(row.begin(), row.end(), 0.0f);
  Scratch& s = scratch();
  s.unknown = s.all = 0;
  std::fill(s.T.begin(), s.T.end(), 1.0f);
  begin(d, s);
  const air_loops::Weights weights{s.depth.data(), s.keep.data(), s.even.data(), s.change.data()};
  column_.shells.walk(from, d, distance, [&](const Shells::Piece& piece) {
    air_loops::weigh(bins_, &column_.extinction[piece.layer * bins_], static_cast<float>(piece.length), weights);
    if (source_) pass_again(piece, from + d * (0.5 * (piece.near + piece.far)), d, s, to);
    for (size_t b = 0; b < beams_.size(); ++b) pass_once(b, piece, from, d, s, to);
    for (size_t i = 0; i < bins_; ++i) s.T[i] *= s.keep[i];
  });
  return s.all > 0 ? s.unknown / s.all : 0;
}

double PolarisedAir::sky(Vec3 from, Dir d, const Light& to) const {
  constexpr double kFar = 3e4;  // m, as of stratified_air.cpp
  const double height = column_.shells.height(from), rise = dot(column_.shells.up(from), d);
  const double level = std::hypot(d.x, d.y), tilt = level > 0 ? std::sqrt(std::max(0.0, 1 - rise * rise)) / level : 0;
  const Dir local{d.x * tilt, d.y * tilt, rise};
  if (!sky_ || std::fabs(from.x) > kFar || std::fabs(from.y) > kFar || !SkyTable::covers(height, local))
    return along(from, d, std::numeric_limits<double>::infinity(), to);
  const float* const row = sky_->drawn(height, local);
  // The table has the side of rising azimuths; on the other one U and V have the other sign.
  const bool other = symmetric_ && std::sin(azimuth(d) - *symmetric_) < 0;
  for (size_t i = 0; i < bins_; ++i) {
    to.I[i] = row[i], to.Q[i] = row[bins_ + i];
    to.U[i] = other ? -row[2 * bins_ + i] : row[2 * bins_ + i];
  }
  for (size_t i = 0; i < to.V.size(); ++i) {
    const float v = tells_v() ? row[3 * bins_ + i] : 0;
    to.V[i] = other ? -v : v;
  }
  return double{row[parts_ * bins_]};
}

}  // namespace suite
