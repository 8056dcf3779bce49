#include <algorithm>

#include "base/parallel.h"
#include "mesh/check.h"
#include "mesh/repair.h"

namespace suite {

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
  }
}

}  // namespace suite
