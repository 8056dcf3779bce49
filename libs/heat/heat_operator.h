// What paths find of a scene for its balance of heat, without any weather: with it, another weather under the same sun
// makes temperatures without a new ray, and another day new ones of sunlight only.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "heat/exchange_paths.h"
#include "heat/sunlight.h"

namespace suite {

struct HeatOperator {
  ExchangePaths exchange;
  Sunlight sun;
};

// The scene as paths see it.
struct HeatScene {
  const Tracer& tracer;
  const Elements& elements;
  const HeatFaces& faces;
  const HeatOptics& optics;
};

// Where pieces of it are kept as they are found, so that a search that was ended goes on where it was.
class HeatPieces {
 public:
  virtual ~HeatPieces() = default;
  // Puts what is there of some rows, those of faces or all after them, in its place, counts included. The ranges of it,
  // ascending and apart, each as the tracing functions take them.
  virtual std::vector<FaceRange> take(ExchangePaths& out, FaceRange of) = 0;
  virtual std::vector<FaceRange> take(Sunlight& out, FaceRange of, SunStage stage) = 0;
  // count: of this piece. A piece of scattered sunlight has the straight one with it.
  virtual void keep(const ExchangePaths& found, FaceRange range, PathCount count) = 0;
  virtual void keep(const Sunlight& found, SunStage stage, FaceRange range, PathCount count) = 0;
  // s: about how long finding a piece may take, which is lost at most; 0 = the smallest pieces.
  virtual double seconds() const = 0;
};

// Bits do not depend on pieces: each face's paths are its own. pieces: may be null. progress: is told faces that are
// done, those that were there among them; of sunlight each twice.
ExchangePaths find_exchange(const HeatScene& scene, const PathOptions& options, HeatPieces* pieces = nullptr,
                            const std::function<void(size_t)>& progress = {});
Sunlight find_sunlight(const HeatScene& scene, const SunCourse& course, const PathOptions& options,
                       HeatPieces* pieces = nullptr, const std::function<void(size_t)>& progress = {});

// Equal where all sunlight is found for the same: places of the sun at all moments (as far as 1e-9 tells), its size,
// spectra of beam and sky.
std::string digest_of(const SunCourse& course);

}  // namespace suite
