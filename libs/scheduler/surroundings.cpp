#include "scheduler/surroundings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "math/sampling.h"
#include "scene/scene.h"
#include "scheduler/points_in_view.h"
#include "transport/channels.h"
#include "transport/lost_light.h"
#include "transport/media/bodies.h"
#include "transport/refracted_ray.h"

namespace suite {

namespace {

constexpr int kRays = 64;         // through each object
constexpr size_t kObjects = 256;  // of all, the first ones
constexpr int kMostHits = 64;     // on one of them
constexpr double kOff = 3;        // where the surroundings are asked for, in steps of rays that leave the surface
constexpr double kTouching = 16;  // steps within which bodies touch and do not overlap
constexpr uint64_t kSurroundingsPurpose = 0x77657473;

class Look {
 public:
  Look(const Tracer& tracer, const Optics& optics)
      : tracer_(tracer),
        scene_(tracer.scene()),
        surface_(tracer, optics),
        optics_(optics),
        bodies_(surface_),
        um_(optics.state().reference_um) {
    for (uint32_t i = 0; i < scene_.materials.size(); ++i) {
      const Material& m = scene_.materials[i];
      refracts_.push_back(m.surface.curves.count("index") && !m.is_boundary() && optics.material(i).model &&
                          !optics.material(i).model->opaque());
      const auto bends = [&](uint32_t medium) { return medium != kNone && std::fabs(index_of(medium) - 1) > kApart; };
      looked_at_.push_back(refracts_.back() || (m.is_boundary() && (bends(m.inside) || bends(m.outside))));
    }
  }

  std::vector<Diagnostic> all() {
    look_for_overlaps();
    if (std::find(looked_at_.begin(), looked_at_.end(), true) == looked_at_.end()) return found();
    size_t seen = 0;
    tracer_.each(
        "refracting surfaces", [&](const TracedObject& o) { return has(o, looked_at_); },
        [&](uint32_t number, const TracedObject& o) {
          if (seen++ >= kObjects) return;
          shoot(box_of(number, o), seen);
          drop(box_of(number, o), seen);
        });
    if (!skipping_.empty()) insert(Dr::dense_medium_skipped, skipping_);
    return found();
  }

 private:
  std::vector<Diagnostic> found() const {
    std::vector<Diagnostic> all;
    for (const auto& [text, code] : found_) all.push_back({code, text});
    return all;
  }
  void insert(Dr code, const std::string& text) { found_.emplace(text, code); }

  // Where bodies of different media may overlap at all.
  void look_for_overlaps() {
    std::set<uint32_t> media;
    std::vector<bool> bounds;
    for (uint32_t i = 0; i < scene_.materials.size(); ++i) {
      const uint32_t medium = optics_.medium_behind(i);
      bounds.push_back(medium != kNone);
      if (medium != kNone) media.insert(medium);
    }
    if (media.size() < 2) return;
    size_t seen = 0;
    tracer_.each(
        "bodies of media", [&](const TracedObject& o) { return has(o, bounds); },
        [&](uint32_t number, const TracedObject& o) {
          if (seen++ < kObjects) pass(box_of(number, o), seen);
        });
  }

  bool has(const TracedObject& o, const std::vector<bool>& wanted) const {
    const auto is = [&](uint32_t material) { return material != kNone && wanted[material]; };
    if (o.material_override != kNone) return is(o.material_override);
    if (o.primitive != kNone) return is(scene_.primitives[o.primitive].material);
    const auto& parts = scene_.meshes[o.mesh].parts;
    return std::any_of(parts.begin(), parts.end(), [&](const Part& p) { return is(p.material); });
  }

  // ENU; of what has no bounds that of all other things, and something around the origin.
  Box3 box_of(uint32_t number, const TracedObject& o) const {
    Box3 box = tracer_.local_box(number);
    if (!box.empty()) box = o.node == kNone ? transformed(box, tracer_.place(number)) : Box3{};
    if (box.empty()) box = tracer_.bounds();
    if (box.empty()) box.grow(Vec3{-1, -1, -1}), box.grow(Vec3{1, 1, 1});
    return box;
  }

  void shoot(const Box3& box, uint64_t object) {
    for (uint64_t r = 0; r < kRays; ++r) {
      const auto u = [&](uint64_t i) { return unit_double(hash_of(kSurroundingsPurpose, hash_of(object, r, i))); };
      const Vec3 size = box.size();
      const double z = 2 * u(3) - 1, s = std::sqrt(1 - z * z), phi = 2 * kPi * u(4);
      const Dir d{s * std::cos(phi), s * std::sin(phi), z};
      Ray ray{box.low + Vec3{u(0) * size.x, u(1) * size.y, u(2) * size.z} - d * length(size), d, 0,
              static_cast<uint32_t>(hash_of(object, r))};
      Hit hit;
      for (int n = 0; n < kMostHits; ++n) {
        tracer_.nearest({&ray, 1}, {&hit, 1}, false, statistics_);
        if (!hit.hit()) break;
        const uint32_t material = surface_.material(hit);
        if (material != kNone && refracts_[material]) look_at(hit, material);
        ray.origin = tracer_.leave(hit, d);
      }
    }
  }

  // From above all things down to what is opaque: boundaries go on below the ground where they matter to nobody.
  void drop(const Box3& box, uint64_t object) {
    for (uint64_t r = 0; r < kRays; ++r) {
      const auto u = [&](uint64_t i) { return unit_double(hash_of(kSurroundingsPurpose, hash_of(object, r, i + 8))); };
      const double phi = 2 * kPi * u(2), top = std::max(box.high.z, tracer_.bounds().high.z);
      const Dir d = normalized(Dir{0.1 * std::cos(phi), 0.1 * std::sin(phi), -1});
      const Vec3 size = box.size(), in{box.low.x + u(0) * size.x, box.low.y + u(1) * size.y, box.high.z};
      Ray ray{in - d * ((top - in.z + 1) / -d.z), d, 0, static_cast<uint32_t>(hash_of(object, r))};
      Hit hit;
      for (int n = 0; n < kMostHits; ++n) {
        tracer_.nearest({&ray, 1}, {&hit, 1}, false, statistics_);
        const uint32_t material = hit.hit() ? surface_.material(hit) : kNone;
        if (material == kNone || !(refracts_[material] || scene_.materials[material].is_boundary())) break;
        if (looked_at_[material] && !refracts_[material]) look_at(hit, material);
        ray.origin = tracer_.leave(hit, d);
      }
    }
  }

  void look_at(const Hit& hit, uint32_t material) {
    const std::string id = scene_.materials[material].id;
    const double step = double{hit.step};
    tracer_.all({hit.position - hit.normal * (0.5 * step), hit.normal, hit.time}, step, beside_, statistics_);
    for (const Hit& h : beside_) {
      const uint32_t other = surface_.material(h);
      if (!refracts_[material] && other != kNone && !scene_.materials[other].is_boundary()) return;  // that bends
      if (other == kNone || !refracts_[material] || !refracts_[other] ||
          tracer_.object(h.object).instance == tracer_.object(hit.object).instance)
        continue;
      const auto [a, b] = std::minmax(id, scene_.materials[other].id);
      insert(Dr::interfaces_coincide,
             "refracting surfaces ('" + a + "', '" + b +
                 "') lie in each other: only one of them bends light there, and what it goes on through is wrong. Give "
                 "the common face one surface with `inside` and `outside`, or leave a gap");
      return;
    }
    if (!refracts_[material])
      compare_sides(hit, material);
    else if (bodies_.any())
      compare(hit, material);
  }

  // Of a boundary, which bends nothing.
  void compare_sides(const Hit& hit, uint32_t material) {
    const double off = kOff * double{hit.step};
    const uint32_t front = medium_at(hit.position + hit.normal * off, hit.time),
                   back = medium_at(hit.position - hit.normal * off, hit.time);
    const double there = index_of(front), here = index_of(back);
    if (std::fabs(here - there) <= kApart * there) return;
    insert(Dr::boundary_without_interface,
           strf("'%s' parts %s (index %.4g) from %s (index %.4g) and bends nothing, as a material without a `model` "
                "does: light goes straight on and none is reflected there. Give it `model: dielectric` with "
                "`index: %.4g`, or the media one index",
                scene_.materials[material].id.c_str(), name_of(back).c_str(), here, name_of(front).c_str(), there,
                here / there));
  }

  uint32_t medium_at(Vec3 place, double time) {
    return bodies_.around(place, time, statistics_).medium(scene_.ambient);
  }
  std::string name_of(uint32_t medium) const {
    return medium == kNone ? "nothing" : is_named(medium) ? "'" + scene_.media[medium].id + "'" : "clear matter";
  }
  double index_of(uint32_t medium) const {
    if (medium == kNone) return 1;
    if (is_named(medium)) return scene_.media[medium].index.at(um_);
    return std::sqrt(double{optics_.matter(medium).index_squared[optics_.state().knots[0]]});
  }
  bool is_named(uint32_t medium) const { return medium < scene_.media.size(); }

  // An index that suits what is on both sides is right, whatever the material names.
  void compare(const Hit& hit, uint32_t material) {
    const Material& m = scene_.materials[material];
    const double off = kOff * double{hit.step};
    const uint32_t front = medium_at(hit.position + hit.normal * off, hit.time),
                   back = medium_at(hit.position - hit.normal * off, hit.time);
    for (const uint32_t medium : {front, back}) keep_skipped(hit, m, medium);
    const auto apart = [](double a, double b) { return std::fabs(a - b) > kApart * b; };
    const double made_for = index_of(m.outside), own = m.surface.curves.at("index").at(um_);
    if (!apart(own * index_of(front), index_of(back))) return;
    if (apart(index_of(front), made_for)) {
      insert(Dr::index_in_front,
             strf("'%s' has %s (index %.4g) in front of it, and bends light as if that had index %.4g: there it "
                  "needs a material with `outside`, or to end",
                  m.id.c_str(), name_of(front).c_str(), index_of(front), made_for));
      return;
    }
    const double meant = own * index_of(front), share = std::pow(index_of(back) / meant, 2);
    insert(
        Dr::index_behind,
        strf("'%s' bends light into matter of index %.4g, but behind it there is %s (index %.4g): radiance from there "
             "is "
             "%.3g times what it should be. Give what the surface encloses the higher `priority`, or close the surface",
             m.id.c_str(), meant, name_of(back).c_str(), index_of(back), share));
  }

  // Bodies of media of equal priority that overlap in part: one of them ends within the other.
  void pass(const Box3& box, uint64_t object) {
    struct In {
      uint32_t body, material, medium;
      Vec3 place;
    };
    std::vector<In> in;
    for (uint64_t r = 0; r < kRays / 4; ++r) {
      const auto u = [&](uint64_t i) { return unit_double(hash_of(kSurroundingsPurpose, hash_of(object, r, i + 16))); };
      const Vec3 size = box.size();
      const double z = 2 * u(3) - 1, s = std::sqrt(1 - z * z), phi = 2 * kPi * u(4);
      const Dir d{s * std::cos(phi), s * std::sin(phi), z};
      Ray ray{box.low + Vec3{u(0) * size.x, u(1) * size.y, u(2) * size.z} - d * length(size), d, 0,
              static_cast<uint32_t>(hash_of(object, r))};
      in.clear();
      for (int n = 0; n < kMostHits; ++n) {
        Hit hit;
        tracer_.nearest({&ray, 1}, {&hit, 1}, false, statistics_);
        const uint32_t material = hit.hit() ? surface_.material(hit) : kNone;
        const uint32_t medium = material == kNone ? kNone : optics_.medium_behind(material);
        if (material == kNone || (optics_.material(material).model && optics_.material(material).model->opaque()))
          break;
        const uint32_t body = tracer_.object(hit.object).instance;
        if (dot(d, hit.normal) < 0) {
          if (medium != kNone) in.push_back({body, material, medium, hit.position});
        } else if (const auto left = std::find_if(in.rbegin(), in.rend(), [&](const In& b) { return b.body == body; });
                   left != in.rend()) {
          for (auto later = in.rbegin(); later != left; ++later)
            if (length(hit.position - later->place) > kTouching * double{hit.step}) report_overlap(*left, *later);
          in.erase(std::next(left).base());
        }
        ray.origin = tracer_.leave(hit, d);
      }
    }
  }
  template <class In>
  void report_overlap(const In& a, const In& b) {
    const auto priority = [&](uint32_t medium) { return is_named(medium) ? scene_.media[medium].priority : 0; };
    if (a.medium == b.medium || a.body == b.body || priority(a.medium) != priority(b.medium)) return;
    const auto rate = [&](uint32_t medium) {
      const BakedMedium& m = optics_.matter(medium);
      const size_t bin = optics_.state().knots[0];
      return double{m.absorption[bin]} + double{m.scattering[bin]};
    };
    const bool turned = scene_.materials[a.material].id > scene_.materials[b.material].id;
    const In &first = turned ? b : a, &second = turned ? a : b;
    insert(
        Dr::media_overlap,
        strf("bodies of '%s' and '%s' overlap in part and have one priority: which of %s (extinction %.3g 1/m, index "
             "%.4g) and %s (%.3g 1/m, %.4g) fills what they share depends on where the light comes from. Give one of "
             "them a higher `priority`",
             scene_.materials[first.material].id.c_str(), scene_.materials[second.material].id.c_str(),
             name_of(first.medium).c_str(), rate(first.medium), index_of(first.medium), name_of(second.medium).c_str(),
             rate(second.medium), index_of(second.medium)));
  }

  // Rays leave a surface from a step off it, so that they do not meet it again where float places are coarse; what
  // fills that step is left out. The worst case is reported once.
  void keep_skipped(const Hit& hit, const Material& m, uint32_t medium) {
    if (medium == kNone || !is_named(medium)) return;
    const BakedMedium& baked = optics_.media()[medium];
    double densest = 0;
    for (size_t i = 0; i < baked.absorption.size(); ++i)
      densest = std::max(densest, double{baked.absorption[i]} + double{baked.scattering[i]});
    const double lost = densest * double{hit.step};
    if (lost < kSkipped || lost <= skipped_) return;
    skipped_ = lost;
    skipping_ = strf(
        "paths in '%s' begin %.2g m off '%s' (places of so large an object are that coarse) and skip what "
        "is there: at the wavelength where it is densest, %.3g 1/m, some %.1g %% too much light wherever they leave "
        "it, and more at an angle; "
        "smaller parts are met more exactly",
        scene_.media[medium].id.c_str(), double{hit.step}, m.id.c_str(), densest, 100 * lost);
  }

  const Tracer& tracer_;
  const Scene& scene_;
  const Surface surface_;
  const Optics& optics_;
  Bodies bodies_;
  double um_;
  std::vector<bool> refracts_, looked_at_;  // per material
  std::vector<Hit> beside_;
  std::map<std::string, Dr> found_;  // by text: each once
  double skipped_ = 0;               // the most
  std::string skipping_;
  TraceStatistics statistics_;
};

}  // namespace

std::vector<Diagnostic> diagnose_surroundings(const Tracer& tracer, const Optics& optics) {
  return tracer.tells_all() ? Look(tracer, optics).all() : std::vector<Diagnostic>{};
}

std::vector<Diagnostic> diagnose_light_paths(const Tracer& tracer, const SourceSpecs& sources, const Optics& optics,
                                             const PipelineOptions& options, uint32_t paths, const Sensor& sensor,
                                             const Environment& environment) {
  std::vector<Diagnostic> all =
      diagnose_lost_light(tracer.scene(), sources, optics, options, paths, tracer.periodic().has_value());
  const bool wide = std::any_of(sources.lights.begin(), sources.lights.end(),
                                [](const LightSpecPtr& light) { return light->key() == "night_sky"; });
  if (ChannelPlan(sensor.channels()).of_stokes() && sources.air && sources.air->scattering == AirScattering::diffuse &&
      sources.air->adjacency)
    all.push_back({Dr::stokes_techniques,
                   "sensor '" + sensor.name() +
                       "' sees polarisation: the residual estimator of the air carries no Mueller matrices and is off; "
                       "the air shines as over an even ground, without shadows in it" +
                       (wide ? "; what it scatters of the night sky is left out: some 17 % of what a camera in "
                               "clear air sees of that at 0.55 um, towards the horizon"
                             : "")});
  if (!ChannelPlan(sensor.channels()).of_stokes() &&
      std::any_of(sources.lights.begin(), sources.lights.end(),
                  [](const LightSpecPtr& light) { return light->polarised(); }))
    all.push_back({Dr::polarised_lamps,
                   "sensor '" + sensor.name() + "' sees no polarisation: lamps with `stokes` shine as if unpolarised"});
  if (auto d = diagnose_points(tracer, environment, optics, sensor)) all.push_back(std::move(*d));
  for (Diagnostic& d : diagnose_surroundings(tracer, optics)) all.push_back(std::move(d));
  return all;
}

}  // namespace suite
