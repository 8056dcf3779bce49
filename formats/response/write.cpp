#include <cmath>
#include <filesystem>

#include "base/files.h"
#include "formats/hdf5/h5.h"
#include "formats/response/layout.h"
#include "formats/response/response_file.h"
#include "math/stats.h"

namespace suite {

using namespace response_layout;

struct ResponseWriter::Open {
  Open(const std::string& path, const ResponseHead& h, size_t entries)
      : head(h), file(path), writer(file.temporary(), path, [](const std::string&) { return 1; }), most(entries) {}
  void flush();
  void end();  // nothing more comes
  ResponseHead head;
  AtomicFile file;
  h5::Writer writer;
  size_t most;
  ResponseBlock kept;
  size_t blocks = 0;
  uint64_t pulses = 0;
};

namespace {

void put_poses(h5::Writer& w, size_t number, const char* place, const char* turn,
               const std::vector<ResponsePulse>& pulses, Pose ResponsePulse::*which) {
  std::vector<double> places, turns;
  for (const ResponsePulse& p : pulses) {
    const Pose& pose = p.*which;
    for (int k = 0; k < 3; ++k) places.push_back(pose.translation[k]);
    turns.insert(turns.end(), {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z});
  }
  w.put(in_block(number, place), places, "m", 3);
  w.put(in_block(number, turn), turns, "1", 4);
}

void put_pulses(h5::Writer& w, size_t number, const std::vector<ResponsePulse>& pulses) {
  std::vector<double> time, wavelength, energy, start;
  for (const ResponsePulse& p : pulses)
    time.push_back(p.time), wavelength.push_back(p.wavelength_um), energy.push_back(p.energy), start.push_back(p.start);
  w.put(in_block(number, "pulses/time"), time, "s");
  w.put(in_block(number, "pulses/wavelength"), wavelength, "um");
  w.put(in_block(number, "pulses/energy"), energy, "J");
  w.put(in_block(number, "pulses/start"), start, "s");
  put_poses(w, number, "pulses/emission_place", "pulses/emission_rotation", pulses, &ResponsePulse::emission);
  put_poses(w, number, "pulses/reception_place", "pulses/reception_rotation", pulses, &ResponsePulse::reception);
}

void put_block(h5::Writer& w, size_t number, const ResponseBlock& b, size_t channels) {
  put_pulses(w, number, b.pulses);
  w.put(in_block(number, "rows/begin"), b.begin, "1");
  w.put(in_block(number, "rows/bound"), b.bound, "photons");
  w.put(in_block(number, "rows/paths"), b.paths, "1");
  w.put(in_block(number, "entries/bin"), b.bin, "1");
  w.put(in_block(number, "entries/contributions"), b.contributions, "1");
  w.put(in_block(number, "entries/value"), b.value, "photons", channels);
  w.put(in_block(number, "entries/variance"), b.variance, "photons2", channels);
  if (!b.skewness.empty()) w.put(in_block(number, "entries/skewness"), b.skewness, "1", channels);
}

void append(ResponseBlock& to, ResponseBlock&& more) {
  if (to.pulses.empty()) {
    to = std::move(more);
    return;
  }
  const uint64_t before = to.entries();
  const auto add = [](auto& a, const auto& b) { a.insert(a.end(), b.begin(), b.end()); };
  for (size_t r = 1; r < more.begin.size(); ++r) to.begin.push_back(before + more.begin[r]);
  add(to.pulses, more.pulses), add(to.bound, more.bound), add(to.paths, more.paths), add(to.bin, more.bin);
  add(to.contributions, more.contributions), add(to.value, more.value), add(to.variance, more.variance);
  add(to.skewness, more.skewness);
}

}  // namespace

void ResponseWriter::Open::flush() {
  if (kept.pulses.empty()) return;
  put_block(writer, blocks++, kept, head.channels.size());
  kept = {};
}

ResponseWriter::ResponseWriter(const std::string& path, const ResponseHead& head, const std::string& made_by,
                               size_t block_entries)
    : open_(std::make_unique<Open>(path, head, block_entries)) {
  if (const std::string wrong = fault_of(head); !wrong.empty()) throw_bug(__FILE__, __LINE__, "fault_of(head)", wrong);
  h5::Writer& w = open_->writer;
  w.attribute("format", kFormat);
  w.attribute("version", kVersion);
  w.attribute("arguments", made_by);
  w.attribute("epoch", head.epoch ? to_iso8601(*head.epoch, 9) : std::string());
  w.attribute("places_along", head.along == PlacesAlong::beam ? "beam" : "pixel");
  if (head.origin) {
    const double place[3] = {head.origin->latitude_deg, head.origin->longitude_deg, head.origin->height_m};
    w.attribute("origin_latitude_longitude_height", place);
  }
  w.attribute("has_origin", head.origin ? "yes" : "no");
  w.put_names("/channels", head.channels);
  std::vector<double> pixels;
  for (const Dir& d : head.pixels) pixels.insert(pixels.end(), {d.x, d.y, d.z});
  w.put("/pixels", pixels, "1", 3);
  if (head.scrambles > 0)
    w.put(kScrambles,
          std::vector<double>{static_cast<double>(head.scrambles), student_t_quantile(0.95, head.scrambles - 1)}, "1");
}

ResponseWriter::~ResponseWriter() = default;

void ResponseWriter::take(ResponseBlock&& block) {
  if (const std::string wrong = fault_of(open_->head, block); !wrong.empty())
    throw_bug(__FILE__, __LINE__, "fault_of(head, block)", wrong);
  SUITE_CHECK_EQ(block.first_pulse, open_->pulses);
  open_->pulses += block.pulses.size();
  append(open_->kept, std::move(block));
  if (open_->kept.entries() >= open_->most || open_->kept.row_count() >= open_->most) open_->flush();
}

void ResponseWriter::Open::end() {
  Open& o = *this;
  o.flush();
  const double numbers[8] = {o.head.bin,
                             static_cast<double>(o.head.bins),
                             static_cast<double>(o.head.columns),
                             static_cast<double>(o.head.rows),
                             o.head.group_index,
                             static_cast<double>(o.head.epsg),
                             static_cast<double>(o.blocks),
                             static_cast<double>(o.pulses)};
  o.writer.attribute(kBins, numbers);
  o.writer.close();
}

void ResponseWriter::finish() {
  open_->end();
  open_->file.commit();
}

void ResponseWriter::leave(const std::string& path, const std::string& identity) {
  open_->writer.put_names(kUnfinished, {identity});
  open_->end();
  std::error_code failed;
  std::filesystem::rename(open_->file.temporary(), path, failed);
  if (failed) throw Error(Where{path, 0, 0, {}, -1}, "cannot be written: " + failed.message());
}

}  // namespace suite
