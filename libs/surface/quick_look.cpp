#include "surface/quick_look.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "surface/material_lookup.h"

namespace suite {

namespace {

const Part* part_of(const Tracer& tracer, const Hit& hit) {
  const TracedObject& object = tracer.objects()[hit.object];
  if (object.mesh == kNone) return nullptr;
  const std::vector<Part>& parts = tracer.scene().meshes[object.mesh].parts;
  const auto after = std::upper_bound(parts.begin(), parts.end(), hit.triangle,
                                      [](uint32_t t, const Part& p) { return t < p.first_triangle; });
  return after == parts.begin() ? nullptr : &*(after - 1);
}

// Hues a golden angle apart, so that neighbouring ids differ.
void colour(uint32_t material, double shade, uint8_t* rgb) {
  const double hue = std::fmod(0.11 + 0.61803398875 * (material == kNone ? 0 : material + 1), 1.0) * 6;
  const double saturation = material == kNone ? 0 : 0.55;
  for (int c = 0; c < 3; ++c) {
    const double k = std::fmod(hue + (c == 0 ? 5 : c == 1 ? 3 : 1), 6.0);
    const double value = 1 - saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    rgb[c] = static_cast<uint8_t>(std::lround(255 * std::clamp(value * shade, 0.0, 1.0)));
  }
}

}  // namespace

uint32_t material_of(const Tracer& tracer, const Hit& hit) {
  return MaterialLookup(tracer.scene()).at(tracer.objects()[hit.object], hit);
}

std::string describe_hit(const Tracer& tracer, const Ray& ray) {
  const FlushDenormals flush;
  Hit hit;
  TraceStatistics statistics;
  tracer.nearest(std::span(&ray, 1), std::span(&hit, 1), false, statistics);
  if (!hit.hit()) return "nothing\n";
  const Scene& scene = tracer.scene();
  const TracedObject& object = tracer.objects()[hit.object];
  std::string out = "object    " +
                    (object.mesh != kNone ? scene.meshes[object.mesh].name : scene.primitives[object.primitive].name) +
                    strf(" (instance %u)\n", object.instance);
  if (const Part* part = part_of(tracer, hit)) out += "part      " + part->name + strf(", triangle %u\n", hit.triangle);
  const uint32_t material = material_of(tracer, hit);
  out += "material  " + (material == kNone ? std::string("none") : scene.materials[material].id) + "\n";
  if (object.tag != kNone) out += "tag       " + scene.tags[object.tag] + "\n";
  out += strf("distance  %.6f m\nplace     %.6f %.6f %.6f m\nnormal    %.6f %.6f %.6f\n", hit.distance, hit.position.x,
              hit.position.y, hit.position.z, hit.normal.x, hit.normal.y, hit.normal.z);
  return out;
}

View view_from_above(const Tracer& tracer, int pixels) {
  const Box3 box = tracer.bounds();
  const Vec3 size = box.size();
  if (box.empty() || !(std::max(size.x, size.y) > 0)) throw Error("the scene has no extent to look at");
  const double gsd = std::max(size.x, size.y) / pixels;
  View view;
  view.width = std::max(1, static_cast<int>(std::ceil(size.x / gsd)));
  view.height = std::max(1, static_cast<int>(std::ceil(size.y / gsd)));
  view.rgb.assign(3 * static_cast<size_t>(view.width) * static_cast<size_t>(view.height), 255);
  const Dir sun = normalized(Vec3{-1, 1, std::sqrt(2.0)});
  const MaterialLookup lookup(tracer.scene());
  parallel_for(0, static_cast<size_t>(view.height), 4, [&](size_t begin, size_t end) {
    const FlushDenormals flush;
    TraceStatistics statistics;
    std::vector<Ray> rays(static_cast<size_t>(view.width));
    std::vector<Hit> hits(rays.size());
    for (size_t j = begin; j < end; ++j) {
      for (size_t i = 0; i < rays.size(); ++i)
        rays[i] = {{box.low.x + (static_cast<double>(i) + 0.5) * gsd, box.high.y - (static_cast<double>(j) + 0.5) * gsd,
                    box.high.z + 1},
                   {0, 0, -1},
                   0};
      std::fill(hits.begin(), hits.end(), Hit{});
      tracer.nearest(rays, hits, true, statistics);
      for (size_t i = 0; i < rays.size(); ++i)
        if (hits[i].hit())
          colour(lookup.at(tracer.objects()[hits[i].object], hits[i]),
                 0.25 + 0.75 * std::fabs(dot(hits[i].normal, sun)), &view.rgb[3 * (j * rays.size() + i)]);
    }
  });
  return view;
}

}  // namespace suite
