#include "transport/lost_light.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/sampling.h"

namespace suite {

namespace {
constexpr int kMostSurfaces = 4096;  // on one way to a source; then it counts as blocked
}  // namespace

bool LostLight::refracts(const BakedMaterial& material) {
  const auto passes = [](const ScatterModel* m) { return m && m->has_delta() && !m->opaque(); };
  if (passes(material.model)) return true;
  if (!material.maps) return false;
  const MaterialMaps& maps = *material.maps;
  return std::any_of(maps.variants.begin(), maps.variants.end(), [&](const auto& m) { return passes(m.get()); }) ||
         std::any_of(maps.parts.begin(), maps.parts.end(), [](const BakedMaterial* m) { return m && refracts(*m); });
}

std::vector<uint32_t> LostLight::refracting(const Scene& scene, const Optics& optics) {
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < scene.materials.size(); ++i)
    if (refracts(optics.material(i))) found.push_back(i);
  return found;
}

LostLight::LostLight(const Surface& surface, const Optics& optics)
    : surface_(surface),
      refracts_(surface.tracer().scene().materials.size()),
      reference_bin_(optics.state().knots[0]),
      there_(optics.state().size()),
      back_(optics.state().size()) {
  for (const uint32_t i : refracting(surface.tracer().scene(), optics)) refracts_[i] = true;
}

// Lobes stand in a fixed order, and what passes is often the last or the first of them; else chance finds it.
auto LostLight::draw(const ScatterModel& model, Dir out, uint64_t key) -> std::optional<Passed> {
  constexpr double kLast = 1 - 0x1p-53;
  const auto passed = [&](Vec2 u, double lobe_u) {
    auto drawn = model.sample(out, u, lobe_u, 0);
    if (drawn && !(drawn->delta && drawn->in.z * out.z < 0)) drawn.reset();
    return drawn;
  };
  for (const double lobe_u : {kLast, 0.0})
    if (const auto drawn = passed({0.5, 0.5}, lobe_u)) return Passed{*drawn, out, 1};
  const auto drawn = passed({unit_double(mix64(key)), unit_double(mix64(key + 1))}, unit_double(mix64(key + 2)));
  float probability = 0;
  if (drawn) model.delta_probability(out, drawn->lobe, 0, {&probability, 1});
  if (!(probability > 0)) return std::nullopt;
  return Passed{*drawn, out, double{probability}};
}

double LostLight::through(const Hit& hit, const Ray& ray) {
  const uint32_t material = surface_.material(hit);
  if (material == kNone || !refracts_[material]) return 0;
  surface_.interact(hit, ray.direction, at_, ray.time);
  const ScatterModel* model = at_.baked ? at_.baked->model : nullptr;
  if (!model) return 0;
  const uint64_t key = hash_of(ray.draw, std::bit_cast<uint64_t>(hit.distance));
  const Dir out = at_.frame.to_local(ray.direction);
  auto passed = draw(*model, out, key);
  // Denser on the side of the light.
  if (!passed || std::fabs(passed->drawn.in.z) < std::fabs(out.z))
    if (const auto turned = draw(*model, -out, key)) passed = turned;
  if (!passed) return 0;
  // Weights of both ways: their factors n^2 are inverse to each other.
  model->delta_weight(passed->out, passed->drawn.lobe, 0, there_);
  model->delta_weight(passed->drawn.in, passed->drawn.lobe, 0, back_);
  const double both = double{there_[reference_bin_]} * double{back_[reference_bin_]};
  return both > 0 ? std::sqrt(both) / passed->chance : 0;
}

void LostLight::begin(std::span<const Ray> rays, std::span<const double> distance, std::span<const uint8_t> wanted) {
  passes_.assign(rays.size(), 0.0);
  rays_.clear(), left_.clear(), owner_.clear();
  round_ = 0;
  for (size_t r = 0; r < rays.size(); ++r)
    if (wanted[r]) rays_.push_back(rays[r]), left_.push_back(distance[r]), owner_.push_back(r), passes_[r] = 1;
}

bool LostLight::next(TraceRequest& request) {
  if (round_++ > 0) take();
  if (rays_.empty()) return false;
  hits_.resize(rays_.size());
  request = {TraceRequest::Kind::nearest, rays_, false, hits_, {}, {}};
  return true;
}

// Takes rays through the surfaces that they have met.
void LostLight::take() {
  size_t kept = 0;
  for (size_t i = 0; i < rays_.size(); ++i) {
    const Hit& hit = hits_[i];
    if (!hit.hit() || hit.distance >= left_[i]) continue;
    double& passes = passes_[owner_[i]];
    passes *= round_ <= kMostSurfaces ? through(hit, rays_[i]) : 0;
    if (!(passes > 0)) continue;
    Ray on = rays_[i];
    on.origin = surface_.tracer().leave(hit, on.direction);
    left_[kept] = left_[i] - hit.distance;
    owner_[kept] = owner_[i];
    rays_[kept++] = on;
  }
  rays_.resize(kept), left_.resize(kept), owner_.resize(kept);
}

}  // namespace suite
