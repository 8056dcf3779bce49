// Light that has to be known before the sensors' materials can be baked, such as what heats surfaces: elements of the
// scene as problems, over spectra and time windows of the pass's own.
//
// A pre-pass is a sensor that a job runs first (JobOptions::prepasses), so that all that holds for captures holds for
// it: the tracer of each window, kits of its own states and windows, executor, store. What it finds reaches the
// sensors' materials through JobOptions::loads.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sensor/sensor.h"

namespace suite {

// Irradiance on planes, one an element, under everything that shines, with what the scene scatters and what glows in it
// at temperatures that do not wait for loads. Dated sources stand where they do in the middle of each window.
class Prepass final : public Sensor {
 public:
  // It receives over the hemisphere around its normal (unit). Stands still. An element of a surface stands off it by
  // more than rays miss it by: 1e-6 of the size of what it belongs to is enough.
  struct Element {
    Vec3 position;  // m, ENU
    Dir normal;
  };
  // Light of a state, in bands.
  struct Spectrum {
    SpectralState state;
    std::vector<Band> bands;
  };
  // goal: of each element in each window and spectrum; its floor is an irradiance, W/(m2 um). Error: no elements,
  // spectra or windows; positions that are not finite, normals that are not unit; windows that end before they begin; a
  // state whose bins are still to be chosen.
  Prepass(std::string name, std::vector<Element> elements, std::vector<Spectrum> spectra,
          std::span<const TimeWindow> windows, const Convergence& goal);

  // Mean over a window and its standard error, W/(m2 um), once the pass has run. [element][band]
  std::span<const double> irradiance(size_t window, size_t spectrum) const;
  std::span<const double> standard_error(size_t window, size_t spectrum) const;

  std::string name() const override { return name_; }
  std::span<const SpectralState> states() const override { return states_; }
  std::span<const Band> bands(size_t state) const override { return bands_[state]; }
  std::span<const Task> tasks() const override { return tasks_; }  // one a window, a capture a spectrum
  int numbers() const override { return 1; }
  std::span<const std::string> truth() const override { return {}; }
  SensorRay ray(const RayRequest& request) const override;
  void accept(CaptureResult&& result) override;

 private:
  const CaptureResult& result(size_t window, size_t spectrum) const;
  std::string name_;
  std::vector<Element> elements_;
  std::vector<SpectralState> states_;
  std::vector<std::vector<Band>> bands_;
  std::vector<Task> tasks_;
  std::vector<CaptureResult> results_;  // [window][spectrum]
};

// Wavelengths, um, that the states of sensors and pre-passes reach over: what a scene has to be loaded for.
std::vector<std::array<double, 2>> windows_um(std::span<const std::unique_ptr<Sensor>> sensors,
                                              std::span<const std::unique_ptr<Sensor>> prepasses);

}  // namespace suite
