// Lamps before they are baked: from a text, and as others need to know them.
#include <algorithm>

#include "light/kinds/lamps.h"
#include "light/kinds/rows.h"
#include "spectral/photopic.h"

namespace suite {

namespace {

const Curve& spectrum_of(const LampSpec& lamp) {
  return lamp.kind == LampSpec::Kind::surface ? lamp.radiance : lamp.intensity;
}

class LampLights final : public LightSpec {
 public:
  explicit LampLights(std::vector<LampSpec> lamps) : lamps_(std::move(lamps)) {}
  std::string key() const override { return "lamps"; }
  size_t entries() const override { return lamps_.size(); }
  LightSpecPtr joined(std::span<LightSpecPtr> others) const override {
    std::vector<LampSpec> all = lamps_;
    for (LightSpecPtr& other : others) {
      const auto* lamps = dynamic_cast<const LampLights*>(other.get());
      if (!lamps) continue;
      all.insert(all.end(), lamps->lamps_.begin(), lamps->lamps_.end());
      other = nullptr;
    }
    return all.size() == lamps_.size() ? nullptr : make_light(std::move(all));
  }
  bool shines(double low_um, double high_um) const override {
    return std::any_of(lamps_.begin(), lamps_.end(),
                       [&](const LampSpec& lamp) { return shines_between(spectrum_of(lamp), low_um, high_um); });
  }
  bool polarised() const override {
    return std::any_of(lamps_.begin(), lamps_.end(), [](const LampSpec& lamp) { return lamp.stokes.has_value(); });
  }
  void add_spectra(std::vector<LightSpectra>& to) const override {
    for (const LampSpec& lamp : lamps_) add_curve("lamp '" + lamp.name + "'", spectrum_of(lamp), to);
  }
  std::vector<std::string> hardly_met(double) const override {
    std::vector<std::string> points;
    for (const LampSpec& lamp : lamps_)
      if (lamp.kind != LampSpec::Kind::surface) points.push_back("lamp '" + lamp.name + "' (a point)");
    return points;
  }
  std::shared_ptr<const Light> bake(const Tracer& tracer, const SpectralState& state) const override {
    return std::make_shared<const Lamps>(lamps_, tracer, state);
  }

 private:
  const std::vector<LampSpec> lamps_;
};

LampSpec named_lamp(LampSpec::Kind kind, const Params& p, const LightContext& context) {
  LampSpec lamp;
  lamp.where = p.where();
  lamp.name = p.text("name", strf("lamp %zu", context.number));
  lamp.kind = kind;
  if (const auto schedule = p.find("schedule")) lamp.schedule = context.schedule(*schedule);
  if (const auto stokes = p.find("stokes")) lamp.stokes = read_stokes(*stokes);
  if (const auto axis = p.find("stokes_axis")) {
    if (!lamp.stokes) throw axis->error("an axis of light that is not polarised", "`stokes: [1, Q, U, V]` beside it");
    const auto v = axis->as_direction();
    lamp.stokes_axis = Dir{v[0], v[1], v[2]};
  }
  return lamp;
}

// The spectrum, on whatever scale, of a unit of a map that holds radiance in a band.
Curve of_a_map(const Curve& spectrum, const Params& p, const Params& map) {
  std::vector<double> band{0.5, 0.9};
  const auto given = map.find("band_um");
  if (given) band = given->as_numbers();
  if (band.size() != 2 || !(band[0] >= 0.1 && band[0] < band[1] && band[1] <= 100))
    throw given->error("a band is two wavelengths, the lower one first", "as in [0.5, 0.9]");
  const double unit = map.number_in("scale", 1e-30, 1e30, "W/(m2 sr) of a unit of the map", 1e-5);
  if (!spectrum.covers(band[0], band[1]))
    throw p.error("the spectrum reaches from " + spectrum.range_text() +
                      strf(", and the map's band from %g to %g um", band[0], band[1]),
                  "give a longer curve, or declare 'outside: hold' or 'zero'");
  const double in_band = spectrum.mean(band[0], band[1]) * (band[1] - band[0]);
  if (!(in_band > 0)) throw p.error("has no light in the map's band");
  return spectrum.scaled(unit / in_band);
}

LightSpecPtr read_surface(const Params& p, const LightContext& context) {
  LampSpec lamp = named_lamp(LampSpec::Kind::surface, p, context);
  lamp.material = p.text("material");
  lamp.radiance = context.positive(p.at("radiance"), "radiance", "W/(m2 sr um)");
  lamp.both_sides = p.boolean("both_sides", false);
  if (const auto map = p.find("map")) {
    lamp.map = context.lamp_map(*map);
    lamp.radiance = of_a_map(lamp.radiance, p.at("radiance"), *map);
  }
  return make_light(std::move(lamp));
}

Vec3 vector_of(const Params& p) {
  const auto v = p.as_vec3();
  return {v[0], v[1], v[2]};
}

std::shared_ptr<const IntensityTable> read_distribution(const Params& p, const LightContext& context) {
  auto t = std::make_shared<IntensityTable>();
  if (const auto file = p.find("sqt")) {
    t->sqt = context.intensity(*file);
    return t;
  }
  if (const auto file = p.find("ies")) {
    *t = context.candela(*file);
    return t;
  }
  const Params table = p.at("table");
  read_rows(table, t->polars, t->azimuths, t->value, "a table of intensity");
  if (t->polars < 2)
    throw table.error("a table of intensity needs at least two rows", "the first is the axis, the last its opposite");
  return t;
}

// The spectrum, on whatever scale, of a light of one candela.
Curve of_a_candela(const Curve& spectrum, const Params& p) {
  if (!spectrum.covers(0.38, 0.78))
    throw p.error(
        "the spectrum of a light in candela reaches from " + spectrum.range_text() + ", not from 0.38 to 0.78 um",
        "give a longer curve, or declare 'outside: hold' or 'zero'");
  const double candela = photopic(spectrum);
  if (!(candela > 0)) throw p.error("has no light that the eye sees: candela cannot say how much it is");
  return spectrum.scaled(1 / candela);
}

// Places, axis and intensity of points of either kind, and the cone of spots.
LightSpecPtr read_points(LampSpec::Kind kind, const Params& p, const LightContext& context) {
  LampSpec lamp = named_lamp(kind, p, context);
  lamp.ride = p.text("attached_to", "");
  const auto one = p.find("position_m");
  const auto many = p.find("positions_m");
  if (!one == !many) throw p.error("a lamp has either position_m or positions_m");
  if (one)
    lamp.positions.push_back(vector_of(*one));
  else
    for (const Params& at : many->items()) lamp.positions.push_back(vector_of(at));
  if (lamp.positions.empty()) throw many->error("a lamp needs at least one position");
  if (const auto axis = p.find("axis")) {
    lamp.axis = vector_of(*axis);
    if (!(length(lamp.axis) > 0)) throw axis->error("the axis has no length");
  }
  lamp.intensity = context.positive(p.at("intensity"), "intensity", "W/(sr um)");
  if (kind == LampSpec::Kind::spot) {
    const Params outer = p.at("outer_deg");
    lamp.outer = outer.as_number_in(0.01, 180, "degrees") * kDegree;
    lamp.inner = p.number_in("inner_deg", 0, 180, "degrees", 0.8 * lamp.outer / kDegree) * kDegree;
    if (lamp.inner > lamp.outer) throw outer.error("the outer cone is narrower than the inner one");
  }
  if (const auto distribution = p.find("distribution")) {
    lamp.table = read_distribution(*distribution, context);
    if (distribution->find("ies")) lamp.intensity = of_a_candela(lamp.intensity, p.at("intensity"));
  }
  return make_light(std::move(lamp));
}

}  // namespace

LightSpecPtr make_light(std::vector<LampSpec> lamps) { return std::make_shared<const LampLights>(std::move(lamps)); }
LightSpecPtr make_light(LampSpec lamp) { return make_light(std::vector<LampSpec>{std::move(lamp)}); }

LightRow lamp_point_row() {
  return {
      {"lamps point", "a point of intensity W/(sr um), with a table or SQT of its distribution if given", "W/(sr um)",
       [](const Params& p, const LightContext& c) { return read_points(LampSpec::Kind::point, p, c); }},
      true,
      "Point, spot and glowing lamps: a light tree is built over them and one is sampled at every node.",
      "lamps: [{kind: point, position_m: [0.5, -0.3, 2], intensity: 100, distribution: {table: [[1], [0.5], "
      "[0.2]]}}]\n"};
}

LightRow lamp_spot_row() {
  return {{"lamps spot", "a point that shines into a cone with a smooth rim", "W/(sr um)",
           [](const Params& p, const LightContext& c) { return read_points(LampSpec::Kind::spot, p, c); }},
          true,
          {},
          "lamps: [{kind: spot, position_m: [0.3, 0.4, 3], intensity: 50, outer_deg: 30, axis: [-0.1, -0.1, -1]}]\n"};
}

LightRow lamp_surface_row() {
  return {
      {"lamps surface", "everything of one material glows with a radiance W/(m2 sr um)", "W/(m2 sr um)", read_surface},
      true,
      {},
      "lamps: [{kind: surface, material: lamp, radiance: 20}]\n"};
}

}  // namespace suite
