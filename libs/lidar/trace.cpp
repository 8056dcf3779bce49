#include "lidar/trace.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "lidar/pulse_rows.h"
#include "scene/scene.h"
#include "surface/cut_out.h"

namespace suite {

namespace {

// FNV-1a: the same everywhere.
uint64_t key_of(const std::string& name) {
  uint64_t h = 0xcbf29ce484222325ull;
  for (const char c : name) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return h;
}

void check(const LidarInstrument& instrument) {
  if (const std::string wrong = fault_of(instrument); !wrong.empty())
    throw Error("lidar '" + instrument.name + "': " + wrong);
}

void check(const TraceOptions& options) {
  if (options.scrambles < 2 || options.scrambles > 64)
    throw Error(strf("%u scrambles for standard errors", options.scrambles), "2 to 64");
  suite::check(options.method);
  if (options.method.method != Method::standard)
    throw Error("pulses are traced by the standard estimator", "leave the method as it is");
  if (!options.method.explicit_sources)
    throw Error("without light sampling no pulse is found: laser and receiver are points",
                "leave out `light_sampling: off` of `techniques`");
}

bool laser_first(const LidarInstrument& i, const LaserBeam& beam, const ReceiverField& field) {
  if (polarised(i)) return false;
  if (i.start_from != StartFrom::automatic) return i.start_from == StartFrom::laser;
  return beam.solid_angle() < field.solid_angle();
}

// Channels of tags of placements and of materials. Error: neither has the name.
RangeSink::Tags tags_of(const LidarInstrument& instrument, const Tracer& tracer) {
  RangeSink::Tags tags;
  if (instrument.tags.empty()) return tags;
  const Scene& scene = tracer.scene();
  const auto channel = [&](const std::string& name) {
    const auto at = std::find(instrument.tags.begin(), instrument.tags.end(), name);
    return at == instrument.tags.end() ? size_t{0} : static_cast<size_t>(at - instrument.tags.begin()) + 2;
  };
  std::vector<std::string> names = scene.tags;
  for (const Material& m : scene.materials) names.push_back(m.id), tags.of_material.push_back(channel(m.id));
  for (const std::string& tag : instrument.tags)
    if (std::find(names.begin(), names.end(), tag) == names.end())
      throw Error("lidar '" + instrument.name + "': the scene has no tag and no material '" + tag + "'",
                  name_hint(tag, names));
  tags.of_object.assign(tracer.object_count(), 0);
  tracer.each(
      "surfaces with channels of a lidar", [](const TracedObject&) { return true; },
      [&](uint32_t o, const TracedObject& object) {
        if (object.tag != kNone) tags.of_object[o] = channel(scene.tags[object.tag]);
      });
  return tags;
}

// Of the whole train, whichever of its pulses are traced: from the emission of the first pulse to the end of the last
// one's gate; pulses without a beam do not count.
TimeSpan window_of(const LidarInstrument& instrument) {
  const uint64_t all = instrument.pulses->size();
  std::optional<ResponsePulse> begin, end;
  for (uint64_t at = 0; at < all && !begin; ++at) begin = instrument.pulses->pulse(at);
  for (uint64_t at = all; at > 0 && begin && !end; --at) end = instrument.pulses->pulse(at - 1);
  if (!begin || !end) return {};
  return {begin->time, end->time + end->start + instrument.gate.stop};
}

// Rows of a piece. Where matter scatters, every range bin of a row is filled, some hundred bytes each while it is
// traced.
size_t rows_at_once(const Scene& scene, const SourceSpecs& passive, const ResponseHead& head) {
  constexpr size_t kMost = 256, kBins = 200000;
  if (!uses_media(scene) && !passive.has_air()) return kMost;
  return std::clamp<size_t>(kBins / head.bins, 1, kMost);
}

class Tracing {
 public:
  Tracing(std::shared_ptr<const Scene> scene, const SourceSpecs& passive, const LidarInstrument& instrument,
          const TraceOptions& options, TimeSpan window)
      : scene_(std::move(scene)),
        window_(window),
        tracer_(scene_, std::nullopt, changes_in_time(*scene_) ? window : TimeSpan{}, cut_out(*scene_)),
        head_(response_head(*scene_, instrument, options)),
        passive_(passive),
        rows_at_once_(rows_at_once(*scene_, passive, head_)),
        plan_{tracer_,
              instrument,
              options,
              head_,
              LaserBeam(instrument.laser.beam),
              ReceiverField(instrument.receiver),
              false,
              polarised(instrument),
              tags_of(instrument, tracer_),
              key_of(instrument.name),
              head_.scrambles} {
    plan_.laser_first = laser_first(instrument, plan_.beam, plan_.field);
    resolve_sources(passive_, *scene_, window.begin);
  }

  void run(uint64_t first, uint64_t last, ResponseSink& sink, PulseReport& report);

 private:
  struct Piece {  // of a block
    RowRange range;
    ResponseBlock rows;
    PulseReport report;
  };
  std::vector<ResponseBlock> trace(uint64_t first, uint64_t last, PulseReport& report);
  void trace(Piece& piece);
  void bake(double wavelength_um);

  std::shared_ptr<const Scene> scene_;
  TimeSpan window_;
  Tracer tracer_;
  ResponseHead head_;
  SourceSpecs passive_;
  size_t rows_at_once_;
  TracePlan plan_;
  std::map<double, std::unique_ptr<const LineKit>> kits_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<PulseRows>> idle_;
};

void Tracing::bake(double wavelength_um) {
  constexpr size_t kMostLines = 64;
  auto& made = kits_[wavelength_um];
  if (made) return;
  if (kits_.size() > kMostLines)
    throw Error(strf("lidar '%s' has pulses of more than %zu wavelengths", plan_.instrument.name.c_str(), kMostLines));
  const LidarInstrument& i = plan_.instrument;
  made = std::make_unique<LineKit>(tracer_, passive_,
                                   LineKit::Line{wavelength_um, i.laser.width_um, i.receiver.filter_um}, window_);
}

void Tracing::trace(Piece& piece) {
  const LineKit& line = *kits_.at(piece.range.pulses[0].pulse.wavelength_um);
  std::unique_ptr<PulseRows> rows;
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(idle_.begin(), idle_.end(), [&](const auto& r) { return &r->kit() == &line; });
    if (found != idle_.end()) rows = std::move(*found), idle_.erase(found);
  }
  if (!rows) rows = std::make_unique<PulseRows>(plan_, line);
  rows->trace(piece.range, piece.rows, piece.report);
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(rows));
}

void append(const ResponseBlock& rows, ResponseBlock& block) {
  const uint64_t before = block.begin.back();
  for (size_t r = 1; r < rows.begin.size(); ++r) block.begin.push_back(before + rows.begin[r]);
  const auto add = [](const auto& from, auto& to) { to.insert(to.end(), from.begin(), from.end()); };
  add(rows.bound, block.bound), add(rows.paths, block.paths), add(rows.bin, block.bin);
  add(rows.contributions, block.contributions), add(rows.value, block.value), add(rows.variance, block.variance);
  add(rows.skewness, block.skewness);
}

// A difference to an even field may leave passive light below nothing by its error.
void clear_negative(ResponseBlock& block) {
  for (double& v : block.value) v = std::max(v, 0.0);
}

// Pulses before a number of the train at which a beam leaves.
uint64_t lit_before(const PulseTrain& train, uint64_t number) {
  uint64_t n = 0;
  for (uint64_t i = 0; i < number; ++i) n += train.pulse(i).has_value();
  return n;
}

void Tracing::run(uint64_t first, uint64_t last, ResponseSink& sink, PulseReport& report) {
  uint64_t number = lit_before(*plan_.instrument.pulses, first);
  // Pieces are the same however many threads take them, and start where they would for the whole train.
  constexpr uint64_t kPiecesAtOnce = 32;
  const uint64_t pixels = plan_.field.pixels(), pulses = std::max<uint64_t>(1, rows_at_once_ / pixels);
  for (uint64_t at = first; at < last;) {
    stop_point();
    const uint64_t end = std::min(last, (at / pulses + kPiecesAtOnce) * pulses);
    for (ResponseBlock& block : trace(at, end, report)) {
      clear_negative(block);
      for (size_t e = 0; e < block.entries(); ++e)
        if (block.bin[e] > 0)
          report.photons +=
              block.value[e * head_.channels.size() + kSingle] + block.value[e * head_.channels.size() + kMultiple];
      report.pulses += block.pulses.size();
      block.first_pulse = number, number += block.pulses.size();
      if (!block.pulses.empty()) sink.take(std::move(block));
    }
    if (plan_.options.progress) plan_.options.progress->add(static_cast<double>(end - at));
    at = end;
  }
  report.laser_first = plan_.laser_first;
  for (const auto& [um, line] : kits_)
    report.passive |= line->shines(), report.hot_spot |= line->any_leaves(), report.smooth |= line->any_smooth();
  if (report.met > 0) report.unknown_polarisation /= report.met;
  if (report.paths > 0) report.truncated /= static_cast<double>(report.paths);
}

std::vector<ResponseBlock> Tracing::trace(uint64_t first, uint64_t last, PulseReport& report) {
  std::vector<std::optional<PulseAtWork>> begun(last - first);
  parallel_for(0, begun.size(), 64, [&](size_t a, size_t b) {
    const FlushDenormals flush;
    TraceStatistics statistics;
    for (size_t i = a; i < b; ++i) begun[i] = begin_pulse(plan_.instrument, first + i, tracer_, statistics);
  });
  // Blocks: neighbours in number and line.
  const size_t pixels = plan_.field.pixels(), most = std::max<size_t>(1, rows_at_once_ / pixels);
  std::vector<std::vector<PulseAtWork>> groups;
  for (size_t i = 0; i < begun.size(); ++i) {
    if (!begun[i]) {
      ++report.dark;
      continue;
    }
    const bool next = !groups.empty() && groups.back().back().number + 1 == begun[i]->number &&
                      groups.back().back().pulse.wavelength_um == begun[i]->pulse.wavelength_um &&
                      begun[i]->number % most != 0;
    if (!next) groups.emplace_back();
    bake(begun[i]->pulse.wavelength_um);
    groups.back().push_back(std::move(*begun[i]));
  }
  std::vector<Piece> pieces;
  std::vector<size_t> block_of;
  const size_t step = plan_.laser_first ? pixels : std::min(pixels, rows_at_once_);
  for (size_t g = 0; g < groups.size(); ++g)
    for (size_t pixel = 0; pixel < pixels; pixel += step) {
      pieces.push_back({{groups[g], pixel, std::min(pixels, pixel + step)}, {}, {}});
      block_of.push_back(g);
    }
  parallel_for(0, pieces.size(), 1, [&](size_t a, size_t b) {
    for (size_t i = a; i < b; ++i) trace(pieces[i]);
  });
  std::vector<ResponseBlock> blocks(groups.size());
  for (size_t i = 0; i < pieces.size(); ++i) {
    append(pieces[i].rows, blocks[block_of[i]]);
    report.rows += pieces[i].report.rows, report.paths += pieces[i].report.paths;
    report.failures += pieces[i].report.failures, report.outside += pieces[i].report.outside;
    report.truncated += pieces[i].report.truncated;
    report.met += pieces[i].report.met, report.unknown_polarisation += pieces[i].report.unknown_polarisation;
  }
  for (size_t g = 0; g < groups.size(); ++g)
    for (PulseAtWork& p : groups[g]) blocks[g].pulses.push_back(std::move(p.pulse));
  return blocks;
}

}  // namespace

ResponseHead response_head(const Scene& scene, const LidarInstrument& instrument, const TraceOptions& options) {
  check(instrument);
  ResponseHead head;
  head.scrambles = static_cast<int>(std::min(options.scrambles, instrument.paths));
  head.bin = instrument.gate.bin;
  head.bins = static_cast<uint32_t>(
      std::max(1.0, std::ceil((instrument.gate.stop - instrument.gate.start) / instrument.gate.bin * (1 - 1e-12))));
  for (const std::string& tag : instrument.tags) head.channels.push_back("tag:" + tag);
  for (const Analyser a : instrument.receiver.analysers)
    head.channels.emplace_back(kAnalyserNames[static_cast<size_t>(a)]);
  const ReceiverField field(instrument.receiver);
  head.columns = field.columns(), head.rows = field.rows();
  head.pixels.clear();
  for (size_t pixel = 0; pixel < field.pixels(); ++pixel) head.pixels.push_back(field.middle(pixel));
  head.along = field.pixels() > 1 ? PlacesAlong::pixel : PlacesAlong::beam;
  head.epoch = instrument.epoch;
  if (scene.origin.given)
    head.origin = Geodetic{scene.origin.latitude_deg, scene.origin.longitude_deg, scene.origin.ellipsoid_height_m};
  return head;
}

PulseReport trace_pulses(const std::shared_ptr<const Scene>& scene, const SourceSpecs& passive,
                         const LidarInstrument& instrument, const TraceOptions& options, ResponseSink& sink) {
  check(instrument);
  check(options);
  SUITE_CHECK(instrument.pulses);
  const uint64_t all = instrument.pulses->size(), first = std::min(options.first, all),
                 last = first + std::min(options.count, all - first);
  PulseReport report;
  if (first == last) return report;
  Tracing(scene, passive, instrument, options, window_of(instrument)).run(first, last, sink, report);
  return report;
}

}  // namespace suite
