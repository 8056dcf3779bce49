#include "light/stratified_air.h"

#include <algorithm>
#include <cmath>

#include "air/beam_table.h"
#include "air/column.h"
#include "air/diffuse_field.h"
#include "light/air_loops.h"
#include "light/air_scratch.h"
#include "light/air_vertices.h"
#include "light/sky_table.h"

namespace suite {

namespace {

using Row = std::vector<float>;
using Scratch = AirScratch;
using BeamAt = AirScratch::BeamAt;
constexpr float kShadow = 1e4f;  // depth of a beam in the shadow of the Earth

class StratifiedAir final : public Atmosphere {
 public:
  StratifiedAir(const AirSpec& spec, std::shared_ptr<const AirColumn> column, const SpectralState& state,
                std::vector<Beam> beams)
      : made_(std::move(column)), column_(*made_), beams_(std::move(beams)), bins_(column_.bins) {
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
    if (!seen_from_above(from, d, end)) return integrate(from, d, distance, T, S, kAll);
    if (!outwards(end, -d, T)) transmittance(from, d, distance, T);
    view_->radiance(column_.shells.height(end), to_local(end, -d), S);
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
  Dir to_local(Vec3 p, Dir d) const { return Frame::with_tangent(column_.shells.up(p), {1, 0, 0}).to_local(d); }
  // Whether a way comes through all of the air down to a place where the table of views holds, and not too slant.
  bool seen_from_above(Vec3 from, Dir d, Vec3 end) const {
    constexpr double kSlant = 0.17;
    return near_origin(end) && d.z < -kSlant && SkyTable::covers(column_.shells.height(end), -d) &&
           column_.shells.height(from) >= bounds_.back();
  }
  // What of the light is wanted.
  struct Which {
    bool thermal, single, multiple;
  };
  static constexpr Which kAll{true, true, true};
  void integrate(Vec3 from, Dir d, double distance, std::span<float> T, std::span<float> S, Which which) const {
    std::fill(T.begin(), T.end(), 1.0f);
    std::fill(S.begin(), S.end(), 0.0f);
    Scratch& s = scratch();
    for (size_t b = 0; b < beams_.size(); ++b) begin_phases(b, d, s), s.near[b].known = false;
    column_.shells.walk(from, d, distance, [&](const Shells::Piece& piece) {
      const float* const k = extinction_of(piece);
      const auto length = static_cast<float>(piece.length);
      const bool thin = greatest_[piece.layer] * piece.length < double{air_loops::kThin};
      pass(piece, s, from + d * (0.5 * (piece.near + piece.far)), d, which);
      if (!thin) air_loops::weigh(bins_, k, length, s.weights());
      for (size_t b = 0; which.single && b < beams_.size(); ++b) {
        BeamAt &near = s.near[b], &far = s.far[b];
        if (!near.known) look_up(b, from + d * piece.near, piece.near_height, near);
        scattered_once(b, piece.layer, s, s.scattered);
        if (thin && scatter_thin(b, piece, from, d, s, T, S)) continue;
        if (thin) air_loops::weigh(bins_, k, length, s.weights());
        look_up(b, from + d * piece.far, piece.far_height, far);
        if (near.lit == far.lit)
          scatter(near, far, length, s.weights(), s, T, S);
        else
          scatter_lit(b, piece, from, d, s, T, S);
        std::swap(near, far);
      }
      if (thin)
        air_loops::send_thin(bins_, k, length, s.at_near.data(), s.at_far.data(), T.data(), S.data());
      else
        air_loops::send(bins_, s.weights(), s.at_near.data(), s.at_far.data(), T.data(), S.data());
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
    const double cosine = dot(column_.shells.up(from), d);
    if (!column_.refractivity.empty() || cosine < kLevel) return false;
    tables_[0].depth(column_.shells.height(from), cosine, T);
    for (float& t : T) t = exp_falling(t);
    return true;
  }
  // What arrives of light whose source stands in a direction.
  void arrive(Vec3 at, Dir d, std::span<float> T) const {
    if (!tables_[0].depth(column_.shells.height(at), dot(column_.shells.up(at), d), T))
      return std::fill(T.begin(), T.end(), 0.0f);
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
  void sky_radiance(Vec3 from, Dir d, std::span<float> scratch, std::span<float> S) const override {
    const Dir local = to_local(from, d);
    const double height = column_.shells.height(from);
    if (near_origin(from) && SkyTable::covers(height, local)) return sky_->radiance(height, local, S);
    integrate(from, d, std::numeric_limits<double>::infinity(), scratch, S, kAll);
  }
  bool bends() const override { return bent(std::numeric_limits<double>::infinity()); }
  const Light* sky() const override { return sky_->light(); }
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
  size_t beams() const override { return beams_.size(); }
  void beam(size_t b, size_t l, Vec3 from, Dir d, BeamAlong along) const override {
    Scratch& s = scratch();
    begin_phases(b, d, s);
    beam_depth(b, from, column_.shells.height(from), along.depth);
    // Growth of the depth over a way so short that it stays in the layer.
    const double step = 1e-2 * (bounds_[l + 1] - bounds_[l]);
    const Vec3 on = from + d * step;
    beam_depth(b, on, column_.shells.height(on), along.slope);
    scattered_once(b, l, s, along.scattered);
    for (size_t i = 0; i < bins_; ++i) along.slope[i] = (along.slope[i] - along.depth[i]) / static_cast<float>(step);
  }

 private:
  Scratch& scratch() const {
    thread_local Scratch s;
    s.fit(bins_, beams_.size(), column_.kinds.size());
    return s;
  }

  // What a layer emits at its ends, over its extinction; and which layers do anything at all.
  void bake_emission() {
    constexpr float kDark = 1e-12f;  // W/(m2 sr um)
    const auto any = [&](const float* row, float more) {
      return std::any_of(row, row + bins_, [more](float v) { return v > more; });
    };
    for (const AirColumn::Kind& kind : column_.kinds)
      for (size_t l = 0; l < column_.layers(); ++l) scatters_.push_back(any(&kind.scattering[l * bins_], 0));
    for (size_t l = 0; l < column_.layers(); ++l) {
      const float* const k = &column_.extinction[l * bins_];
      greatest_.push_back(static_cast<double>(*std::max_element(k, k + bins_)));
    }
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
      emits_.push_back(any(&emission_[2 * l * bins_], kDark) || any(&emission_[(2 * l + 1) * bins_], kDark));
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
    const double low = bounds_[l], thickness = bounds_[l + 1] - low;
    const auto share = [&](double height) {
      return static_cast<float>(std::clamp((height - low) / thickness, 0.0, 1.0));
    };
    const float near = share(piece.near_height), far = share(piece.far_height);
    if (diffuse_ && which.multiple) {
      const DiffuseSource::Corners corners = corners_of(middle, d);
      air_loops::Sources sources;
      for (size_t c = 0; c < 4; ++c) {
        sources.low[c] = diffuse_->at(l, 0, corners.at[c]), sources.high[c] = diffuse_->at(l, 1, corners.at[c]);
        sources.weight[c] = corners.weight[c];
      }
      air_loops::see_sources(bins_, sources, near, far, s.at_near.data(), s.at_far.data());
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

  DiffuseSource::Corners corners_of(Vec3 at, Dir d) const {
    const Dir local = to_local(at, d);
    return diffuse_->corners(local.z, azimuth(local));
  }
  // Light comes along -beam and goes on along -d: angles for phase functions, which are looked up where they matter.
  void begin_phases(size_t b, Dir d, Scratch& s) const {
    s.cosines[b] = std::clamp(dot(beams_[b].direction, d), -1.0, 1.0);
    for (Row& p : s.phases[b]) p.clear();
  }
  const Row& phase_of(size_t b, size_t kind, Scratch& s) const {
    Row& p = s.phases[b][kind];
    if (!p.empty()) return p;
    p.resize(bins_);
    const PhaseFunction& phase = *column_.kinds[kind].phase;
    phase.eval(s.cosines[b], phase.spectrally_uniform() ? std::span(p).first(1) : std::span(p));
    if (phase.spectrally_uniform()) std::fill(p.begin(), p.end(), p[0]);
    return p;
  }
  // False in the shadow of the Earth.
  bool beam_depth(size_t b, Vec3 p, double height, std::span<float> depth) const {
    const bool lit = tables_[b].spread_depth(height, dot(column_.shells.up(p), beams_[b].direction), depth);
    if (!lit) std::fill(depth.begin(), depth.end(), kShadow);
    return lit;
  }
  void look_up(size_t b, Vec3 p, double height, BeamAt& at) const {
    at.known = true;
    at.lit = beam_depth(b, p, height, at.depth);
    air_loops::fall(bins_, at.depth.data(), at.light.data());
  }

  // Scattering times phase function, summed over the kinds, times the irradiance of the beam above the air.
  void scattered_once(size_t b, size_t layer, Scratch& s, std::span<float> to) const {
    std::fill(to.begin(), to.end(), 0.0f);
    for (size_t k = 0; k < column_.kinds.size(); ++k) {
      if (scatters_[k * column_.layers() + layer])
        air_loops::multiply_add(bins_, &column_.kinds[k].scattering[layer * bins_], phase_of(b, k, s).data(),
                                to.data());
    }
    for (size_t i = 0; i < bins_; ++i) to[i] *= beams_[b].irradiance[i];
  }
  // Light of a beam that is scattered once on a way; s.scattered: how.
  void scatter(const BeamAt& near, const BeamAt& far, float length, const air_loops::Weights& weights, const Scratch& s,
               std::span<const float> T, std::span<float> S) const {
    air_loops::scatter(bins_, s.scattered.data(), length, weights, {near.depth.data(), near.light.data()},
                       {far.depth.data(), far.light.data()}, T.data(), S.data());
  }
  // The same of a thin piece under a straight beam that comes down well; s.near: where it begins. False: not so.
  // With d = (D - M / (R c^2)) / c, D the depth over a height and M its first moment, the beam's depth grows by
  // -k dh / c and by d (c_near / c - 1 + dh / (R c^2)): within 2e-4 of what is scattered
  // (tests/physics/light/thin_air_test.cpp).
  bool scatter_thin(size_t b, const Shells::Piece& piece, Vec3 from, Dir d, Scratch& s, std::span<const float> T,
                    std::span<float> S) const {
    constexpr double kLow = 0.2, kTurn = 0.01;
    const Dir beam = beams_[b].direction;
    const double near = dot(column_.shells.up(from + d * piece.near), beam),
                 far = dot(column_.shells.up(from + d * piece.far), beam);
    const double rise = piece.far_height - piece.near_height, way = -rise / far;
    const double share = near / far - 1 + rise * column_.shells.curvature() / (far * far);
    if (!column_.refractivity.empty() || near < kLow || far < kLow || std::fabs(share) > kTurn) return false;
    if (greatest_[piece.layer] * (piece.length + std::fabs(way)) > 0.8 * double{air_loops::kThin}) return false;
    air_loops::scatter_thin(bins_, extinction_of(piece), static_cast<float>(piece.length),
                            {s.near[b].light.data(), s.near[b].depth.data(), s.scattered.data(),
                             static_cast<float>(way), static_cast<float>(share)},
                            T.data(), S.data());
    s.near[b].known = false;
    return true;
  }
  // The same of a piece that goes into the shadow of the Earth or comes out of it: only the part outside is lit.
  void scatter_lit(size_t b, const Shells::Piece& piece, Vec3 from, Dir d, Scratch& s, std::span<const float> T,
                   std::span<float> S) const {
    const bool near_lit = s.near[b].lit;
    double lit = near_lit ? piece.near : piece.far, dark = near_lit ? piece.far : piece.near;
    const auto at = [&](double t) { return from + d * t; };
    for (int i = 0; i < 30; ++i) {
      const double middle = 0.5 * (lit + dark);
      const Vec3 p = at(middle);
      const double cosine = dot(column_.shells.up(p), beams_[b].direction);
      (tables_[b].seen(column_.shells.height(p), cosine) ? lit : dark) = middle;
    }
    look_up(b, at(lit), column_.shells.height(at(lit)), s.edge);
    const auto share = static_cast<float>(std::fabs(lit - (near_lit ? piece.near : piece.far)) / piece.length);
    for (size_t i = 0; i < bins_; ++i) {
      s.lit_depth[i] = share * s.depth[i];
      s.lit_keep[i] = exp_falling(s.lit_depth[i]);
      s.dark_T[i] = near_lit ? T[i] : T[i] * exp_falling((1 - share) * s.depth[i]);
    }
    scatter(near_lit ? s.near[b] : s.edge, near_lit ? s.edge : s.far[b], share * static_cast<float>(piece.length),
            {s.lit_depth.data(), s.lit_keep.data(), nullptr, nullptr}, s, s.dark_T, S);
  }

  std::shared_ptr<const AirColumn> made_;
  const AirColumn& column_;
  std::vector<Beam> beams_;
  std::shared_ptr<const DiffuseSource> diffuse_;
  size_t bins_;
  std::vector<double> bounds_;
  std::vector<BeamTable> tables_;
  std::vector<float> emission_;    // [layer][end][bin]
  std::vector<uint8_t> emits_;     // per layer
  std::vector<double> greatest_;   // extinction of all bins, per layer
  std::vector<uint8_t> scatters_;  // [kind][layer]
  std::unique_ptr<SkyTable> sky_, view_;
  std::unique_ptr<const AirVertices> vertices_;
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
