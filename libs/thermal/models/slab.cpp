// Conduction in layers below a surface that absorbs, radiates and convects; see slab.h for the method.
#include <algorithm>
#include <cmath>

#include "thermal/models/rows.h"

namespace suite {

namespace {

class SlabModel final : public TemperatureModel {
 public:
  explicit SlabModel(const TemperatureSpec& s) : numbers_(s.numbers) {
    spec_.layers = s.layers;
    if (s.layers.empty()) {
      for (const char* name : {"thickness_m", "density_kg_m3", "specific_heat_j_kg_k", "conductivity_w_m_k"})
        if (!numbers_.count(name))
          throw Error(std::string("a slab without layers needs '") + name + "'", "all four, or layers");
      SlabLayer l;
      l.thickness = numbers_.at("thickness_m");
      l.density = numbers_.at("density_kg_m3");
      l.specific_heat = {numbers_.at("specific_heat_j_kg_k")};
      l.conductivity = {numbers_.at("conductivity_w_m_k")};
      spec_.layers = {l};
    }
    if (!numbers_.count("period_s") && !numbers_.count("start_s"))
      throw Error("a slab needs a past", "period_s to start periodic, or start_s with initial_k, or both");
    spec_.top.kind = SlabFace::Kind::surface;
    spec_.top.emissivity = numbers_.at("emissivity");
    spec_.top.convection_still = numbers_.at("convection_still_w_m2_k");
    spec_.top.convection_wind = numbers_.at("convection_wind_j_m3_k");
    if (const auto deep = numbers_.find("deep_temperature_k"); deep != numbers_.end()) {
      if (numbers_.at("deep_flux_w_m2") != 0)
        throw Error("a slab has both a deep temperature and a deep flux", "give one of them");
      spec_.bottom.kind = SlabFace::Kind::temperature;
      spec_.bottom.value = [kelvin = deep->second](double) { return kelvin; };
    } else {
      spec_.bottom.value = [flux = numbers_.at("deep_flux_w_m2")](double) { return flux; };
    }
    options_.tolerance = numbers_.at("tolerance_k");
    options_.max_step = numbers_.at("max_step_s");
    SlabSpec trial = spec_;  // refuses bad layers now, not at the first question
    trial.top.loads = [](double) { return SurfaceLoad{}; };
    Slab(std::move(trial), options_);
    if (s.loads_repeat && s.load_times.size() > 1)
      load_step_ = (s.load_times.back() - s.load_times.front()) / static_cast<double>(s.load_times.size() - 1);
    if (const auto period = numbers_.find("period_s"); period != numbers_.end())
      check_steps(period->second, "a slab's period_s");
  }

  void kelvin(std::span<const double> times, const Loads& loads, std::span<double> out) const override {
    SUITE_CHECK_EQ(times.size(), out.size());
    if (times.empty()) return;
    SlabSpec spec = spec_;
    spec.top.loads = loads;
    Slab slab(std::move(spec), options_);
    const auto period = numbers_.find("period_s"), begin = numbers_.find("start_s");
    const double start = begin != numbers_.end() ? begin->second : times[0] - period->second;
    if (start > times[0])
      throw Error(strf("a slab that starts at %.9g s is asked for %.9g s", start, times[0]), "give an earlier start_s");
    check_steps(times.back() - start, "the past of a slab and the time that is simulated");
    slab.start(start, numbers_.at("initial_k"));
    if (period != numbers_.end()) {
      spin_up(slab, start, period->second, {options_.tolerance / 10, 500});
      // The state repeats: the end of the period is also its start.
      const std::vector<double> periodic(slab.kelvin().begin(), slab.kelvin().end());
      slab.start(start, periodic);
    }
    for (size_t i = 0; i < times.size(); ++i) {
      slab.advance(times[i]);
      out[i] = slab.surface();
    }
  }
  bool needs_loads() const override { return true; }

 private:
  // The steps that a span takes at least: the longest allowed, and one for every row of loads that repeat.
  void check_steps(double span, const char* what) const {
    const double least = std::max(span / options_.max_step, span / load_step_);
    if (!(least <= options_.most_steps))
      throw Error(strf("%s: %.9g s are at least %.3g steps", what, span, least),
                  strf("at most %.2g: shorter, %s", options_.most_steps,
                       span / load_step_ > options_.most_steps ? "or loads whose rows lie farther apart"
                                                               : "or a longer max_step_s"));
  }
  std::map<std::string, double> numbers_;
  SlabSpec spec_;
  SlabOptions options_;
  double load_step_ = INFINITY;  // s, mean distance of the rows of loads that repeat
};

std::vector<TemperatureSpec> examples() {
  const std::map<std::string, double> soil{
      {"thickness_m", 0.5}, {"density_kg_m3", 1600},        {"specific_heat_j_kg_k", 900},  {"conductivity_w_m_k", 0.6},
      {"period_s", 86400},  {"convection_still_w_m2_k", 8}, {"convection_wind_j_m3_k", 3.8}};
  SlabLayer paint, steel, foam;
  paint.thickness = 1e-4, paint.density = 1400, paint.specific_heat = {1000}, paint.conductivity = {0.2};
  steel.thickness = 0.002, steel.density = 7800, steel.specific_heat = {300, 0.5}, steel.conductivity = {60, -0.02};
  steel.contact_resistance = 1e-3;
  foam.thickness = 0.05, foam.density = 40, foam.specific_heat = {1400}, foam.conductivity = {0.02, 0, 0, 1e-10};
  return {{"slab", soil, {}, {}, false, {}},
          {"slab",
           {{"start_s", -86400}, {"initial_k", 285}, {"deep_temperature_k", 293}, {"convection_still_w_m2_k", 5}},
           {},
           {},
           false,
           {paint, steel, foam}}};
}

}  // namespace

TemperatureRow slab_temperature_row() {
  using P = Parameter;
  return {
      {"slab", "conduction in layers, radiation, convection and absorbed light on top", "K",
       [](const TemperatureSpec& spec) -> std::unique_ptr<const TemperatureModel> {
         return std::make_unique<SlabModel>(spec);
       }},
      {{"thickness_m", P::Kind::number, "m", "of the one layer, when no layers are given", 1e-9, 1e6, false, NAN},
       {"density_kg_m3", P::Kind::number, "kg/m3", "of the one layer", 1e-6, 1e5, false, NAN},
       {"specific_heat_j_kg_k", P::Kind::number, "J/(kg K)", "of the one layer", 1e-6, 1e6, false, NAN},
       {"conductivity_w_m_k", P::Kind::number, "W/(m K)", "of the one layer", 1e-9, 1e5, false, NAN},
       {"emissivity", P::Kind::number, "1", "of the surface in the thermal infrared", 0, 1, false, 0.95},
       {"convection_still_w_m2_k", P::Kind::number, "W/(m2 K)", "transfer to still air", 0, 1e4, false, 0},
       {"convection_wind_j_m3_k", P::Kind::number, "J/(m3 K)", "its growth per m/s of wind", 0, 1e4, false, 0},
       {"deep_flux_w_m2", P::Kind::number, "W/m2", "flux from below", -1e5, 1e5, false, 0},
       {"deep_temperature_k", P::Kind::number, "K", "temperature held below, instead of a flux", 1, 10000, false, NAN},
       {"initial_k", P::Kind::number, "K", "where the past begins", 1, 10000, false, 290},
       {"start_s", P::Kind::number, "s", "when the past begins", -1e12, 1e12, false, NAN},
       {"period_s", P::Kind::number, "s", "the loads repeat: begin in the state that repeats with them", 1e-3, 1e12,
        false, NAN},
       {"tolerance_k", P::Kind::number, "K", "error of one step", 1e-6, 10, false, 0.01},
       {"max_step_s", P::Kind::number, "s", "longest step", 1e-6, 1e9, false, 1800}},
      false,
      true,
      examples};
}

}  // namespace suite
