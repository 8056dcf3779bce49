// What sensors with one spectral state and one capture have in common.
#pragma once
#include "math/warps.h"
#include "sensor/degree_target.h"
#include "sensor/kinds/rows.h"
#include "sensor/polarimetry.h"

namespace suite {

class SimpleSensor : public Sensor, public HasDegreeTarget {
 public:
  SimpleSensor(const Params& p, const SensorContext& context, const std::string& default_name)
      : deliver_(context.deliver),
        name_(p.name("name", default_name)),
        bands_(read_bands(p.at("bands"), context)),
        truth_(read_truth(p)) {
    states_.push_back(read_state(p, bands_));
    capture_.name = name_;
    capture_.window = read_window(p);
    capture_.convergence = read_convergence(p);
    capture_.band_targets = read_band_targets(p, bands_, capture_.convergence);
    degree_target_ = read_degree_target(p, bands_, capture_.convergence, capture_.band_targets);
  }
  std::string name() const override { return name_; }
  std::span<const SpectralState> states() const override { return states_; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  void take_state(size_t state, SpectralState with_bins) override { states_[state] = std::move(with_bins); }
  std::span<const Task> tasks() const override { return tasks_; }
  std::span<const std::string> truth() const override { return truth_; }
  std::span<const std::string> channels() const override { return channels_; }
  ImageWishes wishes(const Capture&) const override { return wishes_; }
  const Polarimetry* polarimetry() const override { return polarimetry_ ? &*polarimetry_ : nullptr; }
  double degree_target(const Capture&) const override { return degree_target_.error; }
  void accept(CaptureResult&& result) override {
    Delivery d{*this, lay_out(tasks_, name_)[0][0], std::move(result), bands_, {}, {}, {}, {}};
    if (polarimetry_) {
      add_polarisation(d);
      d.description = text_of(*polarimetry_);
    }
    finish(d);
    deliver_(d);
  }

 protected:
  // To be called by the constructor once capture_ has its size.
  void done() {
    check_degree_target(degree_target_, channels(), capture_.bins);
    tasks_.push_back({name_, capture_.window, {capture_}});
  }
  // Adds what a kind has to say to its delivery.
  virtual void finish(Delivery&) const {}
  double moment(double u) const { return capture_.window.begin + u * (capture_.window.end - capture_.window.begin); }

  std::function<void(const Delivery&)> deliver_;
  std::string name_;
  std::vector<Band> bands_;
  std::vector<std::string> truth_;
  ImageWishes wishes_;  // read by the kinds that make pictures of radiance, with
  std::vector<std::string> channels_{"radiance"};
  std::optional<Polarimetry> polarimetry_;  // likewise
  std::vector<SpectralState> states_;
  Capture capture_;
  DegreeTarget degree_target_;
  std::vector<Task> tasks_;
};

// A horizontal rectangle: keys origin_m: [east, north] of its south-west corner, size_m: [east, north].
struct Patch {
  Vec2 low, size;
  Vec3 at(double u, double v, double z) const { return {low.x + u * size.x, low.y + v * size.y, z}; }
};
inline Patch read_patch(const Params& p) {
  const std::vector<double> low = p.at("origin_m").as_numbers(), size = p.at("size_m").as_numbers();
  if (low.size() != 2 || size.size() != 2) throw p.error("origin_m and size_m are two numbers each: east, north");
  if (!(size[0] > 0 && size[1] > 0)) throw p.at("size_m").error("the patch needs a positive size");
  return {{low[0], low[1]}, {size[0], size[1]}};
}

}  // namespace suite
