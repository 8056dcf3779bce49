#include "light/stratified_air.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <mutex>
#include <utility>

#include "air/beam_table.h"
#include "air/column.h"
#include "air/diffuse_field.h"
#include "base/parallel.h"
#include "light/air_loops.h"
#include "light/air_scratch.h"
#include "light/air_vertices.h"
#include "light/beam_light.h"
#include "light/polarised_air.h"
#include "light/sky_table.h"
#include "light/thin_bins.h"
#include "math/quick_angle.h"

namespace suite {

namespace {

using Row = std::vector<float>;
using Scratch = AirScratch;

class StratifiedAir final : public Atmosphere {
 public:
  StratifiedAir(const AirSpec& spec, std::shared_ptr<const AirColumn> column, const SpectralState& state,
                std::vector<Beam> beams)
      : made_(std::move(column)), column_(*made_), beams_(std::move(beams)), bins_(column_.bins), knots_(state.knots) {
    const std::span<const double> heights = column_.shells.heights();
    bounds_.assign(heights.begin(), heights.end());
    std::vector<AirBeam> from;
    for (const Beam& beam : beams_) {
      tables_.push_back(bake_beam_table(spec, column_));
      from.push_back({beam.direction, beam.irradiance});
    }
    bake_emission();
    if (tables_.empty() && column_.refractivity.empty()) tables_.push_back(bake_beam_table(spec, column_));
    DiffuseReport even;
    if (spec.scattering == AirScattering::diffuse)
      diffuse_ = solve_diffuse_field(spec, column_, state, from, tables_, &even);
    tabulate_sky();
    make_polarised_ = [this, spec, state, from](StokesParts parts) { return polarised(spec, state, from, parts); };
    if (diffuse_ && spec.adjacency) place_vertices(state, std::move(even.up));
  }

  void transmittance(Vec3 from, Dir d, double distance, std::span<float> T) const override {
    if (bent(distance)) return arrive(from, d, T);
    if (distance == std::numeric_limits<double>::infinity() && outwards(from, d, T)) return;
    std::fill(T.begin(), T.end(), 0.0f);
    column_.shells.walk(from, d, distance, [&](const Shells::Piece& piece) {
      const float* __restrict k = &column_.extinction[piece.layer * bins_];
      float* __restrict depth = T.data();
      const auto length = static_cast<float>(piece.length);
      for (size_t i = 0; i < bins_; ++i) depth[i] += k[i] * length;
    });
    for (float& t : T) t = exp_falling(t);
  }

  void path(Vec3 from, Dir d, double distance, std::span<float> T, std::span<float> S) const override {
    const Vec3 end = from + d * distance;
    if (!seen_from_above(from, d, end)) {
      if (!pass_at_once(from, d, distance, T, S)) integrate(from, d, distance, T, S, kAll);
      return;
    }
    if (!outwards(end, -d, T)) transmittance(from, d, distance, T);
    view_->radiance(column_.shells.height(end), to_local(end, -d), S);
  }

  // Aureoles fall with the angle, and ways grow towards the horizon.
  double steepness(Dir d) const override {
    double sum = 1 + 1 / std::fabs(d.z);
    for (const Beam& beam : beams_) sum += 1 / length(d - beam.direction);
    return sum;
  }

  bool parts(Vec3 from, Dir d, double distance, const Parts& p) const override {
    integrate(from, d, distance, p.transmittance, p.thermal, {true, false, false});
    integrate(from, d, distance, p.transmittance, p.single, {false, true, false});
    integrate(from, d, distance, p.transmittance, p.multiple, {false, false, true});
    return true;
  }
  double water(Vec3 from, Dir d, double distance) const override {
    double sum = 0;
    column_.shells.walk(from, d, distance,
                        [&](const Shells::Piece& piece) { sum += column_.water[piece.layer] * piece.length; });
    return sum;
  }

 private:
  // Tables are those of the scene's origin; so far from it the sun stands as there, within 0.3 degrees.
  static bool near_origin(Vec3 p) {
    constexpr double kFar = 3e4;  // m
    return std::fabs(p.x) < kFar && std::fabs(p.y) < kFar;
  }
  // A direction in the frame of the local vertical; azimuths are the scene's.
  Dir to_local(Vec3 p, Dir d) const {
    const Dir up = column_.shells.up(p);
    const double across = 1 - up.x * up.x;
    if (across < 0.5) return Frame::with_tangent(up, {1, 0, 0}).to_local(d);
    const double scale = 1 / std::sqrt(across), rise = dot(up, d);
    return {(d.x - up.x * rise) * scale, (up.z * d.y - up.y * d.z) * scale, rise};
  }
  // Whether a way comes through all of the air down to a place where the table of views holds, and not too slant.
  bool seen_from_above(Vec3 from, Dir d, Vec3 end) const {
    constexpr double kSlant = 0.17;
    return d.z < -kSlant && near_origin(end) && column_.shells.height(from) >= bounds_.back() &&
           SkyTable::covers(column_.shells.height(end), -d);
  }
  // What of the light is wanted.
  struct Which {
    bool thermal, single, multiple;
  };
  static constexpr Which kAll{true, true, true};
  // path() of most ways in and over a scene, in one loop a layer: where layers do not shine by themselves, under one
  // beam that stands as over the scene's middle. False: not so.
  bool pass_at_once(Vec3 from, Dir d, double distance, std::span<float> T, std::span<float> S) const {
    if (beams_.size() != 1 || (diffuse_ && diffuse_->low_sun())) return false;
    bool all = true, any = false;
    column_.shells.walk(from, d, distance, [&](const Shells::Piece& piece) {
      const size_t l = piece.layer;
      const auto beam = all && !emits_[l] ? once_.here(0, piece, from, d) : std::nullopt;
      if (!(all = beam.has_value())) return;
      const air_loops::Sources sources =
          diffuse_ ? sources_of(l, from + d * (0.5 * (piece.near + piece.far)), d) : nothing();
      const float* const k = extinction_of(piece);
      const float near = share(l, piece.near_height), far = share(l, piece.far_height);
      const auto pass = [&](auto thin, auto alone, size_t i, size_t n) {
        air_loops::pass<thin.value, alone.value>(i, n, k, sources, near, far, *beam, T.data(), S.data());
      };
      const bool alone = !std::exchange(any, true);
      thin_.over(l, std::max(piece.length, std::fabs(double{beam->grows})), [&](size_t i, size_t n, bool thin) {
        using Yes = std::true_type;
        using No = std::false_type;
        if (alone)
          thin ? pass(Yes{}, Yes{}, i, n) : pass(No{}, Yes{}, i, n);
        else
          thin ? pass(Yes{}, No{}, i, n) : pass(No{}, No{}, i, n);
      });
    });
    return all && any;
  }
  void integrate(Vec3 from, Dir d, double distance, std::span<float> T, std::span<float> S, Which which) const {
    std::fill(T.begin(), T.end(), 1.0f);
    std::fill(S.begin(), S.end(), 0.0f);
    Scratch& s = scratch();
    once_.begin(d, s);
    column_.shells.walk(from, d, distance, [&](const Shells::Piece& piece) {
      const float* const k = extinction_of(piece);
      const auto length = static_cast<float>(piece.length);
      bool weighed = false;
      pass(piece, s, from + d * (0.5 * (piece.near + piece.far)), d, which);
      if (which.single) once_.add(piece, from, d, s, weighed, T, S);
      thin_.over(piece.layer, piece.length, [&](size_t i, size_t n, bool thin) {
        if (thin) return air_loops::send_thin(n, k + i, length, &s.at_near[i], &s.at_far[i], &T[i], &S[i]);
        if (!weighed) air_loops::weigh(n, k + i, length, s.weights(i));
        air_loops::send(n, s.weights(i), &s.at_near[i], &s.at_far[i], &T[i], &S[i]);
      });
    });
    if (bent(distance)) arrive(from, d, T);
  }
  // Whether what comes from the end of a way comes from outside, bent: only beams do.
  bool bent(double distance) const {
    return distance == std::numeric_limits<double>::infinity() && !column_.refractivity.empty() && !tables_.empty();
  }
  // Transmittance of a straight way out of the air that rises well, from the table of the beams. False: another way.
  bool outwards(Vec3 from, Dir d, std::span<float> T) const {
    constexpr double kLevel = 0.05;
    const double height = column_.shells.height(from), cosine = column_.shells.cosine(from, height, d);
    if (!column_.refractivity.empty() || cosine < kLevel) return false;
    if (const auto depth = once_.local().depth(height, cosine)) {
      air_loops::fall_here(bins_, *depth, T.data());
      return true;
    }
    tables_[0].depth(height, cosine, T);
    for (float& t : T) t = exp_falling(t);
    return true;
  }
  // What arrives of light whose source stands in a direction.
  void arrive(Vec3 at, Dir d, std::span<float> T) const {
    const double height = column_.shells.height(at);
    if (!tables_[0].depth(height, column_.shells.cosine(at, height, d), T)) return std::fill(T.begin(), T.end(), 0.0f);
    for (float& t : T) t = exp_falling(t);
  }

 public:
  void skylight(Vec3 from, Dir d, std::span<float> T, std::span<float> S) const override {
    const Dir local = to_local(from, d);
    const double height = column_.shells.height(from);
    if (!near_origin(from) || !SkyTable::covers(height, local))
      return integrate(from, d, std::numeric_limits<double>::infinity(), T, S, kAll);
    transmittance(from, d, std::numeric_limits<double>::infinity(), T);
    sky_->radiance(height, local, S);
  }
  const float* sky_radiance(Vec3 from, Dir d, std::span<float> scratch, std::span<float> S) const override {
    const Dir local = to_local(from, d);
    const double height = column_.shells.height(from);
    if (near_origin(from) && SkyTable::covers(height, local)) return sky_->drawn(height, local);
    integrate(from, d, std::numeric_limits<double>::infinity(), scratch, S, kAll);
    return S.data();
  }
  bool bends() const override { return bent(std::numeric_limits<double>::infinity()); }
  const Light* sky() const override { return sky_->light(); }
  const SkyThroughWater* sky_through_water() const override {
    return sky_->light() ? &sky_->through_water(knots_) : nullptr;
  }
  double sky_density(Dir d) const override { return sky_->density(d); }
  const AirVertices* vertices() const override { return vertices_.get(); }

  const Shells& shells() const override { return column_.shells; }
  std::span<const float> extinction(size_t l) const override { return {&column_.extinction[l * bins_], bins_}; }
  void source(size_t l, Vec3 from, Dir d, std::span<float> to) const override {
    const float *low = &emission_[2 * l * bins_], *high = low + bins_;
    for (size_t i = 0; i < bins_; ++i) to[i] = 0.5f * (low[i] + high[i]);
    if (!diffuse_) return;
    const DiffuseSource::Corners corners = corners_of(from, d);
    for (size_t c = 0; c < 4; ++c) {
      const float *bottom = diffuse_->at(l, 0, corners.at[c]), *top = diffuse_->at(l, 1, corners.at[c]);
      for (size_t i = 0; i < bins_; ++i) to[i] += corners.weight[c] * 0.5f * (bottom[i] + top[i]);
    }
  }
  const PolarisedAir* polarisation(StokesParts parts) const override {
    Polarised& of = polarised_[parts == StokesParts::all ? 1 : 0];
    std::call_once(of.once, [&] { isolated([&] { of.air = make_polarised_(parts); }); });
    return of.air.get();
  }
  size_t beams() const override { return beams_.size(); }
  void beam(size_t b, size_t l, Vec3 from, Dir d, BeamAlong along) const override {
    Scratch& s = scratch();
    once_.begin(d, s);
    once_.depth(b, from, column_.shells.height(from), along.depth);
    // Growth of the depth over a way so short that it stays in the layer.
    const double step = 1e-2 * (bounds_[l + 1] - bounds_[l]);
    const Vec3 on = from + d * step;
    once_.depth(b, on, column_.shells.height(on), along.slope);
    once_.source(b, l, s, along.scattered);
    for (size_t i = 0; i < bins_; ++i) along.slope[i] = (along.slope[i] - along.depth[i]) / static_cast<float>(step);
  }

 private:
  Scratch& scratch() const {
    thread_local Scratch s;
    s.fit(bins_, beams_.size(), column_.kinds.size());
    return s;
  }

  std::unique_ptr<const PolarisedAir> polarised(const AirSpec& spec, const SpectralState& state,
                                                std::span<const AirBeam> from, StokesParts parts) const {
    std::shared_ptr<const PolarisedSource> again;
    if (diffuse_) {
      std::vector<std::vector<double>> depths;
      for (size_t b = 0; b < from.size(); ++b) depths.push_back(level_depths(column_, from[b].direction.z, tables_[b]));
      again = solve_polarised_source(spec, column_, state, from, depths, parts);
    }
    return std::make_unique<const PolarisedAir>(column_, beams_, once_, std::move(again));
  }

  // What a layer emits at its ends, over its extinction; and which layers shine at all.
  void bake_emission() {
    constexpr float kDark = 1e-12f;  // W/(m2 sr um)
    const auto any = [&](const float* row) { return std::any_of(row, row + bins_, [](float v) { return v > kDark; }); };
    emission_.resize(2 * column_.layers() * bins_);
    for (size_t l = 0; l < column_.layers(); ++l)
      for (size_t i = 0; i < bins_; ++i) {
        const size_t at = l * bins_ + i;
        double scattered = 0;
        for (const AirColumn::Kind& kind : column_.kinds) scattered += kind.scattering[at];
        const double k = column_.extinction[at], absorbed = k > 0 ? std::clamp(1 - scattered / k, 0.0, 1.0) : 0;
        for (size_t end = 0; end < 2; ++end)
          emission_[(2 * l + end) * bins_ + i] =
              static_cast<float>(absorbed * column_.blackbody[(l + end) * bins_ + i]);
      }
    for (size_t l = 0; l < column_.layers(); ++l)
      emits_.push_back(any(&emission_[2 * l * bins_]) || any(&emission_[(2 * l + 1) * bins_]));
  }

  // up: flux that leaves the even ground, W/(m2 um).
  void place_vertices(const SpectralState& state, Row up) {
    for (float& L : up) L /= static_cast<float>(kPi);
    auto vertices = std::make_unique<const AirVertices>(made_, state, *this, std::move(up));
    if (vertices->any()) vertices_ = std::move(vertices);
  }

  void tabulate_sky() {
    std::optional<double> symmetric;
    if (beams_.size() == 1) symmetric = azimuth(beams_[0].direction);
    const auto along = [this](Vec3 from, Dir d, double distance, std::span<float> radiance) {
      thread_local Row T;
      T.resize(bins_);
      integrate(from, d, distance, T, radiance, kAll);
    };
    sky_ = std::make_unique<SkyTable>(bins_, beams_.empty(), symmetric, 1000,
                                      [along](double height, Dir d, std::span<float> radiance) {
                                        along({0, 0, height}, d, std::numeric_limits<double>::infinity(), radiance);
                                      });
    sky_->make_light();
    view_ = std::make_unique<SkyTable>(bins_, beams_.empty(), symmetric, 250,
                                       [along, this](double height, Dir up, std::span<float> radiance) {
                                         const double far = 20 * bounds_.back();  // beyond the air at any angle used
                                         along(Vec3{0, 0, height} + up * far, -up, far, radiance);
                                       });
  }

  const float* extinction_of(const Shells::Piece& piece) const { return &column_.extinction[piece.layer * bins_]; }
  // The source of a piece at its ends.
  void pass(const Shells::Piece& piece, Scratch& s, Vec3 middle, Dir d, Which which) const {
    const size_t l = piece.layer;
    const float near = share(l, piece.near_height), far = share(l, piece.far_height);
    if (diffuse_ && which.multiple) {
      air_loops::see_sources(bins_, sources_of(l, middle, d), near, far, s.at_near.data(), s.at_far.data());
      if (diffuse_->low_sun())
        diffuse_->relight(l, dot(column_.shells.up(middle), beams_[0].direction), s.at_near.data(), s.at_far.data());
    } else {
      std::fill(s.at_near.begin(), s.at_near.end(), 0.0f);
      std::fill(s.at_far.begin(), s.at_far.end(), 0.0f);
    }
    if (which.thermal && emits_[l])
      air_loops::add_source(bins_, &emission_[2 * l * bins_], &emission_[(2 * l + 1) * bins_], near, far,
                            s.at_near.data(), s.at_far.data());
  }

  // Where a height lies in a layer, 0..1.
  float share(size_t l, double height) const {
    return static_cast<float>(std::clamp((height - bounds_[l]) / (bounds_[l + 1] - bounds_[l]), 0.0, 1.0));
  }
  // What a layer scatters more than once.
  air_loops::Sources sources_of(size_t l, Vec3 at, Dir d) const {
    const DiffuseSource::Corners corners = corners_of(at, d);
    air_loops::Sources sources;
    for (size_t c = 0; c < 4; ++c) {
      sources.low[c] = diffuse_->at(l, 0, corners.at[c]), sources.high[c] = diffuse_->at(l, 1, corners.at[c]);
      sources.weight[c] = corners.weight[c];
    }
    return sources;
  }
  air_loops::Sources nothing() const {
    const float* const dark = dark_.data();
    return {{dark, dark, dark, dark}, {dark, dark, dark, dark}, {0, 0, 0, 0}};
  }
  DiffuseSource::Corners corners_of(Vec3 at, Dir d) const {
    const Dir local = to_local(at, d);
    return diffuse_->corners(local.z, quick_azimuth(local));
  }
  std::shared_ptr<const AirColumn> made_;
  const AirColumn& column_;
  std::vector<Beam> beams_;
  std::shared_ptr<const DiffuseSource> diffuse_;
  size_t bins_;
  std::vector<size_t> knots_;
  Row dark_ = Row(bins_, 0.0f);
  std::vector<double> bounds_;
  std::vector<BeamTable> tables_;
  BeamLight once_{column_, beams_, tables_};
  ThinBins thin_{column_};
  std::vector<float> emission_;  // [layer][end][bin]
  std::vector<uint8_t> emits_;   // per layer
  std::unique_ptr<SkyTable> sky_, view_;
  std::unique_ptr<const AirVertices> vertices_;
  std::function<std::unique_ptr<const PolarisedAir>(StokesParts)> make_polarised_;
  struct Polarised {
    std::once_flag once;
    std::unique_ptr<const PolarisedAir> air;
  };
  mutable std::array<Polarised, 2> polarised_;  // without V, and with it
};

}  // namespace

std::unique_ptr<const Atmosphere> make_stratified_air(const AirSpec& spec, std::shared_ptr<const AirColumn> column,
                                                      const SpectralState& state, std::vector<Beam> beams) {
  return std::make_unique<StratifiedAir>(spec, std::move(column), state, std::move(beams));
}
std::unique_ptr<const Atmosphere> make_stratified_air(const AirSpec& spec, const SpectralState& state,
                                                      std::vector<Beam> beams) {
  return make_stratified_air(spec, std::make_shared<const AirColumn>(bake_column(spec, state)), state,
                             std::move(beams));
}

}  // namespace suite
