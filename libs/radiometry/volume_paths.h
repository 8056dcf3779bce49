// Takes paths through media from one surface to the next: flights, scattering events with the light that reaches them,
// index-matched boundaries on the way.
//
// Everything between two surfaces belongs to one segment of the path (wave.h: through, gathered), so a walk of
// thousands of scatterings needs no record of each: light is carried forward along it. Surfaces stay the nodes of the
// path. With beta the weight of the path so far, v the sum over the contents of density x scattering x phase function,
// T the transmittance towards a source of radiance L drawn with density p_s, and q_k = v_k / (scattering coefficient)
// the density of directions at knot k:
//   explicit light: beta_i v_i T_i L_i / (A p_s + sum P_k r_k q_k T_k),     continuation: beta_i <- beta_i v_i / q_h
// which is the heuristic of path_generator.h with the flights' densities in it.
#pragma once
#include <memory>
#include <vector>

#include "radiometry/pipeline.h"
#include "radiometry/volume_light.h"
#include "radiometry/wave.h"

namespace suite {

class VolumePaths {
 public:
  // Keeps references. knot_probability: P_k. lost: null where no light can be lost.
  VolumePaths(const Surface& surface, const Optics& optics, const Environment& environment,
              const PipelineOptions& options, std::span<const double> knot_probability, LostLight* lost);

  // Puts a new path into the bodies around its origin.
  void start(LivePath& live, double time, TraceStatistics& statistics);
  // Takes the paths of wave.active, whose next hits wave.hits tells, on to surfaces that are nodes or out of the scene,
  // and fills the segment behind their last node. Paths that end in a medium leave both lists.
  void travel(Wave& wave, std::vector<LivePath>& live, RunStatistics& statistics);
  // Starts the segment behind the path's last node: everything that arrives passes, nothing is gathered yet.
  static void open(Wave& wave, uint32_t p);
  // A path goes on through a surface to the other side.
  void cross(LivePath& live, const Node& node) {
    bodies_.transmit(live.bodies, node.hit, node.at.material, node.in, crossing_);
  }

  // Visibility of sources from nodes: as Tracer::occluded for wave.rays of the paths wave.owner, asked at their last
  // nodes.
  void look(Wave& wave, const std::vector<LivePath>& live, RunStatistics& statistics);
  // What ray i of the last look() leaves of its light: false = all of it. knots: the same of scattering alone, the
  // share of flights that reach the source.
  bool dims(size_t ray, std::span<float> transmission, std::span<double> knots) const;
  // Of ray i of the last look(), which is blocked: the share of its light that smooth surfaces pass, if nothing else
  // blocks it.
  double passes(size_t ray) const { return light_.passes(ray); }

 private:
  struct Scattering {  // of one path
    size_t slot;       // in wave.active
    uint32_t path;
    Vec3 place;
    std::vector<Constituent> contents;
    double rate[kMaxKnots];  // scattering coefficient
  };
  struct Light {   // of one ray towards a source
    size_t event;  // in events_
    double density, radiance;
    const float* spectrum;
    bool disk;  // the Sun's or the Moon's
    bool sky;
  };
  std::array<double, 4> numbers(const LivePath& live, uint32_t block) const;
  // How a path goes on after an event of travel().
  struct Start {
    Vec3 from;       // of the ray that looks for what the path will meet
    double gap = 0;  // m from live.origin to there
  };
  bool step(Wave& wave, size_t slot, LivePath& live, bool& moves, TraceStatistics& statistics);
  void remember(Wave& wave, size_t slot, Vec3 place);
  void light_events(Wave& wave, std::vector<LivePath>& live, RunStatistics& statistics);
  void ask_sources(Wave& wave, size_t event, const LivePath& live);
  // arrives: else it is lost on smooth surfaces, and only noted.
  void add_light(Wave& wave, const LivePath& live, const Light& light, Dir direction, size_t ray, bool arrives);
  bool scatter(Wave& wave, const Scattering& event, LivePath& live);
  void densities(const Scattering& event, double cosine, std::span<double> q) const;
  void phase_spectrum(const Scattering& event, double cosine, std::span<float> v);

  const Surface& surface_;
  const Optics& optics_;
  const Environment& environment_;
  PipelineOptions options_;
  uint32_t ambient_;
  std::vector<double> probability_;
  VolumeField field_;
  Bodies bodies_;
  Flights flights_;
  VolumeLight light_;
  std::vector<Scattering> events_;
  size_t event_count_ = 0;
  std::vector<Light> lights_;
  std::vector<uint8_t> ended_;            // per slot
  std::vector<Start> start_;              // per slot
  TraceStatistics crossing_;              // of rays at nodes, until travel() reports them
  std::vector<size_t> pending_, moving_;  // slots
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<float> spectrum_, transmission_, phase_;
};

}  // namespace suite
