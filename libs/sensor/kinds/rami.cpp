// The measurements of the RAMI canopy intercomparison: BRF in the principal and the orthogonal plane, black-sky albedo,
// and what canopy and ground absorb.
//
// Assumes: a collimated sun of the given direction and irradiance and no sky in the simulation; a Lambertian ground.
// The reference area is the whole patch at the height of the canopy's top; every problem is a mean over all of it.
// Based on: J.-L. Widlowski et al., "Third Radiation Transfer Model Intercomparison (RAMI) exercise", J. Geophys. Res.
// 112, 2007; Goodenough & Brown, section V-B (each measurement is a problem of fixed angles).
#include <cmath>

#include "sensor/kinds/simple.h"

namespace suite {

namespace {

constexpr int kViews = 76;       // -75, -73 ... 75 degrees in each plane
constexpr double kAbove = 1e-3;  // m: where the look at the ground starts

class Rami final : public SimpleSensor {
 public:
  Rami(const Params& p, const SensorContext& context)
      : SimpleSensor(p, context, "rami"), patch_(read_patch(p.at("patch"))) {
    top_ = p.number_in("top_m", -1e7, 1e7, "m");
    ground_ = p.number_in("ground_m", -1e7, top_, "m", 0);
    sun_zenith_ = p.number_in("sun_zenith_deg", 0, 89.9, "degrees") * kDegree;
    sun_azimuth_ =
        azimuth_from_compass_deg(p.number_in("sun_azimuth_deg", -360, 360, "degrees clockwise from north", 90));
    const BandProjection projection(states_[0], bands_);
    auto in_bands = [&](const Params& value) {
      std::vector<float> bins = states_[0].sample(context.curve(value));
      std::vector<double> wide(bins.begin(), bins.end()), out(bands_.size());
      projection.apply(wide, out);
      return out;
    };
    irradiance_ = in_bands(p.at("irradiance"));
    for (const double e : irradiance_)
      if (!(e > 0)) throw p.at("irradiance").error("the sun's irradiance must be positive in every band");
    if (const auto ground = p.find("ground_reflectance")) ground_reflectance_ = in_bands(*ground);
    capture_.columns = 2 * kViews + 2;
    capture_.rows = 1;
    capture_.neighbours = false;
    done();
  }
  std::span<const Channel> channels() const override {
    static constexpr Channel both[] = {Channel::radiance, Channel::single};
    return both;
  }
  SensorRay ray(const RayRequest& r) const override {
    const size_t i = r.problem;
    if (i < 2 * kViews) {
      const Dir out = view(i);
      return {{patch_.at(r.u[0], r.u[1], top_), -out, moment(0)}};
    }
    if (i == 2 * kViews) {  // all directions, cosine-weighted: the mean radiance times pi is the flux upwards
      const Dir out = cosine_hemisphere({r.u[2], r.u[3]});
      return {{patch_.at(r.u[0], r.u[1], top_), -out, moment(0)}};
    }
    return {{patch_.at(r.u[0], r.u[1], ground_ + kAbove), {0, 0, -1}, moment(0)}};  // the ground itself
  }

 private:
  // Negative zeniths look from the sun's side.
  static double zenith_deg(size_t i) { return -75 + 2.0 * static_cast<double>(i % kViews); }
  Dir view(size_t i) const {
    const double zenith = zenith_deg(i) * kDegree, side = i < kViews ? 0 : kPi / 2;
    return dir_from_angles(std::fabs(zenith), sun_azimuth_ + side + (zenith < 0 ? 0 : kPi));
  }
  double value(const Delivery& d, size_t i, size_t channel, size_t b, bool error) const {
    const auto& from = error ? d.result.standard_error : d.result.radiance;
    return kPi * from[(i * 2 + channel) * bands_.size() + b] / (irradiance_[b] * std::cos(sun_zenith_));
  }
  void finish(Delivery& d) const override {
    std::string views = "plane,view_zenith_deg,view_azimuth_from_sun_deg,band,brf,standard_error,brf_single\n";
    std::string fluxes = "band,quantity,value,standard_error\n";
    for (size_t b = 0; b < bands_.size(); ++b) {
      for (size_t i = 0; i < 2 * kViews; ++i) {
        const double from_sun = (i < kViews ? 0 : 90) + (zenith_deg(i) < 0 ? 0 : 180);
        views +=
            strf("%s,%g,%g,%s,%.8g,%.3g,%.8g\n", i < kViews ? "principal" : "orthogonal", zenith_deg(i), from_sun,
                 bands_[b].name.c_str(), value(d, i, 0, b, false), value(d, i, 0, b, true), value(d, i, 1, b, false));
      }
      add_fluxes(d, b, fluxes);
      for (const int plane : {0, 1})
        d.texts.push_back({name_ + "_" + bands_[b].name + (plane ? "-brfop.mes" : "-brfpp.mes"), mes(d, b, plane)});
    }
    d.texts.push_back({name_ + "_brf.csv", std::move(views)});
    d.texts.push_back({name_ + "_fluxes.csv", std::move(fluxes)});
    d.description = "problems: 76 views in the principal plane, 76 in the orthogonal one, the upward flux, the ground";
  }
  void add_fluxes(const Delivery& d, size_t b, std::string& text) const {
    auto line = [&](const char* what, double v, double e) {
      text += strf("%s,%s,%.8g,%.3g\n", bands_[b].name.c_str(), what, v, e);
    };
    const double albedo = value(d, 2 * kViews, 0, b, false), e = value(d, 2 * kViews, 0, b, true);
    line("black_sky_albedo", albedo, e);
    if (ground_reflectance_.empty() || !(ground_reflectance_[b] > 0)) return;
    // A Lambertian ground of reflectance r shows r times its irradiance over pi.
    const double r = ground_reflectance_[b], down = value(d, 2 * kViews + 1, 0, b, false) / r,
                 de = value(d, 2 * kViews + 1, 0, b, true) / r;
    line("transmitted_to_ground", down, de);
    line("absorbed_by_ground", (1 - r) * down, (1 - r) * de);
    line("absorbed_by_canopy", 1 - albedo - (1 - r) * down, std::hypot(e, (1 - r) * de));
  }
  // One line a view: sun zenith, sun azimuth, view zenith, view azimuth from the sun (rad), value; the first line
  // counts lines and columns.
  std::string mes(const Delivery& d, size_t b, int plane) const {
    std::string text = strf("%d 5 -1.000000\n", kViews);
    for (int i = 0; i < kViews; ++i) {
      const size_t at = static_cast<size_t>(plane * kViews + i);
      const double from_sun = (plane ? 90 : 0) + (zenith_deg(at) < 0 ? 0 : 180);
      text += strf("%.6f %.6f %.6f %.6f %.6f\n", sun_zenith_, 0.0, std::fabs(zenith_deg(at)) * kDegree,
                   from_sun * kDegree, value(d, at, 0, b, false));
    }
    return text;
  }

  Patch patch_;
  double top_ = 0, ground_ = 0, sun_zenith_ = 0, sun_azimuth_ = 0;
  std::vector<double> irradiance_, ground_reflectance_;
};

}  // namespace

SensorRow rami_row() {
  return {
      "rami", "BRF in two planes, black-sky albedo and absorbed fluxes of a canopy, as CSV and .mes tables",
      [](const Params& p, const SensorContext& c) -> std::unique_ptr<Sensor> { return std::make_unique<Rami>(p, c); }};
}

}  // namespace suite
