/* Sensors for dirsig-render from outside: everything a plug-in needs, in one header without dependencies.
 *
 * A plug-in is a shared library that exports suite_sensor_plugin_entry(). It describes one kind of sensor: its spectral
 * states, tasks and captures; the host asks it for rays and gives it results. All structures start with their size in
 * bytes, as the side that fills them knows it; readers look no further than that, so that fields can be added at their
 * ends. Calls across the border are C: no exceptions, no C++ types, no ownership except where said. Strings are UTF-8
 * and live as long as the structure they are in. C++ authors derive from suite_sdk::Sensor below and need nothing else.
 *
 * Units: m, s, rad, W/(m2 sr um); wavelengths in um. Coordinates: scene ENU (x east, y north, z up).
 * Based on: Goodenough & Brown, section III-B ("The sensor API is openly documented ...").
 */
#ifndef SUITE_SENSOR_H
#define SUITE_SENSOR_H
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Raised when plug-ins of older headers cannot work any more. Those built without fields that say "since" go on. */
#define SUITE_SENSOR_ABI 1u
#define SUITE_SENSOR_MINOR 4u /* counts what "since 1.x" says below; since 1.4 */

enum suite_band_shape {
  SUITE_BAND_GAUSSIAN = 0,
  SUITE_BAND_RECTANGULAR = 1,
  SUITE_BAND_TRIANGULAR = 2,
  SUITE_BAND_TABULATED = 3
};

typedef struct suite_band {
  uint32_t size;
  uint32_t shape; /* suite_band_shape */
  const char* name;
  double center_um, fwhm_um;              /* not for tabulated ones */
  uint32_t points;                        /* tabulated only */
  const double *wavelength_um, *response; /* ascending; relative, >= 0 */
} suite_band;

typedef struct suite_state {
  uint32_t size;
  uint32_t band_count;
  const suite_band* bands;
  double step_um;      /* no stretch of a band this wide goes without bins; 0 = no limit */
  double reference_um; /* drives directions; 0 = middle of the bands */
} suite_state;

typedef struct suite_capture {
  uint32_t size;
  uint32_t task, state;          /* indices */
  uint32_t columns, rows;        /* problems, row-major */
  uint32_t min_paths, max_paths; /* equal = a fixed number */
  uint32_t no_neighbours;        /* 1: problems beside each other have nothing to do with each other */
  double begin_s, end_s;         /* all rays have their times in here */
  double relative_error;         /* target of the standard error; 0 = none */
} suite_capture;

typedef struct suite_task {
  uint32_t size;
  const char* name;
  double begin_s, end_s;
} suite_task;

typedef struct suite_ray_request {
  uint32_t size;
  uint32_t capture; /* index */
  uint64_t problem;
  const double* u; /* `numbers` uniform numbers in [0, 1) */
  uint32_t numbers;
  uint32_t bins;        /* of the state; chosen for what is seen, neither even nor known before the first ray */
  float* weights;       /* one per bin, to be filled when suite_ray.weighted is set */
  const double* bin_um; /* middle of each bin; since 1.2 */
} suite_ray_request;

/* What a sample collects: the radiance along its ray, or the light of many directions at the ray's origin. The host
 * then chooses where to look and asks Sun, Moon, sky and lamps there, as it does at surfaces. */
enum suite_receiver {
  SUITE_RECEIVER_NONE = 0,
  SUITE_RECEIVER_PLANE = 1, /* facing `direction`: the sample is irradiance / pi */
  SUITE_RECEIVER_SPHERE = 2 /* the sample is the flux through a small sphere's cross-section / (4 pi) */
};

typedef struct suite_ray {
  uint32_t size;
  uint32_t weighted;              /* 1: weights were filled, see the request */
  double origin[3], direction[3]; /* ENU; the direction need not be a unit vector, but finite and not 0 */
  double time_s;
  double weight;     /* pupil weight; 0 = contributes nothing */
  uint32_t receiver; /* suite_receiver; since 1.1 */
  uint32_t reserved;
} suite_ray;

/* What one problem may take; see suite_sensor.convergence. */
typedef struct suite_convergence {
  uint32_t size;
  uint32_t min_paths, max_paths; /* at least 1; equal = a fixed number */
  uint32_t reserved;
  double relative_error; /* target of the standard error at the reference wavelength; 0 = none, max_paths are taken */
  double absolute_floor; /* radiance below which the error is judged absolutely */
} suite_convergence;

/* Bits of suite_result.quality. */
enum suite_quality {
  SUITE_QUALITY_HEAVY_TAIL = 1, /* rare events: the true error may be far beyond the reported one */
  SUITE_QUALITY_FAILURES = 2,   /* samples that were NaN or negative were rejected */
  SUITE_QUALITY_TRUNCATED = 4,  /* more than 1 % of the energy was cut at the maximum number of nodes */
  SUITE_QUALITY_UNRESOLVED = 8, /* light behind smooth refracting surfaces was not found */
  SUITE_QUALITY_CLIPPED = 16    /* a detector's counts or charge are clipped */
};

typedef struct suite_result {
  uint32_t size;
  uint32_t capture;
  uint32_t columns, rows, bands, truth_count;
  const double *radiance, *standard_error; /* [problem][band] */
  const uint32_t* paths;                   /* [problem] */
  const char* const* truth_names;
  const double* truth;    /* [problem][truth]; NaN = nothing known */
  const uint8_t* quality; /* [problem], bits of suite_quality; since 1.3 */
} suite_result;

/* The bins of one state and how bands are made of them: the radiance of a band is the sum over the bins of weight times
 * the bin's radiance, which is its mean over the bin's interval. The weights of a band add up to 1. Several bins may
 * share an interval: each then is one of its g-points, which stands for the part of the interval's wavelengths that a
 * gas absorbs alike, and its radiance is the mean over these (since 1.4; before, each bin had an interval of its own).
 * Unless the user
 * asks for even bins (`spectral_error: 0`) bins are chosen for the spectra of the scene; a function of another kind
 * that the plug-in weighs them with is followed as finely as suite_state.step_um says. Since 1.3. */
typedef struct suite_bins {
  uint32_t size;
  uint32_t bins, bands, reserved;
  const double *low_um, *high_um; /* [bin], ascending; equal for the g-points of one interval */
  const double* weights;          /* [band][bin] */
  double reference_um;
  /* Since 1.4. [bin]: number of the g-point in its interval, from 0; the share of the interval that it stands for. 0
   * and 1 where an interval has one bin. */
  const uint32_t* g_point;
  const double* g_weight;
} suite_bins;

/* Where the scene is on the Earth (WGS84). Since 1.3. */
typedef struct suite_frame {
  uint32_t size;
  uint32_t reserved;
  double latitude_deg, longitude_deg, height_m; /* of the origin of the scene's ENU frame; height: ellipsoidal */
  double ecef_from_enu[9];                      /* row-major; turns directions */
  double ecef_origin_m[3];                      /* place in ECEF = ecef_from_enu * ENU + ecef_origin_m */
} suite_frame;

/* What is known when rendering begins; see suite_sensor.start. Since 1.3. */
typedef struct suite_run {
  uint32_t size;
  uint32_t state_count;
  const suite_bins* bins; /* [state] */
  const char* name;       /* of the sensor, as the user gave it */
  const char* folder;     /* for the sensor's own files, its alone; NULL: this run keeps no files (a study) */
  const char* made_by;    /* program, version and command line, as results record them */
  uint64_t seed;          /* of the run */
  void* context;
  /* Writes a file of that name into `folder`, which is made when the first one comes; the file is there whole or not at
   * all. The name is one of a file without folders. To be called from start() and accept() only. Returns 0, or anything
   * else when it could not be written: the host reports why and the run ends. Without a folder it does nothing. */
  int (*write_file)(void* context, const char* name, const void* bytes, uint64_t count);
} suite_run;

/* What the host offers while a sensor is made. Each returns 1 when the key was given, 0 when not, -1 when what was
 * given is wrong (the host then reports where; the plug-in should give up). A key that is not asked for is an error of
 * the user. */
typedef struct suite_host {
  uint32_t size, abi;
  void* context;
  int (*number)(void* context, const char* key, double* value);
  int (*numbers)(void* context, const char* key, double* values, uint32_t capacity, uint32_t* count);
  int (*text)(void* context, const char* key, char* buffer, uint32_t capacity);
  void (*fail)(void* context, const char* message); /* why the sensor cannot be made */
  /* Since 1.3. frame: comes in with its size set; 0 when the scene has no place on the Earth. utc: the date of a time
   * of the simulation, as "2026-06-21T10:30:00.000000Z" (its second 0 is the epoch); 0 when the simulation has no
   * clock. */
  int (*frame)(void* context, suite_frame* frame);
  int (*utc)(void* context, double time_s, char* buffer, uint32_t capacity);
} suite_host;

/* A sensor. The arrays must stay where they are until destroy(). */
typedef struct suite_sensor {
  uint32_t size;
  uint32_t numbers; /* uniform numbers a ray takes, 1..8 */
  void* self;
  uint32_t state_count, task_count, capture_count, truth_count;
  const suite_state* states;
  const suite_task* tasks;
  const suite_capture* captures;
  const char* const* truth; /* names of the truth to collect */
  /* Called from many threads. Returns 0, or anything else when there is no ray: the sample counts as failed. */
  int (*ray)(void* self, const suite_ray_request* request, suite_ray* ray);
  /* Called from one thread, once per capture, in any order. Returns 0 or anything else for a failure. */
  int (*accept)(void* self, const suite_result* result);
  void (*destroy)(void* self);
  /* May be NULL. Called before rendering, from one thread, for every problem: comes in filled with what the capture
   * says for all of them. Returns 0 or anything else for a failure. Since 1.1. */
  int (*convergence)(void* self, uint32_t capture, uint64_t problem, suite_convergence* convergence);
  /* May be NULL. Called from one thread before a run's first capture (a study makes several runs); what it is given
   * lives until the next run or destroy(). To see what the scene holds, the host may ask for rays and convergence
   * before. Returns 0 or anything else for a failure. Since 1.3. */
  int (*start)(void* self, const suite_run* run);
} suite_sensor;

typedef struct suite_sensor_plugin {
  uint32_t size, abi; /* SUITE_SENSOR_ABI of the header that it was built with */
  const char *kind, *summary;
  /* Fills the sensor; returns 0, or anything else after host->fail. */
  int (*make)(const suite_host* host, suite_sensor* sensor);
} suite_sensor_plugin;

/* The one symbol that a plug-in exports. */
const suite_sensor_plugin* suite_sensor_plugin_entry(void);

#ifdef __cplusplus
} /* extern "C" */

#include <cstddef>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace suite_sdk {

/* Keys of the user's text. */
class Keys {
 public:
  explicit Keys(const suite_host& host) : host_(host) {}
  std::optional<double> number(const char* key) const {
    double value = 0;
    const int got = host_.number(host_.context, key, &value);
    if (got < 0) throw Refused();
    return got ? std::optional<double>(value) : std::nullopt;
  }
  double number(const char* key, double otherwise) const { return number(key).value_or(otherwise); }
  std::vector<double> numbers(const char* key, std::vector<double> otherwise = {}) const {
    std::vector<double> values(1024);
    uint32_t count = 0;
    const int got = host_.numbers(host_.context, key, values.data(), 1024, &count);
    if (got < 0) throw Refused();
    values.resize(count);
    return got ? values : otherwise;
  }
  std::string text(const char* key, const std::string& otherwise) const {
    char buffer[4096];
    const int got = host_.text(host_.context, key, buffer, sizeof buffer);
    if (got < 0) throw Refused();
    return got ? buffer : otherwise;
  }
  /* Where the scene is; nothing when it has no place on the Earth. */
  std::optional<suite_frame> frame() const {
    suite_frame frame = {};
    frame.size = sizeof frame;
    const int got = host_.frame(host_.context, &frame);
    if (got < 0) throw Refused();
    return got ? std::optional<suite_frame>(frame) : std::nullopt;
  }
  /* The date of a time of the simulation; empty when it has no clock. */
  std::string utc(double time_s) const {
    char buffer[64];
    const int got = host_.utc(host_.context, time_s, buffer, sizeof buffer);
    if (got < 0) throw Refused();
    return got ? buffer : "";
  }
  struct Refused : std::exception {
    const char* what() const noexcept override { return "a key was refused"; }
  };

 private:
  const suite_host& host_;
};

/* Base of a sensor: fill the lists in the constructor, override ray() and, if wanted, start() and accept(). Exceptions
 * are welcome: they end at the border. */
class Sensor {
 public:
  virtual ~Sensor() = default;
  virtual void ray(const suite_ray_request& request, suite_ray& ray) const = 0;
  /* run() and bins() hold from here on. */
  virtual void start() {}
  virtual void accept(const suite_result&) {}
  /* Asked for every problem when own_convergence is set. */
  virtual void convergence(uint32_t /*capture*/, uint64_t /*problem*/, suite_convergence&) const {}

  std::vector<suite_state> states;
  std::vector<suite_task> tasks;
  std::vector<suite_capture> captures;
  std::vector<const char*> truth;
  uint32_t numbers = 4;
  bool own_convergence = false;

  void begin(const suite_run& run) {
    run_ = &run;
    start();
  }

 protected:
  const suite_run& run() const { return *run_; }
  /* Elements are as large as the host knows them. */
  const suite_bins& bins(uint32_t state) const {
    const char* first = reinterpret_cast<const char*>(run_->bins);
    return *reinterpret_cast<const suite_bins*>(first + std::size_t{state} * run_->bins->size);
  }
  /* A file in run().folder, whole or not at all; from start() and accept(). */
  void write_file(const std::string& name, const std::string& bytes) const {
    if (run_->write_file(run_->context, name.c_str(), bytes.data(), bytes.size()))
      throw std::runtime_error(name + " was not written");
  }
  static suite_band gaussian(const char* name, double center_um, double fwhm_um) {
    return {sizeof(suite_band), SUITE_BAND_GAUSSIAN, name, center_um, fwhm_um, 0, nullptr, nullptr};
  }
  /* The state keeps its bands here. */
  uint32_t add_state(std::vector<suite_band> bands, double step_um = 0, double reference_um = 0) {
    bands_.push_back(std::move(bands));
    states.push_back({sizeof(suite_state), static_cast<uint32_t>(bands_.back().size()), bands_.back().data(), step_um,
                      reference_um});
    return static_cast<uint32_t>(states.size() - 1);
  }
  void add_capture(uint32_t task, uint32_t state, uint32_t columns, uint32_t rows, double begin_s, double end_s,
                   uint32_t paths) {
    captures.push_back({sizeof(suite_capture), task, state, columns, rows, paths, paths, 0, begin_s, end_s, 0});
  }

 private:
  std::vector<std::vector<suite_band>> bands_;
  const suite_run* run_ = nullptr;
};

template <class T>
int make(const suite_host* host, suite_sensor* out) noexcept {
  if (out->size < sizeof(suite_sensor)) {
    host->fail(host->context, "this program knows a smaller suite_sensor than the plug-in");
    return 1;
  }
  try {
    T* sensor = new T(Keys(*host));
    out->self = static_cast<Sensor*>(sensor);
    out->numbers = sensor->numbers;
    out->states = sensor->states.data(), out->state_count = static_cast<uint32_t>(sensor->states.size());
    out->tasks = sensor->tasks.data(), out->task_count = static_cast<uint32_t>(sensor->tasks.size());
    out->captures = sensor->captures.data(), out->capture_count = static_cast<uint32_t>(sensor->captures.size());
    out->truth = sensor->truth.data(), out->truth_count = static_cast<uint32_t>(sensor->truth.size());
    out->ray = [](void* self, const suite_ray_request* request, suite_ray* ray) noexcept {
      try {
        static_cast<const Sensor*>(self)->ray(*request, *ray);
        return 0;
      } catch (...) {
        return 1;
      }
    };
    out->accept = [](void* self, const suite_result* result) noexcept {
      try {
        static_cast<Sensor*>(self)->accept(*result);
        return 0;
      } catch (...) {
        return 1;
      }
    };
    if (sensor->own_convergence)
      out->convergence = [](void* self, uint32_t capture, uint64_t problem, suite_convergence* c) noexcept {
        try {
          static_cast<const Sensor*>(self)->convergence(capture, problem, *c);
          return 0;
        } catch (...) {
          return 1;
        }
      };
    out->start = [](void* self, const suite_run* run) noexcept {
      try {
        static_cast<Sensor*>(self)->begin(*run);
        return 0;
      } catch (...) {
        return 1;
      }
    };
    out->destroy = [](void* self) noexcept { delete static_cast<Sensor*>(self); };
    return 0;
  } catch (const std::exception& e) {
    host->fail(host->context, e.what());
  } catch (...) {
    host->fail(host->context, "unknown exception");
  }
  return 1;
}

}  // namespace suite_sdk

/* Puts a class derived from suite_sdk::Sensor, made from (const suite_sdk::Keys&), behind the entry point. */
#define SUITE_SENSOR_PLUGIN(kind_, summary_, Class)                                                              \
  extern "C" __attribute__((visibility("default"))) const suite_sensor_plugin* suite_sensor_plugin_entry(void) { \
    static const suite_sensor_plugin plugin = {sizeof(suite_sensor_plugin), SUITE_SENSOR_ABI, kind_, summary_,   \
                                               &suite_sdk::make<Class>};                                         \
    return &plugin;                                                                                              \
  }
#endif /* __cplusplus */
#endif
