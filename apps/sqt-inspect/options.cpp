#include "options.h"

#include <charconv>
#include <cmath>

#include "base/error.h"
#include "formats/measured/measured.h"

namespace suite {

AppInfo inspect_info() {
  return {"sqt-inspect",
          "Looks into a fitted scattering function (.sqt): header, checks, pictures, comparisons, single values.",
          "Angles of options are in degrees, wavelengths in um; directions point away from the surface.\n"
          "Inputs of --compare, recognised by content:\n" +
              measured_formats() +
              "Examples:\n"
              "  sqt-inspect satin.sqt\n"
              "  sqt-inspect satin.sqt --check\n"
              "  sqt-inspect satin.sqt --map satin.png --channel 1\n"
              "  sqt-inspect satin.sqt --map lobe.png --channel 1 --views 20,60 --zoom 20\n"
              "  sqt-inspect satin.sqt --compare satin_purple_rgb.bsdf --error-map error.png\n"
              "  sqt-inspect satin.sqt --eval 30,0,30,180,0.55\n"
              "  sqt-inspect satin.sqt --export satin.csv\n"
              "  sqt-inspect satin.sqt --export satin_for_mitsuba.bsdf --export-size 128\n"
              "Exit codes: 0 fine, 1 bad input or a failed check, 2 wrong usage, 3 a bug of ours."};
}

void declare_options(Cli& cli, InspectOptions& o) {
  cli.positional("file", o.file, "the .sqt file");
  cli.flag("--json", o.json, "print the header, the findings of --check or the figures of --compare as JSON");
  cli.flag("--check", o.check, "test values, energy, masses of cells, sampling (significance 1e-3), reciprocity");
  cli.option("--map", o.map, "picture of the cells over the values of several slices up to 80 deg", "PNG");
  cli.option("--panels", o.panels, "slices shown by --map, 1 to 24", "N");
  cli.option("--zoom", o.zoom, "--map shows what lies within this angle of the mirror direction; 0 = the hemisphere",
             "DEG");
  cli.flag("--no-edges", o.no_edges, "--map without the borders of the cells");
  cli.option("--view", o.view,
             "page with the lobes and cells of all stored view directions, to turn in a browser; needs nothing else",
             "FILE.html");
  cli.option("--slice", o.slice, "principal plane as a table", "CSV");
  cli.option("--plot", o.plot, "principal plane as a plot; with a comparison the data as dots beside it", "PNG");
  cli.option("--views", o.views,
             "view angles of --slice and --plot, deg, at most 6 (none given: 0,20,45,70); --map then shows the slices "
             "nearest to them",
             "DEG,...");
  cli.option("--compare", o.compare, "errors against a measured file", "INPUT");
  cli.option("--compare-model", o.compare_model, "errors against a scattering model", "NAME:PARAM=VALUE,...");
  cli.option("--pairs", o.pairs, "direction pairs of the comparison, 1000 to 100000000", "N");
  cli.option("--error-map", o.error_map, "with a comparison: picture of the errors", "PNG");
  cli.option("--sample", o.sample, "print N directions drawn for --out in --channel as CSV", "N");
  cli.option("--seed", o.seed, "seed of --sample", "N");
  cli.option("--out", o.out, "outgoing direction of --sample: zenith,azimuth, deg", "DEG,DEG");
  cli.option("--eval", o.eval, "print f, w = f |cos in|, density and total for one pair of directions",
             "THETA_O,PHI_O,THETA_I,PHI_I,UM");
  cli.option("--sphere", o.sphere, "preview of a sphere under sun and sky", "PNG");
  cli.option("--export", o.export_to,
             "write it for others: .csv (angles and values), .raw (raw sample text), .bsdf (Mitsuba's measured), .xml "
             "(Radiance's tensor tree, one --channel)",
             "FILE");
  cli.option("--export-size", o.export_size,
             "of --export: steps from pole to horizon of .csv and .raw (18), side of the tables of .bsdf (64 or as "
             "many more as "
             "keep the error, to 512), thousands of leaves of .xml at most (60000)",
             "N");
  cli.option("--export-error", o.export_error,
             "of .bsdf and .xml: relative L1 to the fit that they are to keep, 0.0001 to 1 (none given: what the fit "
             "states of itself)",
             "E");
  cli.option("--size", o.size, "pixels of --sphere and of a slice of --map, 16 to 4096", "N");
  cli.option("--channel", o.channel, "channel of --map, --plot, --sample, --error-map and --export FILE.xml, from 0",
             "N");
}

std::vector<double> number_list(const std::string& option, const std::string& text, size_t least, size_t most) {
  std::vector<double> list;
  for (size_t at = 0; at <= text.size();) {
    const size_t end = std::min(text.find(',', at), text.size());
    double value = 0;
    const auto [stop, code] = std::from_chars(text.data() + at, text.data() + end, value);
    if (code != std::errc() || stop != text.data() + end || !std::isfinite(value))
      throw UsageError(strf("%s: '%s' is not a list of numbers", option.c_str(), text.c_str()));
    list.push_back(value);
    at = end + 1;
  }
  if (list.size() < least || list.size() > most)
    throw UsageError(least == most ? strf("%s takes %zu numbers", option.c_str(), least)
                                   : strf("%s takes %zu to %zu numbers", option.c_str(), least, most));
  return list;
}

}  // namespace suite
