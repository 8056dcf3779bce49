// Faces that go together when sunlight is traced: the working memory of one thread.
#pragma once
#include <algorithm>
#include <cmath>

#include "heat/heat_walk.h"
#include "heat/lit_time.h"
#include "heat/path_numbers.h"
#include "heat/sunlight.h"
#include "heat/told_sun.h"

namespace suite {

inline constexpr double kFinestEdge = 1;  // s, to which edges of shadows are found
// Points of each half of a block that look at the sun once, at most: more than there can be asked for.
PathOptions asking_more(const PathOptions& watching, const SunCourse& course);

class SunlightWave {
 public:
  SunlightWave(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
               const SunCourse& course, const PathOptions& options, uint32_t joins, Sunlight& out);
  void beam(size_t begin, size_t end);       // straight from the sun
  void scattered(size_t begin, size_t end);  // along paths
  // What a point takes straight from the sun through the day, by moment and for a beam of 1, as beam() has it of faces.
  // disk: where on the sun it looks, radii. back: of the surface's back.
  void of_point(const Hit& hit, bool back, Vec2 disk, std::span<float> takes);
  uint64_t rays() const { return trace_.rays; }
  double unfinished() const { return unfinished_; }

 private:
  // A point of a face through the day.
  struct Watch {
    uint32_t face, block, half;
    Hit hit;
    Dir normal;  // of the face's side
    struct Stand {
      Hit hit;
      Dir normal;
    };
    std::vector<Stand> stands;  // by interval of rest, of what stands in other places at other times; else empty
    double disk_x, disk_y;      // where on the sun's disk it looks, radii
    std::vector<uint8_t> lit;   // by moment
    std::vector<float> takes;   // by moment: what it absorbs of a beam of 1 that is not hidden
  };
  struct Edge {  // between two moments that differ
    size_t watch, moment;
    double low, high;
    uint8_t lit_low;
  };
  struct Going {
    uint32_t slot;
    uint32_t spectrum;  // number of its throughput
    WalkDensities drawn;
  };
  struct Join {
    uint32_t row;    // of the face, its block and half, of those that go together
    uint32_t sunny;  // number of the moment
    double value, told;
  };
  // within: of the paths (or points, when options say so) of the face.
  PathNumbers numbers_of(uint32_t slot, uint64_t purpose) const {
    const uint32_t each = options_.blocks * options_.paths;
    return {options_, purpose, faces_.number(out_.rows.face(slot / each)), slot % each};
  }
  Dir towards_sun(const Watch& watch, double t) const;
  const Hit& hit_at(const Watch& w, double t) const {
    return w.stands.empty() ? w.hit : w.stands[interval_of(elements_.rests(), t)].hit;
  }
  const Dir& normal_at(const Watch& w, double t) const {
    return w.stands.empty() ? w.normal : w.stands[interval_of(elements_.rests(), t)].normal;
  }
  Dir towards_sun(const Watch& watch, uint32_t moment) const {
    return on_disk(suns_[moment], watch.disk_x, watch.disk_y, course_.angular_radius);
  }
  void beam_of(size_t begin, size_t end);
  // disk: two numbers for where on the sun it looks.
  Watch watch_of(uint32_t face, const PathNumbers& numbers, const std::array<double, 4>& disk) const;
  // late: share of the time to the next moment that has passed. d: to the sun then.
  double takes_between(const Watch& watch, size_t moment, double late, Dir d);
  uint32_t watches_of_block() const { return watching_.paths; }
  uint32_t row_of(uint32_t slot) const { return slot / options_.half() - first_ * 2 * options_.blocks; }
  void look(std::vector<Watch>& watches);
  void find_edges(std::vector<Watch>& watches, std::vector<Edge>& edges);
  PointDay day_of(const Watch& watch, std::span<const Edge> edges) const;
  std::array<double, 4> place_of(uint32_t face, Vec3 position, double disk_x, double disk_y) const;
  // Points of a face and their days, and the block that is told from the others.
  struct BlockOfFace {
    std::span<const Watch> watches;
    std::span<const PointDay> days;
    uint32_t block;
    bool own(size_t k) const { return watches[k].block == block; }
  };
  // What the other blocks tell of a block's points.
  struct Told {
    PassingEdges edges;
    std::vector<float> takes;    // by moment: the others' mean
    std::vector<float> even;     // by step: share that is lit, where no edge is told
    std::vector<uint32_t> more;  // by step: rays for each point besides its own day
    std::vector<float> own_day;  // by step: share of that day in what its point finds
    bool any = false;            // of more
  };
  void add_face(std::span<const Watch> watches, std::span<const PointDay> days);
  Told told_of(const BlockOfFace& of) const;
  void plan_more(const BlockOfFace& of, Told& told) const;
  void add_block(const BlockOfFace& of);
  void add_told(const BlockOfFace& of, const Told& told, uint32_t half);
  void ask_more(const BlockOfFace& of, const Told& told);
  void put_lit(uint32_t block, double sign, size_t moment, double value);
  void add_spread(std::span<const Watch> watches, std::span<const PointDay> days);
  void add_lit(uint32_t face, uint32_t block, double sign, std::span<const float> takes, std::span<const float> shares);
  std::span<const float> kept_by(const Watch& watch);
  float taken(const Watch& watch, uint32_t moment, Dir d);
  void start(uint32_t row);
  bool go_on(Going& path, Ray& ray, const Hit& hit, uint32_t n);
  // By sunny moment, whether points of the face were lit; null: it is none of an element.
  const uint8_t* lit_on(uint32_t face) const {
    return face < faces_.size() ? &out_.lit[size_t{face} * sunny_.size()] : nullptr;
  }
  void ask_sun(const Going& path, const Hit& hit, Dir direction, uint32_t n);
  void join_sun(const Going& path, const Hit& hit, Dir out, uint32_t n, const uint8_t* lit, const uint8_t* beyond);
  void answer_sun();
  void clear_rows();
  void keep_rows(uint32_t face);
  void lift_beam();
  void add_scattered(size_t begin, size_t end);
  void add_sky(size_t begin, size_t end);
  double mean_ratio(const Going& path) const { return path.drawn.weight(knots_); }
  void leave(const Going& path, Dir d);
  std::span<float> throughput(const Going& path) { return {&spectra_[size_t{path.spectrum} * bins_], bins_}; }

  const Tracer& tracer_;
  const Elements& elements_;
  const HeatFaces& faces_;
  const SunCourse& course_;
  const PathOptions& options_;
  const PathOptions watching_;  // of the points that look at the sun
  const PathOptions more_;      // of those that look once
  uint32_t joins_;
  Sunlight& out_;
  Surface surface_;
  size_t bins_, knots_;
  double step_;                  // s, between moments
  std::vector<uint32_t> sunny_;  // moments with the sun up
  std::vector<Frame> suns_;      // by moment: z to the middle of the sun
  ToldSun told_sun_;
  std::vector<std::vector<float>> shares_;           // interval_shares(), where there are several
  std::vector<std::vector<uint32_t>> sunny_within_;  // by interval: sunny moments (of these) that are of it
  const ChangingRoom* changing_ = nullptr;           // of rows of which it is to be found whether they see changes
  uint32_t first_ = 0;                               // of the rows that go together
  std::vector<float> rows_;  // [row][block][half][sunny moment] of those: what is scattered to them, by these paths
  std::vector<float> told_;  // by sunny moment
  std::vector<float> beam_, parts_;        // of one face, as Sunlight::beam and beam_of_block
  std::vector<float> sky_, sky_of_block_;  // of those that go together, as Sunlight has them
  Interaction at_;
  std::vector<float> W_, w_;
  SurfaceWalk walk_;
  const float* kept_of_ = nullptr;  // reflectance of which kept_ is told
  std::vector<float> kept_;         // by moment
  LitTime lit_;
  std::vector<float> lit_by_step_;  // [point of a face][step]: share of it
  TraceStatistics trace_;
  std::vector<Going> going_;
  std::vector<float> spectra_;
  std::vector<Ray> rays_, sights_;
  std::vector<Hit> hits_;
  std::vector<Join> asked_;
  std::vector<double> reach_;
  std::vector<uint8_t> blocked_;
  double unfinished_ = 0;
};

}  // namespace suite
