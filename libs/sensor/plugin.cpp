#include "sensor/plugin.h"

#include <dlfcn.h>

#include <cmath>
#include <limits>

#include "sensor/plugin_host.h"

namespace suite {

namespace {

static_assert(SUITE_QUALITY_HEAVY_TAIL == int{quality_heavy_tail} && SUITE_QUALITY_FAILURES == int{quality_failures} &&
              SUITE_QUALITY_TRUNCATED == int{quality_truncated} &&
              SUITE_QUALITY_UNRESOLVED == int{quality_unresolved} && SUITE_QUALITY_CLIPPED == int{quality_clipped});

// Element i of a plug-in's array, whose elements are as large as the plug-in knows them. Error: smaller than ours.
template <class T>
const T& element(const T* first, uint32_t i, const char* what) {
  if (first->size < sizeof(T)) throw Error(strf("its %s are %u bytes, %zu are expected", what, first->size, sizeof(T)));
  return *reinterpret_cast<const T*>(reinterpret_cast<const std::byte*>(first) + size_t{i} * first->size);
}

Band band_of(const suite_band& b) {
  if (!b.name) throw Error("a band has no name");
  if (b.shape == SUITE_BAND_TABULATED) {
    if (!b.points || !b.wavelength_um || !b.response)
      throw Error(std::string("the tabulated band '") + b.name + "' has no table");
    return Band::tabulated(b.name, Curve({b.wavelength_um, b.wavelength_um + b.points},
                                         {b.response, b.response + b.points}, Outside::zero));
  }
  if (!(b.center_um > 0 && b.fwhm_um > 0 && b.fwhm_um < 2 * b.center_um))
    throw Error(std::string("the band '") + b.name + "' has no sound centre and width");
  return b.shape == SUITE_BAND_RECTANGULAR  ? Band::rectangular(b.name, b.center_um, b.fwhm_um)
         : b.shape == SUITE_BAND_TRIANGULAR ? Band::triangular(b.name, b.center_um, b.fwhm_um)
                                            : Band::gaussian(b.name, b.center_um, b.fwhm_um);
}

class PluginSensor final : public Sensor {
 public:
  PluginSensor(const suite_sensor_plugin& plugin, const Params& params, const SensorContext& context)
      : deliver_(context.deliver), kind_(plugin.kind), name_(params.name("name", plugin.kind)), run_(name_) {
    PluginMaking making{params, context, {}, {}};
    const suite_host host = making.host();
    sensor_.size = sizeof(suite_sensor);
    int failed = 1;
    try {
      failed = plugin.make(&host, &sensor_);
    } catch (...) {
      making.failure = "it threw an exception across the border";
    }
    if (making.error) throw *making.error;
    if (failed)
      throw params.error("the plug-in '" + kind_ +
                         "' made no sensor: " + (making.failure.empty() ? "no reason given" : making.failure));
    try {
      take(read_spectral_error(params));
    } catch (const Error& e) {
      destroy();
      throw params.error("the plug-in '" + kind_ + "': " + e.message(), e.hint());
    }
  }
  ~PluginSensor() override { destroy(); }

  std::string name() const override { return name_; }
  std::span<const SpectralState> states() const override { return states_; }
  std::span<const Band> bands(size_t state) const override { return bands_[state]; }
  void take_state(size_t state, SpectralState with_bins) override {
    states_[state] = std::move(with_bins);
    set_centers();
  }
  std::span<const Task> tasks() const override { return tasks_; }
  std::span<const std::string> truth() const override { return truth_; }
  int numbers() const override { return static_cast<int>(sensor_.numbers); }

  SensorRay ray(const RayRequest& r) const override {
    const auto [task, index] = place_of(r.capture);
    const suite_ray_request request{sizeof(suite_ray_request),
                                    numbers_[task][index],
                                    r.problem,
                                    r.u.data(),
                                    static_cast<uint32_t>(r.u.size()),
                                    static_cast<uint32_t>(r.spectral.size()),
                                    r.spectral.data(),
                                    centers_[r.capture.state].data()};
    suite_ray out{sizeof(suite_ray), 0, {0, 0, 0}, {0, 0, 0}, r.capture.window.begin, 1, SUITE_RECEIVER_NONE, 0};
    bool good = false;
    try {
      good = sensor_.ray(sensor_.self, &request, &out) == 0;
    } catch (...) {
    }
    const Vec3 origin{out.origin[0], out.origin[1], out.origin[2]},
        direction{out.direction[0], out.direction[1], out.direction[2]};
    const double len = length(direction);
    good = good && finite(origin) && len > 0 && std::isfinite(len) && std::isfinite(out.weight) && out.weight >= 0 &&
           std::isfinite(out.time_s) && out.receiver <= SUITE_RECEIVER_SPHERE;
    // A ray that is none: harmless, and with a weight that makes its sample count as failed.
    if (!good) return {{{}, {0, 0, 1}, r.capture.window.begin}, std::numeric_limits<double>::quiet_NaN(), false};
    return {{origin, direction / len, std::clamp(out.time_s, r.capture.window.begin, r.capture.window.end)},
            out.weight,
            out.weighted != 0,
            static_cast<SensorRay::Receiver>(out.receiver)};
  }

  Convergence convergence(const Capture& capture, size_t problem) const override {
    const auto [task, index] = place_of(capture);
    const Convergence& c = capture.convergence;
    suite_convergence own{sizeof(suite_convergence), c.min_paths, c.max_paths, 0, c.relative_error, c.absolute_floor};
    int failed = 1;
    try {
      failed = sensor_.convergence(sensor_.self, numbers_[task][index], problem, &own);
    } catch (...) {
    }
    if (failed)
      throw Error(strf("the plug-in '%s' failed when it was asked what problem %zu of capture %u may take",
                       kind_.c_str(), problem, numbers_[task][index]));
    return {own.min_paths, own.max_paths, own.relative_error, own.absolute_floor};
  }

  void start(const RunFacts& facts) override {
    const suite_run& run = run_.begin(facts, states_, bands_);
    if (!sensor_.start) return;
    call([&] { return sensor_.start(sensor_.self, &run); }, "when the run of sensor '" + name_ + "' began");
  }

  void accept(CaptureResult&& r) override {
    std::vector<const char*> names;
    for (const std::string& n : r.truth_names) names.push_back(n.c_str());
    const suite_result result{sizeof(suite_result),
                              numbers_[r.task][r.capture],
                              r.columns,
                              r.rows,
                              static_cast<uint32_t>(r.bands),
                              static_cast<uint32_t>(names.size()),
                              r.radiance.data(),
                              r.standard_error.data(),
                              r.paths.data(),
                              names.data(),
                              r.truth.data(),
                              r.quality.data()};
    if (sensor_.accept)
      call([&] { return sensor_.accept(sensor_.self, &result); }, "while it took the result of sensor '" + name_ + "'");
    std::vector<Band> bands = bands_[tasks_[r.task].captures[r.capture].state];
    ImageRows rows = rows_[r.task][r.capture];
    deliver_({*this, std::move(rows), std::move(r), std::move(bands), {}, {}, {}, "plug-in '" + kind_ + "'"});
  }

 private:
  // Calls what may write files. Error: the file that could not be written, else that the plug-in failed.
  template <class Call>
  void call(const Call& plugin, const std::string& when) {
    int failed = 1;
    try {
      failed = plugin();
    } catch (...) {
    }
    run_.rethrow();
    if (failed) throw Error("the plug-in '" + kind_ + "' failed " + when);
  }

  void destroy() {
    if (sensor_.destroy && sensor_.self) sensor_.destroy(sensor_.self);
    sensor_ = {};
  }

  void take(double spectral_error) {
    if (!sensor_.ray) throw Error("it gives no rays");
    if (sensor_.numbers < 1 || sensor_.numbers > 8)
      throw Error(strf("it asks for %u numbers a ray", sensor_.numbers), "1 to 8");
    if (!sensor_.state_count || !sensor_.capture_count || !sensor_.states || !sensor_.captures)
      throw Error("it has no states or no captures");
    for (uint32_t s = 0; s < sensor_.state_count; ++s) {
      const suite_state& state = element(sensor_.states, s, "states");
      bands_.emplace_back();
      for (uint32_t b = 0; b < state.band_count; ++b)
        bands_.back().push_back(band_of(element(state.bands, b, "bands")));
      states_.push_back(state_for(bands_.back(), spectral_error, state.step_um, state.reference_um, 4));
    }
    set_centers();
    for (uint32_t t = 0; t < sensor_.task_count; ++t) {
      const suite_task& task = element(sensor_.tasks, t, "tasks");
      tasks_.push_back({task.name ? task.name : strf("task_%u", t), {task.begin_s, task.end_s}, {}});
    }
    if (tasks_.empty()) tasks_.push_back({"task", {}, {}});
    numbers_.resize(tasks_.size());
    std::vector<std::vector<ImageKey>> keys(tasks_.size());
    for (uint32_t c = 0; c < sensor_.capture_count; ++c) {
      const suite_capture& from = element(sensor_.captures, c, "captures");
      if (from.task >= tasks_.size() || from.state >= states_.size())
        throw Error(strf("capture %u belongs to no task or state", c));
      if (!from.columns || !from.rows || !(from.end_s >= from.begin_s) || !from.min_paths ||
          from.max_paths < from.min_paths || !(from.relative_error >= 0))
        throw Error(strf("capture %u has no problems, no paths, or a window that ends before it begins", c));
      Capture capture;
      capture.name = strf("%s_%04u", name_.c_str(), c);
      capture.window = {from.begin_s, from.end_s};
      capture.columns = from.columns, capture.rows = from.rows, capture.state = from.state;
      capture.convergence = {from.min_paths, from.max_paths, from.relative_error, 0};
      capture.neighbours = !from.no_neighbours;
      capture.own_convergence = sensor_.convergence != nullptr;
      tasks_[from.task].captures.push_back(std::move(capture));
      numbers_[from.task].push_back(c);
      // Captures of different sizes or bands are different images.
      keys[from.task].push_back({states_.size() > 1 ? strf("%s_s%u", name_.c_str(), from.state) : name_, false});
    }
    for (uint32_t i = 0; i < sensor_.truth_count; ++i) truth_.push_back(sensor_.truth[i]);
    rows_ = lay_out(tasks_, keys);
  }

  void set_centers() {
    centers_.clear();
    for (const SpectralState& s : states_) {
      centers_.emplace_back();
      for (const Bin& b : s.bins) centers_.back().push_back(b.center_um());
    }
  }

  std::pair<size_t, size_t> place_of(const Capture& capture) const {
    for (size_t t = 0; t < tasks_.size(); ++t) {
      const auto& list = tasks_[t].captures;
      if (!list.empty() && &capture >= list.data() && &capture < list.data() + list.size())
        return {t, static_cast<size_t>(&capture - list.data())};
    }
    for (size_t t = 0; t < tasks_.size(); ++t)
      for (size_t c = 0; c < tasks_[t].captures.size(); ++c)
        if (tasks_[t].captures[c].name == capture.name) return {t, c};
    throw Bug("a capture that its sensor does not know");
  }

  std::function<void(const Delivery&)> deliver_;
  std::string kind_, name_;
  suite_sensor sensor_{};
  PluginRun run_;
  std::vector<std::vector<Band>> bands_;
  std::vector<SpectralState> states_;
  std::vector<std::vector<double>> centers_;  // um, of the bins of each state
  std::vector<Task> tasks_;
  std::vector<std::vector<uint32_t>> numbers_;  // [task][capture]: the plug-in's own
  std::vector<std::vector<ImageRows>> rows_;
  std::vector<std::string> truth_;
};

}  // namespace

std::string load_plugin(const std::string& path) {
  const Where where{path, 0, 0, {}, -1};
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* why = dlerror();
    throw Error(where, std::string("cannot be loaded as a plug-in: ") + (why ? why : "unknown reason"));
  }
  const auto entry = reinterpret_cast<const suite_sensor_plugin* (*)()>(dlsym(library, "suite_sensor_plugin_entry"));
  const suite_sensor_plugin* plugin = nullptr;
  if (!entry)
    throw Error(where, "exports no suite_sensor_plugin_entry",
                "build it against suite_sensor.h with SUITE_SENSOR_PLUGIN(...)");
  try {
    plugin = entry();
  } catch (...) {
  }
  if (!plugin) throw Error(where, "describes no sensor");
  if (plugin->abi != SUITE_SENSOR_ABI)
    throw Error(where,
                strf("was built for version %u of the sensor interface, this program has version %u", plugin->abi,
                     SUITE_SENSOR_ABI),
                "rebuild the plug-in against the installed suite_sensor.h");
  if (plugin->size < sizeof(suite_sensor_plugin) || !plugin->kind || !*plugin->kind || !plugin->make)
    throw Error(where, "describes no kind of sensor");
  try {
    sensor_kinds().add({plugin->kind, plugin->summary ? plugin->summary : "", "",
                        [plugin](const Params& p, const SensorContext& c) -> std::unique_ptr<Sensor> {
                          return std::make_unique<PluginSensor>(*plugin, p, c);
                        }});
  } catch (const Error& e) {
    throw Error(where, e.message(), e.hint());
  }
  return plugin->kind;
}

}  // namespace suite
