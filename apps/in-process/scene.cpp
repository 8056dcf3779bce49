// Prepared scenes at the border: arrays of rays against Tracer.
#include <cmath>
#include <vector>

#include "apps/in-process/border.h"
#include "apps/in-process/remote_scenes.h"
#include "base/error.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "surface/cut_out.h"
#include "surface/material_lookup.h"
#include "trace/tracer.h"

namespace suite {

namespace {

std::shared_ptr<const Scene> load(const char* path, double begin, double end) {
  need(path, "path");
  if (!(std::fabs(begin) <= kLargestNumber && std::fabs(end) <= kLargestNumber && begin <= end))
    throw Error(strf("begin %g and end %g are no span of time", begin, end), "seconds, begin <= end");
  return std::make_shared<const Scene>(read_scene(path));
}

int64_t number_of(uint32_t known) { return known == kNone ? -1 : int64_t{known}; }

}  // namespace

}  // namespace suite

struct rs_scene {
  rs_scene(const char* path, double begin, double end)
      : scene(suite::load(path, begin, end)),
        span{begin, end},
        tracer(scene, std::nullopt, span, suite::cut_out(*scene)),
        materials(*scene) {}
  std::shared_ptr<const suite::Scene> scene;
  suite::TimeSpan span;
  suite::Tracer tracer;
  suite::MaterialLookup materials;
};

namespace suite {

namespace {

Handles<rs_scene>& scenes() {
  static auto* const all = new Handles<rs_scene>;  // never destroyed: threads may use it to the end of the process
  return *all;
}

void need_times(const rs_scene& scene, size_t n, const double* time) {
  if (!time) return;
  for (size_t i = 0; i < n; ++i)
    if (!(time[i] >= scene.span.begin && time[i] <= scene.span.end))
      throw Error(strf("time: row %zu has %g s", i, time[i]),
                  strf("the scene was opened for %g to %g s", scene.span.begin, scene.span.end));
}

void put(const rs_scene& scene, const Hit& hit, size_t i, const rs_hits& to) {
  const bool met = hit.hit();
  const TracedObject object = met ? scene.tracer.object(hit.object) : TracedObject{};
  if (to.distance) to.distance[i] = met ? hit.distance : INFINITY;
  if (to.position) put3(to.position, i, met ? hit.position : Vec3{NAN, NAN, NAN});
  if (to.normal) put3(to.normal, i, met ? hit.normal : Vec3{NAN, NAN, NAN});
  if (to.material) to.material[i] = met ? number_of(scene.materials.at(object, hit)) : -1;
  if (to.instance) to.instance[i] = number_of(object.instance);
  if (to.tag) to.tag[i] = number_of(object.tag);
  if (to.triangle) to.triangle[i] = object.mesh == kNone ? -1 : int64_t{hit.triangle};
}

void trace(const rs_scene& scene, size_t n, const double* origin, const double* direction, const double* time,
           const uint32_t* draw, const rs_hits& to) {
  in_parallel(n, [&](size_t begin, size_t end) {
    std::vector<Ray> rays(end - begin);
    std::vector<Hit> hits(rays.size());
    for (size_t i = begin; i < end; ++i)
      rays[i - begin].set(row3(origin, i), row3(direction, i), time ? time[i] : scene.span.begin, draw ? draw[i] : 0);
    TraceStatistics statistics;
    scene.tracer.nearest(rays, hits, false, statistics);
    for (size_t i = begin; i < end; ++i) put(scene, hits[i - begin], i, to);
  });
}

void see(const rs_scene& scene, size_t n, const double* from, const double* to, double gap, const double* time,
         uint8_t* visible) {
  in_parallel(n, [&](size_t begin, size_t end) {
    std::vector<Ray> rays(end - begin);
    std::vector<double> reach(rays.size());
    std::vector<uint8_t> blocked(rays.size());
    for (size_t i = begin; i < end; ++i) {
      const Vec3 a = row3(from, i), way = row3(to, i) - a;
      const double length = std::sqrt(dot(way, way));
      const Dir along = length > 0 ? way * (1 / length) : Dir{0, 0, 1};
      rays[i - begin].set(a + along * gap, along, time ? time[i] : scene.span.begin, 0);
      reach[i - begin] = std::max(0.0, length - 2 * gap);
    }
    TraceStatistics statistics;
    scene.tracer.occluded(rays, reach, blocked, false, statistics);
    for (size_t i = begin; i < end; ++i) visible[i] = !blocked[i - begin];
  });
}

}  // namespace

}  // namespace suite

using suite::at_border;
using suite::need;

int rs_scene_open(const char* path, double begin, double end, rs_scene** scene) {
  return at_border([&] {
    need(scene, "scene");
    *scene = suite::scenes().add(std::make_shared<const rs_scene>(path, begin, end));
  });
}

void rs_scene_close(rs_scene* scene) { suite::scenes().close(scene); }

void rs_scene_describe(const rs_scene* handle, rs_scene_info* info) {
  *info = {};
  const auto scene = suite::scenes().find(handle);
  if (!scene) return;
  const suite::Scene& s = *scene->scene;
  const suite::Box3& box = scene->tracer.bounds();
  *info = {s.materials.size(),
           s.tags.size(),
           scene->tracer.triangles(),
           {box.low.x, box.low.y, box.low.z},
           {box.high.x, box.high.y, box.high.z},
           s.origin.latitude_deg,
           s.origin.longitude_deg,
           s.origin.ellipsoid_height_m};
}

const char* rs_scene_material(const rs_scene* handle, size_t number) {
  const auto scene = suite::scenes().find(handle);
  if (!scene) return nullptr;
  const auto& all = scene->scene->materials;
  return number < all.size() ? all[number].id.c_str() : nullptr;
}

const char* rs_scene_tag(const rs_scene* handle, size_t number) {
  const auto scene = suite::scenes().find(handle);
  if (!scene) return nullptr;
  const auto& all = scene->scene->tags;
  return number < all.size() ? all[number].c_str() : nullptr;
}

int rs_scene_trace(const rs_scene* handle, size_t n, const double* origin, const double* direction, const double* time,
                   const uint32_t* draw, const rs_hits* hits) {
  return at_border([&] {
    const auto scene = suite::scenes().get(handle, "scene");
    need(hits, "hits");
    if (n == 0) return;
    need(origin, "origin");
    need(direction, "direction");
    suite::need_finite(origin, n, 3, "origin");
    suite::need_units(direction, n, "direction");
    suite::need_times(*scene, n, time);
    suite::trace(*scene, n, origin, direction, time, draw, *hits);
  });
}

int rs_scene_visible(const rs_scene* handle, size_t n, const double* from, const double* to, double gap,
                     const double* time, uint8_t* visible) {
  return at_border([&] {
    const auto scene = suite::scenes().get(handle, "scene");
    if (!(gap >= 0 && gap <= suite::kLargestNumber))
      throw suite::Error(suite::strf("gap: %g", gap), "metres, 0 or more");
    if (n == 0) return;
    need(from, "from");
    need(to, "to");
    need(visible, "visible");
    suite::need_finite(from, n, 3, "from");
    suite::need_finite(to, n, 3, "to");
    suite::need_times(*scene, n, time);
    suite::see(*scene, n, from, to, gap, time, visible);
  });
}
