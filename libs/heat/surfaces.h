// A scene's elements through a span of time: what acts on their faces, conduction behind them, and the longwave
// exchange that couples them.
//
// Assumes: all faces feel the same air; histories are straight between the steps' ends.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "heat/balance.h"
#include "heat/compact_rows.h"
#include "heat/exchange_through.h"
#include "heat/slab_batch.h"
#include "heat/surface_parts.h"

namespace suite {

// Elements of one construction. A face is a row of the exchange.
struct SurfaceGroup {
  std::string name;               // of its material, for messages; may be empty
  std::vector<SlabLayer> layers;  // from the front down; empty: no heat capacity, as leaves
  FaceTraits front, back;         // back: of faces in back_rows
  std::vector<double> cosine_up;  // of each front's outward normal, a back's is the opposite; empty = the traits'
  std::vector<double> front_emissivity, back_emissivity;  // of each; empty = the traits'
  std::vector<uint32_t> front_rows;                       // of each element
  std::vector<uint32_t> back_rows;  // of each element when its back is open to sky and surfaces; empty: `behind`
  BackCondition behind;

  // Of one element.
  FaceTraits front_of(size_t element) const;
  FaceTraits back_of(size_t element) const;
};

// Air over time (s), straight between the times, which cover the span unless they repeat.
struct AirSeries {
  std::vector<double> times, kelvin, wind, vapour_pressure;  // s, K, m/s, Pa; one a time
  double pressure = 101325;                                  // Pa, mean
  bool repeat = false;
};

struct SurfaceLoads {
  double begin = 0;           // s
  std::vector<double> steps;  // s
  AirSeries air;
  std::vector<std::vector<float>> shares;  // of the moments by interval of rest; may be empty where there is one
  CompactRows absorbed;                    // W/m2 shortwave: by face, then by moment (begin and the steps' ends)
  std::vector<double> source;              // W/m2 released at every element's front, by face; empty = none
  std::vector<double> outside;             // W/m2 emitted by the outsides of the exchange, by outside and moment
};

struct SurfaceOptions {
  bool periodic = true;  // the span repeats; otherwise it goes on from the present state
  PeriodicOptions past;
  CouplingOptions coupling;
  bool last = false;  // no other span follows: the state is given up for room, as soon as it can be
};

struct SurfaceHistory {
  size_t moments = 0;
  Histories kelvin;                // K, of every face
  CompactRows received;            // W/m2 longwave, by face, then by moment
  std::vector<double> step_error;  // K, by face: largest estimated error of a step; 0 without heat capacity
  // J/m2 over the span, by front face: what went to what lies behind, and what the layers took up (of a span that
  // repeats nothing); 0 of backs.
  std::vector<double> behind, stored;
  CouplingResult coupling;
  double past_distance = 0;  // K, largest estimated distance of a node from the periodic state
  double kelvin_at(size_t face, size_t moment) const { return kelvin.at(face, moment); }
};

class CoupledSurfaces {
 public:
  // The exchange must outlive this. Error: as SlabBatch, groups whose rows are not those of the exchange, each once,
  // and neighbours of other layers, or one open and one closed back.
  CoupledSurfaces(std::vector<SurfaceGroup> groups, ExchangeThrough exchange, const SurfaceNeighbours& neighbours = {});
  // The present state: one temperature (K) everywhere.
  void start(double kelvin);
  // Solves the span and leaves the state at its end, from where a span that is not periodic goes on: the past of n days
  // is a first one that repeats and then each as it was. In parallel over elements, with the same result on any number
  // of threads. Error: as find_periodic, couple_histories and massless_kelvin; loads of other sizes.
  SurfaceHistory solve(const SurfaceLoads& loads, const SurfaceOptions& options = {});

 private:
  struct Part : SurfacePart {
    double distance = 0;                   // K, from the periodic state
    std::optional<SlabBatch> batch, next;  // the present state and that of the sweep; none without heat capacity
  };
  struct Through;   // what all elements share through a span
  struct Received;  // infrared that the faces of a part receive
  const SurfaceGroup& group_of(const Part& part, size_t i) const { return groups_[part.members[i].group]; }
  uint32_t front_row(const Part& part, size_t i) const { return group_of(part, i).front_rows[part.members[i].element]; }
  uint32_t back_row(const Part& part, size_t i) const { return group_of(part, i).back_rows[part.members[i].element]; }
  void check(const SurfaceLoads& loads) const;
  void fill(const Part& part, size_t step, const Through& through, const Received& received, const SlabBatch& batch,
            FaceLines& top, FaceLines& bottom) const;
  void answer_of(Part& part, const Through& through, const PutEmitted& put);
  void answer(Part& part, const Through& through, const PutEmitted& put);
  void answer_massless(const Part& part, const Through& through, const PutEmitted& put) const;
  CouplingResult couple(Through& through, Histories& emitted);

  std::vector<SurfaceGroup> groups_;
  ExchangeThrough exchange_;
  std::vector<Part> parts_;
  std::vector<double> step_error_, behind_, stored_;  // by face
};

}  // namespace suite
