#include "heat_report.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/diagnostics.h"
#include "base/progress.h"
#include "heat/heat_fluxes.h"
#include "heat/seen_warmth.h"
#include "page/page.h"
#include "spectral/planck.h"

namespace suite {

namespace {

double moment_time(const HeatResult& h, size_t k) { return h.span.begin + h.step * static_cast<double>(k); }

// Errors of a temperature by cause, as columns.
constexpr double HeatErrors::*kCauses[] = {&HeatErrors::paths, &HeatErrors::size, &HeatErrors::steps,
                                           &HeatErrors::sweeps};
constexpr const char* kErrorColumns = "path_error_k,size_error_k,step_error_k,sweep_error_k";
std::string error_text(const HeatErrors& e) { return strf("%.4f,%.4f,%.4f,%.4f", e.paths, e.size, e.steps, e.sweeps); }

// Means over the fronts of one material at one moment, weighed by area.
struct MaterialMoment {
  double area = 0, kelvin = 0, coldest = INFINITY, warmest = 0, sunlight = 0, infrared = 0;
  HeatErrors errors;  // roots of the mean squares
};
using MaterialTable = std::map<uint32_t, std::vector<MaterialMoment>>;

MaterialTable means_of(const HeatResult& h, const PreparedHeat& p) {
  MaterialTable table;
  for (uint32_t e = 0; e < p.elements->size(); ++e) {
    std::vector<MaterialMoment>& rows = table[(*p.elements)[e].material];
    rows.resize(h.moments);
    const double a = (*p.elements)[e].area;
    for (size_t k = 0; k < h.moments; ++k) {
      MaterialMoment& m = rows[k];
      const double T = double{h.kelvin[e * h.moments + k]};
      m.area += a, m.kelvin += a * T, m.coldest = std::min(m.coldest, T), m.warmest = std::max(m.warmest, T);
      m.sunlight += a * double{h.absorbed[e * h.moments + k]}, m.infrared += a * double{h.received[e * h.moments + k]};
      const HeatErrors one = h.errors_at(e, moment_time(h, k));
      for (const auto cause : kCauses) m.errors.*cause += a * std::pow(one.*cause, 2);
    }
  }
  for (auto& [material, rows] : table)
    for (MaterialMoment& m : rows) {
      m.kelvin /= m.area, m.sunlight /= m.area, m.infrared /= m.area;
      for (const auto cause : kCauses) m.errors.*cause = std::sqrt(m.errors.*cause / m.area);
    }
  return table;
}

std::string moment_text(const HeatResult& h, size_t k, const Simulation& sim) {
  const double t = moment_time(h, k);
  return strf("%.3f,%s", t, to_iso8601(Clock(*sim.epoch).utc(t), 0).c_str());
}

}  // namespace

void report_hot_neighbours(const Scene& scene, const Simulation& sim) {
  const double hottest = hottest_given(scene);
  for (const auto& sensor : sim.sensors)
    for (const SpectralState& state : sensor->states())
      if (hottest > kWeatherBelow && sees_warmth(state, hottest)) {
        emit({Dr::heat_limit,
              strf("heat: sensor '%s': surfaces that wait for the balance of heat stay dark, as none of its bands sees "
                   "what is as warm as %g K; the scene holds %.0f K, and what that heats may send out up to %.2g W/(m2 "
                   "sr um) at %.3g um; temperatures are found with a band beyond 2 um or with `truth: [temperature]`",
                   sensor->name().c_str(), kWeatherBelow, hottest, planck_radiance(state.high_um, hottest),
                   state.high_um)});
        break;
      }
}

std::vector<std::string> heat_sentences(const HeatResult& h, const PreparedHeat& p, double seconds) {
  std::vector<std::string> out;
  double worst = 0, sum = 0, area = 0, sizes = 0, steps = 0;
  std::vector<double> by_face;
  for (size_t f = 0; f < p.faces->size(); ++f) {
    const auto mean_square = [&](const std::vector<float>& errors) {
      double square = 0;
      for (size_t k = 0; k < kHeatParts; ++k) square += std::pow(double{errors[f * kHeatParts + k]}, 2) / kHeatParts;
      return square;
    };
    const double square = mean_square(h.path_error);
    by_face.push_back(std::sqrt(square));
    worst = std::max(worst, by_face.back());
    const double a = (*p.elements)[p.faces->element(f)].area;
    sum += a * square, area += a;
    sizes += a * mean_square(h.size_error), steps += a * mean_square(h.step_error);
  }
  std::sort(by_face.begin(), by_face.end());
  out.push_back(strf("%zu elements (%zu faces) of %.4g m2, %s rays, %d sweeps, %.1f s", p.elements->size(),
                     p.faces->size(), p.elements->total_area(), human_count(h.rays).c_str(), h.sweeps, seconds));
  out.push_back(strf(
      "standard error by the paths %.2g K (root mean square over the area), half of the faces below %.2g K, "
      "the worst %.2g K; by the steps in time %.2g K, by the sweeps %.1g K, by the past %.1g K",
      std::sqrt(sum / area), by_face[by_face.size() / 2], worst, std::sqrt(steps / area), h.sweep_error, h.past_error));
  out.push_back(strf(
      "places within an element differ from its mean by %.2g K (root mean square) where direct sun does; "
      "`elements` makes that smaller%s",
      std::sqrt(sizes / area), p.spec.lateral ? "; conduction along the surface, too, which this does not know" : ""));
  const auto& b = h.balance;
  const double scale = 1 / p.elements->total_area();
  out.push_back(
      strf("mean of the span in W/m2: sunlight %.2f + infrared %.2f + sources %.2f = emitted %.2f + to the air "
           "%.2f + to "
           "what is behind %.2f + stored %.2f + %.3f that is left",
           b.sunlight * scale, b.infrared * scale, b.source * scale, b.emitted * scale, b.to_air * scale,
           b.behind * scale, b.stored * scale, b.residual() * scale));
  out.push_back(
      strf("elements of %.3g m2 at most; air, sky and beam are those of the weather everywhere; beyond the scene "
           "the ground is "
           "as warm as the air, with an albedo of %g",
           p.elements->largest(), p.spec.ground_albedo));
  if (h.audit) out.push_back(audit_sentence(*h.audit));
  return out;
}

std::string audit_sentence(const HeatAudit& a) {
  std::string out = strf("audit by %zu probes, %s rays: elements are %+.3f +- %.3f K too warm in the mean (95 %%; %s)",
                         a.probes.size(), human_count(a.rays).c_str(), a.bias, HeatAudit::kSure * a.bias_error,
                         a.biased() ? "biased" : "no bias is seen");
  const double sure = HeatAudit::kSure * a.square_error;
  out += a.spread() > 0 ? strf("; places differ from their elements by %.2f K (root mean square, %.2f to %.2f)",
                               a.spread(), std::sqrt(std::max(0.0, a.square - sure)), std::sqrt(a.square + sure))
                        : strf("; places differ from their elements by less than %.2f K (root mean square)",
                               std::sqrt(std::max(0.0, a.square + sure)));
  if (a.cut > 0) out += strf("; %zu walks were cut after %u events", a.cut, HeatAudit::kMostEvents);
  if (a.fast > 0) out += strf("; %zu waits were longer than their rates allowed", a.fast);
  return out;
}

std::string audit_table(const HeatAudit& audit, const PreparedHeat& p, const Scene& scene) {
  std::string out = "face,material,east_m,north_m,up_m,time_s,found_k,walked_k,walked_again_k,more_k,more_again_k\n";
  for (const AuditProbe& a : audit.probes)
    out += strf("%u,%s,%.6g,%.6g,%.6g,%.3f,%.4f,%.4f,%.4f,%.4f,%.4f\n", a.face,
                scene.materials[(*p.elements)[p.faces->element(a.face)].material].id.c_str(), a.at.x, a.at.y, a.at.z,
                a.time, a.found, a.walked[0], a.walked[1], a.more[0], a.more[1]);
  return out;
}

std::string heat_table(const HeatResult& h, const PreparedHeat& p, const Scene& scene, const Simulation& sim) {
  const MaterialTable table = means_of(h, p);
  std::string out = strf(
      "time_s,time_utc,material,area_m2,temperature_k,coldest_k,warmest_k,%s,absorbed_sunlight_w_m2,"
      "received_infrared_w_m2,air_k\n",
      kErrorColumns);
  for (size_t k = 0; k < h.moments; ++k)
    for (const auto& [material, rows] : table) {
      const MaterialMoment& m = rows[k];
      out += moment_text(h, k, sim) +
             strf(",%s,%.6g,%.4f,%.4f,%.4f,%s,%.3f,%.3f,%.3f\n", scene.materials[material].id.c_str(), m.area, m.kelvin,
                  m.coldest, m.warmest, error_text(m.errors).c_str(), m.sunlight, m.infrared, double{h.air_kelvin[k]});
    }
  return out;
}

std::string heat_probes(const HeatResult& h, const PreparedHeat& p, const WeatherLoads& weather, const Scene& scene,
                        const Simulation& sim) {
  if (sim.heat->probes.empty()) return {};
  std::string out = strf(
      "time_s,time_utc,probe,material,temperature_k,%s,absorbed_sunlight_w_m2,absorbed_infrared_w_m2,"
      "source_w_m2,emitted_w_m2,to_air_w_m2,into_surface_w_m2\n",
      kErrorColumns);
  for (const auto& [name, place] : sim.heat->probes) {
    const uint32_t element = element_of(*p.tracer, *p.elements, place, p.spec.span.begin);
    const std::vector<HeatFluxes> fluxes = fluxes_of(h, *p.elements, p.optics, weather, element);
    for (size_t k = 0; k < fluxes.size(); ++k) {
      const HeatFluxes& f = fluxes[k];
      out += moment_text(h, k, sim) + strf(",%s,%s,%.4f,%s,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f\n", name.c_str(),
                                           scene.materials[(*p.elements)[element].material].id.c_str(), f.kelvin,
                                           error_text(f.errors).c_str(), f.sunlight, f.infrared, f.source, f.emitted,
                                           f.to_air, f.into());
    }
  }
  return out;
}

std::string heat_page(const HeatResult& h, const PreparedHeat& p, const WeatherLoads& weather, const Scene& scene,
                      const Simulation& sim, const std::vector<std::string>& sentences) {
  Page page{"Temperatures from weather", sentences, {}, {}};
  for (const std::string& note : h.notes) page.paragraphs.push_back(note);
  std::vector<double> hours;
  for (size_t k = 0; k < h.moments; ++k) hours.push_back((moment_time(h, k) - h.span.begin) / 3600);
  const std::string axis = "hours after " + to_iso8601(Clock(*sim.epoch).utc(h.span.begin), 0);
  const auto plot = [&](const std::string& title, const std::string& unit) {
    page.plots.push_back({title, axis, unit, false, false, {}});
    return page.plots.size() - 1;
  };
  const size_t warm = plot("Means of materials; bands from the coldest to the warmest element", "K"),
               sun = plot("Sunlight absorbed, means of materials", "W/m2"),
               infrared = plot("Infrared received, means of materials", "W/m2");
  PageTable materials{"Materials",
                      {"material", "area, m2", "coldest, K", "warmest, K", "errors: paths, K", "element size", "steps"},
                      {}};
  for (const auto& [material, rows] : means_of(h, p)) {
    const std::string& name = scene.materials[material].id;
    PlotSeries T{name, hours, {}, {}, {}}, light{name, hours, {}, {}, {}}, glow = light;
    MaterialMoment all = rows.front();
    for (const MaterialMoment& m : rows) {
      T.y.push_back(m.kelvin), T.low.push_back(m.coldest), T.high.push_back(m.warmest);
      light.y.push_back(m.sunlight), glow.y.push_back(m.infrared);
      all.coldest = std::min(all.coldest, m.coldest), all.warmest = std::max(all.warmest, m.warmest);
      for (const auto cause : kCauses) all.errors.*cause = std::max(all.errors.*cause, m.errors.*cause);
    }
    page.plots[warm].series.push_back(T), page.plots[sun].series.push_back(light);
    page.plots[infrared].series.push_back(glow);
    materials.rows.push_back({name, strf("%.4g", all.area), strf("%.2f", all.coldest), strf("%.2f", all.warmest),
                              strf("%.3f", all.errors.paths), strf("%.3f", all.errors.size),
                              strf("%.3f", all.errors.steps)});
  }
  page.plots[warm].series.push_back({"air", hours, weather.air_kelvin, {}, {}});
  if (!sim.heat->probes.empty()) {
    const size_t probes = plot("Probes; bands of twice the error of all causes", "K");
    for (const auto& [name, place] : sim.heat->probes) {
      PlotSeries T{name, hours, {}, {}, {}};
      for (const HeatFluxes& f :
           fluxes_of(h, *p.elements, p.optics, weather, element_of(*p.tracer, *p.elements, place, p.spec.span.begin)))
        T.y.push_back(f.kelvin), T.low.push_back(f.kelvin - 2 * f.errors.total()),
            T.high.push_back(f.kelvin + 2 * f.errors.total());
      page.plots[probes].series.push_back(T);
    }
  }
  page.tables.push_back(std::move(materials));
  return html_of(page);
}

}  // namespace suite
