#include "transport/media/flight.h"

#include <algorithm>
#include <cmath>

#include "math/falling.h"

namespace suite {

namespace {
constexpr double kNear = 0.01;  // depth of scattering
}  // namespace

Flights::Flights(const VolumeField& field, const Optics& optics, std::span<const double> knot_probability,
                 const Atmosphere* air)
    : field_(field),
      optics_(optics),
      media_(optics.media()),
      bins_of_knots_(optics.state().knots),
      probability_(knot_probability.begin(), knot_probability.end()),
      depth_(media_.size()),
      air_(air, optics.state().size()),
      tau_(optics.state().size()),
      emission_(optics.state().size()),
      sent_(optics.state().size()),
      place_(optics.state().size()),
      knots_(probability_.size()) {
  for (const BakedMedium& m : media_) {
    any_emission_ = any_emission_ || !m.blackbody.empty();
    absorbs_.push_back(std::any_of(m.absorption.begin(), m.absorption.end(), [](float a) { return a > 0; }));
  }
  for (const PlacedGrid& p : field.placed()) any_emission_ = any_emission_ || p.emits;
}

double Flights::scattering_depth(size_t bin) const {
  double tau = 0;
  for (size_t m = 0; m < depth_.size(); ++m) tau += depth_[m] * double{media_[m].scattering[bin]};
  return tau;
}

bool Flights::emits(const Constituent& c) const {
  return absorbs_[c.medium] && (c.kelvin > 0 || !media_[c.medium].blackbody.empty());
}

Flights::Result Flights::fly(LivePath& live, double length, uint32_t background, bool airless, Vec2 u,
                             std::span<float> through, std::span<float> emitted) {
  airy_ = air_.any() && !airless;
  const size_t own = bins_of_knots_[static_cast<size_t>(live.knot)];
  std::fill(depth_.begin(), depth_.end(), 0.0);
  run_.clear();
  result_ = {false, length};
  if (live.branch != Branch::none) set_whole(live, length, background);
  if (airy_) {
    air_.begin();
    stretch_.clear();
    run_layer_ = kNone;
  }
  if (const AirLayers* layers = optics_.air())
    walk_.start(field_, live.origin, live.direction, length, background, live.time, &layers->shells, layers->first);
  else
    walk_.start(field_, live.origin, live.direction, length, background, live.time, airy_ ? air_.shells() : nullptr);
  if (walk_.empty() && !airy_) return result_;
  double left = -std::log1p(-u.x * (live.branch == Branch::forced ? scattered_[live.knot] : 1));
  for (;;) {
    left -= pass_lone(live, left, u.y, emitted);
    if (result_.scattered || !walk_.next()) break;
    const std::vector<Constituent>& contents = walk_.contents();
    double way = walk_.end() - walk_.begin(), rate = 0;
    for (const Constituent& c : contents) rate += c.density * double{media_[c.medium].scattering[own]};
    if (rate * way > left) {
      way = left / rate;
      result_.scattered = true, result_.distance = walk_.begin() + way;
    } else if (rate > 0) {
      left -= rate * way;
    }
    way = std::min(way, kEndlessWay);
    if (!same_run()) {
      end_run(live, u.y, emitted);
      begin_run(live);
    }
    for (size_t c = 0; c < contents.size(); ++c) run_[c].density += contents[c].density * way;
    run_length_ += way;
  }
  end_run(live, u.y, emitted);
  if (airy_) {
    air_.transmittance(through);
    if (length == std::numeric_limits<double>::infinity() && !result_.scattered)
      air_.bend(live.origin, live.direction, through);
    result_.dense = true;
  }
  weigh(live, through);
  return result_;
}

// Goes through a grid that is alone in its space, up to the cell where depth `left` of scattering is reached; returns
// the depth passed.
double Flights::pass_lone(const LivePath& live, double left, double u, std::span<float> emitted) {
  const Constituent alone{walk_.lone_medium(), 0, 0};
  if (result_.scattered || alone.medium == kNone) return 0;
  const double scattering = media_[alone.medium].scattering[bins_of_knots_[static_cast<size_t>(live.knot)]];
  const double mass = walk_.pass(scattering > 0 ? left / scattering : std::numeric_limits<double>::infinity());
  if (!(mass > 0)) return 0;
  if (run_.size() != 1 || !(run_[0] == alone)) {
    end_run(live, u, emitted);
    run_.push_back(alone);
  }
  run_[0].density += mass;
  return std::min(left, scattering * mass);
}

// Stretches of one medium at one temperature make one run: its emission needs only the mass passed. In a layer of the
// air, which shines, too, densities must be alike.
bool Flights::same_run() const {
  const std::vector<Constituent>& contents = walk_.contents();
  if (!airy_) return run_.size() == 1 && contents.size() == 1 && run_[0] == contents[0];
  return walk_.layer() == run_layer_ &&
         std::equal(contents.begin(), contents.end(), stretch_.begin(), stretch_.end(),
                    [](const Constituent& a, const Constituent& b) { return a == b && a.density == b.density; });
}

void Flights::begin_run(const LivePath& live) {
  for (const Constituent& c : walk_.contents()) run_.push_back({c.medium, 0, c.kelvin});
  run_length_ = 0;
  if (!airy_) return;
  stretch_ = walk_.contents();
  run_layer_ = walk_.layer();
  air_.enter(run_layer_, live.origin + live.direction * walk_.begin(), live.direction);
}

bool Flights::run_shines() const {
  if (run_layer_ != kNone || (airy_ && !run_.empty())) return run_length_ > 0;
  return any_emission_ && std::any_of(run_.begin(), run_.end(), [&](const Constituent& c) { return emits(c); });
}

void Flights::end_run(const LivePath& live, double u, std::span<float> emitted) {
  if (run_shines()) {
    if (!result_.emits) std::fill(emitted.begin(), emitted.end(), 0.0f);
    result_.emits = true;
    emit(live, u, emitted);
  }
  for (const Constituent& c : run_) depth_[c.medium] += c.density;
  run_.clear();
}

// What the run sends towards the start of the flight.
void Flights::emit(const LivePath& live, double u, std::span<float> emitted) {
  const bool spectral = optics_.spectral_flights();
  media_emission();
  if (spectral) set_places(live, u);
  if (airy_)
    air_.pass(run_length_, tau_, emission_, u, sent_, mean_.most > 0 ? std::span(place_) : std::span<double>{});
  else
    emit_media(u);
  for (size_t i = 0; i < emitted.size(); ++i)
    if (sent_[i] > 0) emitted[i] += static_cast<float>(sent_[i] * (spectral ? ratio(i, place_[i]) : 1));
}

void Flights::emit_media(double u) {
  for (size_t i = 0; i < sent_.size(); ++i) {
    sent_[i] = 0;
    if (!(emission_[i] > 0)) continue;
    const double tau = tau_[i], reached = -std::expm1(-tau);
    double absorbed = 0;
    for (size_t m = 0; m < depth_.size(); ++m) absorbed += depth_[m] * double{media_[m].absorption[i]};
    sent_[i] = std::exp(-absorbed) * reached / tau * emission_[i];
    if (optics_.spectral_flights()) place_[i] = place_in_fall(u, tau);
  }
}

// Depth of absorption of the media in the run, and what they emit in it if nothing weakens that.
void Flights::media_emission() {
  std::fill(tau_.begin(), tau_.end(), 0.0f);
  std::fill(emission_.begin(), emission_.end(), 0.0f);
  for (const Constituent& c : run_) {
    if (!absorbs_[c.medium]) continue;
    const BakedMedium& m = media_[c.medium];
    const float amount = static_cast<float>(c.density);
    for (size_t i = 0; i < tau_.size(); ++i) {
      const float tau = amount * m.absorption[i];
      tau_[i] += tau;
      emission_[i] += tau * field_.source(m, c.kelvin, i);
    }
  }
}

// Prepares ratio() for the run, for places not far from a share of its length.
void Flights::set_places(const LivePath& live, double share) {
  mean_ = {};
  for (size_t k = 0; k < knots_.size(); ++k) {
    knots_[k] = {live.relative.part(probability_, k), scattering_depth(bins_of_knots_[k]), 0};
    for (const Constituent& c : run_)
      knots_[k].within += c.density * double{media_[c.medium].scattering[bins_of_knots_[k]]};
  }
  if (!airy_) return;
  mean_.place = share;
  mean_.offset = knots_[0].before;
  for (const Knot& k : knots_) mean_.offset = std::min(mean_.offset, k.before);
  for (const Knot& k : knots_) {
    const double part = k.share * std::exp(mean_.offset - k.before - share * k.within);
    mean_.sum += part, mean_.slope += part * k.within, mean_.bend += part * k.within * k.within;
    mean_.most = std::max(mean_.most, k.within);
  }
}

// R of a bin at a place in the run. share: of its length.
double Flights::ratio(size_t bin, double share) const {
  double scattered = scattering_depth(bin), mixture = 0;
  for (const Constituent& c : run_) scattered += share * c.density * double{media_[c.medium].scattering[bin]};
  // In air runs are many and short; the mixture of all knots is then known well enough from one place: its series there
  // is true to some 1e-7.
  const double off = share - mean_.place;
  if (airy_ && std::fabs(off) * mean_.most < kNear)
    return std::exp(mean_.offset - scattered) / (mean_.sum - off * (mean_.slope - 0.5 * off * mean_.bend));
  for (const Knot& k : knots_) mixture += k.share * std::exp(scattered - k.before - share * k.within);
  return 1 / mixture;
}

// Weighs the path for the way in depth_: r_k, the spectrum, the densities that later sources share.
void Flights::weigh(LivePath& live, std::span<float> through) {
  if (std::all_of(depth_.begin(), depth_.end(), [](double d) { return d == 0; })) return;
  const size_t knots = bins_of_knots_.size();
  const size_t own_bin = bins_of_knots_[static_cast<size_t>(live.knot)];
  const double own = scattering_depth(own_bin);
  double own_rate = 1;
  if (result_.scattered) {
    own_rate = 0;
    for (const Constituent& c : walk_.contents()) own_rate += c.density * double{media_[c.medium].scattering[own_bin]};
  }
  const double shares = join_knots(live, result_.scattered, own_rate);
  if (!result_.scattered) live.last_density *= std::exp(-own);
  result_.scale = 1 / (own_rate * shares);
  for (size_t k = 0; k < knots; ++k) live.throughput[k] *= result_.scale;
  const bool spectral = optics_.spectral_flights();
  bool absorbs = false;
  for (size_t m = 0; m < depth_.size(); ++m) absorbs = absorbs || (depth_[m] > 0 && absorbs_[m]);
  if (!absorbs && !spectral) return;
  // Scattering that is the same everywhere cancels exactly.
  std::fill(tau_.begin(), tau_.end(), 0.0f);
  for (size_t m = 0; m < depth_.size(); ++m) {
    if (!(depth_[m] > 0)) continue;
    const float amount = static_cast<float>(depth_[m]);
    const float *absorption = media_[m].absorption.data(), *scattering = media_[m].scattering.data();
    for (size_t i = 0; i < tau_.size(); ++i)
      tau_[i] += amount * (spectral ? absorption[i] + scattering[i] : absorption[i]);
  }
  const double offset = spectral ? own : 0;
  for (size_t k = 0; k < knots; ++k) live.throughput[k] *= std::exp(offset - tau_[bins_of_knots_[k]]);
  const std::span<float> onto = result_.dense ? std::span(tau_) : through;
  spectral ? exp_difference(offset, tau_, onto) : exp_falling(tau_, onto);
  for (size_t i = 0; result_.dense && i < through.size(); ++i) through[i] *= tau_[i];
  result_.dense = true;
}

// F_k of the way that the path has before it (techniques/splitting.h).
void Flights::set_whole(const LivePath& live, double length, uint32_t background) {
  whole_.assign(media_.size(), 0);
  add_depths({live.origin, live.direction, live.time}, length, background, whole_);
  for (size_t k = 0; k < bins_of_knots_.size(); ++k) {
    double tau = 0;
    for (size_t m = 0; m < whole_.size(); ++m) tau += whole_[m] * double{media_[m].scattering[bins_of_knots_[k]]};
    scattered_[k] = -std::expm1(-tau);
  }
}

// r_k, of both branches that may have come to where this one was scattered; over the density of being scattered there.
double Flights::combined(const LivePath& live, size_t k, bool scattered) const {
  if (!scattered || live.branch == Branch::none) return live.relative[k];
  if (!(scattered_[k] > 0)) return 0;
  const bool forced = live.branch == Branch::forced;
  return forced ? live.relative[k] / scattered_[k] + live.other[k] : live.relative[k] + live.other[k] / scattered_[k];
}

// Brings r_k to the end of the way, divided by A; returns A.
double Flights::join_knots(LivePath& live, bool scattered, double own_rate) {
  const size_t knots = bins_of_knots_.size();
  const double own = scattering_depth(bins_of_knots_[static_cast<size_t>(live.knot)]);
  for (size_t k = 0; k < knots; ++k) {
    double rate = own_rate;
    if (scattered) {
      rate = 0;
      for (const Constituent& c : walk_.contents())
        rate += c.density * double{media_[c.medium].scattering[bins_of_knots_[k]]};
    }
    const double way = std::exp(own - scattering_depth(bins_of_knots_[k])) * (rate / own_rate);
    live.relative[k] = combined(live, k, scattered) * way;
    if (live.sided) live.other[k] *= way;
  }
  const double shares = live.relative.mean(probability_);
  live.relative.divide(knots, shares);
  if (live.sided) live.other.divide(knots, shares);
  live.before /= shares;
  return shares;
}

void Flights::add_depths(const Ray& ray, double length, uint32_t background, std::span<double> depth) {
  const AirLayers* layers = optics_.air();
  walk_.start(field_, ray.origin, ray.direction, length, background, ray.time, layers ? &layers->shells : nullptr,
              layers ? layers->first : kNone);
  walk_.add_depths(depth);
}

bool Flights::transmittance(std::span<const double> depth, std::span<float> transmission) const {
  bool clear = true;
  for (size_t m = 0; m < depth.size(); ++m) {
    if (!(depth[m] > 0)) continue;
    const float amount = static_cast<float>(depth[m]);
    const BakedMedium& medium = media_[m];
    for (size_t i = 0; i < transmission.size(); ++i) {
      const float tau = amount * (medium.absorption[i] + medium.scattering[i]);
      transmission[i] = clear ? tau : transmission[i] + tau;
    }
    clear = false;
  }
  if (clear) return false;
  exp_falling(transmission, transmission);
  return true;
}

}  // namespace suite
