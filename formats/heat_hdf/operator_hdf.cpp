#include "formats/heat_hdf/operator_hdf.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <type_traits>

#include "base/files.h"
#include "formats/hdf5/format_version.h"
#include "formats/hdf5/h5.h"
#include "formats/heat_hdf/cut_hdf.h"

namespace suite {

namespace {

constexpr const char *kOperatorFormat = "suite heat operator", *kOperatorVersion = "6";
constexpr const char *kInfrared = "infrared", *kSunlight = "sunlight", *kStraight = "straight_sunlight";
constexpr float kMost = 1e9f;  // of any value; means of few points corrected by others (passing_edges.h) may be below 0
constexpr const char *kMirrored = "mirrored_places_endless_moving_unfinished",
                     *kByMirrors = "/sunlight/beam_by_mirrors";
constexpr const char* kRadius = "radius_rad_of_the_sun";
constexpr const char* kHint = "remove it to find the paths again, or write to another folder";

// The datasets of a part, each with its values a row, and the least that a value can be. What only faces have is
// shorter than the rows are.
template <class Exchange, class Visit>
requires std::is_same_v<std::remove_const_t<Exchange>, ExchangePaths>
void visit_all(Exchange& e, const Visit& visit) {
  const size_t each = size_t{e.blocks} * e.paths;
  visit("/infrared/end", "1", each, std::span(e.ends), 0.0f);
  visit("/infrared/weight", "1", each, std::span(e.weights), 0.0f);
  visit("/infrared/emissivity", "1", size_t{1}, std::span(e.emissivity), 0.0f);
  if (!e.rows.changing.empty()) visit("/infrared/changing", "1", size_t{1}, std::span(e.rows.changing), 0.0f);
}
// Rows in two bytes a number, so many a face.
template <class Rows, class Visit>
void visit_rows(const Visit& visit, const std::string& name, const char* units, size_t each, Rows& rows, float least) {
  visit(name, "1", each * rows.width(), rows.above(), 0.0f);
  visit(name + "_step", units, each, rows.steps(), 0.0f);
  visit(name + "_least", units, each, rows.least(), least);
}
// What is straight from the sun, to which what is scattered is added.
template <class Sun, class Visit>
void visit_straight(Sun& s, const Visit& visit) {
  visit_rows(visit, "/sunlight/beam", "1", 1, s.beam, -kMost);
  visit_rows(visit, "/sunlight/beam_of_block", "1", s.blocks, s.beam_of_block, -kMost);
  visit_rows(visit, "/sunlight/beam_spread", "1", Sunlight::kContrasts, s.beam_spread, -kMost);
  visit("/sunlight/sun_hours", "h", size_t{1}, std::span(s.sun_hours), 0.0f);
}
template <class Sun, class Visit>
requires std::is_same_v<std::remove_const_t<Sun>, Sunlight>
void visit_all(Sun& s, const Visit& visit) {
  visit_straight(s, visit);
  if (!s.rows.changing.empty()) visit("/sunlight/changing", "1", size_t{1}, std::span(s.rows.changing), 0.0f);
  visit_rows(visit, "/sunlight/sky", "sr", 1, s.sky, 0.0f);
  visit("/sunlight/below", "sr", size_t{1}, std::span(s.below), 0.0f);
  visit_rows(visit, "/sunlight/sky_of_block", "sr", s.blocks, s.sky_of_block, -kMost);
  visit("/sunlight/below_of_block", "sr", size_t{s.blocks}, std::span(s.below_of_block), -kMost);
  visit("/sunlight/absorptance", "1", size_t{1}, std::span(s.absorptance), 0.0f);
}

template <class Sun, class Visit>
void visit_mirrored(Sun& s, const Visit& visit) {
  if (s.beam_by_mirrors.rows() > 0) visit_rows(visit, kByMirrors, "1", 1, s.beam_by_mirrors, 0.0f);
}

// Of sunlight, what is found first, with what the rest is found by.
template <class Sun>
struct Straight {
  static constexpr size_t kTogether = Sunlight::kTogether;
  Sun& of;
};
PathCount& count_of(ExchangePaths& found) { return found.count; }
PathCount& count_of(Sunlight& found) { return found.count; }
PathCount& count_of(const Straight<Sunlight>& straight) { return straight.of.count; }
template <class Sun, class Visit>
void visit_all(const Straight<Sun>& straight, const Visit& visit) {
  auto& s = straight.of;
  visit_straight(s, visit);
  visit("/sunlight/lit", "1", s.faces() > 0 ? s.lit.size() / s.faces() : 0, std::span(s.lit), 0.0f);
}

const PathRows& rows_of(const ExchangePaths& found) { return found.rows; }
const PathRows& rows_of(const Sunlight& found) { return found.rows; }
template <class Sun>
const PathRows& rows_of(const Straight<Sun>& straight) {
  return straight.of.rows;
}
// The part of a range that a dataset has.
FaceRange range_in(size_t values, size_t width, FaceRange range) {
  const size_t rows = width > 0 ? values / width : 0;
  return {std::min(range.begin, rows), std::min(range.end, rows)};
}

const char* name_of(const ExchangePaths&) { return kInfrared; }
const char* name_of(const Sunlight&) { return kSunlight; }
template <class Sun>
const char* name_of(const Straight<Sun>&) {
  return kStraight;
}

void put_identity(h5::Writer& w, const OperatorIdentity& identity) {
  w.attribute("format", kOperatorFormat);
  w.attribute("version", kOperatorVersion);
  for (const auto& [name, text] : identity.scene) w.attribute("of_" + name, text);
}

// Halves of 32 bits are exact as doubles.
template <class Found>
void put(h5::Writer& w, const Found& found, FaceRange range, PathCount count, const std::string& sun) {
  const std::string name = name_of(found);
  if (name != kInfrared) w.attribute("of_sun", sun);
  const auto high = [](uint64_t v) { return static_cast<double>(v >> 32); };
  const auto low = [](uint64_t v) { return static_cast<double>(v & 0xffffffff); };
  const double numbers[6] = {
      static_cast<double>(range.begin), static_cast<double>(range.end), high(count.rays), low(count.rays),
      high(count.unfinished),           low(count.unfinished)};
  w.attribute(name + "_begin_end_rays_unfinished", numbers);
  visit_all(found, [&](const std::string& dataset, const char* units, size_t width, auto values, float) {
    using Value = typename decltype(values)::value_type;
    const FaceRange part = range_in(values.size(), width, range);
    if (part.size() > 0 || range.size() == 0)
      w.put(dataset, std::span<const Value>(values).subspan(part.begin * width, part.size() * width), units, width);
  });
}

// Of a whole one: what mirrors add is found when all faces' paths are.
void put_mirrored(h5::Writer& w, const Sunlight& s) {
  const auto& m = s.mirrored;
  const double numbers[4] = {static_cast<double>(m.places), static_cast<double>(m.endless),
                             static_cast<double>(m.moving), m.unfinished};
  w.attribute(kMirrored, numbers);
  visit_mirrored(s, [&](const std::string& dataset, const char* units, size_t width, auto values, float) {
    using Value = typename decltype(values)::value_type;
    w.put(dataset, std::span<const Value>(values), units, width);
  });
}

// Of a whole one: for which days it serves.
void put_path(h5::Writer& w, const SunPath& path) {
  std::vector<double> towards;
  std::vector<float> beam;
  for (const Dir d : path.towards)
    for (int k = 0; k < 3; ++k) towards.push_back(d[k]);
  for (const auto& spectrum : path.beam) beam.insert(beam.end(), spectrum.begin(), spectrum.end());
  const double radius[1] = {path.angular_radius};
  w.attribute(kRadius, radius);
  w.put("/sun/moment", path.moments, "s");
  w.put("/sun/towards", towards, "1", 3);
  w.put("/sun/beam_spectrum", beam, "1", path.sky.size());
  w.put("/sun/sky_spectrum", path.sky, "1");
}

SunPath take_path(h5::Reader& r) {
  SunPath path;
  path.angular_radius = r.numbers(kRadius, 1)[0];
  path.moments = r.get<double>("/sun/moment", "s");
  path.sky = r.get<float>("/sun/sky_spectrum", "1");
  const auto n = static_cast<long long>(path.moments.size());
  const std::vector<double> towards = r.get<double>("/sun/towards", "1", 3, n);
  if (path.sky.empty()) r.fail("has a sky without a spectrum");
  const std::vector<float> beam = r.get<float>("/sun/beam_spectrum", "1", path.sky.size(), n);
  for (size_t k = 0; k < path.moments.size(); ++k) {
    const Dir d{towards[3 * k], towards[3 * k + 1], towards[3 * k + 2]};
    if (!(std::fabs(length(d) - 1) < 1e-6) || !std::isfinite(path.moments[k])) r.fail("has the sun where it cannot be");
    path.towards.push_back(d);
    const auto from = beam.begin() + static_cast<std::ptrdiff_t>(k * path.sky.size());
    path.beam.emplace_back(from, from + static_cast<std::ptrdiff_t>(path.sky.size()));
  }
  for (const std::vector<float>* spectrum : std::initializer_list<const std::vector<float>*>{&path.sky, &beam})
    for (const float share : *spectrum)
      if (!(share >= 0 && share <= 1)) r.fail(strf("has a spectrum with a share of %g", double{share}));
  return path;
}

void check_operator_kind(h5::Reader& r) {
  if (r.text("format") != kOperatorFormat) r.fail("holds no paths of a balance of heat");
  h5::check_version(r, kOperatorVersion);
}

// What is in a file of this kind and fits.
class Stored {
 public:
  Stored(const std::string& path, const OperatorIdentity& identity) : reader_(path, kHint), identity_(identity) {
    check_operator_kind(reader_);
    for (const auto& [name, text] : identity.scene)
      if (const std::string there = reader_.text("of_" + name); there != text)
        reader_.fail("was found with another " + name + " (" + there.substr(0, 60) + ", here " + text.substr(0, 60) +
                     ")");
  }
  bool same_sun() { return reader_.text("of_sun") == identity_.sun; }
  SunPath sun_path() { return take_path(reader_); }
  void check_sun() {
    if (!same_sun())
      reader_.fail("was found with the sun elsewhere: on another day, at another place or in other steps");
  }

  // The rows that it has.
  FaceRange range(const std::string& name) {
    const std::vector<double> v = counts(name);
    return {static_cast<size_t>(v[0]), static_cast<size_t>(v[1])};
  }
  // Adds to the counts.
  template <class Found>
  FaceRange read(Found&& into) {
    constexpr size_t kTogether = std::remove_cvref_t<Found>::kTogether;
    const std::string name = name_of(into);
    ends_ = identity_.ends;
    const std::vector<double> v = counts(name);
    const FaceRange range{static_cast<size_t>(v[0]), static_cast<size_t>(v[1])};
    const PathRows& rows = rows_of(into);
    const auto [first, last] = rows.alike(range.begin);
    const bool piece = range.end <= last && (range.begin - first) % kTogether == 0 &&
                       ((range.end - first) % kTogether == 0 || range.end == last);
    if (!(range.begin < range.end) || (!piece && range != FaceRange{0, rows.size()}))
      reader_.fail(strf("has faces %zu to %zu of %zu", range.begin, range.end, rows.size()));
    visit_all(into, [&](const std::string& dataset, const char* units, size_t width, auto values, float least) {
      take(dataset, units, width, range, values, least);
    });
    const auto whole = [](double high, double low) {
      return static_cast<uint64_t>(high) << 32 | static_cast<uint64_t>(low);
    };
    count_of(into) += {whole(v[2], v[3]), whole(v[4], v[5])};
    return range;
  }
  // Which faces see changes, and room for what they have.
  template <class Found>
  void read_changing(Found& into) {
    if (into.rows.changing.empty()) return;
    take(std::string("/") + name_of(into) + "/changing", "1", 1, {0, into.rows.faces}, std::span(into.rows.changing),
         0.0f);
    into.make_more();
  }
  void read_mirrored(Sunlight& into) {
    const std::vector<double> v = reader_.numbers(kMirrored, 4);
    for (const double n : v)
      if (!(n >= 0 && n <= 4294967295.0)) reader_.fail("counts what cannot be");
    into.mirrored = {static_cast<size_t>(v[0]), static_cast<size_t>(v[1]), static_cast<size_t>(v[2]), v[3]};
    if (!reader_.has(kByMirrors)) return;
    into.beam_by_mirrors = CompactRows(into.faces(), into.moments);
    visit_mirrored(into, [&](const std::string& dataset, const char* units, size_t width, auto values, float least) {
      take(dataset, units, width, {0, into.faces()}, values, least);
    });
  }
  [[noreturn]] void fail(const std::string& what) const { reader_.fail(what); }

 private:
  std::vector<double> counts(const std::string& name) {
    std::vector<double> v = reader_.numbers(name + "_begin_end_rays_unfinished", 6);
    for (const double n : v)
      if (!(n >= 0 && n <= 4294967295.0 && n == std::floor(n))) reader_.fail("counts what cannot be");
    return v;
  }
  template <class Value>
  void take(const std::string& dataset, const char* units, size_t width, FaceRange range, std::span<Value> values,
            float least) {
    range = range_in(values.size(), width, range);
    if (range.size() == 0) return;
    const auto opened = reader_.open(dataset, h5::native<Value>(), units, width, static_cast<long long>(range.size()));
    Value* to = &values[range.begin * width];
    reader_.read(dataset, opened, h5::native<Value>(), to, 0, opened.count);
    for (size_t k = 0; k < opened.count; ++k)
      if (!can_be(to[k], least)) reader_.fail(strf("%s holds %g", dataset.c_str(), static_cast<double>(to[k])));
  }
  bool can_be(uint32_t end, float) const { return end < ends_; }
  static bool can_be(uint8_t, float) { return true; }
  static bool can_be(uint16_t, float) { return true; }
  static bool can_be(float v, float least) { return v >= least && v <= kMost; }
  static bool can_be(double emissivity, float) { return emissivity >= 0 && emissivity <= 1; }

  mutable h5::Reader reader_;
  const OperatorIdentity identity_;
  size_t ends_ = 0;  // numbers of what paths may end at
};

class Folder final : public HeatPieces {
 public:
  Folder(std::string folder, OperatorIdentity identity, double seconds)
      : folder_(std::move(folder)), identity_(std::move(identity)), seconds_(seconds) {}
  std::vector<FaceRange> take(ExchangePaths& out, FaceRange of) override { return take_all(out, of); }
  std::vector<FaceRange> take(Sunlight& out, FaceRange of, SunStage stage) override {
    return stage == SunStage::straight ? take_all(Straight<Sunlight>{out}, of) : take_all(out, of);
  }
  void keep(const ExchangePaths& found, FaceRange range, PathCount count) override { put_one(found, range, count); }
  void keep(const Sunlight& found, SunStage stage, FaceRange range, PathCount count) override {
    stage == SunStage::straight ? put_one(Straight<const Sunlight>{found}, range, count) : put_one(found, range, count);
  }
  double seconds() const override { return seconds_; }

 private:
  std::string name_of_piece(const char* part, FaceRange range) const {
    return folder_ + strf("/%s_%010zu.h5", part, range.begin);
  }
  template <class Found>
  std::vector<FaceRange> take_all(Found&& out, FaceRange of) {
    std::vector<std::string> files;
    const std::string prefix = std::string(name_of(out)) + "_";
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, none))
      if (const std::string name = entry.path().filename(); name.starts_with(prefix) && name.ends_with(".h5"))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());  // by their first faces
    std::vector<FaceRange> there;
    for (const std::string& path : files) {
      Stored stored(path, identity_);
      if (prefix != std::string(kInfrared) + "_") stored.check_sun();
      const size_t first = stored.range(name_of(out)).begin;
      if (first < of.begin || (first >= of.end && of.begin == 0 && rows_of(out).intervals > 1)) continue;
      const FaceRange range = stored.read(out);
      if (!there.empty() && range.begin < there.back().end) stored.fail("has faces that another piece has, too");
      there.push_back(range);
    }
    return there;
  }
  template <class Found>
  void put_one(const Found& found, FaceRange range, PathCount count) {
    make_folder(folder_);
    const std::string path = name_of_piece(name_of(found), range);
    AtomicFile file(path);
    h5::Writer w(file.temporary(), path);
    put_identity(w, identity_);
    put(w, found, range, count, identity_.sun);
    w.close();
    file.commit();
  }
  std::string folder_;
  OperatorIdentity identity_;
  double seconds_;
};

}  // namespace

void write_operator(const std::string& path, const HeatOperator& found, const OperatorIdentity& identity,
                    const std::string& made_by) {
  AtomicFile file(path);
  h5::Writer w(file.temporary(), path);
  put_identity(w, identity);
  w.attribute("arguments", made_by);
  put(w, found.exchange, {0, found.exchange.rows.size()}, found.exchange.count, identity.sun);
  put(w, found.sun, {0, found.sun.rows.size()}, found.sun.count, identity.sun);
  put_mirrored(w, found.sun);
  put_path(w, identity.path);
  put_cut(w, identity.cut);
  w.close();
  file.commit();
}

struct StoredOperator::File : Stored {
  using Stored::Stored;
  template <class Found>
  void read_all(Found& into) {
    read_changing(into);
    if (read(into) != FaceRange{0, into.rows.size()}) fail("has not all faces");
  }
};

StoredOperator::StoredOperator(const std::string& path, const OperatorIdentity& identity)
    : file_(std::make_unique<File>(path, identity)) {}
StoredOperator::~StoredOperator() = default;
bool StoredOperator::same_sun() const { return file_->same_sun(); }
SunPath StoredOperator::sun_path() const { return file_->sun_path(); }
void StoredOperator::read(ExchangePaths& into) const { file_->read_all(into); }
void StoredOperator::read(Sunlight& into) const {
  file_->read_all(into);
  file_->read_mirrored(into);
}

HeatCut operator_cut(const std::string& path) {
  h5::Reader r(path, kHint);
  check_operator_kind(r);
  return take_cut(r);
}

std::unique_ptr<HeatPieces> pieces_in(const std::string& folder, const OperatorIdentity& identity, double seconds) {
  return std::make_unique<Folder>(folder, identity, seconds);
}

void remove_pieces(const std::string& folder) {
  std::error_code ignored;
  std::vector<std::filesystem::path> pieces;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename();
    // With what a killed one was writing: NAME.h5.part-...
    if (name.find(".h5") != std::string::npos &&
        (name.starts_with(kInfrared) || name.starts_with(kSunlight) || name.starts_with(kStraight)))
      pieces.push_back(entry.path());
  }
  for (const auto& piece : pieces) std::filesystem::remove(piece, ignored);
  std::filesystem::remove(folder, ignored);
}

}  // namespace suite
