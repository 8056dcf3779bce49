// Laser radars at the border: pulses are traced as dirsig-render does, their responses stay in memory.
#include <algorithm>

#include "apps/in-process/border.h"
#include "apps/in-process/reading.h"
#include "apps/in-process/remote_scenes.h"
#include "base/diagnostics.h"
#include "base/renamed.h"
#include "lidar/pulse_train.h"
#include "lidar/trace.h"
#include "math/stats.h"
#include "scheduler/moments.h"

namespace suite {

namespace {

const SimulationLidar& lidar_of(const Simulation& sim, const char* name) {
  std::string all;
  for (const SimulationLidar& l : sim.lidars) {
    if (name ? l.instrument.name == name : sim.lidars.size() == 1) return l;
    all += (all.empty() ? "" : ", ") + l.instrument.name;
  }
  const Where where{sim.path, 0, 0, {}, -1};
  if (all.empty()) throw Error(where, "the simulation has no laser radar", "a sensor of `kind: lidar`");
  if (!name) throw Error(where, strf("the simulation has %zu laser radars", sim.lidars.size()), "name one of " + all);
  throw Error(where, "there is no laser radar '" + printable(name) + "'", "known: " + all);
}

}  // namespace

}  // namespace suite

struct rs_lidar {
  rs_lidar(const char* path, const char* name, std::vector<std::string>& messages)
      : sim(suite::simulation_of(path)), of(suite::lidar_of(sim, name)), scene(suite::scenes_of(sim)) {
    using namespace suite;
    for (const RenamedUse& use : take_renamed_uses()) messages.push_back(line_of({Dr::renamed, text_of(use)}));
    if (sim.periodic) throw Error(sim.periodic_where, kNoPeriodicLidar, kNoPeriodicLidarHint);
    const TimeSpan span = dynamic_cast<const ClockedTrain&>(*of.instrument.pulses).span();
    middle = 0.5 * (span.begin + span.end);
    check_motion(*scene, span.begin, span.end + of.instrument.gate.stop, of.where);
    head = response_head(*scene, of.instrument);
  }
  suite::Simulation sim;
  const suite::SimulationLidar& of;
  std::shared_ptr<suite::Scene> scene;
  suite::ResponseHead head;
  double middle;  // s, of the tasks
};

// All pulses of a call, one block.
struct rs_responses final : suite::ResponseSink {
  suite::ResponseHead head;
  suite::ResponseBlock block;
  std::vector<double> time, energy, wavelength_um, start, places[2], rotations[2];  // emission, reception
  void take(suite::ResponseBlock&& more) override;
  void lay_out();
};

// Pulses at which no beam leaves are left out, so the numbers of pulses may have gaps.
void rs_responses::take(suite::ResponseBlock&& more) {
  const uint64_t before = block.entries();
  const auto add = [](auto& a, const auto& b) { a.insert(a.end(), b.begin(), b.end()); };
  for (size_t r = 1; r < more.begin.size(); ++r) block.begin.push_back(before + more.begin[r]);
  add(block.pulses, more.pulses), add(block.bound, more.bound), add(block.paths, more.paths);
  add(block.bin, more.bin), add(block.contributions, more.contributions);
  add(block.value, more.value), add(block.variance, more.variance), add(block.skewness, more.skewness);
}

void rs_responses::lay_out() {
  for (const suite::ResponsePulse& p : block.pulses) {
    time.push_back(p.time), energy.push_back(p.energy), wavelength_um.push_back(p.wavelength_um);
    start.push_back(p.start);
    for (const int k : {0, 1}) {
      const suite::Pose& pose = k == 0 ? p.emission : p.reception;
      places[k].insert(places[k].end(), {pose.translation.x, pose.translation.y, pose.translation.z});
      rotations[k].insert(rotations[k].end(), {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z});
    }
  }
}

namespace suite {

namespace {

Handles<rs_lidar>& lidars() {
  static auto* const all = new Handles<rs_lidar>;  // never destroyed: threads may use it to the end of the process
  return *all;
}

Handles<rs_responses>& responses() {
  static auto* const all = new Handles<rs_responses>;
  return *all;
}

std::shared_ptr<const rs_responses> trace(const rs_lidar& lidar, uint64_t first, uint64_t count, uint32_t paths,
                                          uint64_t seed) {
  LidarInstrument instrument = lidar.of.instrument;
  if (paths) instrument.paths = paths;
  TraceOptions options;
  options.first = first, options.count = count, options.seed = seed;
  options.method = lidar.sim.pipeline;
  auto all = std::make_shared<rs_responses>();
  all->head = suite::response_head(*lidar.scene, instrument, options);
  SourcesInTime sources(lidar.sim.sources, *lidar.scene);
  trace_pulses(lidar.scene, sources.at(lidar.middle), instrument, options, *all);
  all->lay_out();
  return all;
}

}  // namespace

}  // namespace suite

using suite::at_border;
using suite::need;

int rs_lidar_open(const char* path, const char* sensor, rs_lidar** lidar) {
  return at_border([&](std::vector<std::string>& messages) {
    need(lidar, "lidar");
    *lidar = suite::lidars().add(std::make_shared<const rs_lidar>(path, sensor, messages));
  });
}

void rs_lidar_close(rs_lidar* lidar) { suite::lidars().close(lidar); }

void rs_lidar_describe(const rs_lidar* handle, rs_lidar_info* info) {
  *info = {};
  const auto lidar = suite::lidars().find(handle);
  if (!lidar) return;
  const suite::LidarInstrument& i = lidar->of.instrument;
  const suite::ResponseHead& h = lidar->head;
  *info = {i.pulses->size(), lidar->sim.pipeline.seed, i.paths, h.bins,       h.columns,
           h.rows,           h.channels.size(),        h.bin,   h.group_index};
}

const char* rs_lidar_channel(const rs_lidar* handle, size_t number) {
  const auto lidar = suite::lidars().find(handle);
  return lidar && number < lidar->head.channels.size() ? lidar->head.channels[number].c_str() : nullptr;
}

int rs_lidar_trace(const rs_lidar* handle, uint64_t first, uint64_t count, uint32_t paths, uint64_t seed,
                   rs_responses** traced) {
  return at_border([&](std::vector<std::string>&) {
    const auto lidar = suite::lidars().get(handle, "lidar");
    need(traced, "traced");
    if (seed > (uint64_t{1} << 53)) throw suite::Error("a seed above 2^53");
    if (paths == 1 || paths > (1u << 30)) throw suite::Error(suite::strf("%u paths", paths), "0, or 2 to 2^30");
    *traced = suite::responses().add(suite::trace(*lidar, first, count, paths, seed));
  });
}

void rs_responses_close(rs_responses* traced) { suite::responses().close(traced); }

void rs_responses_describe(const rs_responses* handle, rs_response_arrays* arrays) {
  *arrays = {};
  const auto of = suite::responses().find(handle);
  if (!of) return;
  const suite::ResponseBlock& b = of->block;
  *arrays = {b.pulses.size(),
             b.row_count(),
             b.entries(),
             of->time.data(),
             of->energy.data(),
             of->wavelength_um.data(),
             of->start.data(),
             of->places[0].data(),
             of->rotations[0].data(),
             of->places[1].data(),
             of->rotations[1].data(),
             b.begin.data(),
             b.bound.data(),
             b.paths.data(),
             b.bin.data(),
             b.contributions.data(),
             b.value.data(),
             b.variance.data(),
             b.skewness.data(),
             static_cast<double>(of->head.scrambles),
             suite::student_t_quantile(0.95, of->head.scrambles - 1)};
}
