#include "transport/gloss_photons.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/sampling.h"
#include "surface/surface_walk.h"
#include "transport/gloss_turn.h"

namespace suite {

namespace {

constexpr size_t kWave = 2048;     // photons that are traced side by side
constexpr size_t kWorthwhile = 8;  // of the first wave; where fewer land no more are sent
constexpr int kMostTurns = 6;
constexpr size_t kMostGlossyObjects = size_t{1} << 22;
constexpr size_t kMostGlossy = size_t{1} << 15;  // of more objects too few photons come from each to say anything
struct Ball {
  Vec3 centre;
  double radius;  // m
};

class Sender {
 public:
  Sender(const Surface& surface, const Optics& optics, const Environment& environment)
      : surface_(surface), turns_(optics.state()), spectrum_(optics.state().size()), lookup_(surface.tracer().scene()) {
    for (const auto& light : environment.lights)
      if (const LightNature& n = light->nature(); n.drawn && !n.wide) lights_.push_back(light.get());
    if (lights_.empty() || surface.tracer().object_count() > kMostGlossyObjects || !find_glossy(optics)) return;
    list_balls();
  }

  std::vector<GlossPhoton> send(size_t most) {
    std::vector<GlossPhoton> landed;
    size_t sent = 0;
    if (!balls_.empty())
      for (; sent < most; sent += kWave) {
        send_wave(sent, landed);
        if (sent == 0 && landed.size() < kWorthwhile) return {};
      }
    for (GlossPhoton& p : landed) p.flux /= static_cast<float>(sent);
    return landed;
  }

 private:
  struct Flying {
    uint64_t key;
    double flux, irradiance;
    bool sharp;  // so far nothing but mirrors have turned light that has no width: no path can find it
    int turns = 0;
    Dir normal{};  // where it was turned last
  };

  bool find_glossy(const Optics& optics) {
    const auto& scene = surface_.tracer().scene();
    glossy_.assign(scene.materials.size(), false);
    for (uint32_t i = 0; i < glossy_.size(); ++i) glossy_[i] = turns_.is_glossy(optics.material(i));
    for (const MapBinding& b : scene.map_bindings)
      for (const uint32_t id : scene.class_maps[b.class_map].materials)
        if (id != kNone && glossy_[id]) glossy_[b.material] = true;
    return std::find(glossy_.begin(), glossy_.end(), true) != glossy_.end();
  }

  bool is_glossy(const TracedObject& object) const {
    const auto has = [&](uint32_t material) { return material != kNone && glossy_[material]; };
    if (object.material_override != kNone || object.mesh == kNone) return has(lookup_.plain(object, 0));
    const auto& parts = surface_.tracer().scene().meshes[object.mesh].parts;
    return std::any_of(parts.begin(), parts.end(), [&](const Part& p) { return has(p.material); });
  }

  void list_balls() {
    const Tracer& tracer = surface_.tracer();
    time_ = tracer.window() ? (tracer.window()->begin + tracer.window()->end) / 2 : 0;
    double sum = 0;
    tracer.each(
        "glossy objects", [&](const TracedObject& o) { return is_glossy(o); },
        [&](uint32_t number, const TracedObject& o) {
          if (balls_.size() > kMostGlossy) return;
          const Box3 box = tracer.local_box(number);
          if (box.empty() || !tracer.there(number, time_)) return;
          const Affine3 to_world = tracer.to_world(number, time_);
          const Vec3 centre = box.center(), half = box.size() * 0.5;
          double radius2 = 0;
          for (int k = 0; k < 3; ++k) {
            Vec3 axis;
            axis[k] = half[k];
            const Vec3 image = to_world.vector(axis);
            radius2 += dot(image, image);
          }
          if (o.primitive != kNone && tracer.scene().primitives[o.primitive].kind == PrimitiveKind::sphere)
            radius2 /= 3;
          if (!(radius2 > 0) || !std::isfinite(radius2)) return;
          balls_.push_back({to_world.point(centre), std::sqrt(radius2)});
          // By their radii: large objects get more, but small ones are not forgotten beside them.
          chances_.push_back(sum += std::sqrt(radius2));
        });
    if (balls_.size() > kMostGlossy) balls_.clear();
  }

  // Aims a photon; false when its light does not reach the ball.
  bool aim(uint64_t key, Ray& ray, Flying& photon) {
    const auto u = [&](uint64_t n) { return unit_double(hash_of(key, n)); };
    const double at = u(0) * chances_.back();
    const size_t b =
        std::min<size_t>(static_cast<size_t>(std::upper_bound(chances_.begin(), chances_.end(), at) - chances_.begin()),
                         balls_.size() - 1);
    const Ball& ball = balls_[b];
    const double chance = (chances_[b] - (b > 0 ? chances_[b - 1] : 0)) / chances_.back();
    const Light* light =
        lights_[std::min(lights_.size() - 1, static_cast<size_t>(u(1) * static_cast<double>(lights_.size())))];
    const auto sample = light->sample({ball.centre, {}, true}, {u(2), u(3), u(4), u(5)}, time_);
    if (!sample || !(sample->scale > 0)) return false;
    if (!sample->spectrum) {
      std::fill(spectrum_.begin(), spectrum_.end(), 0.0f);
      light->add(sample->direction, time_, 1, spectrum_);
    }
    const std::span<const float> spectrum{sample->spectrum ? sample->spectrum : spectrum_.data(), spectrum_.size()};
    photon.irradiance = sample->scale * turns_.at_reference(spectrum) / (sample->density > 0 ? sample->density : 1);
    if (!(photon.irradiance > 0)) return false;
    photon.key = key, photon.sharp = light->nature().delta;
    const double area = sample->distance < std::numeric_limits<double>::infinity()
                            ? aim_near(ball, sample->end, u(6), u(7), ray)
                            : aim_far(ball, sample->direction, u(6), u(7), ray);
    photon.flux = photon.irradiance * area * static_cast<double>(lights_.size()) / chance;
    ray.time = time_, ray.draw = static_cast<uint32_t>(key);
    return true;
  }

  // Returns the area (m2) of the disk that photons cross: the ball's.
  double aim_far(const Ball& ball, Dir toward, double u, double v, Ray& ray) const {
    const Frame frame = Frame::around(toward);
    const double r = ball.radius * std::sqrt(u), phi = 2 * kPi * v;
    const Box3& all = surface_.tracer().bounds();
    const double away = length(all.size()) + length(all.center() - ball.centre) + ball.radius;
    ray.origin = ball.centre +
                 frame.to_world({r * std::cos(phi), r * std::sin(phi), std::isfinite(away) ? away : 4 * ball.radius});
    ray.direction = -toward;
    return kPi * ball.radius * ball.radius;
  }

  // The same of a lamp, as if all of it were where the ball is.
  double aim_near(const Ball& ball, Vec3 lamp, double u, double v, Ray& ray) const {
    const Vec3 way = ball.centre - lamp;
    const double distance = length(way);
    const bool outside = distance > ball.radius;
    const double sine2 = outside ? ball.radius * ball.radius / (distance * distance) : 1;
    const double least = outside ? std::sqrt(1 - sine2) : -1;
    const double span = outside ? sine2 / (1 + least) : 2;  // 1 - least
    const double c = 1 - u * span, s = std::sqrt(std::max(0.0, 1 - c * c)), phi = 2 * kPi * v;
    ray.origin = lamp;
    ray.direction =
        Frame::around(distance > 0 ? way / distance : Dir{0, 0, 1}).to_world({s * std::cos(phi), s * std::sin(phi), c});
    return 2 * kPi * span * std::max(distance * distance, 1e-4 * ball.radius * ball.radius);
  }

  void send_wave(size_t first, std::vector<GlossPhoton>& landed) {
    rays_.clear(), flying_.clear();
    for (size_t i = 0; i < kWave; ++i) {
      Ray ray;
      Flying photon{};
      if (aim(hash_of(0x676c6f7373ull, first + i), ray, photon)) rays_.push_back(ray), flying_.push_back(photon);
    }
    TraceStatistics unused;
    walk(
        surface_.tracer(), flying_, rays_, hits_, false, unused,
        [&](Flying& photon, Ray& ray, const Hit& hit, uint32_t) {
          return hit.hit() && arrive(hit, ray, photon, landed);
        },
        [] {});
  }

  // A photon has met a surface: it lands there, or is turned within a narrow lobe and flies on.
  bool arrive(const Hit& hit, Ray& ray, Flying& photon, std::vector<GlossPhoton>& landed) {
    surface_.interact(hit, -ray.direction, at_, ray.time);
    const ScatterModel* model = at_.baked ? at_.baked->model : nullptr;
    if (!model) return false;
    const Dir to = at_.frame.to_local(-ray.direction);
    const auto u = [&](int n) {
      return unit_double(hash_of(photon.key, static_cast<uint64_t>(16 + 4 * photon.turns + n)));
    };
    const auto turn = turns_.draw(*model, to, {u(0), u(1), u(2), u(3)});
    if (!turn || !turn->narrow) {
      if (photon.turns > 0 && !photon.sharp)
        landed.push_back({hit.position, hit.position - ray.direction * hit.distance, photon.normal,
                          static_cast<float>(photon.flux), static_cast<float>(photon.irradiance)});
      return false;
    }
    const Dir in = at_.frame.to_world(turn->in);
    if (photon.turns == kMostTurns || dot(in, at_.geometric_normal) * turn->in.z <= 0) return false;
    photon.flux *= turn->weight;
    photon.sharp = photon.sharp && turn->delta;
    photon.normal = at_.geometric_normal;
    ++photon.turns;
    ray.set(surface_.tracer().leave(hit, in), in, ray.time, ray.draw);
    return true;
  }

  const Surface& surface_;
  GlossTurn turns_;
  std::vector<float> spectrum_;
  const MaterialLookup lookup_;
  double time_ = 0;
  std::vector<const Light*> lights_;
  std::vector<bool> glossy_;
  std::vector<Ball> balls_;
  std::vector<double> chances_;  // running sums
  std::vector<Ray> rays_;
  std::vector<Flying> flying_;
  std::vector<Hit> hits_;
  Interaction at_;
};

}  // namespace

std::vector<GlossPhoton> gloss_photons(const Surface& surface, const Optics& optics, const Environment& environment,
                                       size_t most) {
  return Sender(surface, optics, environment).send(most);
}

}  // namespace suite
