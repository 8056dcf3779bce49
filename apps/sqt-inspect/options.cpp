#include "options.h"

namespace suite {

void declare_options(Cli& cli, InspectOptions& o) {
  cli.positional("file", o.file, "the .sqt file");
  cli.flag("--json", o.json, "print the header as JSON");
  cli.option("--map", o.map, "picture of the cells over the values of several slices", "PNG");
  cli.option("--channel", o.channel, "channel shown, from 0", "N");
  cli.option("--panels", o.panels, "slices shown by --map, 1 to 24", "N");
  cli.flag("--no-edges", o.no_edges, "--map without the borders of the cells");
}

}  // namespace suite
