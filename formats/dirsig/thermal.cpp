// Temperatures of material entries. THERM becomes the scene's balance of heat (`temperature: {model: heat}`).
// Based on: the pages "Temperature solvers" and "Thermal cookbook" of DIRSIG's documentation; the units are those that
// values of public files have (FORMAT.md). What a thickness of 0 and the sign of EXPOSED_AREA stand for is not public.
#include <cmath>

#include "formats/dirsig/scene_writer.h"
#include "math/vec.h"

namespace suite::dirsig {

namespace {

// THERM counts in calories, grams, centimetres and hours.
constexpr double kCalorie = 4184;  // J/kg for 1 cal/g
// Where curves end before the thermal infrared begins, um.
constexpr double kInfraredBegins = 8;
constexpr double kDay = 86400;

struct Row {
  const char *key, *ours;
  double factor;
  const char* unit;
};
constexpr Row kRows[] = {{"SPECIFIC_HEAT", "specific_heat_j_kg_k", kCalorie, "cal/(g C)"},
                         {"MASS_DENSITY", "density_kg_m3", 1000, "g/cm3"},
                         {"THERMAL_CONDUCTIVITY", "conductivity_w_m_k", kCalorie / 1000 / 36, "cal/(cm h C)"},
                         {"THICKNESS", "thickness_m", 0.01, "cm"}};
enum { kHeat, kDensity, kConductivity, kThickness };

// Three times the depth at which a day's wave has 1/e of its size at the surface (H. Carslaw, J. Jaeger, Conduction of
// Heat in Solids, 1959, section 2.6): what lies deeper does not matter to the day.
double day_depth(double conductivity, double density, double specific_heat) {
  return 3 * std::sqrt(conductivity * kDay / (kPi * density * specific_heat));
}

}  // namespace

void SceneWriter::read_solvers(const Item& entry, Tree& to) {
  for (const char* key : {"RAD_SOLVER_NAME", "RAD_SOLVER"})
    if (const Item* solver = entry.find(key)) solver->mark_all(Fate::ignored, "paths are followed in one way here");
  // The old layout has THERM's numbers in the entry itself.
  if (entry.has("SPECIFIC_HEAT") || entry.has("MASS_DENSITY")) read_therm(entry, to);
  const Item *name = entry.find("TEMP_SOLVER_NAME"), *solver = entry.find("TEMP_SOLVER");
  if (!name) {
    if (solver) solver->mark_all(Fate::unsupported, "which solver it belongs to is not said");
    return;
  }
  const std::string kind = lower_case(name->value);
  if (kind == "null" || kind == "none") {
    name->mark(Fate::exact);
    if (solver) solver->mark_all(Fate::ignored, "no temperature");
  } else if (kind == "therm" || kind == "thermaltherm") {
    name->mark(Fate::approximated, "the balance of heat of the scene under its weather, in place of THERM");
    read_therm(solver ? *solver : entry, to);
  } else if (const Item* kelvin = solver ? solver->any({"TEMPERATURE", "CONSTANT_TEMPERATURE"}) : nullptr) {
    const bool known = kind == "datadriven" || kind == "constant" || kind == "fixed";
    name->mark(known ? Fate::exact : Fate::approximated, known ? "" : "a constant temperature");
    to.set("temperature_k", Tree::number(kelvin->number_in(1, 1e5), kelvin->where));
  } else {
    const bool balfour = kind.find("balfour") != kind.npos;
    name->mark(Fate::unsupported, std::string(balfour ? "which of sun, sky, air and wind each of Balfour's "
                                                        "coefficients (SPIE 2426, 1995) multiplies is not public"
                                                      : "this solver is not known "
                                                        "here") +
                                      ": the material does not emit until it is given a temperature");
    if (solver) solver->mark_all(Fate::unsupported, "of a solver that is not known here");
  }
}

// The one layer behind the surface; none without capacity or conduction.
void SceneWriter::read_layer(const Item& solver, Tree& heat) {
  double value[4] = {};
  const Item* item[4] = {};
  for (int i = 0; i < 4; ++i) {
    item[i] = solver.find(kRows[i].key);
    if (!item[i]) continue;
    const double raw = item[i]->number(Fate::converted, std::string("taken as ") + kRows[i].unit);
    value[i] = raw * kRows[i].factor;
    if (!(value[i] >= 1e-6)) {
      if (i != kThickness || raw != 0) item[i]->mark(Fate::approximated, "a value of 0 (or less) is none");
      value[i] = 0;
    }
  }
  if (value[kHeat] == 0 || value[kDensity] == 0 || value[kConductivity] == 0) {
    for (const Item* one : item)
      if (one) one->mark(Fate::approximated, "without heat, density and conductivity: nothing is stored behind it");
    return;
  }
  if (value[kThickness] == 0) {
    value[kThickness] = day_depth(value[kConductivity], value[kDensity], value[kHeat]);
    (item[kThickness] ? item[kThickness] : &solver)
        ->mark(Fate::approximated, strf("without a thickness (that of facets is not read): %.3g m, three times as deep "
                                        "as a day's wave goes",
                                        value[kThickness]));
  }
  for (int i = 0; i < 4; ++i) heat.set(kRows[i].ours, Tree::number(value[i], item[i] ? item[i]->where : solver.where));
}

void SceneWriter::read_therm(const Item& solver, Tree& to) {
  Tree heat = Tree::map(solver.where);
  heat.set("model", Tree::word("heat", solver.where));
  read_layer(solver, heat);
  if (const Item* sun = solver.any({"SOLAR_ABSORPTION", "VISIBLE_EMISSIVITY"})) {
    heat.set("absorptance", Tree::number(sun->number_in(0, 1), sun->where));
    sun->mark(Fate::approximated, "where the curves say nothing of sunlight; else they say what is absorbed");
  }
  if (const Item* glow = solver.find("THERMAL_EMISSIVITY")) {
    const double emissivity = glow->number_in(0, 1);
    if (reach_um_ && *reach_um_ < kInfraredBegins) {
      heat.set("emissivity", Tree::number(emissivity, glow->where));
      glow->mark(Fate::converted, "the curves end before the thermal infrared");
    } else {
      glow->mark(Fate::approximated, "the curves say what the surface emits");
    }
  }
  if (const Item* area = solver.find("EXPOSED_AREA")) {
    const bool both = std::fabs(area->number_in(-1e3, 1e3)) > 0.5;
    if (both) heat.set("back", Tree::word("open", area->where));
    area->mark(Fate::approximated, both ? "more than 0.5: taken as both sides in the open"
                                        : "to 0.5: taken as the front in the open, and nothing passes at the back");
  }
  for (const char* key : {"SPECULARITY", "SPECULARITY_THERM"})
    if (const Item* gloss = solver.find(key); gloss && !gloss->fate())
      gloss->mark(Fate::approximated, "the surface's own reflectance says how much is mirrored");
  to.set("temperature", std::move(heat));
  heat_ = true;
}

}  // namespace suite::dirsig
