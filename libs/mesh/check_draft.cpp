#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "mesh/check.h"
#include "mesh/cut.h"
#include "mesh/decimate.h"
#include "mesh/fill_holes.h"
#include "mesh/repair.h"

namespace suite {

namespace {

// Does a face of this geometry bound a medium?
bool bounds_medium(const Draft& draft, const DraftGeometry& g) {
  const auto has_medium = [&](const std::string& id) {
    return std::any_of(draft.materials.begin(), draft.materials.end(), [&](const DraftMaterial& m) {
      return m.material.id == id && (m.inside.given() || m.outside.given());
    });
  };
  if (has_medium(g.material.name)) return true;
  return std::any_of(g.mesh.runs.begin(), g.mesh.runs.end(), [&](const SourceMesh::Run& run) {
    const auto named = g.materials.find(run.material);
    return has_medium(named == g.materials.end() ? run.material : named->second.name);
  });
}

struct Outcome {
  std::vector<MeshFinding> findings;
  MeshRepairs repairs;
  FilledHoles filled;
  std::optional<Decimated> decimated;
  std::optional<Tin> tin;
};

double meters_per_unit(const DraftGeometry& g) { return std::cbrt(std::fabs(g.to_local.determinant())); }

// Squares of distances and areas must be numbers.
bool measurable(const SourceMesh& mesh) {
  Box3 box;
  for (const Vec3& p : mesh.positions) box.grow(p);
  return mesh.positions.empty() || length(box.size()) < 1e70;
}

Outcome work_on(DraftGeometry& g, const MeshCheck& options, bool repair) {
  Outcome done;
  if (g.tin) done.tin = make_tin(g.mesh, g.tin->error_m / meters_per_unit(g), g.tin->longest_m / meters_per_unit(g));
  if (repair) done.repairs = repair_mesh(g.mesh);
  const bool workable = measurable(g.mesh);
  if (g.fill_holes && workable) done.filled = fill_holes(g.mesh, g.fill_holes);
  done.findings = check_mesh_quality(g.mesh, options);
  if (!g.decimate) return done;
  if (g.normals != NormalRule::file) g.mesh.normals.clear();  // they are made anew, so theirs are no borders
  const double error = g.decimate->error_m > 0 ? g.decimate->error_m / meters_per_unit(g) : HUGE_VAL;
  if (!workable) {
    done.decimated = Decimated{g.mesh.indices.size() / 3, g.mesh.indices.size() / 3, 0, true};
    return done;
  }
  done.decimated = decimate_mesh(g.mesh, g.decimate->to, error);
  return done;
}

void report_changes(const DraftGeometry& g, const Outcome& done, Report& report) {
  const std::string& asset = g.mesh.file;
  const auto add_finding = [&](const char* code, const std::string& text) {
    report.add(code, asset, {{asset, 0, 0, {}, -1}, text});
  };
  if (done.tin)
    add_finding(
        "SP322",
        strf("a surface of %zu triangles through %zu of %zu points; the others are at most %.3g m above or "
             "below it",
             g.mesh.indices.size() / 3, done.tin->used, done.tin->points, done.tin->error * meters_per_unit(g)));
  const MeshRepairs& r = done.repairs;
  if (r.welded + r.dropped + r.turned)
    add_finding("SP320",
                strf("%zu positions welded, %zu triangles dropped, %zu turned", r.welded, r.dropped, r.turned));
  if (g.fill_holes)
    add_finding("SP321", strf("%zu holes of at most %zu edges closed with %zu triangles, %zu left open",
                              done.filled.holes, g.fill_holes, done.filled.triangles, done.filled.left));
  if (!done.decimated) return;
  const Decimated& d = *done.decimated;
  const double share = static_cast<double>(d.after) / static_cast<double>(std::max<size_t>(1, d.before));
  add_finding("SP322", strf("%zu of %zu triangles are left (%.3g); the old surface is at most %.3g m from the new one",
                            d.after, d.before, share, d.distance * meters_per_unit(g)));
  if (d.refused)
    add_finding("SP323", "thousands of triangles meet in one vertex, or the mesh is absurdly large");
  else if (g.decimate->to > 0 &&
           static_cast<double>(d.after) > std::ceil(g.decimate->to * static_cast<double>(d.before)) + 1)
    add_finding("SP323", strf("%.3g of the triangles were asked for, %.3g are left", g.decimate->to, share));
}

}  // namespace

void check_draft_meshes(Draft& draft, const MeshCheck& options, bool repair, Report& report) {
  for (DraftGeometry& g : draft.geometry) cut_holed(g.mesh, report);
  std::vector<Outcome> outcomes(draft.geometry.size());
  parallel_for(0, draft.geometry.size(), 1, [&](size_t begin, size_t end) {
    for (size_t g = begin; g < end; ++g) {
      const SourceMesh& mesh = draft.geometry[g].mesh;
      const bool sound = std::all_of(mesh.positions.begin(), mesh.positions.end(), [](Vec3 p) { return finite(p); });
      if (draft.geometry[g].kind != DraftGeometry::Kind::mesh || !sound) continue;  // SP203 has been filed
      outcomes[g] = work_on(draft.geometry[g], options, repair);
    }
  });
  for (size_t g = 0; g < outcomes.size(); ++g) {
    const std::string& asset = draft.geometry[g].mesh.file;
    report_changes(draft.geometry[g], outcomes[g], report);
    for (const MeshFinding& f : outcomes[g].findings)
      for (size_t k = 0; k < f.examples.size(); ++k)
        report.add(f.code, asset, f.examples[k], k == 0 ? f.count - (f.examples.size() - 1) : 1);
    for (const MeshFinding& f : outcomes[g].findings)
      if (std::string_view(f.code) == "SP306" && !f.examples.empty() && bounds_medium(draft, draft.geometry[g]))
        report.add("SP606", asset, f.examples.front());
  }
}

}  // namespace suite
