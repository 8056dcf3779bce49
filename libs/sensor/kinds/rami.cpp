// The measurements of the RAMI canopy intercomparison: BRF in the principal and the orthogonal plane, black-sky albedo,
// and what canopy and ground absorb.
//
// by_reciprocity: paths start towards the patch along the sun's rays and every view is asked at each of their nodes,
// which gives all views from the same paths (transport/sinks/radiance.h) at a tenth of the cost or less. The patch is
// divided into strata x strata problems, whose mean is the result; fluxes are left to the other mode.
//
// Light that reaches the ground is collected by a level receiver just above it, whatever the ground reflects.
//
// Assumes: a collimated sun of the given direction and irradiance and no sky in the simulation; a level ground at
// ground_m, and for what it absorbs one that reflects by a share (a Lambertian one).
// The reference area is the whole patch at the height of the canopy's top; every problem is a mean over all of it.
// Based on: J.-L. Widlowski et al., "Third Radiation Transfer Model Intercomparison (RAMI) exercise", J. Geophys. Res.
// 112, 2007, and the formats of its online model checker (romc.jrc.ec.europa.eu); Goodenough & Brown, section V-B (each
// measurement is a problem of fixed angles).
#include <array>
#include <cmath>

#include "math/share.h"
#include "sensor/kinds/simple.h"

namespace suite {

namespace {

constexpr size_t kViews = 76;    // -75, -73 ... 75 degrees in each plane
constexpr double kAbove = 1e-3;  // m: of the receiver over the ground

class Rami final : public SimpleSensor {
 public:
  Rami(const Params& p, const SensorContext& context)
      : SimpleSensor(p, context, "rami"), patch_(read_patch(p.at("patch"))) {
    top_ = p.number_in("top_m", -1e7, 1e7, "m");
    ground_ = p.number_in("ground_m", -1e7, top_, "m", 0);
    sun_zenith_ = p.number_in("sun_zenith_deg", 0, 89.9, "degrees") * kDegree;
    sun_azimuth_ =
        azimuth_from_compass_deg(p.number_in("sun_azimuth_deg", -360, 360, "degrees clockwise from north", 90));
    auto in_bands = [&](const Params& value) {
      const Curve curve = context.curve(value);
      std::vector<double> out;
      for (const Band& b : bands_) out.push_back(band_mean(b, curve));
      return out;
    };
    irradiance_ = in_bands(p.at("irradiance"));
    for (const double e : irradiance_)
      if (!(e > 0)) throw p.at("irradiance").error("the sun's irradiance must be positive in every band");
    if (const auto ground = p.find("ground_reflectance")) {
      ground_reflectance_ = in_bands(*ground);
      for (double& r : ground_reflectance_)
        if (r = as_share(r); !is_share(r))
          throw ground->error("the ground's reflectance is not between 0 and 1 in every band");
    }
    planes_ = {true, true};
    if (const auto planes = p.find("planes")) {
      planes_ = {false, false};
      for (const Params& plane : planes->items()) planes_[plane.as_choice({"principal", "orthogonal"})] = true;
    }
    for (const size_t plane : {0u, 1u})
      for (size_t k = 0; planes_[plane] && k < kViews; ++k)
        views_.push_back({plane, -75 + 2.0 * static_cast<double>(k)});
    if (p.boolean("by_reciprocity", false)) {
      if (views_.empty())
        throw p.at("planes").error("by_reciprocity gives views alone, and no plane is listed",
                                   "list principal, orthogonal or both, or drop by_reciprocity for the fluxes");
      strata_ = static_cast<uint32_t>(p.integer("strata", 1, 4096, 32));
      capture_.columns = capture_.rows = strata_;
      capture_.bin_by = Capture::BinBy::sun;
      for (const View& v : views_) capture_.suns.push_back(direction(v));
      capture_.bins = static_cast<uint32_t>(views_.size());
    } else {
      capture_.columns = static_cast<uint32_t>(views_.size()) + 2;
      capture_.rows = 1;
    }
    capture_.neighbours = false;
    model_ = p.name("model", "suite");
    experiment_ = p.name("experiment", "");
    if (!experiment_.empty() && bands_.size() > 1)
      throw p.at("experiment").error("an experiment has one band", "give each band a sensor of its own");
    done();
  }
  std::span<const std::string> channels() const override {
    static const std::vector<std::string> both{"radiance", "single_scattering"};
    return both;
  }
  SensorRay ray(const RayRequest& r) const override {
    const size_t i = r.problem;
    if (strata_) {
      const double column = static_cast<double>(i % strata_), row = static_cast<double>(i / strata_);
      return {{patch_.at((column + r.u[0]) / strata_, (row + r.u[1]) / strata_, top_),
               -dir_from_angles(sun_zenith_, sun_azimuth_), moment(0)}};
    }
    if (i < views_.size()) return {{patch_.at(r.u[0], r.u[1], top_), -direction(views_[i]), moment(0)}};
    if (i == views_.size()) {  // all directions, cosine-weighted: the mean radiance times pi is the flux upwards
      const Dir out = cosine_hemisphere({r.u[2], r.u[3]});
      return {{patch_.at(r.u[0], r.u[1], top_), -out, moment(0)}};
    }
    SensorRay up{{patch_.at(r.u[0], r.u[1], ground_ + kAbove), {0, 0, 1}, moment(0)}};  // what falls on the ground
    up.receiver = SensorRay::Receiver::plane;
    return up;
  }

 private:
  struct View {
    size_t plane;       // 0 = the sun's, 1 = orthogonal to it
    double zenith_deg;  // negative: from the sun's side
    double from_sun_deg() const { return (plane ? 90 : 0) + (zenith_deg < 0 ? 0 : 180); }
  };
  struct Value {
    double value, error;
  };
  Dir direction(const View& v) const {
    return dir_from_angles(std::fabs(v.zenith_deg) * kDegree, sun_azimuth_ + v.from_sun_deg() * kDegree);
  }
  // BRF of a problem of the direct mode.
  Value value(const Delivery& d, size_t i, size_t channel, size_t b) const {
    const double scale = kPi / (irradiance_[b] * std::cos(sun_zenith_));
    const size_t at = (i * 2 + channel) * bands_.size() + b;
    return {scale * d.result.radiance[at], scale * d.result.standard_error[at]};
  }
  // BRF of a view, in either mode.
  Value brf(const Delivery& d, size_t i, size_t channel, size_t b) const {
    if (!strata_) return value(d, i, channel, b);
    const double scale = kPi / std::cos(views_[i].zenith_deg * kDegree) / static_cast<double>(d.result.problems());
    double mean = 0, square = 0;
    for (size_t p = 0; p < d.result.problems(); ++p) {
      const size_t at = ((p * 2 + channel) * views_.size() + i) * bands_.size() + b;
      mean += d.result.radiance[at];
      square += d.result.standard_error[at] * d.result.standard_error[at];
    }
    return {scale * mean, scale * std::sqrt(square)};
  }
  void finish(Delivery& d) const override {
    std::string views = "plane,view_zenith_deg,view_azimuth_from_sun_deg,band,brf,standard_error,brf_single\n";
    std::string fluxes = "band,quantity,value,standard_error\n";
    for (size_t b = 0; b < bands_.size(); ++b) {
      std::array<std::string, 2> total, multiple;
      for (size_t i = 0; i < views_.size(); ++i) {
        const View& v = views_[i];
        const Value all = brf(d, i, 0, b);
        const double single = brf(d, i, 1, b).value;
        views += strf("%s,%g,%g,%s,%.8g,%.3g,%.8g\n", v.plane ? "orthogonal" : "principal", v.zenith_deg,
                      v.from_sun_deg(), bands_[b].name.c_str(), all.value, all.error, single);
        total[v.plane] += mes_line(v, all.value);
        multiple[v.plane] += mes_line(v, all.value - single);
      }
      if (!strata_) add_fluxes(d, b, fluxes);
      for (const size_t plane : {0u, 1u}) {
        if (!planes_[plane]) continue;
        const std::string head = strf("%zu\t5\t-1.000000\n", kViews);
        add_mes(d, b, plane ? "brfop" : "brfpp", head + total[plane]);
        add_mes(d, b, plane ? "brfop_mlt" : "brfpp_mlt", head + multiple[plane]);
      }
      if (!strata_)
        add_mes(d, b, "brf1",
                strf("1\t5\t-1.000000\n%.6f\t-1.000000\t-1.000000\t%.6f\t-1.000000\n", sun_zenith_,
                     value(d, views_.size(), 0, b).value));
    }
    if (!views_.empty()) d.texts.push_back({name_ + "_brf.csv", std::move(views)});
    if (!strata_) d.texts.push_back({name_ + "_fluxes.csv", std::move(fluxes)});
    d.description = strata_ ? "problems: strata of the patch; bins: views, as radiance back along the sun's rays"
                            : "problems: the views of each plane, the upward flux, what falls on the ground";
  }
  // Tables of the intercomparison's model checker: files <measurement>_<model>-<experiment>.mes; a line that counts
  // lines and columns; then sun zenith, view zenith, view azimuth from the sun (rad), value, its spread (-1 = not
  // given).
  std::string mes_line(const View& v, double value) const {
    return strf("%.6f\t%.6f\t%.6f\t%.6f\t-1.000000\n", sun_zenith_, std::fabs(v.zenith_deg) * kDegree,
                v.from_sun_deg() * kDegree, value);
  }
  void add_mes(Delivery& d, size_t b, const std::string& measurement, std::string text) const {
    const std::string experiment = experiment_.empty() ? name_ + "_" + bands_[b].name : experiment_;
    d.texts.push_back({measurement + "_" + model_ + "-" + experiment + ".mes", std::move(text)});
  }
  void add_fluxes(const Delivery& d, size_t b, std::string& text) const {
    auto line = [&](const char* what, double v, double e) {
      text += strf("%s,%s,%.8g,%.3g\n", bands_[b].name.c_str(), what, v, e);
    };
    const Value albedo = value(d, views_.size(), 0, b), ground = value(d, views_.size() + 1, 0, b);
    line("black_sky_albedo", albedo.value, albedo.error);
    // A receiver shows its irradiance over pi.
    line("transmitted_to_ground", ground.value, ground.error);
    if (ground_reflectance_.empty()) return;
    const double taken = 1 - ground_reflectance_[b];
    line("absorbed_by_ground", taken * ground.value, taken * ground.error);
    line("absorbed_by_canopy", 1 - albedo.value - taken * ground.value, std::hypot(albedo.error, taken * ground.error));
  }

  Patch patch_;
  std::string model_, experiment_;
  double top_ = 0, ground_ = 0, sun_zenith_ = 0, sun_azimuth_ = 0;
  std::vector<double> irradiance_, ground_reflectance_;
  std::array<bool, 2> planes_{};
  std::vector<View> views_;
  uint32_t strata_ = 0;  // 0: direct
};

}  // namespace

SensorRow rami_row() {
  return {"rami", "BRF in two planes, black-sky albedo and absorbed fluxes of a canopy, as CSV and .mes tables", "",
          make_kind<Rami>};
}

}  // namespace suite
