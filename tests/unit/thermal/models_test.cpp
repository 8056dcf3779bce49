// Temperature models: what every row of the table promises, loads, and the refusal of bad parameters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "spectral/planck.h"
#include "thermal/models.h"

namespace suite::models_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Loads sunny_day() {
  return [](double t) {
    const double c = -std::cos(2 * kPi * t / 86400);
    return SurfaceLoad{500 * std::fmax(0.0, c), 330, 288 + 6 * c, 2};
  };
}
// Surroundings in balance at one temperature.
Loads cave(double kelvin) {
  return [=](double) { return SurfaceLoad{0, kStefanBoltzmann * std::pow(kelvin, 4), kelvin, 1}; };
}
std::vector<double> ask(const TemperatureModel& model, const std::vector<double>& times, const Loads& loads) {
  std::vector<double> out(times.size());
  model.kelvin(times, loads, out);
  return out;
}
template <class F>
std::string complaint(F make) {
  try {
    make();
    return "";
  } catch (const Error& e) {
    return e.what();
  }
}

class EveryTemperatureModel : public testing::TestWithParam<std::pair<const TemperatureRow*, TemperatureSpec>> {};

std::vector<std::pair<const TemperatureRow*, TemperatureSpec>> all_examples() {
  std::vector<std::pair<const TemperatureRow*, TemperatureSpec>> all;
  for (const TemperatureRow& row : temperature_models())
    for (const TemperatureSpec& spec : row.examples()) all.emplace_back(&row, spec);
  return all;
}

TEST_P(EveryTemperatureModel, IsPositiveRepeatableAndIndependentOfTheQuestions) {
  const auto model = make_temperature_model(GetParam().second);
  const std::vector<double> often{0, 1000, 1001, 20000, 20000.5, 50000, 80000}, rarely{0, 50000, 80000};
  const auto a = ask(*model, often, sunny_day()), b = ask(*model, often, sunny_day()),
             c = ask(*model, rarely, sunny_day());
  EXPECT_EQ(a, b);
  for (const double k : a) {
    EXPECT_GT(k, 200);
    EXPECT_LT(k, 400);
  }
  EXPECT_NEAR(a[5], c[1], 0.05);
  EXPECT_NEAR(a[6], c[2], 0.05);
  EXPECT_TRUE(ask(*model, {}, sunny_day()).empty());
}

TEST_P(EveryTemperatureModel, LoadsMatterExactlyWhenItSaysSo) {
  const auto model = make_temperature_model(GetParam().second);
  const auto sunny = ask(*model, {43200, 60000}, sunny_day());
  if (model->needs_loads())
    EXPECT_NE(sunny, ask(*model, {43200, 60000}, cave(280)));
  else
    EXPECT_EQ(sunny, ask(*model, {43200, 60000}, {}));
}

TEST_P(EveryTemperatureModel, RefusesEveryParameterOutsideItsRangeAndUnknownOnes) {
  const auto& [row, spec] = GetParam();
  for (const Parameter& p : row->parameters) {
    for (const double bad : {p.low - std::fmax(1e-12, std::fabs(p.low) * 0.01), p.high * 1.01 + 1, double{NAN}}) {
      TemperatureSpec s = spec;
      s.numbers[p.name] = bad;
      EXPECT_THAT(complaint([&] { make_temperature_model(s); }), HasSubstr(p.name + " = ")) << bad;
    }
    if (!p.required) continue;
    TemperatureSpec s = spec;
    s.numbers.erase(p.name);
    EXPECT_THAT(complaint([&] { make_temperature_model(s); }), HasSubstr("needs '" + p.name + "'"));
  }
  TemperatureSpec s = spec;
  s.numbers["nonsense"] = 1;
  EXPECT_THAT(complaint([&] {
                make_temperature_model(s, {"m.yaml", 3, 4, {}, -1});
              }),
              HasSubstr("m.yaml:3:4: error: temperature model '"));
}

INSTANTIATE_TEST_SUITE_P(Table, EveryTemperatureModel, testing::ValuesIn(all_examples()),
                         [](const auto& each) { return each.param.first->name + std::to_string(each.index); });

TEST(TemperatureModels, UnknownNamesGetTheNearest) {
  EXPECT_THAT(complaint([] { temperature_models().find("slap"); }), HasSubstr("did you mean 'slab'?"));
}

TEST(TemperatureModels, SlabInBalanceStaysThere) {
  for (const TemperatureSpec& example : temperature_models().find("slab").examples()) {
    TemperatureSpec spec = example;
    spec.numbers["initial_k"] = 280;
    if (spec.numbers.count("deep_temperature_k")) spec.numbers["deep_temperature_k"] = 280;
    const auto model = make_temperature_model(spec);
    for (const double k : ask(*model, {0, 40000, 90000}, cave(280))) EXPECT_NEAR(k, 280, 1e-6);
  }
}

TEST(TemperatureModels, SlabIsPeriodicUnderPeriodicLoads) {
  const auto model = make_temperature_model(temperature_models().find("slab").examples()[0]);
  const auto k = ask(*model, {0, 30000, 86400, 116400}, sunny_day());
  EXPECT_NEAR(k[0], k[2], 0.02);
  EXPECT_NEAR(k[1], k[3], 0.02);
  EXPECT_GT(ask(*model, {50000}, sunny_day())[0], k[0] + 5);  // the afternoon is warmer than midnight
}

TEST(TemperatureModels, SpecsThatContradictThemselves) {
  TemperatureSpec good = temperature_models().find("slab").examples()[0];
  auto changed = [&](auto change) {
    TemperatureSpec s = good;
    change(s);
    return complaint([&] { make_temperature_model(s); });
  };
  EXPECT_EQ(changed([](TemperatureSpec&) {}), "");
  EXPECT_THAT(changed([](TemperatureSpec& s) { s.numbers.erase("thickness_m"); }), HasSubstr("needs 'thickness_m'"));
  EXPECT_THAT(changed([](TemperatureSpec& s) { s.numbers.erase("period_s"); }), HasSubstr("needs a past"));
  EXPECT_THAT(
      changed([](TemperatureSpec& s) { s.numbers["deep_flux_w_m2"] = 1, s.numbers["deep_temperature_k"] = 280; }),
      HasSubstr("both a deep"));
  EXPECT_THAT(changed([](TemperatureSpec& s) { s.times = {0}; }), HasSubstr("takes no table"));
  EXPECT_THAT(complaint([] {
                make_temperature_model({"constant", {{"kelvin", 300}}, {}, {}, false, {SlabLayer{}}});
              }),
              HasSubstr("takes no layers"));
  EXPECT_THAT(complaint([] {
                make_temperature_model({"tabulated", {}, {}, {}, false, {}});
              }),
              HasSubstr("without a row"));
  EXPECT_THAT(complaint([] {
                make_temperature_model({"tabulated", {}, {0, 1}, {300, -5}, false, {}});
              }),
              HasSubstr("-5 K"));
  EXPECT_THAT(complaint([] {
                make_temperature_model({"tabulated", {}, {0, 1}, {300}, false, {}});
              }),
              HasSubstr("2 times and 1 values"));
  const auto model = make_temperature_model({"tabulated", {}, {0, 1}, {300, 301}, false, {}});
  EXPECT_THAT(complaint([&] { ask(*model, {2}, {}); }), HasSubstr("it covers 0 to 1 s"));
  TemperatureSpec late = temperature_models().find("slab").examples()[1];
  const auto slab = make_temperature_model(late);
  EXPECT_THAT(complaint([&] { ask(*slab, {-1e6}, cave(280)); }), HasSubstr("earlier start_s"));
  EXPECT_THAT(complaint([&] { ask(*slab, {10, 5}, cave(280)); }), HasSubstr("times ascend"));
}

TEST(Slab, RefusesImpossibleLayersAndFaces) {
  SlabLayer l;
  l.thickness = 0.1, l.density = 1000, l.specific_heat = {1000}, l.conductivity = {1};
  SlabSpec good;
  good.layers = {l};
  good.top.value = good.bottom.value = [](double) { return 0.0; };
  auto changed = [&](auto change, SlabOptions options = {}) {
    SlabSpec s = good;
    change(s);
    return complaint([&] { Slab slab(s, options); });
  };
  EXPECT_EQ(changed([](SlabSpec&) {}), "");
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers.clear(); }), HasSubstr("without a layer"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers[0].thickness = 0; }), HasSubstr("layer 1 of a slab: thickness 0"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers[0].density = 0; }), HasSubstr("density 0"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers[0].conductivity = {0}; }), HasSubstr("the conductivity is 0 at 20 K"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers[0].conductivity = {1, -0.01}; }), HasSubstr("the conductivity is -"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers[0].specific_heat = {NAN}; }), HasSubstr("specific heat"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers[0].contact_resistance = -1; }), HasSubstr("contact resistance"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers[0].heat_generation = INFINITY; }), HasSubstr("heat generation"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers[0].intervals = -1; }), HasSubstr("-1 intervals"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.top.value = nullptr; }), HasSubstr("the top of a slab has no function"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.top.kind = SlabFace::Kind::surface; }), HasSubstr("has no loads"));
  EXPECT_THAT(changed([](SlabSpec& s) {
                s.bottom.kind = SlabFace::Kind::surface, s.bottom.loads = cave(1), s.bottom.emissivity = 2;
              }),
              HasSubstr("emissivity 2"));
  EXPECT_THAT(changed([](SlabSpec& s) { s.layers[0].intervals = 50000, s.layers.resize(3, s.layers[0]); }),
              HasSubstr("more than 100000 nodes"));
  EXPECT_THAT(changed([](SlabSpec&) {}, {0, 3600, 1e-9, 60}), HasSubstr("tolerance"));
  EXPECT_THAT(changed([](SlabSpec&) {}, {0.1, 0, 1e-9, 60}), HasSubstr("largest step"));
  Slab slab(good, {});
  EXPECT_THAT(complaint([&] { slab.start(0, -3.0); }), HasSubstr("starts at -3 K"));
  slab.start(0, 300);
  slab.advance(10);
  EXPECT_THAT(complaint([&] { slab.advance(5); }), HasSubstr("times ascend"));
  EXPECT_THAT(complaint([&] { spin_up(slab, 0, -1, {}); }), HasSubstr("period of -1 s"));
}

TEST(Slab, SaysWhenItsLoadsAreNone) {
  SlabLayer l;
  l.thickness = 0.1, l.density = 1000, l.specific_heat = {1000}, l.conductivity = {1};
  SlabSpec spec;
  spec.layers = {l};
  spec.top.kind = SlabFace::Kind::surface;
  spec.top.loads = [](double t) { return SurfaceLoad{t > 100 ? NAN : 0.0, 300, 280, 0}; };
  spec.bottom.value = [](double) { return 0.0; };
  Slab slab(spec, {});
  slab.start(0, 280);
  EXPECT_THAT(complaint([&] { slab.advance(1000); }), HasSubstr("not finite at "));
  // A flux that no temperature can carry.
  spec.top.loads = [](double t) { return SurfaceLoad{t > 100 ? 1e12 : 0.0, 300, 280, 0}; };
  Slab burning(spec, {});
  burning.start(0, 280);
  EXPECT_THAT(complaint([&] { burning.advance(1000); }), HasSubstr("finds no step"));
  // Loads that never settle: a spin-up that cannot converge says so.
  spec.top.loads = [](double) { return SurfaceLoad{0, 300, 280, 0}; };
  spec.layers[0].thickness = 50;
  Slab thick(spec, {});
  thick.start(0, 400);
  EXPECT_THAT(complaint([&] { spin_up(thick, 0, 1000, {1e-9, 3}); }), HasSubstr("not periodic after 3 periods"));
}

// Bounded by steps, with the place; a hang before.
TEST(Slab, RefusesMoreStepsThanItCanTake) {
  TemperatureSpec slab{"slab",
                       {{"thickness_m", 0.1},
                        {"density_kg_m3", 2000},
                        {"specific_heat_j_kg_k", 900},
                        {"conductivity_w_m_k", 1},
                        {"period_s", 4294967296.0}},
                       {},
                       {},
                       false,
                       {}};
  slab.load_times = {0, 3600};
  slab.loads = {{500, 300, 290, 2}, {600, 300, 291, 2}};
  slab.loads_repeat = true;
  const Where place{"s.yaml", 4, 5, {}, -1};
  EXPECT_THAT(complaint([&] { make_temperature_model(slab, place); }),
              AllOf(HasSubstr("s.yaml:4:5: error: "), HasSubstr("4.2949673e+09 s are at least 2.39e+06 steps")));
  for (const double apart : {1e-300, 1e-6}) {
    slab.numbers["period_s"] = 3600;
    slab.load_times = {0, apart};
    EXPECT_THAT(complaint([&] { make_temperature_model(slab, place); }), HasSubstr("rows lie farther apart")) << apart;
  }
  // A past that begins too long ago is noticed when the time is known.
  slab.numbers.erase("period_s");
  slab.numbers["start_s"] = -1e11;
  slab.load_times = {0, 3600};
  EXPECT_THAT(complaint([&] { SolvedField(slab, 0, 10); }), HasSubstr("at least "));
  // A year of hourly loads is none too many.
  slab.numbers.erase("start_s");
  slab.numbers["period_s"] = 365.0 * 86400;
  EXPECT_EQ(complaint([&] { make_temperature_model(slab, place); }), "");
}

// Loads that never let a step grow: noticed after 20,000 steps, not after hours.
TEST(Slab, GivesUpWhenStepsStaySmall) {
  SlabLayer l;
  l.thickness = 0.1, l.density = 1000, l.specific_heat = {1000}, l.conductivity = {1};
  SlabSpec spec;
  spec.layers = {l};
  spec.top.kind = SlabFace::Kind::surface;
  spec.top.loads = [](double t) { return SurfaceLoad{1e4 * (1 + std::sin(1e7 * t)), 300, 280, 0}; };
  spec.bottom.value = [](double) { return 0.0; };
  SlabOptions options;
  options.max_step = 1e-5, options.most_steps = 1e5;
  Slab slab(spec, options);
  slab.start(0, 280);
  EXPECT_THAT(complaint([&] { slab.advance(3600); }), HasSubstr("a slab would take about "));
  EXPECT_LT(slab.counters().steps, 30000);
}

TEST(Loads, TablesInterpolateRepeatAndRefuse) {
  using Outside = LoadTable::Outside;
  const std::vector<SurfaceLoad> loads{{0, 300, 280, 0}, {100, 320, 290, 4}, {0, 300, 280, 0}};
  const LoadTable table({0, 10, 20}, loads, Outside::refuse);
  EXPECT_EQ(table.at(5).sun_absorbed, 50);
  EXPECT_EQ(table.at(15).sky_irradiance, 310);
  EXPECT_EQ(table.at(20).wind, 0);
  EXPECT_THAT(complaint([&] { table.at(20.1); }), HasSubstr("asked for 20.1 s; it covers 0 to 20 s"));
  EXPECT_THAT(complaint([&] { table.at(NAN); }), HasSubstr("it covers"));
  const Loads daily =
      LoadTable::function(std::make_shared<const LoadTable>(std::vector<double>{0, 10, 20}, loads, Outside::repeat));
  EXPECT_NEAR(daily(25).air_temperature, 285, 1e-12);
  EXPECT_NEAR(daily(-5).sun_absorbed, 50, 1e-12);
  EXPECT_THROW(LoadTable({}, {}, Outside::refuse), Error);
  EXPECT_THROW(LoadTable({0, 0}, {{}, {}}, Outside::refuse), Error);
  EXPECT_THROW(LoadTable({0}, {{}}, Outside::repeat), Error);
  EXPECT_THROW(LoadTable({0}, {{-1, 0, 0, 0}}, Outside::refuse), Error);
}

TEST(TemperatureField, AsksTheModelWithTheLoadsOfThePlace) {
  const std::shared_ptr<const TemperatureModel> slab =
      make_temperature_model(temperature_models().find("slab").examples()[0]);
  const auto field = field_of(slab, [](const HeatedPlace& p) { return cave(p.position.x > 0 ? 300 : 270); });
  EXPECT_NEAR(field->kelvin({{1, 0, 0}}, 1000), 300, 0.1);
  EXPECT_NEAR(field->kelvin({{-1, 0, 0}}, 1000), 270, 0.1);
  const auto uniform = field_of(make_temperature_model({"constant", {{"kelvin", 301}}, {}, {}, false, {}}), {});
  EXPECT_EQ(uniform->kelvin({}, 5), 301);
}

TEST(TemperatureField, SolvedOnceIsTheModelAskedAnew) {
  // A day that repeats, with the sun switched on within seconds: rows of loads are kinks of the temperature.
  TemperatureSpec spec = temperature_models().find("slab").examples()[0];
  spec.load_times = {0, 21600, 21601, 64800, 64801, 86400};
  spec.loads = {{0, 300, 280, 1},   {0, 300, 282, 1}, {500, 320, 285, 2},
                {400, 330, 290, 2}, {0, 320, 286, 1}, {0, 300, 280, 1}};
  spec.loads_repeat = true;
  const SolvedField field(spec, 5000, 190000);
  const auto model = make_temperature_model(spec);
  for (const double t : {5000.0, 21600.0, 21700.0, 43210.0, 70000.5, 100000.0, 189999.0}) {
    double kelvin = 0;
    model->kelvin({&t, 1}, loads_of(spec), {&kelvin, 1});
    EXPECT_NEAR(field.kelvin({}, t), kelvin, 0.1) << t;  // each has errors of its own steps, 0.01 K a step
  }
  EXPECT_EQ(field.kelvin({}, 0), field.kelvin({}, 5000));
  EXPECT_EQ(field.kelvin({}, 1e9), field.kelvin({}, 190000));
  EXPECT_LT(field.range()[0], field.range()[1] - 5);
  // An instant has one answer; loads that do not cover the times, or belong to another model, are refused.
  EXPECT_EQ(SolvedField(spec, 7, 7).range()[0], SolvedField(spec, 7, 7).range()[1]);
  spec.loads_repeat = false;
  EXPECT_THROW(SolvedField(spec, 0, 90000), Error);
  spec.loads.pop_back();
  EXPECT_THAT(complaint([&] { make_temperature_model(spec); }),
              HasSubstr("loads: a table over time has 6 times and 5 values"));
  TemperatureSpec constant{"constant", {{"kelvin", 301}}, {}, {}, false, {}};
  constant.load_times = {0}, constant.loads = {{}};
  EXPECT_THAT(complaint([&] { make_temperature_model(constant); }), HasSubstr("takes no loads"));
}

}  // namespace
}  // namespace suite::models_test
