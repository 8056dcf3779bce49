// Truth: what is known of the things that a problem's rays met, beside the radiance that came from them. One table, one
// row a collector; a sensor names the rows it wants (Sensor::truth).
//
// Based on: Goodenough & Brown, section III-C (number of paths, average location of the first node, material
// statistics).
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/registry.h"
#include "light/environment.h"
#include "motion/scene_frame.h"
#include "spectral/state.h"
#include "transport/lane.h"

namespace suite {

// What collectors may look at for a whole capture. Everything referred to must outlive the plan.
struct TruthContext {
  const Tracer& tracer;
  const SpectralState& state;
  size_t state_index = 0;
  std::span<const Band> bands;
  const BandProjection& projection;
  const Environment& environment;
};

// One complete path and the first surface that it met (null = nothing).
struct TruthSample {
  const PathRecord& path;
  const FirstMeeting* first = nullptr;
};

// How many samples a problem took and how many of them met something.
struct TruthCounts {
  double paths = 0, hits = 0;
};

// Collects one kind of truth. Memory of a problem is a row of doubles that start as 0.
class TruthCollector {
 public:
  virtual ~TruthCollector() = default;
  virtual size_t slots() const = 0;                      // doubles a problem
  virtual std::vector<std::string> columns() const = 0;  // names with units, one per value that finish() gives
  virtual void add(const TruthSample& sample, double* slots) const = 0;
  // Adds what other samples gave to what some have. Unless it says otherwise, all slots are sums.
  virtual void join(const double* others, double* slots) const;
  // values: one per column, NaN where nothing is known. Not called for a problem without paths.
  virtual void finish(const double* slots, const TruthCounts& counts, double* values) const = 0;
};

// A row's summary says how samples are combined. make: Error when the scene lacks what it needs.
using TruthRow = RegistryRow<std::unique_ptr<const TruthCollector>(const TruthContext&)>;
const Registry<TruthRow>& truth_rows();

// The collectors of a capture, side by side.
class TruthPlan {
 public:
  // `object` joins `tag` and `instance` where a group has a tag. Error: an unknown name, or a scene without what a
  // collector needs (an origin on the Earth).
  TruthPlan(std::span<const std::string> names, const TruthContext& context);
  // Doubles that a problem keeps of each scramble; 0 when nothing is wanted.
  size_t slots() const { return slots_; }
  bool wanted() const { return !collectors_.empty(); }
  const std::vector<std::string>& columns() const { return columns_; }
  void add(const TruthSample& sample, double* slots) const;
  // scrambles: slots() doubles of each scramble of a problem, joined in their order. values: columns().size() numbers.
  void finish(std::span<const double> scrambles, uint32_t paths, double* values) const;

 private:
  std::vector<std::unique_ptr<const TruthCollector>> collectors_;
  std::vector<size_t> widths_;  // columns of each
  std::vector<std::string> columns_;
  size_t slots_ = 0;  // the first counts the hits
};

// The rows of the table, by what they are about.
void add_place_rows(std::vector<TruthRow>& table);    // place.cpp: location, range, time
void add_angle_rows(std::vector<TruthRow>& table);    // place.cpp: normals and angles
void add_matter_rows(std::vector<TruthRow>& table);   // matter.cpp: materials, instances, tags, reflectance
void add_warmth_rows(std::vector<TruthRow>& table);   // warmth.cpp: temperature, its error, what makes it
void add_air_rows(std::vector<TruthRow>& table);      // air.cpp: parts of the air's light in view
void add_account_rows(std::vector<TruthRow>& table);  // account.cpp: counts of paths and nodes, visibility, state

// Collectors made of functions, which is what most rows are.
struct SimpleCollector final : TruthCollector {
  using Add = void (*)(const TruthContext&, const TruthSample&, double*);
  using Finish = void (*)(const TruthContext&, const double*, const TruthCounts&, double*);
  SimpleCollector(const TruthContext& c, size_t n, std::vector<std::string> names, Add a, Finish f)
      : context(c), memory(n), names_of_columns(std::move(names)), add_sample(a), finish_problem(f) {}
  size_t slots() const override { return memory; }
  std::vector<std::string> columns() const override { return names_of_columns; }
  void add(const TruthSample& sample, double* at) const override { add_sample(context, sample, at); }
  void finish(const double* at, const TruthCounts& counts, double* values) const override {
    finish_problem(context, at, counts, values);
  }
  TruthContext context;
  size_t memory;
  std::vector<std::string> names_of_columns;
  Add add_sample;
  Finish finish_problem;
};

}  // namespace suite
