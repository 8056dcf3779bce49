#include "surface/quick_look.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "scene/primitives.h"
#include "surface/material_lookup.h"

namespace suite {

namespace {

const Part* part_of(const Tracer& tracer, const Hit& hit) {
  const TracedObject object = tracer.object(hit.object);
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
  return MaterialLookup(tracer.scene()).at(tracer.object(hit.object), hit);
}

std::string describe_hit(const Tracer& tracer, const Ray& ray) {
  const FlushDenormals flush;
  Hit hit;
  TraceStatistics statistics;
  tracer.nearest(std::span(&ray, 1), std::span(&hit, 1), false, statistics);
  if (!hit.hit()) return "nothing\n";
  const Scene& scene = tracer.scene();
  const TracedObject object = tracer.object(hit.object);
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

Box3 box_of(const Tracer& tracer, const std::string& what) {
  const Scene& scene = tracer.scene();
  const bool number = !what.empty() && what.find_first_not_of("0123456789") == std::string::npos;
  std::vector<std::string> known = scene.tags;
  for (const Mesh& m : scene.meshes) known.push_back(m.name.substr(0, m.name.find('/')));
  for (const Primitive& p : scene.primitives) known.push_back(p.name);
  Box3 all;
  bool found = false;
  const auto grow = [&](uint32_t n, const TracedObject& o) {
    found = true;
    if (o.node != kNone) throw Error("'" + what + "' moves", "look at a place: X Y Z with a size");
    all.grow(
        transformed(o.mesh != kNone ? mesh_box(scene.meshes[o.mesh]) : primitive_box(scene.primitives[o.primitive]),
                    tracer.place(n)));
  };
  if (number) {
    if (what.size() <= 10)
      for (const uint32_t n : tracer.of_instance(static_cast<uint32_t>(std::min(std::stoull(what), 0xffffffffull))))
        grow(n, tracer.object(n));
  } else {
    const auto meant = [&](const TracedObject& o) {
      const std::string& name = o.mesh != kNone ? scene.meshes[o.mesh].name : scene.primitives[o.primitive].name;
      // Tiles of a terrain have a number behind its name.
      return name == what || name.substr(0, name.find('/')) == what || (o.tag != kNone && scene.tags[o.tag] == what);
    };
    tracer.each("what is called '" + what + "'", meant, grow);
  }
  if (!found && number) throw Error("there is no instance " + what, "numbers are those of truth images and --raycast");
  if (!found) throw Error("there is no object or tag '" + what + "'", name_hint(what, known));
  if (all.empty()) throw Error("'" + what + "' has no end", "look at a place: X Y Z with a size");
  return all;
}

std::optional<double> height_at(const Tracer& tracer, double x, double y, double time) {
  const FlushDenormals flush;
  const Ray ray{{x, y, tracer.bounds().empty() ? 1e6 : tracer.bounds().high.z + 1}, {0, 0, -1}, time};
  Hit hit;
  TraceStatistics statistics;
  tracer.nearest(std::span(&ray, 1), std::span(&hit, 1), false, statistics);
  return hit.hit() ? std::optional(hit.position.z) : std::nullopt;
}

namespace {

// The camera of a quick look: parallel rays, z up in the picture (north when looking straight down from the south).
struct Viewer {
  Viewer(const Tracer& tracer, const LookAt& look) {
    const double a = look.azimuth_deg * kPi / 180, e = look.elevation_deg * kPi / 180;
    const Dir back{std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
    along = -back;
    up = {-std::sin(a) * std::sin(e), -std::cos(a) * std::sin(e), std::cos(e)};
    right = cross(along, up);
    const Box3& box = look.box;
    if (box.empty()) throw Error("the scene has no extent to look at", "look at a place: X Y Z with a size");
    Box3 seen;  // x along right, y along up, z towards the viewer
    const auto grow = [&](const Box3& b, Box3& into) {
      for (int i = 0; i < 8 && !b.empty(); ++i) {
        const Vec3 p{i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y, i & 4 ? b.high.z : b.low.z};
        into.grow(Vec3{dot(p, right), dot(p, up), dot(p, back)});
      }
    };
    grow(box, seen);
    width = look.size_m > 0 ? look.size_m : look.margin * seen.size().x;
    height = look.size_m > 0 ? look.size_m : look.margin * seen.size().y;
    if (!(std::max(width, height) > 0)) throw Error("what is looked at has no extent", "give a size");
    const Vec3 middle = seen.center();
    Box3 whole = seen;
    grow(tracer.bounds(), whole);
    corner = right * (middle.x - width / 2) + up * (middle.y + height / 2) +
             back * (whole.high.z + 1 + (tracer.bounds().empty() ? 10 * std::max(width, height) : 0));
  }
  Dir along, up, right;
  Vec3 corner;  // upper left
  double width, height;
};

}  // namespace

View view_of(const Tracer& tracer, const LookAt& look, int pixels) {
  const Viewer viewer(tracer, look);
  const double gsd = std::max(viewer.width, viewer.height) / pixels;
  View view;
  view.width = std::max(1, static_cast<int>(std::ceil(viewer.width / gsd)));
  view.height = std::max(1, static_cast<int>(std::ceil(viewer.height / gsd)));
  view.rgb.assign(3 * static_cast<size_t>(view.width) * static_cast<size_t>(view.height), 255);
  const Dir sun = normalized(Vec3{-1, 1, std::sqrt(2.0)});
  const MaterialLookup lookup(tracer.scene());
  parallel_for(0, static_cast<size_t>(view.height), 4, [&](size_t begin, size_t end) {
    const FlushDenormals flush;
    TraceStatistics statistics;
    std::vector<Ray> rays(static_cast<size_t>(view.width));
    std::vector<Hit> hits(rays.size());
    for (size_t j = begin; j < end; ++j) {
      const Vec3 left = viewer.corner - viewer.up * ((static_cast<double>(j) + 0.5) * gsd);
      for (size_t i = 0; i < rays.size(); ++i)
        rays[i] = {left + viewer.right * ((static_cast<double>(i) + 0.5) * gsd), viewer.along, look.time};
      std::fill(hits.begin(), hits.end(), Hit{});
      tracer.nearest(rays, hits, true, statistics);
      for (size_t i = 0; i < rays.size(); ++i)
        if (hits[i].hit())
          colour(lookup.at(tracer.object(hits[i].object), hits[i]), 0.25 + 0.75 * std::fabs(dot(hits[i].normal, sun)),
                 &view.rgb[3 * (j * rays.size() + i)]);
    }
  });
  return view;
}

}  // namespace suite
