#include <cmath>
#include <map>
#include <set>

#include "optics/stored_range.h"
#include "scene/bake.h"

namespace suite {

namespace {

class MediaBaker {
 public:
  MediaBaker(const Draft& draft, Report& report, Scene& scene, std::vector<Where>& motion_where)
      : draft_(draft), report_(report), scene_(scene), motion_where_(motion_where) {}

  void run() {
    for (const DraftMedium& m : draft_.media) {
      ids_[m.medium.id] = static_cast<uint32_t>(scene_.media.size());
      scene_.media.push_back(m.medium);
      check_coverage(m);
    }
    for (size_t i = 0; i < draft_.materials.size(); ++i) {
      scene_.materials[i].inside = medium(draft_.materials[i].inside);
      scene_.materials[i].outside = medium(draft_.materials[i].outside);
    }
    scene_.ambient = medium(draft_.ambient);
    grids();
    for (const DraftMedium& m : draft_.media)
      if (!used_.count(m.medium.id)) add("SP603", m.where, "medium '" + m.medium.id + "' is not used");
  }

 private:
  void add(const char* code, const Where& where, const std::string& message) {
    report_.add(code, draft_.file, {where, message});
  }

  uint32_t medium(const Reference& ref) {
    if (!ref.given()) return kNone;
    if (const auto found = ids_.find(ref.name); found != ids_.end()) {
      used_.insert(ref.name);
      return found->second;
    }
    std::vector<std::string> known;
    for (const DraftMedium& m : draft_.media) known.push_back(m.medium.id);
    add("SP602", ref.where, "unknown medium '" + ref.name + "'; " + name_hint(ref.name, known));
    return kNone;
  }

  void check_coverage(const DraftMedium& m) {
    std::map<std::string, const Curve*> curves{
        {"absorption", &m.medium.absorption}, {"scattering", &m.medium.scattering}, {"index", &m.medium.index}};
    for (const auto& [name, curve] : m.medium.phase.curves) curves["phase function's " + name] = &curve;
    for (const SpectralWindow& w : draft_.windows) {
      if (const std::string text = beyond_stored(m.medium.phase, w.low_um, w.high_um); !text.empty())
        add("SP104", m.where,
            strf("medium '%s': %s, the window is %g to %g um", m.medium.id.c_str(), text.c_str(), w.low_um, w.high_um));
      for (const auto& [name, curve] : curves)
        if (!curve->covers(w.low_um, w.high_um))
          add("SP104", m.where,
              strf("medium '%s': %s is given from %s, the window is %g to %g um", m.medium.id.c_str(), name.c_str(),
                   curve->range_text().c_str(), w.low_um, w.high_um));
    }
  }

  // Media that share cells are grids on top of each other: coefficients add up, each with its phase function.
  void shared_grid(const DraftGrid& d, std::vector<uint32_t>& rows) {
    for (size_t m = 0; m < d.media.size(); ++m) {
      VoxelGrid g = d.grid;
      g.name += " (" + d.media[m].name + ")";
      g.media = {medium(d.media[m])};
      for (size_t i = 0; i < g.density.size(); ++i) g.density[i] = std::min(g.density[i] * d.shares[m][i], 3e38f);
      rows.push_back(static_cast<uint32_t>(scene_.grids.size()));
      scene_.grids.push_back(std::move(g));
    }
  }

  void grids() {
    std::map<std::string, std::vector<uint32_t>> rows;
    std::vector<std::string> names;
    for (const DraftGrid& d : draft_.grids) {
      if (!d.shares.empty()) {
        names.push_back(d.grid.name);
        shared_grid(d, rows[d.grid.name]);
        continue;
      }
      VoxelGrid g = d.grid;
      for (const Reference& r : d.media) g.media.push_back(medium(r));
      for (const uint8_t k : g.kind)
        if (k >= g.media.size()) {
          add("SP601", d.where,
              strf("grid '%s' has a voxel of medium %u, %zu media are listed", g.name.c_str(), k, g.media.size()));
          break;
        }
      rows[g.name] = {static_cast<uint32_t>(scene_.grids.size())};
      names.push_back(g.name);
      scene_.grids.push_back(std::move(g));
    }
    std::set<std::string> placed;
    for (const DraftVolume& v : draft_.volumes) {
      const auto found = rows.find(v.grid.name);
      if (found == rows.end()) {
        add("SP602", v.grid.where, "unknown voxel grid '" + v.grid.name + "'; " + name_hint(v.grid.name, names));
        continue;
      }
      placed.insert(v.grid.name);
      bool sound = v.to_world.determinant() != 0 && finite(v.to_world.b);
      for (const double a : v.to_world.a) sound = sound && std::isfinite(a);
      if (!sound) add("SP404", v.where, "the transform of '" + v.grid.name + "' flattens or is not finite");
      uint32_t track = kNone;
      if (v.motion) {
        track = static_cast<uint32_t>(scene_.tracks.size());
        scene_.tracks.push_back(
            {strf("volume '%s' (line %d of the scene's text)", v.grid.name.c_str(), v.motion_where.line), v.motion});
        motion_where_.push_back(v.motion_where);
      }
      for (const uint32_t row : found->second) scene_.volumes.push_back({row, v.to_world, track});
    }
    for (const DraftGrid& d : draft_.grids)
      if (!placed.count(d.grid.name)) add("SP603", d.where, "voxel grid '" + d.grid.name + "' is in no volume");
  }

  const Draft& draft_;
  Report& report_;
  Scene& scene_;
  std::vector<Where>& motion_where_;
  std::map<std::string, uint32_t> ids_;
  std::set<std::string> used_;
};

}  // namespace

void bake_media(const Draft& draft, Report& report, Scene& scene, std::vector<Where>& motion_where) {
  MediaBaker(draft, report, scene, motion_where).run();
}

}  // namespace suite
