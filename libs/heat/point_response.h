// How much warmer a point of an element is than the element when more is absorbed there, through a span that repeats.
//
// Method: the answer of the slab to a flux is known from one of one moment (a hat between its neighbours), for a face
// that loses a fixed coefficient g; what the face really loses beyond that (T^4, air, evaporation, the weather's
// changes) is put on the other side, and the sum repeated until it stands:
//   d = K * (q - (L(T + d) - L(T) - g d)),   K * = sum over moments, L what the face emits and loses to the air.
// It is the slab of the balance itself (its volumes, its steps), about the element's history T.
// Assumes: properties of layers near a mean temperature; the infrared that arrives is that of the element.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "heat/heated_material.h"

namespace suite {

class PointResponse {
 public:
  // Steps of `step` s make up the span. loss: W/(m2 K), the g above, > 0. kelvin: about which properties are taken.
  // Error: a material without layers.
  PointResponse(const HeatedMaterial& material, double step, size_t steps, double loss, double kelvin);

  // The element at every moment (steps + 1): its temperature and what acts on its face.
  struct Around {
    FaceTraits traits;
    std::span<const float> kelvin;
    std::span<const FaceWeather> weather;
  };
  // q: W/m2, by moment, what the point absorbs beyond the element. K, by moment. Nothing where it does not settle.
  bool above(const Around& around, std::span<const float> q, std::span<float> kelvin) const;

 private:
  double loss_;
  std::vector<float> kernel_;  // K per W/m2, twice over: by steps after the hat
};

// Mean of the least and the most that a face loses for a kelvin more, W/(m2 K).
double mean_loss(const PointResponse::Around& around);

}  // namespace suite
