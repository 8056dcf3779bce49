#include "sensor/plugin_host.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace suite {

namespace {

template <class Ask>
int guarded(void* context, const Ask& ask) noexcept {
  PluginMaking& m = *static_cast<PluginMaking*>(context);
  try {
    return ask(m);
  } catch (const Error& e) {
    if (!m.error) m.error = e;
  } catch (...) {
    m.failure = "a key could not be read";
  }
  return -1;
}

int host_number(void* context, const char* key, double* value) {
  return guarded(context, [&](const PluginMaking& m) {
    const auto found = m.params.find(key);
    if (found) *value = found->as_number();
    return found ? 1 : 0;
  });
}
int host_numbers(void* context, const char* key, double* values, uint32_t capacity, uint32_t* count) {
  return guarded(context, [&](const PluginMaking& m) {
    *count = 0;
    const auto found = m.params.find(key);
    if (!found) return 0;
    const std::vector<double> list = found->as_numbers();
    if (list.size() > capacity)
      throw found->error(strf("%zu numbers, the plug-in takes %u at most", list.size(), capacity));
    std::copy(list.begin(), list.end(), values);
    *count = static_cast<uint32_t>(list.size());
    return 1;
  });
}
int host_text(void* context, const char* key, char* buffer, uint32_t capacity) {
  return guarded(context, [&](const PluginMaking& m) {
    const auto found = m.params.find(key);
    if (!found) return 0;
    const std::string text = found->as_text();
    if (text.size() + 1 > capacity) throw found->error("the text is too long for the plug-in");
    std::memcpy(buffer, text.c_str(), text.size() + 1);
    return 1;
  });
}
void host_fail(void* context, const char* message) {
  static_cast<PluginMaking*>(context)->failure = message ? message : "no reason given";
}
int host_frame(void* context, suite_frame* out) {
  return guarded(context, [&](const PluginMaking& m) {
    const std::optional<SceneFrame> scene = m.context.frame ? m.context.frame() : std::nullopt;
    if (!scene) return 0;
    const Geodetic& at = scene->origin();
    const Vec3 center = scene->to_ecef().translation;
    suite_frame frame{out->size, 0, at.latitude_deg, at.longitude_deg, at.height_m, {}, {center.x, center.y, center.z}};
    const Vec3 axes[3] = {scene->ecef_direction({1, 0, 0}), scene->ecef_direction({0, 1, 0}),
                          scene->ecef_direction({0, 0, 1})};
    for (int k = 0; k < 3; ++k)
      frame.ecef_from_enu[k] = axes[k].x, frame.ecef_from_enu[3 + k] = axes[k].y,
      frame.ecef_from_enu[6 + k] = axes[k].z;
    std::memcpy(out, &frame, std::min(size_t{out->size}, sizeof frame));
    return 1;
  });
}
int host_utc(void* context, double time_s, char* buffer, uint32_t capacity) {
  return guarded(context, [&](const PluginMaking& m) {
    const std::string text = m.context.utc ? m.context.utc(time_s) : "";
    if (text.empty()) return 0;
    if (text.size() + 1 > capacity) throw m.params.error(strf("a date takes %zu bytes", text.size() + 1));
    std::memcpy(buffer, text.c_str(), text.size() + 1);
    return 1;
  });
}

}  // namespace

suite_host PluginMaking::host() {
  return {sizeof(suite_host), SUITE_SENSOR_ABI, this,       host_number, host_numbers,
          host_text,          host_fail,        host_frame, host_utc};
}

const suite_run& PluginRun::begin(const RunFacts& facts, std::span<const SpectralState> states,
                                  const std::vector<std::vector<Band>>& bands) {
  facts_ = facts;
  folder_ = facts.folder.empty() ? "" : facts.folder + "/" + name_;
  values_.assign(states.size(), {});
  bins_.clear();
  for (size_t s = 0; s < states.size(); ++s) {
    const BandProjection projection(states[s], bands[s]);
    Bins& v = values_[s];
    for (const Bin& b : states[s].bins) {
      v.low.push_back(b.low_um), v.high.push_back(b.high_um);
      v.g_point.push_back(b.g), v.g_weight.push_back(b.weight);
    }
    for (size_t b = 0; b < bands[s].size(); ++b)
      for (size_t k = 0; k < states[s].size(); ++k) v.weights.push_back(projection.weight(b, k));
    bins_.push_back({sizeof(suite_bins), static_cast<uint32_t>(states[s].size()),
                     static_cast<uint32_t>(bands[s].size()), 0, v.low.data(), v.high.data(), v.weights.data(),
                     states[s].reference_um, v.g_point.data(), v.g_weight.data()});
  }
  run_ = {sizeof(suite_run),
          static_cast<uint32_t>(states.size()),
          bins_.data(),
          name_.c_str(),
          folder_.empty() ? nullptr : folder_.c_str(),
          facts_.made_by.c_str(),
          facts_.seed,
          this,
          write_file};
  return run_;
}

int PluginRun::write_file(void* context, const char* name, const void* bytes, uint64_t count) noexcept {
  PluginRun& run = *static_cast<PluginRun*>(context);
  if (run.folder_.empty()) return 0;
  try {
    const std::string file = name ? name : "";
    if (file.empty() || file == "." || file == ".." || file.find('/') != std::string::npos)
      throw Error("a sensor cannot write a file named '" + file + "'", "a name without folders");
    run.facts_.write(run.name_, file, {static_cast<const char*>(bytes), static_cast<size_t>(count)});
    return 0;
  } catch (const Error& e) {
    if (!run.error_) run.error_ = e;
  } catch (...) {
    if (!run.error_) run.error_ = Error("a file of the sensor '" + run.name_ + "' could not be written");
  }
  return 1;
}

void PluginRun::rethrow() {
  if (error_) throw *error_;
}

}  // namespace suite
