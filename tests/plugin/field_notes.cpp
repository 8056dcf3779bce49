// A plug-in that uses what the interface tells it: where the scene is, what time it is, which bins bands are made of
// and how flagged its pixels are. It looks straight down, weighs every wavelength with (wavelength / unit_um)^2 and
// keeps tables of its own beside the pictures.
#include <suite_sensor.h>

#include <cstdio>
#include <stdexcept>

class FieldNotes final : public suite_sdk::Sensor {
 public:
  explicit FieldNotes(const suite_sdk::Keys& keys) {
    size_ = static_cast<uint32_t>(keys.number("pixels", 4));
    unit_um_ = keys.number("unit_um", 0.6);
    file_ = keys.text("file", "bins.csv");
    faulty_ = keys.number("faulty", -1);  // a pixel that loses every other sample
    if (size_ < 1 || size_ > 4096) throw std::runtime_error("pixels must be 1 to 4096");
    if (!(unit_um_ > 0)) throw std::runtime_error("unit_um must be more than 0");
    const double step = keys.number("step_um", 0.002);
    const uint32_t state =
        add_state({gaussian("green", 0.55, 0.04),
                   {sizeof(suite_band), SUITE_BAND_RECTANGULAR, "red", 0.65, 0.03, 0, nullptr, nullptr}},
                  step);
    tasks.push_back({sizeof(suite_task), "look", 0, 60});
    add_capture(0, state, size_, size_, 0, 60, 64);
    where_ = place(keys) + "second 0: " + keys.utc(0) + "\nsecond 60: " + keys.utc(60) + "\n";
  }

  void start() override {
    const suite_bins& b = bins(0);
    std::string table = "low_um,high_um,green,red\n";
    for (uint32_t k = 0; k < b.bins; ++k)
      table += row({b.low_um[k], b.high_um[k], b.weights[k], b.weights[b.bins + k]});
    write_file(file_, table);
#ifdef SUITE_SENSOR_MINOR  // headers before 1.4 know intervals only
    std::string points = "g_point,g_weight\n";
    for (uint32_t k = 0; k < b.bins; ++k) points += row({static_cast<double>(b.g_point[k]), b.g_weight[k]});
    write_file("g_points.csv", points);
#endif
    write_file("where.txt", where_ + "seed: " + std::to_string(run().seed) +
                                "\nreference_um: " + row({b.reference_um}) + "name: " + run().name + "\nfolder: " +
                                (run().folder ? run().folder : "none") + "\nmade by: " + run().made_by + "\n");
  }

  void ray(const suite_ray_request& request, suite_ray& ray) const override {
    if (static_cast<double>(request.problem) == faulty_ && request.u[3] < 0.5) throw std::runtime_error("no ray");
    ray.origin[0] = static_cast<double>(request.problem % size_) + request.u[0];
    ray.origin[1] = static_cast<double>(request.problem / size_) + request.u[1];
    ray.origin[2] = 100;
    ray.direction[2] = -1;
    ray.time_s = 60 * request.u[2];
    ray.weighted = 1;
    for (uint32_t k = 0; k < request.bins; ++k) {
      const double relative = request.bin_um[k] / unit_um_;
      request.weights[k] = static_cast<float>(relative * relative);
    }
  }

  void accept(const suite_result& r) override {
    std::string table = "problem,quality,green,green_error,red,red_error\n";
    for (uint32_t p = 0; p < r.columns * r.rows; ++p) {
      table += std::to_string(p) + "," + std::to_string(r.quality[p]) + ",";
      table += row({r.radiance[2 * p], r.standard_error[2 * p], r.radiance[2 * p + 1], r.standard_error[2 * p + 1]});
    }
    write_file("pixels.csv", table);
  }

 private:
  static std::string row(std::initializer_list<double> values) {
    std::string line;
    char text[32];
    for (const double v : values) {
      std::snprintf(text, sizeof text, "%.17g", v);
      line += (line.empty() ? "" : ",") + std::string(text);
    }
    return line + "\n";
  }
  // Origin, and the place of the point 1000 m east of it in ECEF.
  static std::string place(const suite_sdk::Keys& keys) {
    const auto frame = keys.frame();
    if (!frame) return "origin:\n";
    double east[3];
    for (int k = 0; k < 3; ++k) east[k] = 1000 * frame->ecef_from_enu[3 * k] + frame->ecef_origin_m[k];
    return "origin: " + row({frame->latitude_deg, frame->longitude_deg, frame->height_m}) +
           "1 km east: " + row({east[0], east[1], east[2]});
  }

  uint32_t size_ = 0;
  double unit_um_ = 0, faulty_ = -1;
  std::string file_, where_;
};

SUITE_SENSOR_PLUGIN("field_notes", "keeps tables of what the interface tells it (example plug-in)", FieldNotes)
