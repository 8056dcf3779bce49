// Reads the text of a platform; see SENSORS.md for the grammar.
#include <cmath>
#include <set>

#include "sensor/kinds/platform.h"

namespace suite {

namespace {

Vec2 pair_of(const Params& p, const char* what) {
  const std::vector<double> v = p.as_numbers();
  if (v.size() != 2) throw p.error(std::string(what) + " is two numbers: right, up");
  return {v[0], v[1]};
}

Readout read_readout(const Params& array) {
  Readout r;
  r.integration = array.number_in("integration_time_s", 0, 86400, "s", 0);
  const auto p = array.find("readout");
  if (p) {
    const std::string kind = p->text("kind");
    r.kind = static_cast<Readout::Kind>(p->at("kind").as_choice({"global", "rolling", "line", "whisk"}));
    if (r.kind == Readout::Kind::rolling) r.row_time = p->number_in("row_time_s", 0, 3600, "s");
    if (r.kind == Readout::Kind::line) r.line_period = 1 / p->number_in("line_rate_hz", 1e-6, 1e9, "Hz");
    if (r.kind == Readout::Kind::whisk) {
      r.line_period = 1 / p->number_in("scan_rate_hz", 1e-6, 1e9, "Hz");
      r.samples = static_cast<uint32_t>(p->integer("samples", 1, 1000000));
      r.sample_period = 1 / p->number_in("sample_rate_hz", 1e-6, 1e12, "Hz");
      if (r.samples * r.sample_period > r.line_period * (1 + 1e-9))
        throw p->error(strf("%u samples take %g s, a scan %g s", r.samples, r.samples * r.sample_period, r.line_period),
                       "raise sample_rate_hz or lower scan_rate_hz");
    }
    if (r.kind == Readout::Kind::line || r.kind == Readout::Kind::whisk)
      r.per_capture = static_cast<uint32_t>(p->integer("lines_per_capture", 1, 100000, 64));
  }
  const double longest = r.kind == Readout::Kind::line    ? r.line_period
                         : r.kind == Readout::Kind::whisk ? r.sample_period
                                                          : 86400;
  if (r.integration > longest * (1 + 1e-9))
    throw array.at("integration_time_s")
        .error(strf("the integration takes longer than the %g s from one sample to the next", longest));
  if (const auto tdi = array.find("tdi")) {
    if (r.kind != Readout::Kind::line)
      throw tdi->error("time delay and integration needs a line read-out", "readout: {kind: line, line_rate_hz: N}");
    r.stages = static_cast<uint32_t>(tdi->integer("stages", 1, 4096));
    const auto direction = tdi->find("direction");
    r.direction = direction && direction->as_choice({"down", "up"}) == 1 ? -1 : 1;
  }
  return r;
}

// Chips of an array, side by side in its image; the array itself when it lists none.
void read_chips(const Params& p, FocalArray& array, std::vector<std::optional<Params>>& own_bands) {
  const Vec2 shift = [&] {
    const auto o = p.find("offset_mm");
    return o ? pair_of(*o, "offset_mm") : Vec2{};
  }();
  auto add = [&](uint32_t columns, uint32_t rows, Vec2 at, double gain, std::optional<Params> bands) {
    array.chips.push_back(
        {columns, rows, {(shift.x + at.x) * 1e-3, -(shift.y + at.y) * 1e-3}, gain, {}, array.columns});
    array.columns += columns;
    array.rows = rows;
    own_bands.push_back(std::move(bands));
  };
  const bool line = array.readout.kind == Readout::Kind::line;
  const uint32_t rows = static_cast<uint32_t>(line ? p.integer("rows", 1, 100000, 1) : p.integer("rows", 1, 100000));
  if (line && rows != 1) throw p.at("rows").error("a line read-out has one row of detectors");
  const auto chips = p.find("chips");
  if (!chips) {
    const bool whisk = array.readout.kind == Readout::Kind::whisk;
    const uint32_t columns =
        static_cast<uint32_t>(whisk ? p.integer("columns", 1, 1, 1) : p.integer("columns", 1, 10000000));
    add(columns, rows, {}, 1, std::nullopt);
    return;
  }
  for (const Params& chip : chips->items()) {
    add(static_cast<uint32_t>(chip.integer("columns", 1, 1000000)), rows, pair_of(chip.at("offset_mm"), "offset_mm"),
        chip.number_in("gain", 1e-6, 1e6, "(relative response)", 1), chip.find("bands"));
    if (chip.has("paths")) array.chips.back().convergence = read_convergence(chip);
  }
  if (array.chips.empty()) throw chips->error("an array has at least one chip");
  if (array.readout.kind == Readout::Kind::whisk && array.columns != 1)
    throw chips->error("a whisk read-out has one column of detectors");
}

// Key `paths: {detector_noise: N}`: the share of the detector's noise that the standard error is to reach.
void read_noise_target(const Params& p, const PlatformSpec& spec, Segment& s) {
  const auto paths = p.find("paths");
  const auto share = paths && paths->kind() == Params::Kind::map ? paths->find("detector_noise") : std::nullopt;
  if (!share) return;
  const FocalArray& array = spec.arrays[s.array];
  for (const char* other : {"relative_error", "absolute_floor", "bands", "dolp_error"})
    if (paths->has(other))
      throw paths->at(other).error("the error is judged beside the detector's noise already",
                                   "detector_noise alone, or without it");
  if (!array.reader)
    throw share->error("there is no detector whose noise is known", "detector: {gain_e_per_dn: N, ...} in the array");
  if (array.time_bins > 1)
    throw share->error("parts of an exposure are not read out one by one", "leave out time_bins");
  for (size_t i = 0; i < s.chips; ++i)
    if (array.chips[s.first_chip + i].convergence)
      throw share->error("a chip of the array has `paths` of its own", "one of them");
  s.convergence.relative_error = share->as_number_in(1e-3, 10, "(share of the detector's noise)");
  s.detector_noise = detector_noise_of(spec, s);
}

// A target of the degree of polarisation is one for all chips of an array.
void check_chips_of_degree(const Params& p, const FocalArray& array, const Segment& s) {
  for (size_t i = s.first_chip; i < s.first_chip + s.chips; ++i) {
    if (!array.chips[i].convergence) continue;
    const Params own = p.at("chips")[i].at("paths");
    if (s.degree_target.error > 0 || (own.kind() == Params::Kind::map && own.has("dolp_error")))
      throw own.error("one target of the degree of polarisation holds for all chips",
                      "dolp_error in the `paths` of the array, and none of a chip's own");
  }
}

void add_segment(PlatformSpec& spec, size_t array_number, size_t first_chip, size_t chips, const Params& p,
                 const Params& bands, const SensorContext& context) {
  FocalArray& array = spec.arrays[array_number];
  const Lens& lens = spec.instruments[array.instrument].lens;
  Segment s;
  s.array = array_number, s.first_chip = first_chip, s.chips = chips;
  s.first_column = array.chips[first_chip].first_column;
  for (size_t i = 0; i < chips; ++i) s.columns += array.chips[first_chip + i].columns;
  if (array.readout.kind == Readout::Kind::whisk) s.columns = array.readout.samples;
  s.bands = read_bands(bands, context);
  s.radiance_bands = s.bands.size();
  s.convergence = read_convergence(p);
  s.band_targets = read_band_targets(p, s.bands, s.convergence);
  s.degree_target = read_degree_target(p, s.bands, s.convergence, s.band_targets);
  check_degree_target(s.degree_target, spec.channels, array.time_bins);
  check_chips_of_degree(p, array, s);
  check_mosaic(p, array, s.bands);
  if (!array.segments.empty() && s.radiance_bands != spec.segments[array.segments[0]].radiance_bands)
    throw bands.error("the chips of an array have the same number of bands");
  spec.states.push_back(read_state(p, s.bands));
  if (array.detector)
    for (size_t b = 0; b < s.radiance_bands; ++b) {
      double electrons = 0;
      try {
        s.bands.push_back(photon_band(s.bands[b], array.detector->quantum_efficiency, electrons));
      } catch (const Error& e) {
        throw p.at("detector").error(e.message(), "the quantum efficiency must cover every band");
      }
      s.electrons.push_back(electrons);
    }
  read_noise_target(p, spec, s);
  // An array may have a pattern of its own; else the instrument's holds.
  s.psf = read_psf(p.has("psf") ? p : spec.instruments[array.instrument].text, context, lens.f_number(),
                   lens.obscuration, spec.states.back());
  // Rays are drawn from the mixture of the bins' patterns: it must not have gaps.
  BinChoice& choice = spec.states.back().choice;
  if (choice.widest_um == 0 && s.psf && s.psf->with_bins(spec.states.back())) choice.widest_um = kDefaultStep;
  array.segments.push_back(spec.segments.size());
  spec.segments.push_back(std::move(s));
  try {
    noise_text(spec, spec.segments.back());
  } catch (const Error& e) {
    throw p.at("detector").error(e.message(), e.hint());
  }
}

// Chips are beside each other, and bad pixels in the image.
void check_parts(const FocalArray& array, const Params& p) {
  auto apart = [&](double a, double b, uint32_t m, uint32_t n, double pitch) {
    return std::fabs(a - b) >= 0.5 * (m + n) * pitch * (1 - 1e-9);
  };
  for (size_t i = 0; i < array.chips.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const Chip &a = array.chips[i], &b = array.chips[j];
      if (!apart(a.offset.x, b.offset.x, a.columns, b.columns, array.pitch.x) &&
          !apart(a.offset.y, b.offset.y, a.rows, b.rows, array.pitch.y))
        throw p.at("chips")[i].error(strf("chip %zu overlaps chip %zu in the focal plane", i + 1, j + 1),
                                     "give it another offset_mm, or an array of its own");
    }
  for (size_t i = 0; array.detector && i < array.detector->bad.size(); ++i)
    if (array.detector->bad[i][0] >= array.columns || array.detector->bad[i][1] >= array.rows)
      throw p.at("detector")
          .at("bad_pixels")[i]
          .error(strf("there is no detector [%u, %u]", array.detector->bad[i][0], array.detector->bad[i][1]),
                 strf("columns 0 to %u, rows 0 to %u", array.columns - 1, array.rows - 1));
}

// Every detector must see through the lens.
void check_lens(const FocalArray& array, const Lens& lens, const Params& p) {
  for (const Chip& chip : array.chips)
    for (const uint32_t c : {0u, chip.columns / 2, chip.columns - 1})
      for (const uint32_t r : {0u, chip.rows / 2, chip.rows - 1})
        for (const double e : {0.0, 1.0}) {
          const Vec2 at = place_of(array, chip.first_column + c, r, e, e).place;
          if (!lens.distortion.ideal({at.x / lens.focal_length, at.y / lens.focal_length}))
            throw p.error(
                strf("the lens distortion folds over at (%.3f, %.3f) mm of the focal plane", at.x * 1e3, at.y * 1e3),
                "use smaller coefficients or a smaller array");
        }
}

void read_array(const Params& p, size_t instrument, const std::string& image, PlatformSpec& spec,
                const SensorContext& context) {
  FocalArray array;
  array.instrument = instrument;
  array.image = image;
  array.readout = read_readout(p);
  array.wishes = spec.wishes;
  read_units(p, array.wishes);
  const Params pitch = p.at("pitch_um");
  const std::vector<double> size =
      pitch.kind() == Params::Kind::list ? pitch.as_numbers() : std::vector<double>(2, pitch.as_number());
  if (size.size() != 2 || !(size[0] >= 1e-3 && size[1] >= 1e-3 && size[0] <= 1e6 && size[1] <= 1e6))
    throw pitch.error("the pitch of a detector is 0.001 to 1e6 um, one number or two (right, up)");
  array.pitch = {size[0] * 1e-6, size[1] * 1e-6};
  if (const auto flip = p.find("flip"))
    for (const Params& f : flip->items())
      (f.as_choice({"columns", "rows"}) == 0 ? array.flip_columns : array.flip_rows) = true;
  std::vector<std::optional<Params>> own_bands;
  read_chips(p, array, own_bands);
  if (static_cast<double>(array.image_columns()) * array.rows > 4e9)
    throw p.error("an array of more than 4e9 detectors");
  array.time_bins = static_cast<uint32_t>(p.integer("time_bins", 1, 10000, 1));
  if (array.time_bins > 1 && array.readout.kind != Readout::Kind::global)
    throw p.at("time_bins").error("time bins need a global read-out");
  if (auto made = read_detector(p, context))
    array.detector = std::move(made->spec), array.reader = std::move(made->reader);
  read_array_analysers(p, spec, array);
  check_parts(array, p);
  const Lens& lens = spec.instruments[instrument].lens;
  if (array.detector && !(lens.aperture > 0))
    throw p.at("detector")
        .error("a detector needs to know how much light comes in", "give the instrument aperture_mm or f_number");
  if (array.detector && !(array.readout.integration > 0))
    throw p.at("detector").error("a detector needs an integration time", "integration_time_s: N");
  if (array.reader && array.reader->whole_frames() && (array.scans() || array.chips.size() > 1))
    throw p.at("detector")
        .error("light goes from pixel to pixel in this kind of detector, which wants whole frames",
               "readout: {kind: global} or rolling, and one chip");
  if (const std::string fault = array.reader ? array.reader->fault_of(array.pitch) : ""; !fault.empty())
    throw p.at("detector").error(fault, "a smaller phosphor: {blur_um}, or larger pixels");
  check_lens(array, lens, p);
  spec.arrays.push_back(std::move(array));
  const size_t number = spec.arrays.size() - 1, chips = own_bands.size();
  bool shared = true;
  for (const auto& b : own_bands) shared = shared && !b;
  if (shared) {
    add_segment(spec, number, 0, chips, p, p.at("bands"), context);
  } else {
    for (size_t i = 0; i < chips; ++i)
      add_segment(spec, number, i, 1, p, own_bands[i] ? *own_bands[i] : p.at("bands"), context);
  }
}

void read_instrument(const Params& p, const std::vector<Attachment>& carrier, PlatformSpec& spec,
                     const SensorContext& context, uint64_t seed) {
  const size_t number = spec.instruments.size();
  Instrument instrument{p.name("name", strf("instrument_%zu", number + 1)), {}, carrier, p, {}};
  for (const Instrument& other : spec.instruments)
    if (other.name == instrument.name)
      throw p.error("two instruments are named '" + instrument.name + "'", "give each its own name");
  instrument.chain.push_back(read_attachment(p, context, hash_of(seed, 1000 + number)));
  const auto kind = p.find("kind");
  if (kind && kind->as_choice({"camera", "log"}) == 1) {
    instrument.log_rate = p.number_in("rate_hz", 1e-6, 1e6, "Hz");
    spec.instruments.push_back(std::move(instrument));
    return;
  }
  instrument.lens = read_lens(p);
  if (const auto clock = p.find("clock")) {
    instrument.clock_rate = clock->number_in("rate_hz", 1e-6, 1e9, "Hz");
    instrument.clock_offset = clock->number_in("offset_s", 0, 1e9, "s", 0);
  }
  if (const auto trigger = p.find("trigger")) {
    if (instrument.clock_rate > 0) throw trigger->error("an instrument follows a clock or triggers");
    if (const auto times = trigger->find("times_s")) {
      instrument.triggers = times->as_numbers();
      if (instrument.triggers.empty()) throw times->error("no times: nothing would ever be taken");
    } else {
      instrument.trigger_distance = trigger->number_in("distance_m", 1e-6, 1e9, "m");
    }
  }
  spec.instruments.push_back(std::move(instrument));
  const Params list = p.at("arrays");
  std::set<std::string> names;
  for (const Params& array : list.items()) {
    const std::string own = array.name("name", strf("array_%zu", names.size() + 1));
    if (!names.insert(own).second) throw array.error("two arrays are named '" + own + "'", "give each its own name");
    read_array(array, number, list.items().size() > 1 ? own : "", spec, context);
  }
  if (names.empty()) throw list.error("an instrument has at least one array");
}

void read_carrier(const Params& p, const std::vector<Attachment>& chain, PlatformSpec& spec,
                  const SensorContext& context, uint64_t& seed, int depth) {
  if (depth > 32) throw p.error("attachments nested more than 32 deep");
  if (const auto list = p.find("instruments"))
    for (const Params& i : list->items()) read_instrument(i, chain, spec, context, seed);
  if (const auto list = p.find("attachments"))
    for (const Params& a : list->items()) {
      std::vector<Attachment> longer = chain;
      a.text("name", "");
      longer.push_back(read_attachment(a, context, seed = hash_of(seed, 1)));
      read_carrier(a, longer, spec, context, seed, depth + 1);
    }
}

}  // namespace

DetectorPlace place_of(const FocalArray& array, uint32_t column, uint32_t row, double u, double v) {
  size_t i = 0;
  while (i + 1 < array.chips.size() && column >= array.chips[i + 1].first_column) ++i;
  const Chip& chip = array.chips[i];
  double x = column - chip.first_column + u, y = row + v;
  if (array.flip_columns) x = chip.columns - x;
  if (array.flip_rows) y = chip.rows - y;
  return {
      {chip.offset.x + (x - 0.5 * chip.columns) * array.pitch.x, chip.offset.y + (y - 0.5 * chip.rows) * array.pitch.y},
      &chip};
}

PlatformSpec read_platform(const Params& params, const SensorContext& context) {
  PlatformSpec spec;
  spec.name = params.name("name", "platform");
  uint64_t seed = static_cast<uint64_t>(params.integer("seed", 0, 1LL << 53, 1));
  if (!context.track || !context.jitter || !context.time) throw params.error("motions cannot be read here");
  spec.track = context.track(params.at("motion"));
  if (const auto j = params.find("jitter")) {
    auto jitter = std::make_shared<Jitter>(context.jitter(*j, seed));
    if (!jitter->still()) spec.jitter = std::move(jitter);
  }
  spec.truth = read_truth(params);
  spec.wishes = read_wishes(params, spec.truth);
  spec.channels = read_channels(params);
  read_stokes(params, spec);
  read_carrier(params, {}, spec, context, seed, 0);
  for (const std::string& key : spec.instruments.empty() ? params.keys() : std::vector<std::string>{})
    if (const std::string near = nearest_name(key, std::vector<std::string>{"attachments", "instruments"});
        !near.empty() && !params.has(near))
      throw Error(params.where(key), "unknown key '" + key + "'", "did you mean '" + near + "'?");
  if (spec.instruments.empty()) throw params.error("a platform carries at least one instrument", "instruments: [...]");
  // Names of images: the platform's alone while there is only one.
  size_t cameras = 0;
  for (const Instrument& i : spec.instruments) cameras += i.log_rate > 0 ? 0 : 1;
  for (FocalArray& a : spec.arrays) {
    std::string image = spec.name;
    if (cameras > 1) image += "_" + spec.instruments[a.instrument].name;
    if (!a.image.empty()) image += "_" + a.image;
    a.image = image;
  }
  plan_captures(spec, params, context);
  choose_frame(params, spec);
  return spec;
}

}  // namespace suite
