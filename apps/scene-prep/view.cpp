#include "view.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "base/run_app.h"
#include "mesh/sketch.h"
#include "page/live_page.h"
#include "scene/leaves.h"
#include "scene/primitives.h"
#include "scene/summary.h"

namespace suite {

namespace {

constexpr size_t kMostTriangles = 600'000;   // that the file has: some 15 bytes each, a third more as text
constexpr size_t kMostDrawn = 4'000'000;     // instances counted each
constexpr uint64_t kMostInstances = 60'000;  // 60 bytes each

Json numbers(Vec3 v) {
  Json list = Json::array();
  for (const double x : {v.x, v.y, v.z}) list.push(x);
  return list;
}

// Instances of one mesh or primitive.
struct Placed {
  std::vector<Affine3> places;  // to ENU relative to the scene's middle
  std::vector<uint32_t> keys;   // 3 each: override, tag, number
};
using Target = std::pair<TargetKind, uint32_t>;

struct Instances {
  std::map<Target, Placed> of;
  uint64_t all = 0, kept = 0, step = 1;
};

Instances instances_of(const Scene& scene, Vec3 middle, double time) {
  const Leaves leaves(scene);
  Instances in;
  in.all = leaves.count();
  in.step = std::max<uint64_t>(1, (in.all + kMostInstances - 1) / kMostInstances);
  for (uint64_t i = 0; i < in.all; i += in.step) {
    const std::optional<Leaf> leaf = leaves.at(i, time);
    if (!leaf) continue;
    ++in.kept;
    Placed& p = in.of[{leaf->kind, leaf->target}];
    p.places.push_back(translation(-middle) * leaf->place);
    p.keys.insert(p.keys.end(), {leaf->material_override, leaf->tag, static_cast<uint32_t>(i)});
  }
  return in;
}

// How many triangles each mesh may keep: in proportion, and few of what is placed often.
std::map<uint32_t, size_t> room_of(const Scene& scene, const Instances& in) {
  double all = 0, drawn = 0;
  for (const auto& [target, placed] : in.of)
    if (target.first == TargetKind::mesh) {
      const auto n = static_cast<double>(scene.meshes[target.second].triangle_count());
      all += n, drawn += n * static_cast<double>(placed.keys.size() / 3);
    }
  const double share =
      std::min({1.0, static_cast<double>(kMostTriangles) / all, static_cast<double>(kMostDrawn) / drawn});
  std::map<uint32_t, size_t> room;
  const size_t least = std::clamp<size_t>(kMostTriangles / (4 * std::max<size_t>(1, in.of.size())), 12, 200);
  for (const auto& [target, placed] : in.of)
    if (target.first == TargetKind::mesh) {
      const size_t n = scene.meshes[target.second].triangle_count();
      room[target.second] = share >= 1 ? n : std::max(least, static_cast<size_t>(static_cast<double>(n) * share));
    }
  return room;
}

// How many triangles go around a primitive: few where it is placed often.
int around_of(const Placed& placed) {
  const double each = static_cast<double>(kMostDrawn) / 4 / static_cast<double>(placed.places.size());
  return static_cast<int>(std::clamp(std::sqrt(each), 8.0, 48.0));
}

// Rows of three numbers and a shift, in which a mesh far from its zero loses nothing.
std::vector<float> rows_of(const std::vector<Affine3>& places, Vec3 origin) {
  std::vector<float> rows;
  for (const Affine3& m : places) {
    const Vec3 b = m.point(origin);
    for (size_t row = 0; row < 3; ++row) {
      for (size_t k = 0; k < 3; ++k) rows.push_back(static_cast<float>(m.a[3 * row + k]));
      rows.push_back(static_cast<float>(row == 0 ? b.x : row == 1 ? b.y : b.z));
    }
  }
  return rows;
}

// Positions in 16 bits of their box, and where the box is.
Json put_sketch(LivePage& page, const std::string& id, const std::string& name, const Sketch& s, const Placed& placed) {
  Box3 box;
  for (size_t v = 0; v + 2 < s.positions.size(); v += 3)
    box.grow(Vec3{s.positions[v], s.positions[v + 1], s.positions[v + 2]});
  const Vec3 size = box.size();
  std::vector<uint16_t> cells(s.positions.size());
  for (size_t i = 0; i < cells.size(); ++i) {
    const double low = i % 3 == 0 ? box.low.x : i % 3 == 1 ? box.low.y : box.low.z;
    const double extent = i % 3 == 0 ? size.x : i % 3 == 1 ? size.y : size.z;
    // What lies in the middle but for rounding goes one way, or the pole of a ball would be torn.
    cells[i] = static_cast<uint16_t>(extent > 0 ? std::floor(65535 * (s.positions[i] - low) / extent + 0.5 + 1e-6) : 0);
  }
  page.data(id + "v", LiveKind::u8, std::as_bytes(std::span(cells)));
  if (s.positions.size() / 3 <= 65536) {
    const std::vector<uint16_t> small(s.indices.begin(), s.indices.end());
    page.data(id + "t", LiveKind::u8, std::as_bytes(std::span(small)));
  } else {
    page.data(id + "t", LiveKind::u8, std::as_bytes(std::span(s.indices)));
  }
  const std::vector<float> places = rows_of(placed.places, s.origin);
  page.data(id + "p", LiveKind::f32, std::as_bytes(std::span(places)));
  page.data(id + "k", LiveKind::u32, std::as_bytes(std::span(placed.keys)));
  Json j = Json::object(), parts = Json::array();
  for (size_t t = 0; t < s.material.size();) {
    size_t end = t;
    while (end < s.material.size() && s.material[end] == s.material[t]) ++end;
    Json part = Json::array();
    part.push(t), part.push(end - t), part.push(s.material[t] == kNone ? -1 : static_cast<long long>(s.material[t]));
    parts.push(std::move(part));
    t = end;
  }
  j.set("name", name);
  j.set("origin", numbers(s.origin));
  j.set("low", numbers(box.low));
  j.set("size", numbers(size));
  j.set("vertices", s.positions.size() / 3);
  j.set("parts", std::move(parts));
  return j;
}

// What the page lacks, said once.
struct Lacks {
  size_t before = 0, after = 0, thinned = 0;
  double moved = 0;
  std::vector<std::string> text(const Scene& scene, const Instances& in) const {
    std::vector<std::string> all;
    if (after < before)
      all.push_back(strf(
          "%zu of %zu triangles (without repetitions) are shown; corners moved by up to %.3g m of their "
          "meshes%s",
          after, before, moved, thinned ? strf("; of %zu meshes one in n triangles, enlarged", thinned).c_str() : ""));
    if (in.step > 1)
      all.push_back(strf("one in %llu of the %llu instances is shown", static_cast<unsigned long long>(in.step),
                         static_cast<unsigned long long>(in.all)));
    else if (in.kept < in.all)
      all.push_back(
          strf("%llu instances are not there at that time", static_cast<unsigned long long>(in.all - in.kept)));
    if (!scene.volumes.empty()) all.push_back(strf("%zu volumes of media are not shown", scene.volumes.size()));
    if (!scene.map_bindings.empty() || !scene.property_bindings.empty())
      all.push_back("materials that maps decide have one colour, that of the geometry's own");
    return all;
  }
};

Json about_scene(const Scene& scene, const Box3& box, double time) {
  Json j = Json::object(), materials = Json::array(), tags = Json::array();
  for (const Material& m : scene.materials) materials.push(m.id);
  for (const std::string& t : scene.tags) tags.push(t);
  j.set("name", scene.name);
  j.set("materials", std::move(materials));
  j.set("tags", std::move(tags));
  j.set("middle", numbers((box.low + box.high) * 0.5));
  j.set("radius", 0.5 * length(box.size()));
  j.set("time", time);
  j.set("epoch", scene.epoch);
  if (scene.origin.given) {
    j.set("latitude", scene.origin.latitude_deg);
    j.set("longitude", scene.origin.longitude_deg);
    j.set("height", scene.origin.ellipsoid_height_m);
  }
  j.set("made", strf("suite %s: ", kVersion) + command_line());
  return j;
}

Json list_of(const std::vector<ViewedFinding>& findings) {
  Json list = Json::array();
  for (const ViewedFinding& f : findings) {
    Json one = Json::object();
    one.set("text", f.text);
    one.set("geometry", f.geometry);
    one.set("local", numbers(f.local));
    one.set("error", f.error);
    list.push(std::move(one));
  }
  return list;
}

}  // namespace

std::vector<ViewedFinding> findings_to_view(const Draft& draft, const Report& report) {
  std::vector<ViewedFinding> all;
  for (const PlacedFinding& f : report.placed())
    for (const DraftGeometry& g : draft.geometry) {
      if (g.mesh.file != f.asset) continue;
      const std::array<double, 3>& at = *f.finding.at;
      all.push_back(
          {strf("%s [%s] ", to_text(f.severity), f.code.c_str()) + to_text(f.finding.where) + ": " + f.finding.message,
           g.name, g.to_local.point({at[0], at[1], at[2]}), f.severity == Severity::error});
    }
  return all;
}

void write_scene_view(const Scene& scene, const std::vector<ViewedFinding>& findings, const std::string& path) {
  make_folders_of({path});
  const double time = time_of_all(scene);
  Box3 box = scene_bounds(scene, time, time);
  if (box.empty()) box.grow(Vec3{-10, -10, -10}), box.grow(Vec3{10, 10, 10});
  const Vec3 middle = (box.low + box.high) * 0.5;
  const Instances in = instances_of(scene, middle, time);
  const std::map<uint32_t, size_t> room = room_of(scene, in);
  LivePage page(path, "Scene " + scene.name, {"scene_math.js", "scene_draw.js", "scene.js"},
                about_scene(scene, box, time));
  Json things = Json::array();
  Lacks lacks;
  for (const auto& [target, placed] : in.of) {
    const bool mesh = target.first == TargetKind::mesh;
    if (mesh) scene.meshes[target.second].require();
    const Sketch s =
        mesh ? sketch_of(scene.meshes[target.second], room.at(target.second))
             : sketch_of(scene.primitives[target.second], std::max(1.0, length(box.size())), around_of(placed));
    const std::string& name = mesh ? scene.meshes[target.second].name : scene.primitives[target.second].name;
    lacks.before += s.before, lacks.after += s.material.size(), lacks.thinned += s.thinned;
    lacks.moved = std::max(lacks.moved, s.moved);
    things.push(put_sketch(page, strf("m%c%u.", mesh ? 'm' : 'p', target.second), name, s, placed));
  }
  Json ids = Json::array(), notes = Json::array();
  for (const auto& entry : in.of)
    ids.push(strf("m%c%u.", entry.first.first == TargetKind::mesh ? 'm' : 'p', entry.first.second));
  for (const std::string& sentence : lacks.text(scene, in)) notes.push(sentence), note(path + ": " + sentence);
  Json end = Json::object();
  end.set("ids", std::move(ids));
  end.set("things", std::move(things));
  end.set("notes", std::move(notes));
  end.set("findings", list_of(findings));
  page.json("end", end);
  page.begin();
  page.commit();
  note(strf("%s: %s", path.c_str(), human_bytes(static_cast<double>(file_size(path))).c_str()));
}

}  // namespace suite
