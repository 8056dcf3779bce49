#include "scheduler/shortfall.h"

#include <algorithm>
#include <cmath>

#include "scheduler/techniques.h"
#include "transport/lost_light.h"

namespace suite {

namespace {

std::string listed(const std::vector<std::string>& names) {
  constexpr size_t most = 4;
  std::string out;
  for (size_t i = 0; i < names.size() && i < most; ++i) out += (i ? ", " : "") + names[i];
  return names.size() > most ? out + strf(" and %zu more", names.size() - most) : out;
}

std::string share(const Shortfall& s, const Shortfall::Part& part) {
  std::string said = strf("about %.3g %% of the radiance of all problems", 100 * s.mean_of_all(part));
  if (part.problems)
    said += strf(", of theirs %.3g %% on average, %.3g %% at most", 100 * part.mean(), 100 * part.most);
  return said;
}

bool reports(const Shortfall& s, const Shortfall::Part& part, double least) {
  return part.problems > 0 || s.mean_of_all(part) > least;
}

}  // namespace

void Shortfall::merge(const Shortfall& o) {
  problems += o.problems;
  unresolved.merge(o.unresolved);
  truncated.merge(o.truncated);
  rejecting += o.rejecting;
  rejected += o.rejected;
}

Shortfall shortfall_of(std::span<const Lack> problems) {
  Shortfall all;
  all.problems = problems.size();
  for (const Lack& lack : problems) {
    all.unresolved.add(lack.missing, lack.unresolved());
    all.truncated.add(lack.cut, lack.truncated());
    all.rejecting += lack.rejected > 0;
    all.rejected += lack.rejected;
  }
  return all;
}

std::vector<Diagnostic> diagnose_shortfall(const std::string& sensor, const Shortfall& s) {
  std::vector<Diagnostic> found;
  const auto of = [&](size_t n) { return strf("sensor '%s': %zu of %zu problems ", sensor.c_str(), n, s.problems); };
  if (reports(s, s.unresolved, Lack::kMissing))
    found.push_back({Dr::unresolved_refracted,
                     of(s.unresolved.problems) +
                         "are not resolved: light of small sources behind smooth refracting surfaces was not found, " +
                         share(s, s.unresolved) +
                         ", estimated along straight lines, as flat surfaces would let it pass; where curved surfaces "
                         "or mirrors focus light, up to all of it. Their standard errors contain the estimate. A wider "
                         "disk of the sun, lamps with a surface, rough surfaces or more paths help"});
  if (reports(s, s.truncated, Lack::kCut))
    found.push_back({Dr::truncated_paths, of(s.truncated.problems) +
                                              "miss light of paths that were truncated at the maximum number of "
                                              "nodes, " +
                                              share(s, s.truncated) +
                                              "; their standard errors contain it. More max_nodes help"});
  if (s.rejected)
    found.push_back(
        {Dr::rejected_samples, of(s.rejecting) + strf("rejected %llu samples that were not finite or negative",
                                                      static_cast<unsigned long long>(s.rejected))});
  return found;
}

std::optional<Diagnostic> diagnose_leaks(const RunStatistics& statistics, const Scene& scene) {
  const double share = statistics.paths ? statistics.strayed / static_cast<double>(statistics.paths) : 0;
  if (!(share > kStrays)) return std::nullopt;
  std::vector<std::string> bounded;
  for (const Material& m : scene.materials)
    for (const uint32_t medium : {m.outside, m.inside})
      if (medium != kNone &&
          std::find(bounded.begin(), bounded.end(), "'" + scene.media[medium].id + "'") == bounded.end())
        bounded.push_back("'" + scene.media[medium].id + "'");
  return Diagnostic{
      Dr::open_boundary,
      strf("paths with %.3g %% of the throughput at the reference wavelength leaked out of bodies of media (among %s) "
           "where these have no boundary, and went on as if outside: light passes there that a surface would refract "
           "or stop. Close the body, or let its surface and what lies below reach so far that no light from there "
           "counts",
           100 * share, listed(bounded).c_str())};
}

namespace {

// Parts of sources that continuations hardly ever meet, by who finds their light.
struct SmallSources {
  std::vector<std::string> all, refracted, by_photons, unguided;
};
SmallSources small_sources(const SourceSpecs& sources, const TechniqueFacts& facts, uint32_t paths, bool repeats) {
  // Manifold NEE connects through smooth interfaces; not by way of mirrors.
  const bool connects = uses(ListedTechnique::manifold, facts), guided = uses(ListedTechnique::caustic_guide, facts);
  constexpr double kNever = 1e-12;
  SmallSources found;
  for (const LightSpecPtr& light : sources.lights) {
    const std::vector<std::string> unmet = light->hardly_met(kNever);
    for (const std::string& part : light->hardly_met(Accumulators::kEnoughMeetings / paths)) {
      found.all.push_back(part);
      if (!connects || (repeats && light->in_scene())) found.refracted.push_back(part);
      const bool never = std::find(unmet.begin(), unmet.end(), part) != unmet.end();
      (guided && !never ? found.by_photons : found.unguided).push_back(part);
    }
  }
  return found;
}

}  // namespace

std::vector<Diagnostic> diagnose_lost_light(const Scene& scene, const SourceSpecs& sources, const Optics& optics,
                                            const PipelineOptions& options, uint32_t paths, bool repeats) {
  if (!options.explicit_sources) return {};
  std::vector<std::string> refracting, mirrors;
  for (const uint32_t i : LostLight::refracting(scene, optics)) refracting.push_back("'" + scene.materials[i].id + "'");
  const SmallSources lights = small_sources(sources, technique_facts(scene, sources, options, optics), paths, repeats);
  if (lights.all.empty()) return {};
  for (uint32_t i = 0; i < scene.materials.size(); ++i)
    if (const ScatterModel* m = optics.material(i).model; m && m->has_delta())
      mirrors.push_back("'" + scene.materials[i].id + "'");
  std::vector<Diagnostic> found;
  if (!refracting.empty() && !lights.refracted.empty())
    found.push_back({Dr::refracted_light_not_found,
                     "light of " + listed(lights.refracted) + " is not found behind smooth refracting surfaces (" +
                         listed(refracting) +
                         "): only next-event estimation finds it, and the surfaces refract its shadow rays. What is "
                         "missing is estimated, enlarges standard errors and flags problems as not resolved"});
  if (!mirrors.empty() && !lights.by_photons.empty())
    found.push_back({Dr::caustics_by_photons,
                     "caustics: light of " + listed(lights.by_photons) + " that smooth surfaces (" + listed(mirrors) +
                         ") reflect to others is found by photon-guided sampling; what the photons of surfaces "
                         "without bounds, and of small ones among many, do not reach is left to chance, and no "
                         "standard error or flag contains it"});
  if (!mirrors.empty() && !lights.unguided.empty())
    found.push_back({Dr::caustics_not_found,
                     "caustics: light of " + listed(lights.unguided) + " that smooth surfaces (" + listed(mirrors) +
                         ") reflect to others is not found and not estimated, up to all of what is seen there: no "
                         "standard error and no flag contains it. A rough surface (ggx) or a wider source is found"});
  return found;
}

}  // namespace suite
