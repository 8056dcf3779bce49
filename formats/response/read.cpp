#include <cmath>

#include "base/files.h"
#include "formats/hdf5/format_version.h"
#include "formats/hdf5/h5.h"
#include "formats/response/layout.h"
#include "formats/response/response_file.h"

namespace suite {

using namespace response_layout;

struct ResponseReader::Open {
  explicit Open(const std::string& path) : file(path, "render the pulses again") {}
  h5::Reader file;
  ResponseHead head;
  uint64_t pulses = 0;
  size_t blocks = 0;
  std::vector<uint64_t> first;  // pulse of each block, and the end
};

namespace {

size_t whole(const h5::Reader& r, double v, double most, const char* what) {
  if (!(v >= 0 && v <= most && v == std::floor(v))) r.fail(strf("has %g %s, 0 to %g are read", v, what, most));
  return static_cast<size_t>(v);
}

void take_place(h5::Reader& r, ResponseHead& head) {
  if (const std::string epoch = r.text("epoch"); !epoch.empty()) try {
      head.epoch = parse_iso8601(epoch);
      instant_from_utc(*head.epoch);
    } catch (const Error& e) {
      r.fail("has the epoch '" + printable(epoch) + "': " + e.message());
    }
  const std::string along = r.text("places_along"), origin = r.text("has_origin");
  if (along != "beam" && along != "pixel") r.fail("has places_along = '" + printable(along) + "'");
  head.along = along == "beam" ? PlacesAlong::beam : PlacesAlong::pixel;
  if (origin != "yes") return;
  const std::vector<double> at = r.numbers("origin_latitude_longitude_height", 3);
  head.origin = Geodetic{at[0], at[1], at[2]};
  try {
    check_geodetic(*head.origin);
  } catch (const Error& e) {
    r.fail("has an origin that is none: " + e.message());
  }
}

std::vector<Pose> take_poses(h5::Reader& r, size_t number, const char* place, const char* turn, long long pulses) {
  const std::vector<double> places = r.get<double>(in_block(number, place), "m", 3, pulses),
                            turns = r.get<double>(in_block(number, turn), "1", 4, pulses);
  std::vector<Pose> poses(places.size() / 3);
  for (size_t p = 0; p < poses.size(); ++p)
    poses[p] = {{turns[4 * p], turns[4 * p + 1], turns[4 * p + 2], turns[4 * p + 3]},
                {places[3 * p], places[3 * p + 1], places[3 * p + 2]}};
  return poses;
}

std::vector<ResponsePulse> take_pulses(h5::Reader& r, size_t number) {
  const std::vector<double> time = r.get<double>(in_block(number, "pulses/time"), "s");
  const auto n = static_cast<long long>(time.size());
  const std::vector<double> wavelength = r.get<double>(in_block(number, "pulses/wavelength"), "um", 1, n),
                            energy = r.get<double>(in_block(number, "pulses/energy"), "J", 1, n),
                            start = r.get<double>(in_block(number, "pulses/start"), "s", 1, n);
  const std::vector<Pose> out = take_poses(r, number, "pulses/emission_place", "pulses/emission_rotation", n),
                          in = take_poses(r, number, "pulses/reception_place", "pulses/reception_rotation", n);
  std::vector<ResponsePulse> pulses(time.size());
  for (size_t p = 0; p < pulses.size(); ++p) pulses[p] = {time[p], wavelength[p], energy[p], start[p], out[p], in[p]};
  return pulses;
}

}  // namespace

ResponseReader::ResponseReader(const std::string& path) : open_(std::make_unique<Open>(path)) {
  h5::Reader& r = open_->file;
  if (r.text("format") != kFormat) r.fail("holds no impulse responses of laser pulses");
  h5::check_version(r, kVersion);
  ResponseHead& head = open_->head;
  const std::vector<double> n = r.numbers(kBins, 8);
  head.bin = n[0];
  head.bins = static_cast<uint32_t>(whole(r, n[1], 1e8, "range bins"));
  head.columns = static_cast<uint32_t>(whole(r, n[2], 1e6, "columns"));
  head.rows = static_cast<uint32_t>(whole(r, n[3], 1e6, "rows"));
  head.group_index = n[4];
  head.epsg = static_cast<int>(whole(r, n[5], 999999, "as EPSG code"));
  open_->blocks = whole(r, n[6], 1e7, "blocks");
  open_->pulses = whole(r, n[7], 1e12, "pulses");
  if (r.has(kScrambles))
    head.scrambles = static_cast<int>(whole(r, r.get<double>(kScrambles, "1", 1, 2)[0], 64, "scrambles"));
  take_place(r, head);
  head.channels = r.get_names("/channels");
  const std::vector<double> pixels = r.get<double>("/pixels", "1", 3);
  head.pixels.clear();
  for (size_t p = 0; p + 2 < pixels.size(); p += 3) head.pixels.push_back({pixels[p], pixels[p + 1], pixels[p + 2]});
  if (const std::string wrong = fault_of(head); !wrong.empty()) r.fail("has " + wrong);
  uint64_t pulse = 0;
  for (size_t b = 0; b < open_->blocks; ++b) {
    open_->first.push_back(pulse);
    pulse += r.open(in_block(b, "pulses/time"), h5::native<double>(), "s", 1, -1).count;
  }
  open_->first.push_back(pulse);
  if (pulse != open_->pulses)
    r.fail(strf("has %llu pulses, %llu are declared", static_cast<unsigned long long>(pulse),
                static_cast<unsigned long long>(open_->pulses)));
}

ResponseReader::~ResponseReader() = default;
const ResponseHead& ResponseReader::head() const { return open_->head; }
std::optional<std::string> ResponseReader::unfinished() const {
  if (!open_->file.has(kUnfinished)) return std::nullopt;
  return open_->file.get_names(kUnfinished, 1)[0];
}
uint64_t ResponseReader::pulses() const { return open_->pulses; }
size_t ResponseReader::blocks() const { return open_->blocks; }

ResponseBlock ResponseReader::block(size_t number) const {
  SUITE_CHECK_LT(number, open_->blocks);
  h5::Reader& r = open_->file;
  ResponseBlock b;
  b.first_pulse = open_->first[number];
  b.pulses = take_pulses(r, number);
  const auto rows = static_cast<long long>(b.pulses.size() * open_->head.pixel_count());
  b.begin = r.get<uint64_t>(in_block(number, "rows/begin"), "1", 1, rows + 1);
  b.bound = r.get<double>(in_block(number, "rows/bound"), "photons", 1, rows);
  b.paths = r.get<uint64_t>(in_block(number, "rows/paths"), "1", 1, rows);
  b.bin = r.get<uint32_t>(in_block(number, "entries/bin"), "1");
  const auto entries = static_cast<long long>(b.bin.size());
  b.contributions = r.get<uint32_t>(in_block(number, "entries/contributions"), "1", 1, entries);
  b.value = r.get<double>(in_block(number, "entries/value"), "photons", open_->head.channels.size(), entries);
  b.variance = r.get<double>(in_block(number, "entries/variance"), "photons2", open_->head.channels.size(), entries);
  if (r.has(in_block(number, "entries/skewness")))
    b.skewness = r.get<float>(in_block(number, "entries/skewness"), "1", open_->head.channels.size(), entries);
  if (const std::string wrong = fault_of(open_->head, b); !wrong.empty()) r.fail(wrong);
  return b;
}

void ResponseReader::for_each_block(const std::function<void(const ResponseBlock&)>& visit) const {
  for (size_t b = 0; b < blocks(); ++b) visit(block(b));
}

}  // namespace suite
