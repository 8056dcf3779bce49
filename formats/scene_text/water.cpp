// A medium that is given by what is in the water.
#include "water/water.h"
#include "formats/scene_text/reader.h"

namespace suite::scene_text {

// A table of measured properties: columns wavelength, absorption, scattering and, when there is a third, backscatter.
void Reader::read_measured_water(const Params& p, WaterSpec& spec) {
  const Params file = p.at("iop");
  const std::string path = input(file);
  CurveOptions options;
  const auto column = [&](int k) {
    options.column = k;
    return read_curve(path, options);
  };
  const Curve absorption = column(1), scattering = column(2);
  for (const Curve* c : {&absorption, &scattering})
    if (c->min() < 0) throw file.error(strf("'%s' holds %g 1/m", file.as_text().c_str(), c->min()), "at least 0");
  spec.measured = MeasuredWater{absorption, scattering, std::nullopt, p.boolean("includes_water", true)};
  if (p.boolean("iop_backscatter", false)) spec.measured->backscatter = column(3);
}

void Reader::read_water(const Params& p, Medium& m) {
  WaterSpec s;
  s.temperature_c = p.number("temperature_c", s.temperature_c);
  s.salinity_psu = p.number("salinity", s.salinity_psu);
  s.chlorophyll = p.number("chlorophyll", 0);
  if (const auto cdom = p.find("cdom"); cdom && cdom->as_text() == "case_1")
    s.case_1_dissolved = true;
  else if (cdom)
    s.dissolved_440 = cdom->as_number();
  s.dissolved_slope_per_nm = p.number("cdom_slope_per_nm", s.dissolved_slope_per_nm);
  s.mineral = p.number("mineral", 0);
  s.mineral_backscatter = p.number("mineral_backscatter", s.mineral_backscatter);
  s.particles = p.text("phase", s.particles);
  s.backscatter = p.number("backscatter", 0);
  s.g = p.number("g", s.g);
  if (const auto pure = p.find("pure"))
    s.pure = pure->as_choice({"segelstein", "hale_querry"}) == 0 ? PureWater::segelstein : PureWater::hale_querry;
  if (const auto curve = p.find("pure_absorption")) s.pure_absorption = read_curve_value(*curve);
  if (p.has("iop")) read_measured_water(p, s);
  const Medium made = water_medium(s, p.where());
  m.absorption = made.absorption, m.scattering = made.scattering, m.index = made.index;
  m.phase = made.phase, m.temperature_k = made.temperature_k;
  for (const std::string& note : water_notes(s, made))
    report_.add("SP608", draft_.file, {p.where(), "medium '" + m.id + "': " + note});
}

}  // namespace suite::scene_text
