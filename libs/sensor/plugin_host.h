// The host's side of sdk/suite_sensor.h: the functions that a plug-in calls.
#pragma once
#include <optional>
#include <string>

#include "base/params.h"
#include "sensor/run_facts.h"
#include "sensor/sdk/suite_sensor.h"
#include "sensor/sensors.h"

namespace suite {

// While a plug-in makes its sensor. An Error must not cross the border: what host functions leave behind waits here.
struct PluginMaking {
  const Params& params;
  const SensorContext& context;
  std::optional<Error> error;
  std::string failure;
  // Functions over this object, which stays where it is.
  suite_host host();
};

// What a plug-in knows of a run: its bins, the files it may write.
class PluginRun {
 public:
  // name: of the sensor.
  explicit PluginRun(std::string name) : name_(std::move(name)) {}
  PluginRun(const PluginRun&) = delete;
  PluginRun& operator=(const PluginRun&) = delete;
  // bands: of each state.
  const suite_run& begin(const RunFacts& facts, std::span<const SpectralState> states,
                         const std::vector<std::vector<Band>>& bands);
  // Throws what a file that could not be written left behind.
  void rethrow();

 private:
  struct Bins {
    std::vector<double> low, high, weights, g_weight;
    std::vector<uint32_t> g_point;
  };
  static int write_file(void* context, const char* name, const void* bytes, uint64_t count) noexcept;
  std::string name_, folder_;
  RunFacts facts_;
  std::vector<Bins> values_;
  std::vector<suite_bins> bins_;
  suite_run run_{};
  std::optional<Error> error_;
};

}  // namespace suite
