// What does not change with time in a slab: checks, its grid and faces.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/share.h"
#include "spectral/planck.h"
#include "thermal/slab.h"

namespace suite {

namespace {

void check_face(const SlabFace& f, const char* which) {
  const std::string name = std::string("the ") + which + " of a slab";
  if (f.kind != SlabFace::Kind::surface) {
    if (!f.value)
      throw Error(name + " has no function for its " + (f.kind == SlabFace::Kind::flux ? "flux" : "temperature"));
    return;
  }
  if (!f.loads) throw Error(name + " has no loads");
  if (!is_share(f.emissivity)) throw Error(name + strf(": emissivity %g", f.emissivity), "0 to 1");
  for (const double h : {f.convection_still, f.convection_wind})
    if (!(h >= 0 && h <= 1e6)) throw Error(name + strf(": convection %g W/(m2 K)", h), "0 or more");
}

}  // namespace

Slab::Slab(SlabSpec spec, SlabOptions options) : spec_(std::move(spec)), options_(options) {
  check();
  grid_ = make_slab_grid(spec_.layers, options_.resolution, spec_.bottom.kind == SlabFace::Kind::surface);
  linear_ = spec_.bottom.kind != SlabFace::Kind::surface && has_constant_properties(spec_.layers);
  const size_t n = grid_.depth.size();
  for (Stage* s : {&now_, &middle_, &end_}) {
    s->T.resize(n);
    s->heat.resize(n);
    s->gain.resize(n);
    s->flux.resize(n - 1);
  }
  for (auto* v : {&pivot_, &up_, &down_, &right_, &diagonal_, &lower_, &upper_, &history_, &rate_, &bend_})
    v->resize(n);
  flux_sum_.resize(n - 1);
  T_.assign(n, 0);
}

void Slab::check() const {
  check_slab_layers(spec_.layers);
  check_face(spec_.top, "top");
  check_face(spec_.bottom, "bottom");
  const SlabOptions& o = options_;
  if (!(o.tolerance > 0 && o.tolerance <= 100))
    throw Error(strf("a tolerance of %g K", o.tolerance), "more than 0, at most 100 K");
  if (!(o.max_step > 0 && std::isfinite(o.max_step)))
    throw Error(strf("a largest step of %g s", o.max_step), "more than 0");
  if (!(o.min_step > 0 && o.min_step <= o.max_step))
    throw Error(strf("a smallest step of %g s", o.min_step), "more than 0, at most the largest");
  if (!(o.resolution > 0 && std::isfinite(o.resolution)))
    throw Error(strf("a resolution of %g s", o.resolution), "more than 0");
}

double Slab::capacity_of(size_t node, double T) const {
  const auto& c = grid_.heat;
  return c[0][node] + T * (2 * c[1][node] + T * (3 * c[2][node] + T * (4 * c[3][node] + T * 5 * c[4][node])));
}

Slab::FaceNow Slab::face_at(const SlabFace& face, double t) const {
  FaceNow now;
  switch (face.kind) {
    case SlabFace::Kind::flux:
      now.constant = face.value(t);
      break;
    case SlabFace::Kind::temperature:
      now.fixed = true;
      now.kelvin = face.value(t);
      if (!(now.kelvin > 0)) throw Error(strf("a slab's face is given %g K at %.9g s", now.kelvin, t), "more than 0");
      break;
    case SlabFace::Kind::surface: {
      const SurfaceLoad load = face.loads(t);
      now.linear = face.convection_still + face.convection_wind * load.wind;
      now.constant = load.sun_absorbed + face.emissivity * load.sky_irradiance + now.linear * load.air_temperature;
      now.quartic = face.emissivity * kStefanBoltzmann;
      if (!(now.linear >= 0))
        throw Error(strf("a slab's loads are no loads at %.9g s", t), "finite numbers, wind 0 or more");
    }
  }
  if (!std::isfinite(now.constant) || !std::isfinite(now.kelvin))
    throw Error(strf("a slab's loads are not finite at %.9g s", t), "finite numbers");
  return now;
}

double Slab::at_depth(double z) const {
  const auto after = std::upper_bound(grid_.depth.begin(), grid_.depth.end(), z);
  if (after == grid_.depth.begin()) return T_.front();
  if (after == grid_.depth.end()) return T_.back();
  const size_t i = static_cast<size_t>(after - grid_.depth.begin());
  return T_[i - 1] + (T_[i] - T_[i - 1]) * (z - grid_.depth[i - 1]) / (grid_.depth[i] - grid_.depth[i - 1]);
}

std::span<const double> Slab::heat_capacities() const {
  capacities_.resize(T_.size());
  for (size_t i = 0; i < T_.size(); ++i) capacities_[i] = capacity_of(i, T_[i]);
  return capacities_;
}

}  // namespace suite
