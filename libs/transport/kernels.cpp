// The kernels that occur, and which of them serves a state.
#include "transport/estimators/paper.h"
#include "transport/estimators/standard.h"
#include "transport/kernel_beside.h"
#include "transport/kernel_fill.h"
#include "transport/kernel_fly.h"
#include "transport/kernel_go_on.h"
#include "transport/kernel_light.h"
#include "transport/kernel_meet.h"
#include "transport/media/space_field.h"
#include "transport/space_lit_air.h"
#include "transport/surfaces_matte.h"

namespace suite {

const char* KernelChoice::name() const {
  switch (space) {
    case Space::air:
      return matte ? "matte in air" : "general in air";
    case Space::lit_air:
      return matte ? "matte in lit air" : "general in lit air";
    case Space::field:
      return "general in media";
    case Space::lit_field:
      return "general in media and lit air";
    case Space::nothing:
      break;
  }
  return matte ? "matte" : "general";
}

KernelChoice choose_kernel(const KernelContext& c) {
  using Space = KernelChoice::Space;
  KernelChoice choice;
  const bool media = !c.optics.media().empty(), air = c.environment.atmosphere != nullptr,
             lit = air && !c.stokes && c.environment.atmosphere->vertices() && goes_back(c.options);
  if (media)
    choice.space = lit ? Space::lit_field : Space::field;
  else if (air)
    choice.space = lit ? Space::lit_air : Space::air;
  choice.matte = !c.stokes && c.options.specialise && !c.receivers && c.options.method == Method::standard && !media &&
                 MatteSurfaces::serve(c.surface, c.optics);
  return choice;
}

bool may_lose(const KernelContext& c) {
  const auto small = [](const auto& light) { return light->nature().drawn && !light->nature().wide; };
  return std::any_of(c.environment.lights.begin(), c.environment.lights.end(), small) &&
         LostLight::possible(c.surface.tracer().scene(), c.optics, c.options);
}

bool refracts(const KernelContext& c) {
  if (!c.options.explicit_sources || !c.options.refracted_sources || c.options.method != Method::standard) return false;
  const auto asked = [](const auto& light) { return is_refracted(light->nature()); };
  return std::any_of(c.environment.lights.begin(), c.environment.lights.end(), asked) &&
         SmoothInterfaces(c.surface.tracer().scene(), c.optics).any();
}

namespace {

template <class Surfaces, class Space, class Estimator>
std::unique_ptr<PathTracing> make(const KernelContext& c, size_t width, SpectralThroughputs& throughputs,
                                  Sink<SpectralThroughputs>& sink) {
  return std::make_unique<PathKernel<Wave<Surfaces, Space, SpectralThroughputs, Estimator>>>(c, width, throughputs,
                                                                                             sink);
}

}  // namespace

std::unique_ptr<PathTracing> make_kernel(const KernelChoice& choice, const KernelContext& c, size_t width,
                                         SpectralThroughputs& throughputs, Sink<SpectralThroughputs>& sink) {
  using Space = KernelChoice::Space;
  if (choice.space == Space::lit_field) return make_lit_field_kernel(c, width, throughputs, sink);
  const bool air = choice.space == Space::air;
  auto* const made =
      choice.space == Space::lit_air ? (choice.matte ? &make<MatteSurfaces, LitAirSpace, StandardEstimator>
                                                     : &make<AnySurfaces, LitAirSpace, StandardEstimator>)
      : choice.matte                 ? (air ? &make<MatteSurfaces, AirSpace, StandardEstimator>
                                            : &make<MatteSurfaces, NothingSpace, StandardEstimator>)
      : c.options.method == Method::paper
          ? (air ? &make<AnySurfaces, AirSpace, PaperEstimator> : &make<AnySurfaces, NothingSpace, PaperEstimator>)
      : choice.space == Space::field ? &make<AnySurfaces, FieldSpace, StandardEstimator>
      : air                          ? &make<AnySurfaces, AirSpace, StandardEstimator>
                                     : &make<AnySurfaces, NothingSpace, StandardEstimator>;
  return made(c, width, throughputs, sink);
}

}  // namespace suite
