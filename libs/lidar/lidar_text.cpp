#include "lidar/lidar_text.h"

#include <algorithm>
#include <cmath>

#include "base/required.h"
#include "lidar/pulse_train.h"
#include "light/light_rows.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kMostPulses = 1e9;  // of all tasks and channels

// What a user may mean by it differs by a factor of up to four.
void refuse_divergence(const Params& map) {
  for (const std::string& key : map.keys())
    if (key.find("divergence") != std::string::npos)
      throw Error(map.where(key), "'" + key + "' does not say which angle it is",
                  "beam: {kind: top_hat, half_angle_mrad: N} or {kind: gaussian, full_angle_1_e2_mrad: N}");
}

// One of two keys in different units.
double either(const Params& p, const char* a, double a_unit, const char* b, double b_unit, double low, double high) {
  if (p.has(a) && p.has(b)) throw p.at(b).error(strf("'%s' and '%s' exclude each other", a, b));
  if (p.has(b)) return p.number_in(b, low / b_unit, high / b_unit, "") * b_unit;
  if (!p.has(a)) throw p.error(strf("'%s' is missing", a), strf("%s: N or %s: N", a, b));
  return p.number_in(a, low / a_unit, high / a_unit, "") * a_unit;
}

// Keys offset_m and rotate_deg.
Pose read_place(const Params& p, const SensorContext& context) {
  const auto place = p.find("place");
  if (!place) return {};
  for (const char* key : {"mount", "jitter"})
    if (place->has(key)) throw place->at(key).error("a place has no '" + std::string(key) + "'", "attachments: [...]");
  return read_attachment(*place, context, 0).fixed;
}

BeamProfile read_image_beam(const Params& p, const SensorContext& context) {
  BeamProfile b;
  b.kind = BeamProfile::Kind::image;
  if (!context.image) throw p.error("pictures cannot be read here");
  const GreyImage image = context.image(p.at("file").as_path());
  b.columns = image.width, b.rows = image.height;
  double sum = 0;
  for (const float v : image.values) {
    if (!(v >= 0)) throw p.at("file").error("the image of a beam has negative or undefined values");
    b.image.push_back(v), sum += v;
  }
  if (!(sum > 0)) throw p.at("file").error("the image of a beam has no energy");
  b.cell = p.number_in("mrad_per_pixel", 1e-9, 100, "mrad") * 1e-3;
  return b;
}

BeamProfile read_beam(const Params& laser, double wavelength_um, const SensorContext& context) {
  const Params p = laser.at("beam");
  refuse_divergence(p);
  const std::vector<std::string> kinds{"top_hat", "gaussian", "image"};
  BeamProfile b;
  switch (required(p, "kind", kinds).as_choice(kinds)) {
    case 0:
      b.kind = BeamProfile::Kind::top_hat;
      b.half_angle = p.number_in("half_angle_mrad", 0, 1500, "mrad") * 1e-3;
      return b;
    case 2:
      return read_image_beam(p, context);
    default:
      break;
  }
  b.kind = BeamProfile::Kind::gaussian;
  b.waist = p.number_in("waist_mm", 0, 1e5, "mm", 0) * 1e-3;
  if (const auto angle = p.find("full_angle_1_e2_mrad")) {
    if (p.has("m2")) throw p.at("m2").error("'full_angle_1_e2_mrad' and 'm2' exclude each other", "drop one of them");
    b.full_angle_1_e2 = angle->as_number_in(0, 1500, "mrad") * 1e-3;
    return b;
  }
  if (!(b.waist > 0))
    throw p.error("'full_angle_1_e2_mrad' is missing", "full_angle_1_e2_mrad: N, or waist_mm: N (and m2: N)");
  // A Gaussian beam of beam quality M2: full angle 2 M2 wavelength / (pi waist).
  b.full_angle_1_e2 = 2 * p.number_in("m2", 1, 1000, "", 1) * wavelength_um * 1e-6 / (kPi * b.waist);
  return b;
}

LaserSpec read_laser(const Params& p, const SensorContext& context) {
  refuse_divergence(p);
  LaserSpec laser;
  laser.wavelength_um = p.number_in("wavelength_um", 0.1, 100, "um");
  laser.width_um = p.number_in("width_um", 1e-9, 0.1, "um", laser.width_um);
  laser.beam = read_beam(p, laser.wavelength_um, context);
  if (const auto s = p.find("stokes")) laser.stokes = read_stokes(*s);
  return laser;
}

LidarReceiver read_receiver(const Params& p) {
  LidarReceiver r;
  r.aperture = p.number_in("aperture_mm", 1e-3, 1e6, "mm") * 1e-3;
  r.obscuration = p.number_in("obscuration", 0, 0.999999, "(share of the aperture's area)", 0);
  r.throughput = p.number_in("throughput", 1e-12, 1, "", 1);
  r.filter_um = p.number_in("filter_nm", 1e-6, 1e4, "nm", 1) * 1e-3;
  if (const auto list = p.find("analysers"))
    for (const Params& a : list->items()) {
      const auto kind = static_cast<Analyser>(a.as_choice({kAnalyserNames.begin(), kAnalyserNames.end()}));
      if (std::ranges::find(r.analysers, kind) != r.analysers.end()) throw a.error("the analyser is there twice");
      r.analysers.push_back(kind);
    }
  const auto array = p.find("array");
  if (!array) {
    r.field_of_view = p.number_in("field_of_view_mrad", 1e-6, 2000, "mrad") * 1e-3;
    return r;
  }
  if (p.has("field_of_view_mrad"))
    throw p.at("field_of_view_mrad").error("'array' and 'field_of_view_mrad' exclude each other");
  r.columns = static_cast<uint32_t>(array->integer("columns", 1, 16384));
  r.rows = static_cast<uint32_t>(array->integer("rows", 1, 16384));
  r.pitch = array->number_in("pitch_um", 1e-3, 1e6, "um") * 1e-6;
  r.focal = array->number_in("focal_length_mm", 1e-3, 1e7, "mm") * 1e-3;
  return r;
}

RangeGate read_range_gate(const Params& sensor) {
  const Params p = sensor.at("gate");
  constexpr double kMetre = 2 / kSpeedOfLight, kNanosecond = 1e-9, kLatest = 10;  // s; of the way there and back
  RangeGate g;
  g.start = either(p, "start_m", kMetre, "start_ns", kNanosecond, 0, kLatest);
  g.stop = either(p, "stop_m", kMetre, "stop_ns", kNanosecond, 0, kLatest);
  g.bin = p.number_in("bin_ns", 1e-4, 1000, "ns", kDefaultRangeBin / kNanosecond) * kNanosecond;
  return g;
}

// motion, or position_m (as motions have it) and look_at_m.
TrackPtr read_way(const Params& p, const SensorContext& context) {
  if (!context.track || !context.position || !context.time) throw p.error("motions cannot be read here");
  if (const auto motion = p.find("motion")) {
    if (p.has("look_at_m")) throw p.at("look_at_m").error("'motion' and 'look_at_m' exclude each other");
    return context.track(*motion);
  }
  if (!p.has("look_at_m"))
    throw p.error("'motion' is missing", "motion: TRACK, or position_m and look_at_m: [e, n, u]");
  const auto [east, north, up] = p.at("look_at_m").as_vec3();
  const Vec3 from = context.position(p), to{east, north, up};
  if (!(length(to - from) > 0)) throw p.at("look_at_m").error("the laser radar looks at its own place");
  return pointed_track(static_track({{}, from}), {Pointing::look_at, static_track({{}, to}), nullptr});
}

LidarCarrier read_carrier(const Params& p, const SensorContext& context, uint64_t seed) {
  LidarCarrier c;
  c.track = read_way(p, context);
  if (const auto j = p.find("jitter")) {
    if (!context.jitter) throw j->error("jitter cannot be read here");
    auto jitter = std::make_shared<Jitter>(context.jitter(*j, seed));
    if (!jitter->still()) c.jitter = std::move(jitter);
  }
  if (const auto list = p.find("attachments"))
    for (const Params& a : list->items()) {
      if (c.chain.size() >= 32) throw a.error("more than 32 attachments");
      c.chain.push_back(read_attachment(a, context, seed + 1 + c.chain.size()));
    }
  return c;
}

PulseClock read_clock(const Params& sensor, const Params& laser, const SensorContext& context) {
  PulseClock c;
  c.rate = laser.number_in("rate_hz", 1e-6, 1e9, "Hz");
  if (const auto burst = laser.find("burst")) {
    c.burst = static_cast<uint32_t>(burst->integer("pulses", 1, 1000000));
    c.burst_rate = burst->number_in("rate_hz", 1e-6, 1e12, "Hz");
    if (c.burst / c.burst_rate > (1 + 1e-9) / c.rate)
      throw burst->error(
          strf("%u pulses at %g Hz take longer than the %g s between bursts", c.burst, c.burst_rate, 1 / c.rate),
          "raise the burst's rate_hz");
  }
  const Params list = sensor.at("tasks");
  for (const Params& p : list.items()) {
    PulseClock::Task t;
    t.begin = context.time(p.at("start"));
    if (const auto pulses = p.find("pulses")) {
      if (p.has("stop")) throw p.at("stop").error("'pulses' and 'stop' exclude each other");
      t.shots = static_cast<uint64_t>(pulses->as_integer(1, static_cast<long long>(kMostPulses)));
    } else {
      const double span = context.time(p.at("stop")) - t.begin;
      if (!(span >= 0)) throw p.at("stop").error("the task stops before it starts");
      if (!(span * c.rate < kMostPulses))
        throw p.at("stop").error(strf("%.3g pulses in one task", span * c.rate), "at most 1e9");
      // Up to but without the stop, so that tasks can follow each other.
      t.shots = std::max<uint64_t>(1, static_cast<uint64_t>(std::ceil(span * c.rate - 1e-6)));
    }
    if (!c.tasks.empty() && t.begin < c.end(c.tasks.back()) - 1e-6 / c.rate)
      throw p.error(
          strf("the task starts at %.9g s, before the last one ends at %.9g s", t.begin, c.end(c.tasks.back())),
          "tasks in the order of time, apart");
    c.tasks.push_back(t);
  }
  if (c.tasks.empty()) throw list.error("a laser radar has at least one task", "tasks: [{start: 0, stop: 1}]");
  return c;
}

void check_number(const TrainSpec& s, const Params& tasks) {
  double shots = 0;
  for (const PulseClock::Task& t : s.clock.tasks) shots += static_cast<double>(t.shots);
  const double all = shots * s.clock.burst * static_cast<double>(s.deflector->channels());
  if (all > kMostPulses) throw tasks.error(strf("%.4g pulses of all tasks and channels", all), "at most 1e9");
}

// Channels of one shot are over before the next one.
void check_channels(const TrainSpec& s, const Params& scanner) {
  const PulseClock& c = s.clock;
  const double room = c.burst > 1 ? 1 / c.burst_rate : 1 / c.rate;
  for (size_t k = 0; k < s.deflector->channels(); ++k)
    if (s.deflector->delay(k) >= room)
      throw scanner.error(strf("channel %zu fires %g s after the pulse, the next pulse comes after %g s", k,
                               s.deflector->delay(k), room),
                          "lower rate_hz, which counts shots of all channels");
}

// The motion must be known from the first pulse until the light of the last one is back.
void check_poses(const ClockedTrain& train, const RangeGate& gate, const Params& tasks) {
  const TrainSpec& s = train.spec();
  for (size_t k = 0; k < s.clock.tasks.size(); ++k) {
    const PulseClock::Task& task = s.clock.tasks[k];
    const double end = task.begin + static_cast<double>(task.shots - 1) / s.clock.rate + gate.stop;
    const auto check = [&](const LidarCarrier& c) {
      const TimeSpan known = c.covered();
      if (!(task.begin >= known.begin && end <= known.end))
        throw tasks.items()[k].error(
            strf("the task needs the motion from %.9g to %.9g s, and knows it from %.9g to %.9g s", task.begin, end,
                 known.begin, known.end),
            "shorten the task or extend the motion");
      for (int i = 0; i <= 16; ++i) {
        const double t = task.begin + (end - task.begin) * i / 16;
        Pose pose;
        try {
          pose = c.at(t);
        } catch (const Error& e) {
          throw tasks.items()[k].error(strf("no pose at %.9g s: %s", t, e.message().c_str()), e.hint());
        }
        if (!finite(pose.translation) || !finite(pose.vector({0, 0, 1})))
          throw tasks.items()[k].error(strf("the laser radar has no pose at %.9g s", t),
                                       "is a mount's target in its own place?");
      }
    };
    check(s.carrier);
    if (s.laser) check(*s.laser);
  }
}

// Light that the gate still takes when the next pulse has left: the detection folds it, or knows better.
void check_ambiguity(const Params& p, const ClockedTrain& train, const RangeGate& gate) {
  if (!p.has("detectors")) return;
  const bool heads = train.spec().deflector->channels() > 1;
  const auto how = p.find("pulses_in_air");
  if (heads && how && how->as_text() == "fold")
    throw how->error("light of several channels is not folded: each has a receiver of its own", "refuse or unfold");
  if (how && !(heads && how->as_text() == "refuse")) return;
  if (const double next = train.interval(); gate.stop > next * (1 + 1e-9))
    throw p.at("gate").error(
        strf("the gate ends %.6g ns after a pulse, the next one leaves after %.6g ns (unambiguous range %.6g m)",
             gate.stop * 1e9, next * 1e9, next * kSpeedOfLight / 2),
        "an earlier stop, a lower rate_hz, or pulses_in_air: fold, unfold, or (of one channel) refuse where light is "
        "late");
}

}  // namespace

bool is_lidar(const Params& sensor) {
  return sensor.kind() == Params::Kind::map && sensor.has("kind") && sensor.at("kind").kind() == Params::Kind::scalar &&
         sensor.at("kind").as_text() == "lidar";
}

LidarInstrument read_lidar(const Params& p, const SensorContext& context) {
  refuse_divergence(p);
  p.text("kind");
  LidarInstrument i;
  i.name = p.name("name", "lidar");
  const uint64_t seed = static_cast<uint64_t>(p.integer("seed", 0, 1LL << 53, 1));
  const Params laser = p.at("laser"), receiver = p.at("receiver");
  i.laser = read_laser(laser, context);
  i.receiver = read_receiver(receiver);
  i.gate = read_range_gate(p);
  TrainSpec s;
  s.clock = read_clock(p, laser, context);
  s.carrier = read_carrier(p, context, seed);
  if (laser.has("motion") || laser.has("look_at_m")) s.laser = read_carrier(laser, context, seed + 100);
  s.laser_place = read_place(laser, context), s.receiver_place = read_place(receiver, context);
  const auto scanner = p.find("scanner");
  s.deflector = scanner ? make_deflector(*scanner) : fixed_deflector_row().make(p);
  if (scanner) check_channels(s, *scanner);
  check_number(s, p.at("tasks"));
  s.scan_lag = receiver.boolean("scan_lag", false);
  if (laser.has("pulse_energy_j") && laser.has("average_power_w"))
    throw laser.at("average_power_w").error("'pulse_energy_j' and 'average_power_w' exclude each other");
  s.energy = laser.has("average_power_w")
                 ? laser.number_in("average_power_w", 1e-15, 1e9, "W") /
                       (s.clock.rate * s.clock.burst * static_cast<double>(s.deflector->channels()))
                 : laser.number_in("pulse_energy_j", 1e-18, 1e9, "J");
  s.wavelength_um = i.laser.wavelength_um, s.start = i.gate.start;
  const auto train = std::make_shared<ClockedTrain>(std::move(s));
  check_poses(*train, i.gate, p.at("tasks"));
  check_ambiguity(p, *train, i.gate);
  i.pulses = train;
  i.paths = static_cast<uint32_t>(p.integer("paths", 2, 1LL << 30, i.paths));
  i.orders = static_cast<uint32_t>(p.integer("orders", 1, 100000, i.orders));
  if (const auto from = p.find("start_from"))
    i.start_from = std::array{StartFrom::automatic, StartFrom::laser,
                              StartFrom::receiver}[from->as_choice({"auto", "laser", "receiver"})];
  if (const auto tags = p.find("tags"))
    for (const Params& tag : tags->items()) i.tags.push_back(tag.as_text());
  if (const std::string wrong = fault_of(i); !wrong.empty()) throw p.error("laser radar '" + i.name + "': " + wrong);
  i.detection = p;
  return i;
}

}  // namespace suite
