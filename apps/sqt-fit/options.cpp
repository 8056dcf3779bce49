#include "options.h"

#include "formats/measured/measured.h"

namespace suite {

AppInfo sqt_fit_info() {
  return {
      "sqt-fit", "Fits a spherical quad-tree (.sqt) to a measured or modelled scattering function.",
      "Inputs, recognised by content:\n" + measured_formats() +
          "Models (--model): every scattering model of scenes and every phase function, e.g. lambert, oren_nayar, "
          "ward,\n"
          "  ggx, ggx_dielectric (both sides), rpv, ross_li, roujean, priest_germer, beard_maxwell, shell, mirror, "
          "hg:g=0.9, double_hg, rayleigh; one channel at "
          "0.55 um.\n"
          "  A tabulated phase function (Mie): tabulated:table=@FILE, or in place \"tabulated:table=0 9.1, 5 4.2, ... "
          "180 "
          "0.3\":\n"
          "  angles in deg from 0 (straight on) to 180 and values on any scale.\n"
          "  A wrong name or parameter is answered with those that exist. A lobe narrower than the finest cell becomes "
          "a\n"
          "  Dirac lobe, and the summary says so.\n"
          "Conventions:\n"
          "  units      values are BSDF in 1/sr; angles of files as their formats say; wavelengths in um\n"
          "  cosine     values carry no cosine; the weight that is integrated and sampled is value x |cos theta_in|\n"
          "  bins       a bin of a table stands for its centre; tables are looked up in the nearest bin\n"
          "  horizon    nothing at or below it; cells that it cuts carry the mass above it; RGL files are divided by "
          "the\n"
          "             cosine, clamped at 88 deg\n"
          "  views      0 to 89.9 deg; incident directions to the horizon\n"
          "  errors     --max-error is the cosine-weighted relative L1: sum |f'-f| cos / sum f cos, both angles "
          "uniform "
          "on\n"
          "             the hemisphere up to 80 deg, over all channels\n"
          "Examples:\n"
          "  sqt-fit satin.bsdf -o satin.sqt\n"
          "  sqt-fit gold.binary -o gold.sqt --max-error 0.05 --report gold.json\n"
          "  sqt-fit gold.binary -o gold.sqt --max-bytes 50000 --curve gold.csv\n"
          "  sqt-fit --model ward:diffuse=0.1,specular=0.2,roughness=0.15 -o ward.sqt\n"
          "  sqt-fit BRDFDatabase/brdfs -o merl.csv --fits merl\n"
          "  sqt-fit gold.binary -o old.sqt --method paper --order 6 --views 24 --threshold 0.2\n"
          "Exit codes: 0 written, 1 bad input or (--strict) a promise not kept, 2 wrong usage, 3 a bug of ours."};
}

void declare(Cli& cli, SqtFitOptions& o) {
  cli.positional("input", o.input, "file to fit, or a folder of them: a table of all (-o TABLE.csv)", false);
  cli.option("--model", o.model, "fit a scattering model instead of a file", "NAME:PARAM=VALUE,...");
  cli.option("-o,--output", o.output, "file to write; of a folder TABLE.csv: sizes, errors, seconds of its files",
             "FILE.sqt");
  cli.option("--fits", o.fits, "of a folder: where the .sqt of its files go; without it they are measured only",
             "FOLDER");
  cli.option("--method", o.method, "aligned, or paper (one tree a view and channel, for comparison)", "NAME");
  cli.flag("--swap", o.swap,
           "the data's incident direction is the viewer's (as Mitsuba and pbrt take .bsdf files), not the light's");
  cli.option("--order", o.order, "finest HEALPix order, 3-12 (paper: 1-8); 0 = 10, 12 where lobes need it (paper: 6)",
             "N");
  cli.option("--views", o.views, "view directions, 2-64; 0 = as many as the function's bends ask for (paper: 24)", "N");
  cli.option("--threshold", o.threshold,
             "paper: families whose values differ by at most this share of the slice's mean are consolidated", "X");
  cli.option("--max-error", o.max_error, "aligned: find the smallest file with at most this error", "E");
  cli.option("--max-bytes", o.max_bytes, "aligned: find the best fit of at most this size", "N");
  cli.option("--min-peak", o.min_peak,
             "aligned: lobes at view angles of 20, 45 and 70 deg reach at least this share of the data's, 0-1; 0 = no "
             "matter; without it 0.9, of phase functions 0.98",
             "P");
  cli.option("--mueller-error", o.mueller_error,
             "of Mueller matrices: leave out angles while the rms error of the elements over m11 is at most this; 0 = "
             "keep all",
             "E");
  cli.option("--report", o.report, "write sizes and errors as JSON", "FILE.json");
  cli.option(
      "--curve", o.curve,
      "sweep the quality (paper: the threshold): error against bytes and seconds, and plots beside it in FILE.html",
      "FILE.csv");
  cli.flag("--strict", o.strict, "unphysical input and promises that cannot be kept are errors");
}

}  // namespace suite
