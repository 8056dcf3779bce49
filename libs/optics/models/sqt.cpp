// A fitted spherical quad-tree as a scattering model: shapes at the stored wavelengths, magnitudes from the finer
// table.
//
// At a wavelength between two stored ones the shape is the mean of theirs, weighed by nearness (each normalised to its
// total), and is scaled to the total of that wavelength; outside the stored range what the spec declares. Sampling
// picks one of the two shapes with the same weights, so that a knot's density is exactly its shape's mixture. Based on:
// Goodenough & Brown, section IV-D-4 and V-A.
#include <algorithm>
#include <cmath>

#include "optics/models/rows.h"
#include "optics/stored_range.h"
#include "sqt/bundle.h"

namespace suite {

namespace {

// Between two entries of an ascending table, the nearest end outside.
struct Between {
  size_t low = 0, high = 0;
  double t = 0;
};
Between locate(const std::vector<double>& ascending, double x) {
  const size_t n = ascending.size();
  if (x <= ascending.front()) return {0, 0, 0};
  if (x >= ascending.back()) return {n - 1, n - 1, 0};
  const size_t i = static_cast<size_t>(std::upper_bound(ascending.begin(), ascending.end(), x) - ascending.begin()) - 1;
  return {i, i + 1, (x - ascending[i]) / (ascending[i + 1] - ascending[i])};
}

// The same for every bin, one array each: loops over bins become vector code.
struct Betweens {
  std::vector<int32_t> low, high;
  std::vector<double> t;
  void push_back(const Between& b) {
    low.push_back(static_cast<int32_t>(b.low)), high.push_back(static_cast<int32_t>(b.high)), t.push_back(b.t);
  }
  Between operator[](size_t i) const { return {static_cast<size_t>(low[i]), static_cast<size_t>(high[i]), t[i]}; }
  double mean(const double* of, size_t i) const { return (1 - t[i]) * of[low[i]] + t[i] * of[high[i]]; }
};

class Sqt final : public ScatterModel {
 public:
  Sqt(std::shared_ptr<const sqt::Bundle> bundle, const StoredRange& range, const SpectralState& state)
      : bundle_(std::move(bundle)) {
    const sqt::Bundle::Info& info = bundle_->info();
    // Channels in ascending wavelength (RGB data come red first).
    std::vector<std::pair<double, size_t>> order;
    for (size_t c = 0; c < bundle_->channels(); ++c) order.push_back({info.function.wavelength_um[c], c});
    std::sort(order.begin(), order.end());
    std::vector<double> um;
    for (const auto& [wavelength, c] : order) um.push_back(wavelength);
    for (const Bin& bin : state.bins) {
      Between shape = locate(um, bin.center_um());
      shape.low = order[shape.low].second, shape.high = order[shape.high].second;
      shape_.push_back(shape);
      magnitude_.push_back(locate(info.magnitude_um, bin.center_um()));
      const bool beyond = bin.center_um() < range.low_um || bin.center_um() > range.high_um;
      most_.push_back(beyond && range.outside == Outside::zero ? 0 : 1);
    }
    for (const size_t k : state.knots) knot_.push_back(shape_[k]);
    if (info.mueller)
      for (const Bin& bin : state.bins) matrix_.push_back(locate(info.mueller->data().wavelength_um, bin.center_um()));
    channels_ = used(shape_, state.size()), knot_channels_ = used(knot_, knot_.size());
    for (const double wavelength : info.function.wavelength_um)
      total_of_.push_back(
          static_cast<size_t>(std::lower_bound(info.magnitude_um.begin(), info.magnitude_um.end(), wavelength) -
                              info.magnitude_um.begin()));
  }

  void eval(Dir out, Dir in, std::span<float> w) const override {
    thread_local std::vector<double> f, W;
    f.resize(bundle_->channels());
    if (channels_.size() == f.size())
      bundle_->value(out, in, f);
    else
      for (const size_t c : channels_) f[c] = bundle_->value(out, in, c);
    magnitudes(out, W);
    for (const size_t c : channels_) {
      const double total = f[c] > 0 ? W[total_of_[c]] : 0;
      f[c] = total > 0 ? f[c] * std::fabs(in.z) / total : 0;
    }
    const double* const shapes = f.data();
    const double* const totals = W.data();
    float* __restrict const to = w.data();
    for (size_t i = 0; i < w.size(); ++i)
      to[i] = static_cast<float>(std::min(most_[i], magnitude_.mean(totals, i)) * shape_.mean(shapes, i));
  }
  void total(Dir out, std::span<float> w) const override {
    thread_local std::vector<double> W;
    magnitudes(out, W);
    for (size_t i = 0; i < w.size(); ++i) w[i] = static_cast<float>(at_bin(W, i));
  }
  std::optional<Sample> sample(Dir out, Vec2 u, double lobe_u, int knot) const override {
    const Between& s = knot_[static_cast<size_t>(knot)];
    const double first = 1 - s.t;
    const bool low = lobe_u < first;
    const double rest = low ? lobe_u / first : (lobe_u - first) / s.t;
    const size_t channel = low ? s.low : s.high;
    double within = rest;
    if (has_delta()) {
      const Dirac d = dirac(out, channel);
      if (rest < d.share) return Sample{d.in, kDirac, true};
      within = d.share < 1 ? (rest - d.share) / (1 - d.share) : 0;
    }
    const auto in = bundle_->sample(out, u, std::min(within, 0x1.fffffffffffffp-1), channel);
    if (!in) return std::nullopt;
    return Sample{*in, out.z * in->z > 0 ? 0 : 1, false};
  }
  void pdf(Dir out, Dir in, std::span<float> p) const override {
    thread_local std::vector<double> q;
    q.resize(bundle_->channels());
    if (knot_channels_.size() == q.size())
      bundle_->pdf(out, in, q);
    else
      for (const size_t c : knot_channels_) q[c] = bundle_->pdf(out, in, c);
    if (has_delta())
      for (const size_t c : knot_channels_) q[c] *= 1 - dirac(out, c).share;
    for (size_t k = 0; k < p.size(); ++k)
      p[k] = static_cast<float>((1 - knot_[k].t) * q[knot_[k].low] + knot_[k].t * q[knot_[k].high]);
  }
  bool has_delta() const override { return bundle_->info().has_delta(); }
  void delta_weight(Dir out, int, int, std::span<float> weight) const override {
    thread_local std::vector<double> W;
    magnitudes(out, W);
    for (size_t i = 0; i < weight.size(); ++i) weight[i] = static_cast<float>(at_bin(W, i) * share(out, shape_[i]));
  }
  void delta_probability(Dir out, int, int, std::span<float> probability) const override {
    for (size_t k = 0; k < probability.size(); ++k) probability[k] = static_cast<float>(share(out, knot_[k]));
  }
  Polarised mueller(Dir out, Dir in, std::span<Mueller> m) const override {
    const sqt::MuellerTable* const table = bundle_->info().mueller.get();
    if (!table || !(out.z > 0 && in.z > 0)) return ScatterModel::mueller(out, in, m);
    thread_local std::vector<Mueller> at;
    at.resize(table->data().wavelength_um.size());
    table->at(out, in, at);
    const ScatteringPlane plane(out, in);
    for (Mueller& x : at) x = plane.turned(x);
    const bool grey = at.size() == 1;
    for (size_t i = 0; i < (grey ? 1 : m.size()); ++i) {
      const Between b = matrix_[i];
      m[i] = b.t > 0 ? at[b.low] * (1 - b.t) + at[b.high] * b.t : at[b.low];
    }
    return {grey, 0};
  }
  Polarised delta_mueller(Dir out, int, int, std::span<Mueller> m) const override {
    return mueller(out, dirac(out, knot_.front().low).in, m);
  }
  bool spectrally_uniform_shape() const override { return bundle_->channels() == 1; }
  bool isotropic() const override { return bundle_->info().function.isotropic; }
  bool opaque() const override { return bundle_->info().function.domain == sqt::Domain::hemisphere; }

 private:
  static constexpr int kDirac = 2;  // lobe number; 0 and 1 are the reflected and the transmitted side
  struct Dirac {
    Dir in;
    double share;  // of the total
  };
  Dirac dirac(Dir out, size_t channel) const {
    const auto lobe = bundle_->delta(out, channel);
    const double total = lobe ? bundle_->total(out, channel) : 0;
    return total > 0 ? Dirac{lobe->in, std::min(1.0, lobe->total / total)} : Dirac{{0, 0, 1}, 0};
  }
  // The Dirac lobe's share between two channels.
  double share(Dir out, const Between& b) const {
    const double low = dirac(out, b.low).share;
    return b.t > 0 ? (1 - b.t) * low + b.t * dirac(out, b.high).share : low;
  }
  template <class Shapes>
  static std::vector<size_t> used(const Shapes& shapes, size_t n) {
    std::vector<size_t> channels;
    for (size_t i = 0; i < n; ++i) channels.insert(channels.end(), {shapes[i].low, shapes[i].high});
    std::sort(channels.begin(), channels.end());
    channels.erase(std::unique(channels.begin(), channels.end()), channels.end());
    return channels;
  }
  void magnitudes(Dir out, std::vector<double>& W) const {
    W.resize(bundle_->info().magnitude_um.size());
    bundle_->magnitude(out, W);
  }
  double at_bin(const std::vector<double>& W, size_t i) const {
    return std::min(most_[i], magnitude_.mean(W.data(), i));
  }

  std::shared_ptr<const sqt::Bundle> bundle_;
  Betweens shape_, magnitude_;  // per bin
  Betweens matrix_;             // per bin: between wavelengths of the matrices, where there are some
  std::vector<double> most_;    // per bin: the largest total, 0 where nothing is stored and `zero` declared
  std::vector<Between> knot_;   // per knot
  std::vector<size_t> channels_, knot_channels_;  // that bins, that knots need
  std::vector<size_t> total_of_;                  // per channel: where its total stands among the magnitudes
};

// The tests fit a bundle to each.
std::vector<ModelSpec> examples() {
  return {{"sqt", {}, {}, {{"file", "glossy.sqt"}, {"outside", "hold"}}, nullptr},
          {"sqt", {}, {}, {{"file", "lacquer.sqt"}, {"outside", "hold"}}, nullptr},
          {"sqt", {}, {}, {{"file", "metal.sqt"}, {"outside", "hold"}}, nullptr}};
}

}  // namespace

ModelRow sqt_row() {
  using P = Parameter;
  return {{"sqt", "fitted spherical quad-tree (Goodenough & Brown 2017)", "1/sr",
           [](const ModelSpec& spec, const SpectralState& state) -> std::unique_ptr<const ScatterModel> {
             if (!spec.bundle) throw Error("model 'sqt': the file '" + spec.texts.at("file") + "' has not been loaded");
             if (spec.bundle->info().function.quantity != sqt::Quantity::bsdf)
               throw Error("model 'sqt': '" + spec.texts.at("file") + "' does not hold a surface function",
                           "fit a BRDF or BTDF");
             for (const Bin& bin : state.bins) require_stored(spec, bin.low_um, bin.high_um, "model");
             return std::make_unique<Sqt>(spec.bundle, stored_range(spec), state);
           }},
          {{"file", P::Kind::text, "", "name of the .sqt file", 0, 0},
           {"outside", P::Kind::text, "",
            "beyond half a spacing from the outermost channels (alone: 5 % of its wavelength): error, hold or zero", 0,
            0, false}},
          false,
          examples};
}

}  // namespace suite
