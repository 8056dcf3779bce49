// A virtual goniometer: the BRDF of a patch of a scene, as samples that sqt-fit reads, so that a detailed tree becomes
// the material of a coarser scene.
//
// Rays come in from a few view zeniths all over the patch; what they would carry back is binned by the direction in
// which the paths leave the scene. Under a sky of radiance 1 everywhere and without a sun, a bin holds the integral of
// f(out, in) |cos in| over its cell, and divided by the cell's integral of the cosine it is the BRDF's mean there.
// Cells lie about the azimuth of the view, for reflectance has its extremes in its plane. Assumes: a scene that repeats
// itself or that is wider than light travels sideways. The samples are isotropic: the mean over the view azimuths from
// which the patch is seen, each with the light turned with it. Based on: Goodenough & Brown, section V-B (multi-scale
// modelling).
#include <cmath>

#include "sensor/kinds/simple.h"

namespace suite {

namespace {

class Goniometer final : public SimpleSensor {
 public:
  Goniometer(const Params& p, const SensorContext& context)
      : SimpleSensor(p, context, "goniometer"), patch_(read_patch(p.at("patch"))) {
    height_ = p.number_in("height_m", -1e7, 1e7, "m");
    back_ = p.number_in("distance_m", 0, 1e6, "m", 1000);
    for (const Params& z : p.at("view_zenith_deg").items()) {
      zeniths_.push_back(z.as_number_in(0, 89, "degrees") * kDegree);
      if (zeniths_.size() > 1 && !(zeniths_.back() > zeniths_[zeniths_.size() - 2]))
        throw z.error("the view zeniths do not ascend");
    }
    if (zeniths_.empty()) throw p.at("view_zenith_deg").error("there is no view zenith in the list");
    rings_ = static_cast<uint32_t>(p.integer("rings", 2, 256, 16));
    const uint32_t azimuths = static_cast<uint32_t>(p.integer("azimuths", 2, 512, 32));
    if (azimuths % 2) throw p.at("azimuths").error("the number of azimuths must be even");
    sides_ = static_cast<uint32_t>(p.integer("view_azimuths", 1, 512, 1));
    if (azimuths % sides_) throw p.at("view_azimuths").error("the number of azimuths must be a multiple of it");
    bilateral_ = p.boolean("bilateral", false);
    capture_.columns = static_cast<uint32_t>(zeniths_.size());
    capture_.rows = sides_;
    capture_.neighbours = false;
    capture_.bin_by = Capture::BinBy::escape;
    capture_.bins = rings_ * azimuths;
    capture_.escape_rings = rings_;
    done();
  }
  SensorRay ray(const RayRequest& r) const override {
    const size_t view = r.problem % zeniths_.size(), side = r.problem / zeniths_.size();
    const Dir out = dir_from_angles(zeniths_[view], 2 * kPi * static_cast<double>(side) / sides_);
    return {{patch_.at(r.u[0], r.u[1], height_) + out * back_, -out, moment(r.u[2])}};
  }

 private:
  uint32_t azimuths() const { return capture_.bins / rings_; }
  void finish(Delivery& d) const override {
    std::string text = "RAWBH10A " + name_ + "\n" + strf("%zu", bands_.size());
    for (const Band& b : bands_) text += strf(" %.9g", b.center_um);
    text += strf("\n%zu", zeniths_.size());
    for (const double z : zeniths_) text += strf(" %.12g", z);
    text += "\n";
    for (size_t v = 0; v < zeniths_.size(); ++v)
      for (uint32_t ring = 0; ring < rings_; ++ring)
        for (uint32_t a = 0; a < azimuths(); ++a) {
          // Rings are equal in z; the cosine's integral over a cell is its solid angle times its mean z.
          const double z = (ring + 0.5) / rings_, cell = z * 2 * kPi / capture_.bins, phi = 2 * kPi * a / azimuths(),
                       s = std::sqrt(1 - z * z);
          text += strf("%zu %.9g %.9g %.9g", v, s * std::cos(phi), s * std::sin(phi), z);
          for (size_t b = 0; b < bands_.size(); ++b) text += strf(" %.7g", value(d, v, ring, a, b) / cell);
          text += "\n";
        }
    d.texts.push_back({name_ + ".rawbh", std::move(text)});
    d.description =
        "integral of BRDF times cosine over cells of the hemisphere; right under a sky of radiance 1 everywhere and no "
        "sun";
    d.picture = false;
  }
  // Over the sides; the format has the view at azimuth 0.
  double mean(const Delivery& d, size_t view, uint32_t ring, uint32_t azimuth, size_t band) const {
    double sum = 0;
    for (uint32_t side = 0; side < sides_; ++side) {
      const size_t problem = view + size_t{side} * zeniths_.size(),
                   bin = size_t{ring} * azimuths() + (azimuth + side * (azimuths() / sides_)) % azimuths();
      sum += d.result.radiance[(problem * capture_.bins + bin) * bands_.size() + band];
    }
    return sum / sides_;
  }
  double value(const Delivery& d, size_t view, uint32_t ring, uint32_t azimuth, size_t band) const {
    if (zeniths_[view] == 0) {  // all azimuths are alike for what is isotropic
      double sum = 0;
      for (uint32_t a = 0; a < azimuths(); ++a) sum += mean(d, view, ring, a, band);
      return sum * rings_ / capture_.bins;
    }
    const double one = mean(d, view, ring, azimuth, band);
    return bilateral_ ? 0.5 * (one + mean(d, view, ring, (azimuths() - azimuth) % azimuths(), band)) : one;
  }
  Patch patch_;
  double height_ = 0, back_ = 0;
  std::vector<double> zeniths_;
  uint32_t rings_ = 0, sides_ = 1;
  bool bilateral_ = false;
};

}  // namespace

SensorRow goniometer_row() {
  return {"goniometer", "BRDF of a patch of a scene as samples for sqt-fit", "", make_kind<Goniometer>};
}

}  // namespace suite
