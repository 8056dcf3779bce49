// The polarisation of the light of real air along segments: Q, U and V, and what I lacks of the vector field where
// stratified_air.h has the scalar one.
//
// Light of a beam that is scattered once is exact for the layers; the rest comes from air/polarised_source.h, linear in
// height within a layer and between the cosines of its ways. V is there where the source has it. Kinds of particles
// that do not tell their matrices depolarise, and their share is told. Assumes: meridian planes are those of the
// scene's vertical along the whole way (1 degree off after 110 km); pieces of a way in the Earth's shadow at one end
// are dark; a low sun stands everywhere as over the scene. Error against paths traced through the same air:
// docs/theory/polarisation.md.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "air/polarised_source.h"
#include "light/beam_light.h"
#include "light/sky_table.h"

namespace suite {

class PolarisedAir {
 public:
  // once: of the beams in the column. All must outlive this. source: null where light is scattered once.
  PolarisedAir(const AirColumn& column, const std::vector<Beam>& beams, const BeamLight& once,
               std::shared_ptr<const PolarisedSource> source);

  // Per bin, W/(m2 sr um). V: empty, or for what tells it.
  struct Light {
    std::span<float> I, Q, U, V = {};
  };
  // Whether V is known and asked for.
  bool tells_v() const { return parts_ == 4; }
  // Of the light that comes to `from` along a segment (Atmosphere::path), in the meridian frame of its travel: what is
  // to be added to I, and Q, U and V. Returns the share of light scattered once by what tells no matrix.
  double along(Vec3 from, Dir d, double distance, const Light& to) const;
  // The same of the sky, to infinity, from places where light that is scattered goes on: near the scene's middle one of
  // the values of a table, drawn with its weight between its neighbours (SkyTable::drawn). Within a degree of the
  // zenith meridians are mixed.
  double sky(Vec3 from, Dir d, const Light& to) const;

 private:
  struct Scratch;
  Scratch& scratch() const;
  void begin(Dir d, Scratch& s) const;
  void pass_again(const Shells::Piece& piece, Vec3 middle, Dir d, Scratch& s, const Light& to) const;
  void pass_once(size_t beam, const Shells::Piece& piece, Vec3 from, Dir d, Scratch& s, const Light& to) const;
  float share(size_t layer, double height) const;

  const AirColumn& column_;
  const std::vector<Beam>& beams_;
  const BeamLight& once_;
  std::shared_ptr<const PolarisedSource> source_;
  size_t bins_, parts_;
  std::optional<double> symmetric_;  // azimuth of the only beam
  std::unique_ptr<SkyTable> sky_;    // I, Q, U, V per bin, and the share; null: too large
};

}  // namespace suite
