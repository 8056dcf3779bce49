// What a run says about its own results, with stable codes: what is missing from them, what is less exact than it might
// be, and what will be useless. One table holds every kind; text, render.json, `--mute`, `--list-diagnostics` and the
// reference page are made from it. Findings of scene-prep have their own table (report.h).
#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/report.h"

namespace suite {

// The number after "DR". By hundreds: 1 sensors and lights, 2 transport, 3 interfaces and media, 4 atmosphere,
// 5 spectral bins, 6 temperatures, 7 imported files, 8 products, 9 the run itself. A number is never used again.
enum class Dr : int {
  sun_below_horizon = 101,
  no_twilight = 102,
  unlit_band = 103,
  band_beyond_spectra = 104,
  long_exposure = 105,
  degrees_as_metres = 106,
  sensor_below_ground = 107,
  looks_past_scene = 108,
  nothing_hit = 109,
  all_zero = 110,
  band_zero = 111,
  no_sources = 112,
  clipped = 113,
  guessed_bands = 114,
  unresolved_refracted = 201,
  truncated_paths = 202,
  rejected_samples = 203,
  open_boundary = 204,
  refracted_light_not_found = 205,
  caustics_by_photons = 206,
  caustics_not_found = 207,
  stokes_techniques = 208,
  stokes_depolarised = 209,
  polarised_lamps = 210,
  interfaces_coincide = 301,
  boundary_without_interface = 302,
  index_in_front = 303,
  index_behind = 304,
  media_overlap = 305,
  dense_medium_skipped = 306,
  gas_limits = 401,
  air_open_below = 402,
  even_ground_beyond = 403,
  no_adjacency = 404,
  low_sun = 406,
  limb_low_sun = 407,
  scattered_once = 408,
  within_haze = 409,
  bins_through_gases = 501,
  bins = 502,
  heat_paths = 601,
  heat_left_out = 602,
  heat_limit = 603,
  heat_other_span = 604,
  heat_unused = 605,
  heat_points_displaced = 606,
  heat_points_unsettled = 607,
  import_unsupported = 701,
  import_more = 702,
  no_lookup_table = 801,
  no_map = 802,
  map_offset = 803,
  no_brightness_temperature = 804,
  page_of_other_run = 805,
  page_thinned = 806,
  tile_beyond_limit = 901,
  stopped = 902,
  rank_options = 903,
  renamed = 904,
};

struct DiagnosticKind {
  Dr code;
  Severity severity;      // info or warning: nothing here ends a run
  const char* condition;  // when it is reported, one clause
  const char* cure;       // what to do
};

// All kinds, by code.
std::span<const DiagnosticKind> diagnostic_kinds();
const DiagnosticKind& diagnostic_kind(Dr code);
std::string code_text(Dr code);               // "DR101"
Dr diagnostic_code(const std::string& text);  // Error with the nearest code where there is none of that name

// One of a run. text: a sentence with numbers; names the sensor where it is about one.
struct Diagnostic {
  Dr code;
  std::string text;
};
// "TEXT [DR101]" of each.
std::string line_of(const Diagnostic& diagnostic);
std::vector<std::string> lines_of(std::span<const Diagnostic> diagnostics);

// Prints it to standard error, as a warning or a note by its severity, with its code at the end, unless it is muted;
// and keeps it for render.json.
void emit(const Diagnostic& diagnostic);
// Leaves all of one kind out of the text from now on. They stay in render.json.
void mute(Dr code);
struct ReportedDiagnostic {
  Diagnostic diagnostic;
  bool muted = false;
};
// What this process has reported so far, in order.
std::vector<ReportedDiagnostic> reported_diagnostics();

// For `--list-diagnostics`: code, severity, condition and cure of each kind.
std::string diagnostics_text();

}  // namespace suite
