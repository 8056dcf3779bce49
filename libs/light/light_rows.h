// The table of kinds of lights. A row makes a light from a text; from the table come the keys of the simulation text,
// the error for an unknown kind, `--list-sources`, the features of the renderer, and the conformance tests.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/params.h"
#include "base/registry.h"
#include "light/intensity_table.h"
#include "light/lamp_map.h"
#include "light/lamp_schedule.h"
#include "light/light_spec.h"
#include "light/night/stars.h"
#include "math/mueller.h"
#include "motion/sgp4.h"

namespace suite {

// A curve of a source and where it stands, for the check that it covers what the sensors see.
struct AskedCurve {
  Where where;
  std::string what;  // "irradiance"
  Curve curve;
  std::string hint = "give a longer curve, or declare 'outside: hold' or 'zero'";
};

// A raster as it is stored: row-major, first row first, channels together.
struct LightImage {
  uint32_t width = 0, height = 0, channels = 0;
  std::vector<float> values;
};

// What rows read through: libs open no files.
struct LightContext {
  std::function<Curve(const Params&)> curve;
  std::function<LightImage(const std::string& path)> image;
  // An SQT of quantity `intensity`. Error, at the value that names the file, for others.
  std::function<std::shared_ptr<const sqt::Bundle>(const Params& path)> intensity;
  // Candela of a luminaire's photometric file.
  std::function<IntensityTable(const Params& path)> candela;
  // When a lamp is how bright.
  std::function<std::shared_ptr<const LampSchedule>(const Params&)> schedule;
  // A raster that says how bright a surface is where, of its keys `file`, `local` and `no_data`.
  std::function<std::shared_ptr<const LampMap>(const Params&)> lamp_map = {};
  // Stars of a catalogue of the user.
  std::function<std::vector<CatalogueStar>(const Params& path)> stars = {};
  // Mean elements of a satellite, of its keys `tle` and `satellite`, or `tle_lines`.
  std::function<OrbitElements(const Params&)> orbit = {};
  std::optional<SourceTime> date = {};       // of second 0, where the text says it
  std::vector<AskedCurve>* asked = nullptr;  // receives the curves that were read
  size_t number = 1;                         // of the entry in its list

  // A curve of values >= 0, noted in `asked`. what, unit: for the error.
  Curve positive(const Params& p, const char* what, const char* unit) const;
  // A curve of ours that an entry means by giving none: noted, too. key: under which one of its own would be given.
  Curve builtin(const Params& entry, const char* what, const char* key, const Curve& given) const;
};

// name: the key of the text, and behind a blank the `kind` where a key has several: "sun", "sky clear". The first row
// of a key is meant where a text gives no kind. unit: of the radiance, irradiance or intensity that it is given.
struct LightRow : RegistryRow<LightSpecPtr(const Params&, const LightContext&)> {
  bool list = false;    // the key holds a list, each entry with its kind
  std::string uses;     // what having such a light costs, for the features; that of the key's first row counts
  std::string example;  // a simulation text that holds nothing else; surfaces of its scene have the material "lamp"
  std::string key() const { return name.substr(0, name.find(' ')); }
  std::string kind() const { return name.find(' ') == name.npos ? "" : name.substr(name.find(' ') + 1); }
};

// Lights stand in an environment in the order of the table. Rows may be added before anything is read.
Registry<LightRow>& light_rows();
// The first row of every key.
std::vector<const LightRow*> light_keys();
// A light, of the kind that the text says. Located Error for anything wrong.
LightSpecPtr make_light(const LightRow& first_of_key, const Params& p, const LightContext& context);

// A Stokes vector over its intensity, [1, Q, U, V]. Located Error for one of no light.
Stokes read_stokes(const Params& p);

// Rows of numbers of equal length, >= 0 unless any are, appended to `values`. what: for errors, "a sky table".
enum class TableSigns { positive, any };
void read_rows(const Params& table, size_t& rows, size_t& columns, std::vector<double>& values, const char* what,
               TableSigns signs = TableSigns::positive);

}  // namespace suite
