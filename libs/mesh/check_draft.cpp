#include <algorithm>

#include "base/parallel.h"
#include "mesh/check.h"
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

}  // namespace

void check_draft_meshes(Draft& draft, const MeshCheck& options, bool repair, Report& report) {
  struct Outcome {
    std::vector<MeshFinding> findings;
    MeshRepairs repairs;
  };
  std::vector<Outcome> outcomes(draft.geometry.size());
  parallel_for(0, draft.geometry.size(), 1, [&](size_t begin, size_t end) {
    for (size_t g = begin; g < end; ++g) {
      SourceMesh& mesh = draft.geometry[g].mesh;
      const bool sound = std::all_of(mesh.positions.begin(), mesh.positions.end(), [](Vec3 p) { return finite(p); });
      if (draft.geometry[g].kind != DraftGeometry::Kind::mesh || !sound) continue;  // SP203 has been filed
      if (repair) outcomes[g].repairs = repair_mesh(mesh);
      outcomes[g].findings = check_mesh_quality(mesh, options);
    }
  });
  for (size_t g = 0; g < outcomes.size(); ++g) {
    const std::string& asset = draft.geometry[g].mesh.file;
    const MeshRepairs& r = outcomes[g].repairs;
    if (r.welded + r.dropped + r.turned)
      report.add("SP320", asset,
                 {{asset, 0, 0, {}, -1},
                  strf("%zu positions welded, %zu triangles dropped, %zu turned", r.welded, r.dropped, r.turned)});
    for (const MeshFinding& f : outcomes[g].findings)
      for (size_t k = 0; k < f.examples.size(); ++k)
        report.add(f.code, asset, f.examples[k], k == 0 ? f.count - (f.examples.size() - 1) : 1);
    for (const MeshFinding& f : outcomes[g].findings)
      if (std::string_view(f.code) == "SP306" && !f.examples.empty() && bounds_medium(draft, draft.geometry[g]))
        report.add("SP606", asset, f.examples.front());
  }
}

}  // namespace suite
