#include "run.h"

#include <cstdio>

#include "base/error.h"

#include "formats/sqt/sqt.h"
#include "header.h"
#include "map.h"

namespace suite {

namespace {

size_t chosen_channel(const InspectOptions& o, const sqt::Bundle& bundle) {
  if (o.channel < 0 || o.channel >= static_cast<long long>(bundle.channels()))
    throw UsageError(strf("--channel %lld: the file has channels 0 to %zu", o.channel, bundle.channels() - 1));
  return static_cast<size_t>(o.channel);
}

}  // namespace

int inspect(const Cli&, const InspectOptions& o) {
  const SqtFile file = read_sqt(o.file);
  const auto& bundle = file.bundle;
  const size_t channel = chosen_channel(o, *bundle);
  if (o.json)
    std::fputs(header_json(file, o.file).text().c_str(), stdout);
  else
    std::fputs(header_text(file, o.file).c_str(), stdout);
  if (!o.map.empty()) {
    if (o.panels < 1 || o.panels > 24) throw UsageError("--panels takes 1 to 24");
    MapOptions m;
    m.channel = channel;
    m.panels = static_cast<size_t>(o.panels);
    m.edges = !o.no_edges;
    write_png(o.map, draw_map(*bundle, bundle->info().function.name, m), command_line());
    note("wrote " + o.map);
  }
  return 0;
}

}  // namespace suite
