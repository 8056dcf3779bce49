// Surfaces of any kind: models behind ScatterModel, maps, warm matter. One of the two answers to "what can surfaces be"
// that the path kernel is made for; the other is surfaces_matte.h.
#pragma once
#include <optional>
#include <vector>

#include "light/light.h"
#include "sensor/sensor.h"
#include "transport/contribution.h"
#include "transport/lane.h"

namespace suite {

// Where a path goes on from a node.
struct Continuation {
  Dir in;  // ENU
  bool dirac = false;
  int lobe = 0;   // of a model's Dirac lobe
  Factor weight;  // w, not yet divided by the density
  float density[kMaxKnots];
  double bright = 1;  // light that may come from there, over even light: for roulette
  // Of an event that two branches leave: which of them this is, and the other one's density of going there.
  Branch branch = Branch::none;
  bool sided = false;  // `other` is the density of a side flight (techniques/side_vertex.h)
  float other[kMaxKnots];
};

class AnySurfaces {
 public:
  static constexpr int kKnots = kMaxKnots;
  static constexpr uint32_t kDense = 1;  // spectra that evaluate(), sample() and emission() may need

  AnySurfaces(const Surface& surface, const Optics& optics, size_t width, bool keep_first);

  // Path p has met a surface, and sees it from `out`. first: of the path. False when nothing scatters there.
  bool meet(uint32_t p, const Hit& hit, Dir out, double time, bool first);
  // The same at the Earth under the scene, and at a receiver of the sensor.
  bool meet_earth(uint32_t p, const Hit& hit, uint32_t material, bool first);
  void receive(uint32_t p, const Hit& hit, SensorRay::Receiver kind);
  uint32_t material(uint32_t p) const { return at_[p]->material; }
  // Stays until the path starts anew for the first surface where keep_first was given.
  const Interaction& interaction(uint32_t p) const { return *at_[p]; }

  // How lamps see it: opaque surfaces take light on the side that the path sees.
  LightReceiver receiver(uint32_t p, const Hit& hit, Dir out) const;
  // Whether light from `in` may be scattered towards `out`.
  bool takes(uint32_t p, const Hit& hit, Dir out, Dir in) const;
  // w towards `out` of light from `in`. dense: memory for a spectrum.
  Factor evaluate(uint32_t p, Dir out, Dir in, std::span<float> dense) const;
  // Density of sample() at every knot.
  void densities(uint32_t p, Dir out, Dir in, std::span<float> density) const;
  // Mueller matrices over m11 of what it makes of light from `in`, in the world; lobe: of a Dirac lobe, -1 = none.
  ScatterModel::Polarised mueller(uint32_t p, Dir out, Dir in, int lobe, int knot, std::span<Mueller> m) const;
  // Whether sample() uses lobe_u.
  bool needs_lobe(uint32_t p) const { return !at_[p]->baked->model->single_lobe(); }
  // Whether some of it is as sharp as a mirror.
  bool is_sharp(uint32_t p) const { return at_[p]->baked->model->has_delta(); }
  // Draws where path p, node i of the stage, goes on; false when it ends there.
  bool sample(size_t i, uint32_t p, const Hit& hit, Dir out, Vec2 u, double lobe_u, int knot, std::span<float> dense,
              Continuation& on) const;
  // The same at a surface that only reflects, by a lobe, and passes light on: each gets at least `least` of the paths.
  bool sample_either(uint32_t p, Dir out, int reflecting, double least, double lobe_u, int knot, std::span<float> dense,
                     Continuation& on) const;
  // At such a surface: the share of light of a knot that it reflects, by the lobe `mirror`,
  double mirrors(uint32_t p, Dir out, int mirror, int knot) const;
  // and one of the two ways, taken for certain.
  bool sample_way(uint32_t p, Dir out, int mirror, bool reflects, int knot, std::span<float> dense,
                  Continuation& on) const;
  // The numbers u of node i of a stage, then that of all of its n nodes, before sample(): nothing to prepare.
  void prepare(size_t, Vec2) {}
  void prepare_all(size_t) {}

  // What a warm surface sends towards `out`: factor times radiance.
  struct Emission {
    Factor emissivity;
    const float* radiance;
  };
  bool warm(uint32_t p) const { return at_[p]->baked && !at_[p]->baked->blackbody.empty(); }
  Emission emission(uint32_t p, Dir out, std::span<float> dense) const;
  // Its polarisation, in the first columns: Kirchhoff's law for every component, 1 - W_11, -W_21, -W_31, -W_41 over
  // 1 - W_11, where the columns of W are estimated by light from one direction that is drawn at a knot; those of a
  // mixture with shares times B over that of the whole.
  ScatterModel::Polarised emission_mueller(uint32_t p, Dir out, Vec2 u, double lobe_u, int knot,
                                           std::span<Mueller> m) const;

 private:
  bool take_dirac(uint32_t p, Dir to, const ScatterModel::Sample& drawn, int knot, std::span<float> dense,
                  Continuation& on) const;
  bool local(uint32_t p) const { return at_[p]->own && at_[p]->baked == &at_[p]->own->made; }

  const Surface& surface_;
  const Optics& optics_;
  size_t knots_;
  bool keep_first_;
  std::vector<Interaction> current_, first_;
  std::vector<Interaction*> at_;
  BakedMaterial receivers_[2];  // plane, sphere; made when a ray first asks for one
};

}  // namespace suite
