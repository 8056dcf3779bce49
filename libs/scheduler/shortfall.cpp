#include "scheduler/shortfall.h"

#include <algorithm>
#include <cmath>

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

bool tells(const Shortfall& s, const Shortfall::Part& part, double least) {
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

std::vector<std::string> sentences(const std::string& sensor, const Shortfall& s) {
  std::vector<std::string> said;
  const auto of = [&](size_t n) { return strf("sensor '%s': %zu of %zu problems ", sensor.c_str(), n, s.problems); };
  if (tells(s, s.unresolved, Lack::kMissing))
    said.push_back(of(s.unresolved.problems) +
                   "are not resolved: light of small sources behind smooth refracting surfaces was not found, " +
                   share(s, s.unresolved) +
                   ", estimated along straight lines, as flat surfaces would let it pass; where curved surfaces or "
                   "mirrors throw light together, up to all of it. Their standard errors contain the estimate. A wider "
                   "disk of the sun, lamps with a surface, rough surfaces or more paths help");
  if (tells(s, s.truncated, Lack::kCut))
    said.push_back(of(s.truncated.problems) + "lost light that was cut at the maximum number of nodes, " +
                   share(s, s.truncated) + "; their standard errors contain it. More max_nodes help");
  if (s.rejected)
    said.push_back(of(s.rejecting) + strf("rejected %llu samples that were not finite or negative",
                                          static_cast<unsigned long long>(s.rejected)));
  return said;
}

std::string strayed(const RunStatistics& statistics, const Scene& scene) {
  const double share = statistics.paths ? statistics.strayed / static_cast<double>(statistics.paths) : 0;
  if (!(share > kStrays)) return {};
  std::vector<std::string> bounded;
  for (const Material& m : scene.materials)
    for (const uint32_t medium : {m.outside, m.inside})
      if (medium != kNone &&
          std::find(bounded.begin(), bounded.end(), "'" + scene.media[medium].id + "'") == bounded.end())
        bounded.push_back("'" + scene.media[medium].id + "'");
  return strf(
      "paths with %.3g %% of the throughput at the reference wavelength left bodies of media (among %s) where "
      "these have no surface, and went on as if outside: light comes in there, and goes out, that a surface would bend "
      "or "
      "stop. Close the body, or let its surface and what lies below reach so far that no light from there counts",
      100 * share, listed(bounded).c_str());
}

std::vector<std::string> lost_light(const Scene& scene, const SourceSpecs& sources, const Optics& optics,
                                    const PipelineOptions& options, uint32_t paths, bool repeats) {
  if (!options.explicit_sources) return {};
  // Lights are asked for through smooth interfaces; their mirrored light is not.
  const bool asked = options.refracted_sources && options.method == Method::standard;
  std::vector<std::string> lights, bent, by_photons, unguided, refracting, mirrors;
  for (const uint32_t i : LostLight::refracting(scene, optics)) refracting.push_back("'" + scene.materials[i].id + "'");
  // Where media scatter behind refracting surfaces paths have other guides.
  const bool guided =
      options.gloss_photons > 0 && options.method == Method::standard && (optics.media().empty() || refracting.empty());
  constexpr double kNever = 1e-12;
  for (const LightSpecPtr& light : sources.lights) {
    const std::vector<std::string> unmet = light->hardly_met(kNever);
    for (const std::string& part : light->hardly_met(Accumulators::kEnoughMeetings / paths)) {
      lights.push_back(part);
      if (!asked || (repeats && light->in_scene())) bent.push_back(part);
      const bool never = std::find(unmet.begin(), unmet.end(), part) != unmet.end();
      (guided && !never ? by_photons : unguided).push_back(part);
    }
  }
  if (lights.empty()) return {};
  for (uint32_t i = 0; i < scene.materials.size(); ++i)
    if (const ScatterModel* m = optics.material(i).model; m && m->has_delta())
      mirrors.push_back("'" + scene.materials[i].id + "'");
  std::vector<std::string> said;
  if (!refracting.empty() && !bent.empty())
    said.push_back("light of " + listed(bent) + " is not found behind smooth refracting surfaces (" +
                   listed(refracting) +
                   "): only asking for it finds it, and they bend it away. What is missing is estimated, enlarges "
                   "standard errors and flags problems as not resolved");
  if (!mirrors.empty() && !by_photons.empty())
    said.push_back(
        "light of " + listed(by_photons) + " that smooth surfaces (" + listed(mirrors) +
        ") reflect to others is found where photons say so that are sent when a state is begun; what those of "
        "surfaces without bounds, and of small ones among many, do not reach is left to chance, and no standard error "
        "or flag tells of it");
  if (!mirrors.empty() && !unguided.empty())
    said.push_back(
        "light of " + listed(unguided) + " that smooth surfaces (" + listed(mirrors) +
        ") reflect to others is not found and not estimated, up to all of what is seen there: no standard error "
        "and no flag tells of it. A rough surface (ggx) or a wider source is found");
  return said;
}

}  // namespace suite
