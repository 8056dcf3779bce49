#include "options.h"

namespace suite {

AppInfo render_info() {
  return {"dirsig-render",
          "Renders what the sensors of a simulation measure in a prepared scene: spectral radiance in W/(m2 sr um), "
          "its standard error for "
          "every pixel and band, and truth.",
          "Output, for each sensor NAME, in the folder given with -o (ENVI, opens in GDAL, QGIS, ENVI):\n"
          "  NAME.img         radiance, one band per channel, with wavelengths and fwhm\n"
          "  NAME_error.img   standard error of the radiance, same bands\n"
          "  NAME_quality.img flags of every pixel, a sum of the bits that its header names\n"
          "  NAME_truth.img   material, instance, range, hit position (ENU), paths; NaN = nothing there\n"
          "  NAME.png         preview: three bands, or one with a bar (thermal ones in kelvin)\n"
          "  NAME_sun_hours.png, NAME_temperature.png, ...   of truth about warmth, with a bar\n"
          "  NAME_error_correlation.csv   correlation of the errors of the bands, which share paths\n"
          "and render.json    what was run: every capture with its paths, seconds and errors\n"
          "and what the sensor itself makes: NAME_dn.img, NAME_electrons.img, tables and logs as text.\n"
          "Of laser radars: NAME_response.h5, photons by arrival, and what detectors make of it in the folder NAME.\n"
          "The same seed gives the same bytes for any number of threads.\n\n"
          "Examples:\n"
          "  dirsig-render sim.yaml -o out/\n"
          "  dirsig-render sim.yaml -o quick/ --paths 8       a quick look\n"
          "  dirsig-render sim.yaml --set sensors.0.columns=64 --set sky=null    other values for one run\n"
          "  dirsig-render sim.yaml --target-error 1%          as many paths as each pixel needs\n"
          "  dirsig-render sim.yaml --time 10min               as many as there is time for\n"
          "  dirsig-render sim.yaml --paths 64 --state         ... and later, the same bits as with 128 at once:\n"
          "  dirsig-render sim.yaml --more 64\n"
          "  dirsig-render sim.yaml -o p2 --part 2/8 --state   one part of eight, and when all are there:\n"
          "  dirsig-render sim.yaml -o out --merge p1 p2 p3 p4 p5 p6 p7 p8\n"
          "  dirsig-render -o out --view out.html              a page to look at the finished results\n"
          "  dirsig-render sim.yaml --study study/             how error falls with run time\n"
          "  dirsig-render sim.yaml --dry-run                 what would be computed\n"
          "  dirsig-render --lidar-preset vlp_16              a laser radar to paste (apps/dirsig-render/LIDAR.md)\n"
          "  dirsig-render --detect response.h5 detector.yaml -o points    waveforms and points of laser pulses\n\n"
          "The text format is described in formats/sim_text/FORMAT.md. Exit codes: 0 fine, 1 bad input, 2 bad usage, 3 "
          "our bug."};
}

namespace {

void declare_parts(Cli& cli, RenderOptions& o) {
  cli.option("--part", o.part,
             "run only part K of N of the job, here or elsewhere, into a state of its own (with --state); no pictures",
             "K/N");
  cli.list("--merge", o.merge,
           "join the states of all parts, in these folders, and write what one run would have written; where targets "
           "want a second round, the plan for it",
           "FOLDER...");
  cli.option("--plan", o.plan, "second round: run the part of the plan that --merge left in this folder", "FOLDER");
}

// What is told instead of a picture.
void declare_questions(Cli& cli, RenderOptions& o) {
  cli.flag("--dry-run", o.dry_run,
           "print tasks, captures, states and the number of paths, refuse what a run would refuse, and stop");
  cli.option("--ranks", o.ranks,
             "with --dry-run: run a few blocks and forecast the seconds and the efficiency of the job on so many ranks",
             "N,N,...");
  cli.option("--link", o.link,
             "with --ranks: what ranks pay for talking, as bench/link_bench measures it: microseconds to fetch a block "
             "and for a message, GB/s of messages, GB/s at which results are taken",
             "F,M,R,T");
  cli.flag(
      "--air", o.air,
      "print the layers of real air (`atmosphere: {profile: ...}`) and, for each band, what they let through and the "
      "light at the ground, and stop; of a deck (.tp5, .ltn, tape5) in place of a simulation: its paths in our air");
  cli.option(
      "--air-lut", o.air_lut,
      "make a table for atmospheric correction of the simulation's real air and its sensor's bands over the grid "
      "in this text (formats/air_lut/FORMAT.md), write FOLDER/air_lut.nc (netCDF), air_lut.csv and, with "
      "`zarr: true`, air_lut.zarr, and stop; continues from what a stopped run has done",
      "GRID.yaml");
  cli.option("--against", o.against,
             "with --air and a deck: what the deck's own program wrote (tape7, .json), and the "
             "differences from it",
             "FILE");
  cli.option("--explain", o.explain, "say when a part of a scene is loaded and when it is left out, and stop",
             "FEATURE");
  cli.flag("--load-all", o.load_all, "load what no sensor can see, too, to compare; results agree to rounding");
  cli.flag("--list-sensors", o.list_sensors, "print the kinds of sensors and stop");
  cli.flag("--list-sources", o.list_sources, "print the kinds of light sources and stop");
  cli.option("--plugin", o.plugins, "shared library with a further kind of sensor; may be repeated", "FILE...");
  cli.flag("--list-detectors", o.list_detectors, "print the kinds of detectors of --detect and stop");
  cli.flag("--list-image-detectors", o.list_image_detectors, "print the kinds of detectors of images and stop");
  cli.flag("--list-deflectors", o.list_deflectors, "print the kinds of scanners of laser radars and stop");
  cli.flag("--lidar-presets", o.lidar_presets, "print the laser radars that are known by public numbers and stop");
  cli.option("--lidar-preset", o.lidar_preset,
             "print one of them as a text for `sensors:`, with the sources of its numbers, and stop", "NAME");
  cli.flag("--list-presets", o.list_presets, "print the sensors that are known by public numbers and stop");
  cli.option("--preset", o.preset,
             "print one of them as a text for `sensors:`, with the sources of its numbers, and stop; a sensor may name "
             "it, too: `{kind: platform, preset: NAME, ...}`, whose own keys take the place of the preset's",
             "NAME");
  cli.flag("--list-truth", o.list_truth, "print the kinds of truth and stop");
  cli.flag("--list-channels", o.list_channels, "print the parts of the light that images can hold and stop");
  cli.flag("--list-diagnostics", o.list_diagnostics, "print the code, condition and cure of every diagnostic and stop");
  cli.option("--mute", o.mute, "do not print diagnostics of this code; render.json has them all (repeatable)", "CODE");
  cli.flag("--list-models", o.list_models, "print the scattering models and their parameters and stop");
}

}  // namespace

namespace {

// Of simulations of DIRSIG.
void declare_import(Cli& cli, RenderOptions& o) {
  cli.option("--path", o.search,
             "of a simulation of DIRSIG: folder in which named files are also looked for (repeatable)", "DIR");
  cli.option(
      "--import-report", o.account,
      "of a simulation of DIRSIG: write what became of every element and key of its files, with its line, as JSON",
      "FILE.json");
  cli.option("--convert", o.convert,
             "of a simulation of DIRSIG: write it and its scenes as texts of ours, and the account, into this folder, "
             "and stop",
             "FOLDER");
  cli.flag("--strict", o.strict, "of a simulation of DIRSIG: refuse it when anything is left out, however harmless");
}

void declare_heat(Cli& cli, RenderOptions& o) {
  cli.option("--heat", o.heat,
             "take the temperatures of `heat:` from this file (heat.h5 of another run) instead of finding them",
             "FILE");
  cli.option(
      "--heat-operator", o.heat_operator,
      "take what paths found for `heat:` from this file (heat_operator.h5 of a run with 'heat: {keep: operator}'): "
      "other weather then needs no new rays",
      "FILE");
  cli.flag("--heat-only", o.heat_only, "find the temperatures of `heat:`, write FOLDER/heat.h5 and heat.csv, and stop");
}

void declare_detect(Cli& cli, RenderOptions& o) {
  cli.option("--detect", o.detect,
             "detect stored responses of laser pulses (.h5, or .bin of DIRSIG) with the detectors of the text that is "
             "given in place of a simulation (apps/dirsig-render/DETECTION.md), write points and waveforms into the "
             "folder of -o, and stop; nothing is traced",
             "FILE");
}

void declare_view(Cli& cli, RenderOptions& o) {
  cli.option("--view", o.view,
             "write a page to look at the results in a browser, which needs nothing else: of this run, or without a "
             "simulation of the finished ones in the folder of -o",
             "FILE.html");
  cli.option("--view-size", o.view_size,
             "room for the page (KiB, MiB, GiB; 256MiB unless given); of larger results it has every n-th pixel",
             "64MiB");
}

}  // namespace

void declare_render(Cli& cli, RenderOptions& o) {
  cli.positional(
      "simulation", o.simulation,
      "simulation text (YAML or JSON), or a simulation of DIRSIG (.sim, .jsim); with --detect the text of detectors",
      false);
  cli.option("-o,--output", o.output, "folder for the results; made when missing", "FOLDER");
  cli.option(
      "--set", o.settings,
      "a value in place of the text's, such as sensors.0.columns=64 or sun.direction={zenith_deg: 60, azimuth_deg: "
      "180}; items of lists by number (from 0) or name, values in YAML, null takes a key out; may be repeated",
      "PATH=VALUE");
  cli.option("--paths", o.paths,
             "paths per pixel instead of what the sensors ask for; MIN,MAX leaves room for a target", "N|MIN,MAX");
  cli.option(
      "--target-error", o.target_error,
      "relative standard error of radiance to reach, planned from a pilot without bias; a dolp_error of the text stays",
      "1%");
  cli.option("--target-floor", o.target_floor, "radiance, W/(m2 sr um), below which the error is judged absolutely",
             "L");
  cli.option("--target-bands", o.target_bands, "whose error decides: the band at the reference wavelength, or all",
             "reference|all");
  cli.option("--time", o.time,
             "time for the whole run, s, min or h; turned into a number of paths after the first pilot, and printed",
             "10min");
  cli.option("--stop", o.stop, "'plan' (unbiased) or 'change', the rule of the DIRSIG5 paper, for comparison",
             "plan|change");
  cli.option("--method", o.method,
             "'standard', or 'paper': the estimator of the DIRSIG5 paper as written, with its rule of stopping, for "
             "comparison",
             "standard|paper");
  cli.option("--cache-memory", o.kit_memory,
             "room for materials and lights that are kept for later captures (KiB, MiB, GiB; 1GiB unless given); with "
             "less they are rebuilt, results stay the same",
             "512MiB");
  cli.option(
      "--memory", o.memory,
      "room for the scene's tiles: the ray tracer's structures and the geometry under them (KiB, MiB, GiB); what "
      "is over is dropped and rebuilt, results stay the same",
      "8GiB");
  cli.flag("--state", o.state, "keep FOLDER/result.state.h5, from which the run can be continued");
  cli.flag("--resume", o.resume, "continue a run with --state that was interrupted");
  cli.option("--more", o.more,
             "continue a finished run with --state: N more paths per pixel (0 with a finer --target-error)", "N");
  declare_parts(cli, o);
  declare_heat(cli, o);
  cli.option("--study", o.study,
             "error against run time: many runs against a reference; writes study.csv, .json and .html there, and goes "
             "on from them",
             "FOLDER");
  cli.option("--study-budgets", o.study_budgets, "paths per pixel, or seconds (1s,2s,4s), of the study's runs",
             "N,N,...");
  cli.option("--study-seeds", o.study_seeds, "runs of the study at each budget", "N");
  cli.option("--reference", o.reference, "image that the study's runs are compared with, instead of a long run",
             "FILE");
  declare_view(cli, o);
  declare_detect(cli, o);
  cli.option("--seed", o.seed, "seed of the sample points instead of the simulation's", "N");
  declare_import(cli, o);
  declare_questions(cli, o);
}

}  // namespace suite
