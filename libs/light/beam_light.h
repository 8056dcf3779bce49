// Light of beams from outside that real air scatters once, on straight ways through its layers.
//
// Along a piece of a way within a layer the beam's depth is looked up at both ends (air/beam_table.h), and runs evenly
// between them; where the piece is thin or begins the way, under a straight beam that comes down well, it follows from
// the near end: with d = (D - M / (R c^2)) / c, D the depth over a height and M its first moment, it grows by
// -k dh / c and by d (c_near / c - 1 + dh / (R c^2)), within 2e-4 of what is scattered, or of e^-2 of what would be if
// nothing dimmed it (tests/physics/light/thin_air_test.cpp). A piece that goes into the shadow of the Earth is lit as
// far as that.
#pragma once
#include "light/air_scratch.h"
#include "light/local_air.h"
#include "light/thin_bins.h"

namespace suite {

class BeamLight {
 public:
  // tables: of the beams' depths, filled before anything is asked. All must outlive this, and the beams' spectra.
  BeamLight(const AirColumn& column, const std::vector<Beam>& beams, const std::vector<BeamTable>& tables);

  const LocalAir& local() const { return local_; }
  // A way in a direction begins.
  void begin(Dir d, AirScratch& s) const;
  // Adds to S what a piece of it sends back; T: of what lies before it. weighed: whether s.weights() are those of the
  // piece; set when they have been made so. Per bin.
  void add(const Shells::Piece& piece, Vec3 from, Dir d, AirScratch& s, bool& weighed, std::span<const float> T,
           std::span<float> S) const;
  // What a piece near the scene's middle sends back of a beam, from tables (air_loops::scattered_here). Nothing: it
  // does not lie so.
  std::optional<air_loops::BeamHere> here(size_t b, const Shells::Piece& piece, Vec3 from, Dir d) const;
  // How deep a place lies for a beam, spread as it is there; false in the shadow of the Earth.
  bool depth(size_t b, Vec3 p, double height, std::span<float> depth) const;
  // What a metre of the beam's way sends back along the way that has begun if nothing dims it, W/(m3 sr um).
  void source(size_t b, size_t layer, AirScratch& s, std::span<float> to) const;

 private:
  using BeamAt = AirScratch::BeamAt;
  // How a beam's depth changes along a piece: near, its cosine where it begins; the rest as of air_loops::ThinBeam.
  struct Growth {
    double near, way, share;
  };
  const std::vector<float>& phase_of(size_t b, size_t kind, AirScratch& s) const;
  void look_up(size_t b, Vec3 p, double height, BeamAt& at) const;
  void scatter(const BeamAt& near, const BeamAt& far, float length, const air_loops::Weights& weights,
               const AirScratch& s, std::span<const float> T, std::span<float> S) const;
  std::optional<Growth> growth(size_t b, const Shells::Piece& piece, Vec3 from, Dir d) const;
  bool scatter_thin(size_t b, const Shells::Piece& piece, const Growth& growth, AirScratch& s, std::span<const float> T,
                    std::span<float> S) const;
  std::optional<air_loops::BeamHere> here(size_t b, const Shells::Piece& piece, const Growth& growth,
                                          double cosine) const;
  bool scatter_here(size_t b, const Shells::Piece& piece, const Growth& growth, AirScratch& s,
                    std::span<float> S) const;
  void scatter_lit(size_t b, const Shells::Piece& piece, Vec3 from, Dir d, AirScratch& s, std::span<const float> T,
                   std::span<float> S) const;

  const AirColumn& column_;
  const std::vector<Beam>& beams_;
  const std::vector<BeamTable>& tables_;
  size_t bins_;
  ThinBins thin_;
  LocalAir local_;
  std::vector<uint8_t> scatters_;  // [kind][layer]
};

}  // namespace suite
