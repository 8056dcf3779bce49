// What short ways and beams near the scene's middle need of real air, from tables: there beams stand everywhere almost
// alike, so that their depth follows from a few numbers a layer, and what a layer scatters of them once from the angle.
//
// A straight beam at cosine c comes to a height through a depth D / c - M / (R c^3), D the depth over it, M its first
// moment and R the Earth's radius, to second order in the scale height over R c^2. With q = c0 / c that is
// (a q - b q^3), a and b those under the beam's cosine c0 over the middle: exact there, and for cosines within 1 % of
// it to 5e-6 where c0 is above 0.4. Within a layer it runs linearly in height, to 1e-5.
#pragma once
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "air/column.h"
#include "light/light.h"

namespace suite {

class LocalAir {
 public:
  // column and the beams' spectra must outlive this.
  LocalAir(const AirColumn& column, std::span<const Beam> beams);

  // Per bin: depth = (low + rise * share) * stretch + curve * bend.
  struct BeamDepth {
    const float *low, *rise, *curve;
    float share, stretch, bend;
  };
  // At a height, for light that comes at a cosine. Nothing where no beam stands near that and
  // where beams are low or bent; nor above the air, or deeper below its lowest layer than that is thick.
  std::optional<BeamDepth> depth(double height, double cosine) const;

  // What a metre of the beam's way in a layer sends back if nothing dims it, W/(m3 sr um), per bin, between two angles
  // of scattering: low + share * (high - low). cosine: of the view with the beam's direction.
  // Only where keeps_scattering(): tables of all beams and layers, made when first asked, take kMostBytes at most.
  static constexpr size_t kMostBytes = size_t{256} << 20;
  bool keeps_scattering() const { return keeps_scattering_; }
  struct Scattered {
    const float *low, *high;
    float share;
  };
  Scattered scattered(size_t beam, size_t layer, double cosine) const;

 private:
  struct Table {
    std::once_flag once;
    std::vector<float> rows;  // [angle][bin]
  };
  void fill(size_t beam, size_t layer, std::vector<float>& rows) const;

  const AirColumn& column_;
  std::vector<Beam> beams_;
  std::vector<double> cosines_;             // of the beams over the middle; 0 = not served
  std::vector<std::vector<float>> depths_;  // per beam: [layer][low, rise, curve][bin]
  std::unique_ptr<Table[]> tables_;         // [beam][layer]
  bool keeps_scattering_;
};

}  // namespace suite
