// Kelvin at a place and time: what the renderer asks. Models are described by a TemperatureSpec, made from the one
// table in models.h, and immutable afterwards; what they need from above (loads) is passed in as a function.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "math/vec.h"
#include "thermal/loads.h"
#include "thermal/slab.h"

namespace suite {

// A temperature model as a user describes it and a scene stores it.
struct TemperatureSpec {
  std::string model;                      // a row of temperature_models(), e.g. "constant"
  std::map<std::string, double> numbers;  // e.g. "kelvin" -> 300; the row lists the names
  std::vector<double> times, kelvins;     // tabulated: s, K
  bool repeat = false;                    // tabulated: the table is one period
  std::vector<SlabLayer> layers;          // slab; empty = one layer from the numbers
  // What heats the surface, as a table over time (s); empty = others have to say.
  std::vector<double> load_times = {};
  std::vector<SurfaceLoad> loads = {};
  bool loads_repeat = false;
  std::map<std::string, std::string> texts = {};  // e.g. "back" -> "open"; the row lists the names
};

class TemperatureModel {
 public:
  virtual ~TemperatureModel() = default;
  // Surface temperature (K) of one place at ascending times (s), given the loads of that place; out has as many
  // entries. Error: times that do not ascend, loads or tables that do not cover them. May be called from many threads.
  virtual void kelvin(std::span<const double> times, const Loads& loads, std::span<double> out) const = 0;
  // Whether the loads matter; when not, an empty function may be passed.
  virtual bool needs_loads() const { return false; }
};

// A point of a surface whose temperature is asked for.
struct HeatedPlace {
  Vec3 position;    // scene ENU, m
  Dir normal = {};  // geometric, unit, of the front side; zero where it is not known
  // Number of the flattened instance and of the triangle in its mesh (0 of an exact surface); kNoPart where they are
  // not known.
  static constexpr uint32_t kNoPart = UINT32_MAX;
  uint32_t instance = kNoPart, triangle = kNoPart;
  uint32_t material = kNoPart;  // index, after overrides and maps
};

// Temperatures over a scene.
class TemperatureField {
 public:
  virtual ~TemperatureField() = default;
  virtual double kelvin(const HeatedPlace& place, double time) const = 0;  // s
  // K, standard error of what kelvin() gives; NaN where nobody knows.
  virtual double error(const HeatedPlace& /*place*/, double /*time*/) const { return NAN; }
  // What kelvin() may give, for tables that have to cover it.
  virtual std::array<double, 2> range() const { return {2, 2000}; }
};

// A model over a scene whose loads differ from place to place. Every question is answered anew: a slab is simulated for
// it, so passes that need many answers of one place should ask the model for all times at once.
using LoadsAt = std::function<Loads(const HeatedPlace& place)>;
std::unique_ptr<const TemperatureField> field_of(std::shared_ptr<const TemperatureModel> model, LoadsAt loads);

// The loads of a spec's own table; an empty function when it has none. Error: a bad table (see LoadTable).
Loads loads_of(const TemperatureSpec& spec);

// A model solved once over a span of times: the same kelvin everywhere, linear between times that lie no further apart
// than a minute (a 100 000th of the span, if that is more) and on every row of the spec's loads.
class SolvedField final : public TemperatureField {
 public:
  // begin <= end, s. Error: as TemperatureModel::kelvin.
  SolvedField(const TemperatureSpec& spec, double begin, double end);
  // Times outside the span see its nearer end.
  double kelvin(const HeatedPlace& place, double time) const override;
  std::array<double, 2> range() const override { return {coldest_, hottest_}; }

 private:
  std::vector<double> times_, kelvins_;
  double coldest_ = 0, hottest_ = 0;
};

}  // namespace suite
