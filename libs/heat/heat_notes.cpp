#include "heat/heat_notes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/error.h"
#include "heat/closed_backs.h"
#include "heat/heat_walk.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kFilm = 12;  // W/(m2 K), of a light wind with radiation

std::string share_text(double share) { return strf("%.0f %%", 100 * share); }

// Whether a place that may come and go is there all the time: at 17 times, looked at from just off it.
bool stays(const Tracer& tracer, const Hit& place) {
  const std::optional<TimeSpan> window = tracer.window();
  if (!window) return true;
  constexpr int kTimes = 16;
  const double off = 16 * double{place.step};
  std::vector<Ray> rays;
  for (int k = 0; k <= kTimes; ++k)
    rays.push_back({place.position + place.normal * off, -place.normal,
                    window->begin + (window->end - window->begin) * k / kTimes, static_cast<uint32_t>(k)});
  std::vector<Hit> hits(rays.size());
  TraceStatistics ignored;
  tracer.nearest(rays, hits, false, ignored);
  return std::ranges::all_of(hits, [&](const Hit& h) { return h.hit() && h.distance <= 2 * off; });
}

// By face: whether it belongs to what comes and goes.
std::vector<bool> visitors(const HeatScene& s) {
  std::vector<bool> out;
  for (size_t f = 0; f < s.faces.size(); ++f) {
    const Hit hit = s.elements.point(s.faces.element(f), {SampleStream(0, 0, 0), 0, 0});
    out.push_back(s.tracer.object(hit.object).node != kNone && !stays(s.tracer, hit));
  }
  return out;
}

// W/m2: what a face takes of the infrared of visitors beyond what it would take without them, as a mean over the span.
double taken_of_visitors(const ExchangePaths& exchange, const HeatScene& scene, const SurfaceHistory& history,
                         const std::vector<bool>& visits, size_t face) {
  constexpr size_t kEvery = 8;  // moments
  const size_t each = size_t{exchange.blocks} * exchange.paths, moments = history.moments;
  double all = 0, more = 0, looks = 0;
  for (size_t k = face * each; k < (face + 1) * each; ++k) all += double{exchange.weights[k]};
  for (size_t m = 0; m < moments; m += kEvery) {
    ++looks;
    for (size_t k = face * each; k < (face + 1) * each; ++k) {
      const uint32_t from = scene.faces.face_of(exchange.ends[k]);
      if (from == kNone || !visits[from]) continue;
      const double T = history.kelvin.at(from, m), emitted = kStefanBoltzmann * T * T * T * T;
      more += double{exchange.weights[k]} * (emitted - history.received.at(face, m));
    }
  }
  return all > 0 ? exchange.emissivity[face] * more / (all * looks) : 0;
}

}  // namespace

std::string visitors_note(const HeatScene& scene, const ExchangePaths& exchange, const SurfaceHistory& history) {
  if (!scene.elements.rests().empty()) return {};
  constexpr double kLittle = 1;  // W/m2
  const std::vector<bool> visits = visitors(scene);
  if (std::ranges::find(visits, true) == visits.end()) return {};
  double most = 0, sum = 0;
  size_t felt = 0;
  for (size_t f = 0; f < visits.size(); ++f) {
    if (visits[f]) continue;
    const double taken = std::fabs(taken_of_visitors(exchange, scene, history, visits, f));
    most = std::max(most, taken);
    if (taken > kLittle) ++felt, sum += taken;
  }
  return strf(
      "%zu faces are of what comes and goes: they are followed through the whole span, and others exchange "
      "infrared with them for their share of it, evenly; that is %.3g W/m2 (about %.2g K) at most, and in the "
      "mean %.3g W/m2 on the %zu faces that feel more than %g W/m2; shade and sunlight have their times",
      static_cast<size_t>(std::ranges::count(visits, true)), most, most / kFilm,
      felt > 0 ? sum / static_cast<double>(felt) : 0, felt, kLittle);
}

std::string rests_note(const HeatScene& scene, const HeatOperator& found) {
  const std::vector<RestInterval>& rests = scene.elements.rests();
  if (rests.empty()) return {};
  std::string until;
  for (size_t k = 0; k + 1 < rests.size(); ++k) until += strf("%s%.6g", k == 0 ? "" : ", ", rests[k].span.end);
  const auto faces = static_cast<double>(scene.faces.size());
  const auto share = [&](const PathRows& rows) {
    return 100 * static_cast<double>(rows.size() - rows.faces) / (static_cast<double>(rests.size() - 1) * faces);
  };
  std::string out = strf(
      "things move, come or go: infrared and scattered sunlight are those of %zu intervals of rest, which change at %s "
      "s; %.2g and %.2g %% of the faces see what changes",
      rests.size(), until.c_str(), share(found.exchange.rows), share(found.sun.rows));
  const std::vector<std::string> moves = motion_sentences(scene.tracer, rests);
  for (const std::string& sentence : moves) out += "; " + sentence;
  if (!moves.empty())
    out +=
        "; what moves leaves the exchange meanwhile: it gives shade, counts as warm as the air, and its elements are "
        "followed as if they stood where they rested before";
  return out;
}

bool stands_in_several_places(const HeatScene& scene) {
  std::map<uint32_t, bool> known;  // by object
  for (size_t e = 0; e < scene.elements.size(); ++e) {
    if (!scene.elements.changes_place(e)) continue;
    const uint32_t object = scene.elements.point(e, {SampleStream(0, 0, 0), 0, 0}).object;
    const auto [at, fresh] = known.emplace(object, false);
    if (fresh) at->second = changes_place(scene.tracer, object);
    if (at->second) return true;
  }
  return false;
}

std::vector<std::string> heat_notes(const HeatScene& scene, const HeatOperator& found, bool dry_air) {
  const auto& [tracer, elements, faces, optics] = scene;
  const auto& [exchange, sun] = found;
  std::vector<std::string> notes;
  if (elements.moving() > 0)
    notes.push_back(strf("%zu instances move: they give shade, and count as warm as the air", elements.moving()));
  if (sun.mirrored.moving > 0)
    notes.push_back(
        strf("%zu instances that mirror or refract without scattering move: the sunlight that they send on "
             "is left out",
             sun.mirrored.moving));
  if (sun.mirrored.endless > 1)
    notes.push_back(
        strf("%zu surfaces without end mirror or refract without scattering: sunlight that goes from one to "
             "another and on may be found in part only",
             sun.mirrored.endless));
  if (const std::string sentence = back_note(scene, exchange); !sentence.empty()) notes.push_back(sentence);
  if (uses_media(tracer.scene())) notes.push_back("media are passed by: they neither shade nor warm anything here");
  if (exchange.unfinished() > 1e-6)
    notes.push_back(
        strf("%.2g of the infrared was still being reflected after %u reflections and counts as absorbed there",
             exchange.unfinished(), kMostReflections));
  if (const double left = std::max(sun.unfinished(exchange.blocks * exchange.paths), sun.mirrored.unfinished);
      left > 1e-6)
    notes.push_back(strf("%.2g of the light of paths was still being reflected after %u reflections, and is left out",
                         left, kMostReflections));
  if (elements.shared_cells() > 0)
    notes.push_back(
        strf("%zu cells hold several materials of class maps; one with less than %.1f %% of a cell may have no "
             "element there, and is then as warm as the largest of the others",
             elements.shared_cells(), 100.0 / Elements::kLooks));
  const auto is_wet = [](const HeatedMaterial& m) { return m.front.wetness > 0; };
  if (dry_air && std::any_of(optics.heated.begin(), optics.heated.end(), is_wet))
    notes.push_back("the weather has no humidity: wet surfaces evaporate into dry air");
  for (const HeatOptics::Assumed& a : optics.assumed) {
    if (a.sunlight < 0.01 && a.infrared < 0.01) continue;
    notes.push_back(
        "material '" + optics.materials->materials[a.material].id + "': beyond its curves lie " +
        share_text(a.sunlight) + " of sunlight and " + share_text(a.infrared) +
        " of a body's light at 300 K, for which the ends of the curves (in the infrared their mean from 8 to "
        "14 um) are held");
  }
  return notes;
}

}  // namespace suite
