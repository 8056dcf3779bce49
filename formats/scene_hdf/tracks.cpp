// Motions as trees of numbers, depth first.
#include "formats/scene_hdf/internal.h"
#include "motion/track_record.h"

namespace suite {

namespace {

struct Rows {
  std::vector<uint8_t> kind;
  std::vector<uint32_t> parts;
  std::vector<uint64_t> count;
  std::vector<std::string> text;
};

void put(const TrackRecord& r, Rows& rows, std::vector<double>& numbers) {
  rows.kind.push_back(static_cast<uint8_t>(r.kind));
  rows.parts.push_back(static_cast<uint32_t>(r.parts.size()));
  rows.count.push_back(r.numbers.size());
  rows.text.push_back(r.text);
  numbers.insert(numbers.end(), r.numbers.begin(), r.numbers.end());
  for (const TrackRecord& part : r.parts) put(part, rows, numbers);
}

TrackRecord take(h5::Reader& r, const Rows& rows, size_t& at, Stretch<double>& numbers, int depth) {
  if (at >= rows.kind.size() || depth > 64) r.fail("a motion is cut off or nested too deeply");
  const size_t row = at++;
  if (rows.parts[row] > 2) r.fail("a motion has too many parts");
  TrackRecord made{static_cast<TrackRecord::Kind>(rows.kind[row]), numbers.next(rows.count[row]), rows.text[row], {}};
  for (uint32_t k = 0; k < rows.parts[row]; ++k) made.parts.push_back(take(r, rows, at, numbers, depth + 1));
  return made;
}

}  // namespace

void write_table(h5::Writer& w, const Scene& s, TrackTable) {
  Rows rows;
  std::vector<double> numbers;
  for (const SceneTrack& t : s.tracks) put(t.track->record(), rows, numbers);
  w.put_names("/tracks/name", pick(s.tracks, [](const SceneTrack& t) { return t.name; }));
  w.put("/track_nodes/kind", rows.kind, "1");
  w.put("/track_nodes/parts", rows.parts, "1");
  w.put("/track_nodes/count", rows.count, "1");
  w.put_names("/track_nodes/text", rows.text);
  w.put("/track_nodes/numbers", numbers, "SI");
}

void read_table(h5::Reader& r, Scene& s, Loading& loading, TrackTable) {
  Rows rows;
  const std::vector<std::string> names = r.get_names("/tracks/name");
  rows.text = r.get_names("/track_nodes/text");
  const auto n = static_cast<long long>(rows.text.size());
  rows.kind = r.get<uint8_t>("/track_nodes/kind", "1", 1, n);
  rows.parts = r.get<uint32_t>("/track_nodes/parts", "1", 1, n);
  rows.count = r.get<uint64_t>("/track_nodes/count", "1", 1, n);
  Stretch<double> numbers(r, "/track_nodes/numbers", "SI");
  size_t at = 0;
  for (const std::string& name : names) s.tracks.push_back({name, track_of(take(r, rows, at, numbers, 0))});
  if (at != rows.kind.size()) r.fail("there are motions of nothing");
  numbers.finish();
  LoadRow& row = loading.row("tracks");
  for (const uint64_t count : rows.count) row.stored += 8 * count;
  row.read = row.stored;
  row.why = "something moves";
}

}  // namespace suite
