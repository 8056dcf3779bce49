#include "air_lut.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <numeric>

#include "base/files.h"
#include "base/inputs.h"
#include "base/interrupt.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "base/run_app.h"
#include "base/version.h"
#include "continued.h"
#include "formats/air_lut/air_lut.h"
#include "guard.h"

namespace suite {

namespace {

const Sensor& sensor_of(const LutRequest& request, const Simulation& sim) {
  std::vector<std::string> names;
  for (const auto& sensor : sim.sensors) {
    names.push_back(sensor->name());
    if (sensor->name() == request.sensor || (request.sensor.empty() && sim.sensors.size() == 1)) return *sensor;
  }
  const std::string all =
      names.empty() ? "none"
                    : std::accumulate(names.begin() + 1, names.end(), names[0],
                                      [](const std::string& a, const std::string& b) { return a + ", " + b; });
  throw Error(request.text,
              request.sensor.empty() ? "a table is made for the bands of one sensor"
                                     : "the simulation has no sensor '" + request.sensor + "'",
              "give `sensor:` one of: " + all);
}

// Of all its spectral states.
std::vector<Band> bands_of(const Sensor& sensor) {
  std::vector<Band> bands;
  for (size_t s = 0; s < sensor.states().size(); ++s)
    for (const Band& b : sensor.bands(s)) bands.push_back(b);
  return bands;
}

// Finished states, a file each, so that a run that was stopped goes on; their name says what they belong to.
class KeptStates {
 public:
  KeptStates(const std::string& folder, const std::string& identity, const LutTable& table)
      : folder_(in_folder(folder, "air_lut_states")), identity_(sha256(identity).substr(0, 16)), table_(table) {
    make_folder(folder_);
  }
  bool has(size_t state) const {
    return file_exists(path(state)) && file_size(path(state)) == values() * sizeof(double);
  }
  LutState get(size_t state) const {
    const std::vector<std::byte> bytes = read_bytes(path(state));
    std::vector<double> flat(values());
    std::memcpy(flat.data(), bytes.data(), bytes.size());
    LutState views(table_.views());
    const double* at = flat.data();
    for (LutValues& view : views)
      for (std::vector<double>& key : view) key.assign(at, at + table_.bands.size()), at += table_.bands.size();
    return views;
  }
  void put(size_t state, const LutState& views) const {
    std::vector<double> flat;
    for (const LutValues& view : views)
      for (const std::vector<double>& key : view) flat.insert(flat.end(), key.begin(), key.end());
    write_file(path(state), std::as_bytes(std::span(flat)));
  }
  void remove() const { std::filesystem::remove_all(folder_); }

 private:
  size_t values() const { return table_.views() * kLutKeys * table_.bands.size(); }
  std::string path(size_t state) const { return in_folder(folder_, strf("%s_%zu.bin", identity_.c_str(), state)); }
  std::string folder_, identity_;
  const LutTable& table_;
};

std::vector<LutState> all_states(const AirSpec& air, const LutTable& table, const LutFineness& fineness,
                                 const KeptStates& kept) {
  size_t there = 0;
  for (size_t k = 0; k < table.states(); ++k) there += kept.has(k);
  if (there > 0) note(strf("air LUT: %zu of %zu states are kept from before", there, table.states()));
  Progress progress("air LUT", static_cast<double>(table.states() - there), "state");
  std::vector<LutState> states;
  for (size_t k = 0; k < table.states(); ++k) {
    stop_point();
    if (kept.has(k)) {
      states.push_back(kept.get(k));
      continue;
    }
    states.push_back(lut_state(air, table, k, fineness));
    kept.put(k, states.back());
    progress.add(1);
  }
  progress.finish();
  return states;
}

// The state in the middle, with bins half as wide, twice the g-points, half as many streams again and all layers apart.
LutValues errors_of(const AirSpec& air, const LutTable& table, const LutFineness& fineness,
                    const std::vector<LutState>& states) {
  const size_t middle = table.states() / 2;
  LutFineness finer = fineness;
  finer.points = 2 * fineness.points;
  finer.thin = 0;
  finer.widest_um = 0.5 * widest_bin(table, fineness);
  finer.streams = std::min(64, (fineness.streams + fineness.streams / 2 + 1) / 2 * 2);
  return lut_difference(states[middle], lut_state(air, table, middle, finer));
}

void add_kernels(const AirSpec& air, const LutTable& table, const LutRequest& request, LutResult& result) {
  result.kernel = *request.kernel;
  Progress progress("adjacency kernels", static_cast<double>(table.states()), "state");
  for (size_t k = 0; k < table.states(); ++k) {
    stop_point();
    result.kernels.push_back(lut_kernel(air, table, k, request.fineness, result.kernel));
    progress.add(1);
  }
  progress.finish();
}

void report_kernels(const LutTable& table, const LutResult& result) {
  double worst = 0;
  for (const std::vector<LutKernel>& heights : result.kernels)
    for (const LutKernel& kernel : heights)
      for (const std::vector<double>& errors : kernel.within_error)
        worst = std::max(worst, *std::ranges::max_element(errors));
  note(
      strf("air LUT: adjacency kernels are of views straight down; shares within a radius have standard errors up to "
           "%.2g",
           worst));
  const std::vector<double>& zeniths = table.axes[static_cast<size_t>(LutAxisOf::view_zenith)].values;
  if (zeniths.back() > 0) note("air LUT: other views of the table have no kernel: theirs are not round");
}

void report_errors(const LutTable& table, const LutValues& errors) {
  for (const LutKey key :
       {LutKey::path_reflectance, LutKey::direct_direct, LutKey::up_diffuse, LutKey::spherical_albedo}) {
    const std::vector<double>& e = errors[static_cast<size_t>(key)];
    const auto worst = std::ranges::max_element(e);
    note(strf("air LUT: %s is within %.2g of finer bins and more streams, the most in the band at %.4g nm",
              std::string(kLutNames[static_cast<size_t>(key)]).c_str(), *worst,
              1e3 * table.bands[static_cast<size_t>(worst - e.begin())].center_um));
  }
}

// Where the table is less sure than in general.
void report_limits(const AirSpec& air, const LutTable& table) {
  constexpr double kBlue = 0.6;  // um: beyond, Rayleigh scattering is thin
  const auto blue = std::ranges::count_if(table.bands, [](const Band& b) { return b.center_um < kBlue; });
  if (air.molecules && blue > 0)
    note(strf("air LUT: rhoatm of %zd band(s) below 0.6 um is without polarisation, up to 10 %% of itself off", blue));
  if (!air.gases) return;
  for (const GasLimit& limit : air.gases->limits()) {
    const auto hit = [&](const Band& b) { return b.center_um >= limit.low_um && b.center_um <= limit.high_um; };
    if (const auto n = std::ranges::count_if(table.bands, hit); n > 0)
      note(strf("air LUT: %zd bands lie where gases are less sure: ", n) + limit.text());
  }
}

}  // namespace

int run_air_lut(const RenderOptions& o, const Simulation& sim) {
  if (!sim.sources.air)
    throw Error(Where{sim.path, 0, 0, {}, -1}, "the simulation has no real air to make a table of",
                "give `atmosphere: {profile: us_standard}`");
  note_input(o.air_lut);
  const LutRequest request = read_lut_request(o.air_lut);
  const AirSpec& air = *sim.sources.air;
  const LutTable table =
      located_in(request, [&] { return make_lut(air, bands_of(sensor_of(request, sim)), request.axes); });
  note(strf("air LUT: %zu states of the air, %zu views of each, %zu bands", table.states(), table.views(),
            table.bands.size()));
  if (o.dry_run) return 0;
  const RunLock lock = lock_place(o, sim);
  const std::string grid = read_text(o.air_lut);
  const KeptStates kept(o.output, hash_of_text(sim) + sha256(grid) + version_text(), table);
  const StopInGoodOrder stops;
  LutResult result;
  try {
    located_in(request, [&] {
      result.states = all_states(air, table, request.fineness, kept);
      if (request.check) result.errors = errors_of(air, table, request.fineness, result.states);
      if (request.kernel) add_kernels(air, table, request, result);
      return 0;
    });
  } catch (const Stopped&) {
    note("air LUT: stopped; the same command continues from the states that are done");
    return 128 + stop_signal();
  }
  if (request.check) report_errors(table, result.errors);
  if (request.kernel) report_kernels(table, result);
  report_limits(air, table);
  const LutNotes notes{{"Conventions", "CF-1.8"},
                       {"title", "quantities for atmospheric correction"},
                       {"source", version_text()},
                       {"simulation", sim.path},
                       {"grid", grid}};
  write_lut_netcdf(in_folder(o.output, "air_lut.nc"), table, result, notes);
  if (request.zarr) write_lut_zarr(in_folder(o.output, "air_lut.zarr"), table, result, notes);
  write_lut_csv(in_folder(o.output, "air_lut.csv"), table, result);
  kept.remove();
  return 0;
}

}  // namespace suite
