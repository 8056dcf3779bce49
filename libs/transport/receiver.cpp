#include "transport/receiver.h"

#include "base/error.h"
#include "math/warps.h"

namespace suite {

namespace {

// Receives over the hemisphere of +z with the cosine.
class PlaneReceiver final : public ScatterModel {
 public:
  explicit PlaneReceiver(size_t bins) : ones_(bins, 1.0f) {}
  void eval(Dir, Dir in, std::span<float> w) const override { std::fill(w.begin(), w.end(), weight(in)); }
  std::optional<Factored> factored(Dir, Dir in) const override { return Factored{weight(in), ones_.data()}; }
  void total(Dir, std::span<float> W) const override { std::fill(W.begin(), W.end(), 1.0f); }
  std::optional<Sample> sample(Dir, Vec2 u, double, int) const override {
    const Dir in = cosine_hemisphere(u);
    if (!(in.z > 0)) return std::nullopt;
    return Sample{in, 0, false};
  }
  void pdf(Dir, Dir in, std::span<float> p) const override { std::fill(p.begin(), p.end(), weight(in)); }
  bool spectrally_uniform_shape() const override { return true; }
  bool single_lobe() const override { return true; }

 private:
  static float weight(Dir in) { return in.z > 0 ? static_cast<float>(in.z / kPi) : 0.0f; }
  std::vector<float> ones_;
};

// Receives from everywhere alike.
class SphereReceiver final : public ScatterModel {
 public:
  explicit SphereReceiver(size_t bins) : ones_(bins, 1.0f) {}
  void eval(Dir, Dir, std::span<float> w) const override { std::fill(w.begin(), w.end(), kWeight); }
  std::optional<Factored> factored(Dir, Dir) const override { return Factored{kWeight, ones_.data()}; }
  void total(Dir, std::span<float> W) const override { std::fill(W.begin(), W.end(), 1.0f); }
  std::optional<Sample> sample(Dir, Vec2 u, double, int) const override { return Sample{uniform_sphere(u), 0, false}; }
  void pdf(Dir, Dir, std::span<float> p) const override { std::fill(p.begin(), p.end(), kWeight); }
  bool spectrally_uniform_shape() const override { return true; }
  bool single_lobe() const override { return true; }
  bool opaque() const override { return false; }

 private:
  static constexpr float kWeight = static_cast<float>(1 / (4 * kPi));
  std::vector<float> ones_;
};

}  // namespace

BakedMaterial bake_receiver(SensorRay::Receiver kind, const SpectralState& state) {
  BakedMaterial made;
  switch (kind) {
    case SensorRay::Receiver::plane:
      made.owned = std::make_unique<PlaneReceiver>(state.size());
      break;
    case SensorRay::Receiver::sphere:
      made.owned = std::make_unique<SphereReceiver>(state.size());
      break;
    case SensorRay::Receiver::none:
      throw Bug("a receiver that receives nothing");
  }
  made.model = made.owned.get();
  return made;
}

}  // namespace suite
