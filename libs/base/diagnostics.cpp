#include "base/diagnostics.h"

#include <algorithm>
#include <mutex>
#include <set>

#include "base/run_app.h"

namespace suite {

namespace {

constexpr Severity kWarning = Severity::warning, kInfo = Severity::info;

constexpr DiagnosticKind kKinds[] = {
    // Sensors and lights.
    {Dr::sun_below_horizon, kWarning,
     "the sun is below the horizon (under air: by 6 degrees) in every capture and nothing else shines",
     "choose a time or direction with the sun up, or add a sky, a moon or lamps"},
    {Dr::no_twilight, kWarning, "an endless plane shades all air of a round Earth from a sun below the horizon",
     "give the plane a size; `earth` continues around it"},
    {Dr::unlit_band, kWarning, "no source emits in a band and nothing in the scene glows there",
     "give the sources spectra that reach the band, the scene temperatures, or the sensor other bands"},
    {Dr::band_beyond_spectra, kWarning, "a band lies beyond the ends of all spectra of the scene",
     "give the materials spectra that cover the band, or the sensor other bands"},
    {Dr::long_exposure, kWarning, "sun or moon move during one capture by more than matters",
     "divide the capture: lines_per_capture, tasks, integration times"},
    {Dr::degrees_as_metres, kWarning, "a sensor's position in metres equals the scene's latitude and longitude",
     "give metres in the scene's frame, or latitude_deg, longitude_deg and height_m"},
    {Dr::sensor_below_ground, kWarning, "a sensor stands below the ground or inside the Earth",
     "raise it: positions are metres up from the scene's origin"},
    {Dr::looks_past_scene, kWarning, "no ray of a sensor can meet the scene",
     "check its position and direction: metres east, north and up"},
    {Dr::nothing_hit, kWarning, "no path of a sensor hit anything",
     "check its position and direction: metres east, north and up"},
    {Dr::all_zero, kWarning, "every pixel of every band is zero",
     "check the sources, the reflectance in the sensor's bands, and what shades the scene"},
    {Dr::band_zero, kWarning, "every pixel of some bands is zero",
     "check the spectra of the sources and the surfaces in these bands"},
    {Dr::no_sources, kWarning, "there is no sun, no sky and no lamp: only thermal emission is seen",
     "add sources, or ignore it for a thermal simulation"},
    {Dr::clipped, kWarning, "more than 1 % of a sensor's pixels are clipped by converter or full well",
     "change the integration time, gain_e_per_dn, bias_dn, bits or full_well_e"},
    {Dr::guessed_bands, kWarning, "a band lies beyond the range in which display colours are uplifted to reflectances",
     "give these materials measured spectra where that matters"},
    // Transport.
    {Dr::unresolved_refracted, kWarning, "light of small sources behind smooth refracting surfaces was not found",
     "give the sun a wider disk, lamps a surface, surfaces a roughness, or more paths"},
    {Dr::truncated_paths, kWarning, "paths were truncated at max_nodes with light left in them", "raise max_nodes"},
    {Dr::rejected_samples, kWarning, "samples were not finite or negative and were rejected",
     "please report it with the scene"},
    {Dr::open_boundary, kWarning, "paths leaked out of a medium where it has no boundary surface",
     "close the body, or extend its surface until no light from there matters"},
    {Dr::refracted_light_not_found, kWarning,
     "the method cannot connect to a source through smooth refracting surfaces: what is missing is estimated",
     "use the standard method with refracted_sources, or a wider source"},
    {Dr::caustics_by_photons, kInfo, "caustics of small sources: found by photon-guided sampling only",
     "nothing, unless reflectors are endless or many and small: then a rough surface or a wider source"},
    {Dr::caustics_not_found, kWarning, "caustics of collimated or point sources are not found and not estimated",
     "give the surface a roughness (ggx) or the source a size"},
    {Dr::stokes_techniques, kInfo,
     "a sensor of polarisation: the residual estimator of the air is off, the air shines as over an even ground",
     "nothing, unless the ground varies or shadows matter: then `scattering: traced`"},
    {Dr::stokes_depolarised, kWarning, "more than 1 % of a sensor's light passed what no Mueller matrix is known of",
     "give the materials models that polarise, or read the degree of polarisation as a lower bound"},
    {Dr::polarised_lamps, kInfo, "lamps have `stokes` and a sensor sees no polarisation: they shine as if unpolarised",
     "nothing, unless much of their light is mirrored or scattered once: then ask the sensor for `stokes`"},
    // Interfaces and media.
    {Dr::interfaces_coincide, kWarning, "two refracting surfaces lie in each other: only one of them refracts",
     "give the common face one surface with `inside` and `outside`, or leave a gap"},
    {Dr::boundary_without_interface, kWarning, "a boundary parts media of different index and does not refract",
     "give it `model: dielectric` and `index`, or the media one index"},
    {Dr::index_in_front, kWarning, "a refracting surface has another medium in front than it is made for",
     "give that part a material with `outside`, or end it there"},
    {Dr::index_behind, kWarning, "a refracting surface has another medium behind than it refracts into",
     "give what the surface encloses the higher `priority`, or close the surface"},
    {Dr::media_overlap, kWarning, "bodies of media of equal priority overlap in part",
     "give one of the media a higher `priority`"},
    {Dr::dense_medium_skipped, kWarning, "a medium is so dense that the offset of rays from a surface skips light",
     "divide the object: smaller parts have smaller offsets"},
    // Atmosphere.
    {Dr::gas_limits, kInfo, "bands lie where the gas tables are less exact than in general",
     "allow for the stated error, or bake tables from line lists (scripts/bake_air)"},
    {Dr::air_open_below, kInfo, "traced air has no ground beyond the scene", "add `earth` or an endless plane"},
    {Dr::even_ground_beyond, kInfo, "an even ground continues beyond the scene and counts in the diffuse field",
     "extend the scene, or set its albedo"},
    {Dr::no_adjacency, kInfo, "this method leaves adjacency and shadows in the air out", "use the standard method"},
    {Dr::low_sun, kInfo, "sun or moon are so low that multiple scattering is less exact", "use `scattering: traced`"},
    {Dr::limb_low_sun, kInfo, "a sensor looks along the limb under a sun lower than was validated",
     "use `scattering: traced`"},
    {Dr::scattered_once, kWarning, "the atmosphere without a profile scatters once: light scattered again is missing",
     "use an atmosphere with a `profile`"},
    {Dr::within_haze, kInfo, "a sensor looks from within haze, where particle models differ",
     "allow for the stated difference, or give particles of your own"},
    // Spectral bins.
    {Dr::bins_through_gases, kWarning, "bands miss their spectral_error through the gases",
     "leave out spectral_step_um or reduce it; the errors include the bias"},
    {Dr::bins, kWarning, "bands miss their spectral_error",
     "leave out `spectral_error: 0`, or reduce spectral_step_um"},
    // Temperatures.
    {Dr::heat_paths, kWarning, "the largest number of paths a face is too few for target_error_k",
     "raise target_error_k"},
    {Dr::heat_left_out, kWarning, "elements that are left out change temperatures by more than influence_cutoff_k",
     "reduce influence_cutoff_k, or set it to 0"},
    {Dr::heat_limit, kWarning, "the heat balance neglects something that matters here", "see the text"},
    {Dr::heat_other_span, kWarning, "a file of temperatures covers another time than the simulation",
     "solve for the temperatures again, or change the times"},
    {Dr::heat_unused, kWarning, "the simulation has `heat` and no material uses it",
     "give materials `temperature: {model: heat}`, or remove `heat`"},
    {Dr::heat_points_displaced, kWarning, "points lie on objects that stand elsewhere at other times",
     "nothing: they get their element's temperature"},
    {Dr::heat_points_unsettled, kWarning, "temperatures of points did not converge",
     "nothing: they get their element's temperature"},
    // Imported files.
    {Dr::import_unsupported, kWarning, "an element of an imported simulation is not supported",
     "see the text; --import-report FILE.json lists every element"},
    {Dr::import_more, kWarning, "more elements of an imported simulation are not supported",
     "--import-report FILE.json lists every element"},
    // Products.
    {Dr::no_lookup_table, kWarning, "an image gets no geometric lookup table (GLT)", "see the text"},
    {Dr::no_map, kWarning, "an image gets no map: the horizon is in view", "point the sensor down"},
    {Dr::map_offset, kWarning, "the map of an image is offset from its pixels", "see the text"},
    {Dr::no_brightness_temperature, kWarning, "values have no brightness temperature",
     "use radiance: their radiance is zero, negative or out of range"},
    {Dr::page_of_other_run, kWarning, "a product is left out of the page: it belongs to another run",
     "render into an empty folder"},
    {Dr::page_thinned, kWarning, "the page keeps every n-th column and row to stay within its size",
     "allow a larger page"},
    // The run.
    {Dr::tile_beyond_limit, kWarning, "a tile of the scene alone takes more than the memory limit", "raise the limit"},
    {Dr::stopped, kWarning, "a signal stopped the run in good order", "resume it where a state is kept"},
    {Dr::rank_options, kWarning, "a rank was started with options that cannot be", "start all ranks alike"},
    {Dr::renamed, kWarning, "a key or an option is given by an old name", "write the new name that the text states"},
};

struct Kept {
  std::mutex mutex;
  std::set<Dr> muted;
  std::vector<ReportedDiagnostic> reported;
};
Kept& kept() {
  static Kept all;
  return all;
}

}  // namespace

std::span<const DiagnosticKind> diagnostic_kinds() { return kKinds; }

const DiagnosticKind& diagnostic_kind(Dr code) {
  const auto found = std::ranges::find(kKinds, code, &DiagnosticKind::code);
  if (found == std::end(kKinds)) throw Bug("unlisted diagnostic " + code_text(code));
  return *found;
}

std::string code_text(Dr code) { return strf("DR%03d", static_cast<int>(code)); }

Dr diagnostic_code(const std::string& text) {
  std::vector<std::string> known;
  for (const DiagnosticKind& k : kKinds) {
    known.push_back(code_text(k.code));
    if (known.back() == text) return k.code;
  }
  throw Error("unknown diagnostic code '" + text + "'", name_hint(text, known));
}

std::string line_of(const Diagnostic& d) { return d.text + " [" + code_text(d.code) + "]"; }

std::vector<std::string> lines_of(std::span<const Diagnostic> diagnostics) {
  std::vector<std::string> lines;
  for (const Diagnostic& d : diagnostics) lines.push_back(line_of(d));
  return lines;
}

void emit(const Diagnostic& d) {
  Kept& all = kept();
  bool muted = false;
  {
    const std::lock_guard lock(all.mutex);
    muted = all.muted.contains(d.code);
    all.reported.push_back({d, muted});
  }
  if (muted) return;
  if (diagnostic_kind(d.code).severity == Severity::info)
    note(line_of(d));
  else
    warn(line_of(d));
}

void mute(Dr code) {
  const std::lock_guard lock(kept().mutex);
  kept().muted.insert(code);
}

std::vector<ReportedDiagnostic> reported_diagnostics() {
  const std::lock_guard lock(kept().mutex);
  return kept().reported;
}

std::string diagnostics_text() {
  std::string text;
  for (const DiagnosticKind& k : kKinds)
    text +=
        strf("%s  %-7s  %s\n                %s\n", code_text(k.code).c_str(), to_text(k.severity), k.condition, k.cure);
  return text;
}

}  // namespace suite
