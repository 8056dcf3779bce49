#include "formats/helios/survey.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/yaml_text.h"
#include "formats/helios/survey_parts.h"

namespace suite {

namespace helios {
namespace {

constexpr double kLight = 299792458;  // m/s
constexpr double kGround = 0.2;       // s, that motions go on behind a leg, for light on its way

// [x, y, z] of rotations about x, then y, then z.
std::string angles_text(const Quat& q) {
  const Vec3 x = rotate(q, {1, 0, 0}), y = rotate(q, {0, 1, 0}), z = rotate(q, {0, 0, 1});
  const double b = std::asin(std::clamp(-x.z, -1.0, 1.0));
  const bool upright = std::fabs(x.z) > 1 - 1e-12;  // about x and z alike: all of it about x
  const double a = upright ? std::atan2(-z.y, y.y) : std::atan2(y.z, z.z), c = upright ? 0 : std::atan2(x.y, x.x);
  return strf("[%.12g, %.12g, %.12g]", a / kDegree, b / kDegree, c / kDegree);
}

std::string offset_text(Vec3 v) { return strf("[%.12g, %.12g, %.12g]", v.x, v.y, v.z); }

class Maker {
 public:
  Maker(const HeliosSurveyFiles& files, const std::string& file) : files_(files), file_(file) {}
  HeliosSurvey run(const XmlElement& document);

 private:
  XmlElement asset(const XmlElement& at, const std::string& location, const char* kind);
  void add(const std::string& line, const Where& where) {
    made_.text.yaml += line + "\n";
    made_.text.origins.push_back(where);
  }
  void find(const Where& where, const std::string& text) { made_.findings.push_back({where, text}); }
  void add_leg(const SurveyLeg& leg, const SurveyLeg* next, size_t number);
  void add_sensor(const SurveyLeg& leg, const SurveyLeg* next, const SurveyChannel& channel, const std::string& name,
                  double seconds);
  std::string motion_of(const SurveyLeg& leg, const SurveyLeg* next, double seconds) const;
  std::string scanner_of(const SurveyLeg& leg, const SurveyChannel& channel);
  std::string mirror_of(const SurveyLeg& leg, double half);
  double stop_of(const SurveyLeg& leg) const;
  const HeliosSurveyFiles& files_;
  const std::string& file_;
  std::map<std::string, XmlElement> documents_;
  HeliosSurvey made_;
  SurveyScanner scanner_;
  SurveyPlatform platform_;
  double clock_ = 0;  // s
};

// The element of a location, FILE#ID or #ID.
XmlElement Maker::asset(const XmlElement& at, const std::string& location, const char* kind) {
  const size_t hash = location.find('#');
  const std::string name = hash == std::string::npos ? "" : location.substr(0, hash),
                    id = hash == std::string::npos ? location : location.substr(hash + 1);
  if (!documents_.contains(name)) {
    const HeliosSurveyFiles::Named named = files_.read(name);
    documents_.emplace(name, XmlElement::parse(named.text, named.path));
  }
  std::optional<XmlElement> found;
  documents_.at(name).each_child(kind, [&](const XmlElement& e) {
    if (!found && e.attribute("id").value_or("") == id) found = e;
  });
  if (!found)
    throw at.fault("there is no <" + std::string(kind) + " id=\"" + printable(id) + "\">",
                   "in " + (name.empty() ? file_ : name));
  return *found;
}

// s, that a leg takes.
double seconds_of(const SurveyLeg& leg, const SurveyLeg* next, bool moves, double head_most) {
  double seconds = 0;
  if (moves && next && leg.speed > 0) seconds = length(next->place - leg.place) / leg.speed;
  const double turn = std::min(std::fabs(leg.head_deg_s), head_most > 0 ? head_most : std::fabs(leg.head_deg_s));
  if (!moves && turn > 0) seconds = std::fabs(leg.head_stop_deg - leg.head_start_deg) / turn;
  return leg.seconds ? (seconds > 0 ? std::min(seconds, *leg.seconds) : *leg.seconds) : seconds;
}

std::string Maker::motion_of(const SurveyLeg& leg, const SurveyLeg* next, double seconds) const {
  const auto key = [](double t, Vec3 p, double heading) {
    return strf("{time_s: %.12g, position_m: ", t) + offset_text(p) + strf(", heading_deg: %.12g}", heading);
  };
  const bool moves = platform_.kind == SurveyPlatform::Kind::straight && next && leg.speed > 0;
  if (!moves) return "{kind: static, position_m: " + offset_text(leg.place) + "}";
  const Vec3 way = next->place - leg.place;
  const double heading = std::atan2(way.x, way.y) / kDegree;
  const Vec3 beyond = leg.place + normalized(way) * (leg.speed * (seconds + kGround));
  return "{kind: keyframes, keys: [" + key(clock_, leg.place, heading) + ", " +
         key(clock_ + seconds + kGround, beyond, heading) + "]}";
}

std::string Maker::mirror_of(const SurveyLeg& leg, double half) {
  const SurveyScanner& s = scanner_;
  if (s.optics == "oscillating") {
    double angle = half;
    if (angle * leg.scan_hz > s.scan_product) {
      angle = s.scan_product / leg.scan_hz;
      find(leg.where, strf("scanProduct limits the scan angle to %.6g degrees", angle));
    }
    return strf("{kind: triangle, half_angle_deg: %.12g, rate_hz: %.12g, turn_share: 0, phase_deg: -90}", angle,
                leg.scan_hz);
  }
  if (s.optics == "conic")
    return strf("{kind: palmer, mirror_tilt_deg: %.12g, rotation_hz: %.12g}", half / 2, leg.scan_hz);
  if (s.optics == "line") {
    find(leg.where, "fibres lie evenly about the middle (there half a fibre to one side)");
    return strf("{kind: fibre, fibres: %d, spacing_deg: %.12g, rate_hz: %.12g}", s.fibres, 2 * half / s.fibres,
                leg.pulse_hz);
  }
  const double most = std::min(s.effective_deg, half);
  return strf("{kind: sweep, half_angle_deg: %.12g, rate_hz: %.12g, from_deg: %.12g, to_deg: %.12g}", s.scan_angle_deg,
              leg.scan_hz, std::max(leg.low_deg.value_or(-most), -most), std::min(leg.high_deg.value_or(most), most));
}

std::string Maker::scanner_of(const SurveyLeg& leg, const SurveyChannel& channel) {
  const SurveyScanner& s = scanner_;
  if (s.optics != "risley") {
    const double half = leg.scan_angle_deg > 0 ? std::min(leg.scan_angle_deg, s.scan_angle_deg) : s.scan_angle_deg;
    return mirror_of(leg, half);
  }
  std::string text = "{kind: risley, prisms: [";
  for (size_t k = 0; k < s.prisms.size(); ++k) {
    const SurveyPrism& p = s.prisms[k];
    text +=
        (k ? ", " : "") + strf("{wedge_deg: %.12g, index: %.12g, rotation_hz: %.12g, phase_deg: 180, tilted: %s}",
                               std::fabs(p.wedge_deg), p.index, -p.rotation_hz, p.wedge_deg > 0 ? "first" : "second");
  }
  text += "]";
  // x right, y ahead, z up there are -y, -z and x here.
  if (const auto& b = channel.incident) text += ", incident: " + offset_text({b->z, -b->x, -b->y});
  return text + "}";
}

// m, where the gate ends.
double Maker::stop_of(const SurveyLeg& leg) const {
  if (scanner_.range_max_m) return *scanner_.range_max_m;
  constexpr double kFar = 2000, kSlant = 2;
  return std::max({std::min(kFar, kLight / (2 * leg.pulse_hz)), kSlant * leg.place.z, 2 * scanner_.range_min_m});
}

void Maker::add_sensor(const SurveyLeg& leg, const SurveyLeg* next, const SurveyChannel& channel,
                       const std::string& name, double seconds) {
  const SurveyScanner& s = scanner_;
  const Where& w = leg.where;
  // Their beams leave along y and swing about x; ours along -z, to x.
  const Quat to_ours = quat_about({0, 0, 1}, kPi / 2) * quat_about({0, 1, 0}, -kPi / 2);
  const double turn =
      s.head_deg_s_max > 0 ? std::clamp(leg.head_deg_s, -s.head_deg_s_max, s.head_deg_s_max) : leg.head_deg_s;
  std::string head;
  if (turn != 0 || leg.head_start_deg != 0) {
    const char* axis = std::fabs(s.head_axis.z) > 0.99   ? "vertical"
                       : std::fabs(s.head_axis.x) > 0.99 ? "along"
                                                         : "across";
    const double sign = s.head_axis.x + s.head_axis.y + s.head_axis.z < 0 ? -1 : 1;
    head = strf(", mount: {kind: line_scan, axis: %s, start_deg: %.12g, rate_deg_s: %.12g, start_s: %.12g}", axis,
                sign * leg.head_start_deg, sign * turn, clock_);
  }
  add("  - kind: lidar", w);
  add("    name: " + yaml_quoted(name), w);
  add("    motion: " + motion_of(leg, next, seconds), w);
  add("    attachments:", w);
  add("      - {offset_m: " + offset_text(platform_.mount.translation) +
          ", rotate_deg: " + angles_text(platform_.mount.rotation) + head + "}",
      w);
  add("      - {offset_m: " + offset_text(channel.origin.translation) +
          ", rotate_deg: " + angles_text(channel.origin.rotation) + "}",
      channel.where);
  add("      - {rotate_deg: " + angles_text(to_ours) + "}", w);
  add(strf("    tasks: [{start: %.12g, pulses: %.0f}]", clock_,
           std::max(1.0, std::ceil(seconds * leg.pulse_hz - 1e-6))),
      w);
  add(strf("    laser: {wavelength_um: %.12g, average_power_w: %.12g, rate_hz: %.12g, pulse: {kind: gaussian, fwhm_ns: "
           "%.12g}, beam: {kind: gaussian, "
           "full_angle_1_e2_mrad: %.12g}}",
           channel.wavelength_nm * 1e-3, s.power_w, leg.pulse_hz, s.pulse_ns, s.divergence_rad * 1e3),
      channel.where);
  add(strf("    receiver: {aperture_mm: %.12g, throughput: %.12g, field_of_view_mrad: %.12g}", s.aperture_m * 1e3,
           s.efficiency, std::max(2 * s.divergence_rad * 1e3, 1e-3)),
      w);
  add("    scanner: " + scanner_of(leg, channel), w);
  add(strf("    gate: {start_m: %.12g, stop_m: %.12g, bin_ns: %.12g}", s.range_min_m, stop_of(leg), s.bin_ns), w);
  add("    pulses_in_air: unfold", w);
  add("    orders: 1", w);
  add(strf("    detectors: [{kind: linear, name: returns, quantum_efficiency: 0.8, receiver_fwhm_ns: 1, "
           "step_ns: %.6g, amplifier_noise_e_per_ns: 10, returns: {by: gaussian, threshold_e_per_ns: 100%s}}]",
           std::max(0.25, s.pulse_ns / 8), s.most_returns > 0 ? strf(", most: %d", s.most_returns).c_str() : ""),
      w);
}

void Maker::add_leg(const SurveyLeg& leg, const SurveyLeg* next, size_t number) {
  const bool moves = platform_.kind == SurveyPlatform::Kind::straight && leg.speed > 0;
  const double seconds = seconds_of(leg, next, moves, scanner_.head_deg_s_max);
  if (leg.active && seconds > 0) {
    if (!(leg.pulse_hz > 0))
      throw Error(leg.where, "the leg has no pulseFreq_hz", "scannerSettings pulseFreq_hz=\"100000\"");
    for (const SurveyChannel& c : scanner_.channels)
      add_sensor(leg, next, c, strf("leg_%02zu", number) + (c.name.empty() ? "" : "_" + c.name.substr(0, 32)), seconds);
  } else if (leg.active && (next || !moves)) {
    find(leg.where, "the leg takes no time: nothing is measured on it");
  }
  clock_ += seconds;
}

HeliosSurvey Maker::run(const XmlElement& document) {
  documents_.emplace("", document);
  std::optional<XmlElement> survey;
  document.each_child("survey", [&](const XmlElement& e) {
    if (!survey) survey = e;
  });
  if (!survey) throw document.fault("there is no <survey>");
  Asked a(*survey);
  const auto named = [&](const char* what) {
    const auto location = a.text(what);
    if (!location)
      throw survey->fault("the survey names no " + std::string(what), std::string(what) + "=\"FILE.xml#ID\"");
    return *location;
  };
  const std::string scene = named("scene");
  for (const char* unneeded : {"name", "seed", "numRuns", "simSpeed"}) a.text(unneeded);
  scanner_ = read_scanner(asset(*survey, named("scanner"), "scanner"), made_.findings);
  for (const char* optics : {"oscillating", "rotating", "conic", "line", "risley", ""})
    if (!*optics)
      throw survey->fault("the scanner's optics are '" + printable(scanner_.optics) + "'",
                          "oscillating, rotating, conic, line or risley");
    else if (scanner_.optics == optics)
      break;
  platform_ = read_survey_platform(asset(*survey, named("platform"), "platform"), made_.findings);
  if (const auto f = a.child("FWFSettings")) {
    Asked w(*f);
    scanner_.bin_ns = w.number("binSize_ns", scanner_.bin_ns);
    w.text("beamSampleQuality");
    w.close(made_.findings);
  }
  std::vector<SurveyLeg> legs;
  for (const XmlElement& e : a.children("leg"))
    legs.push_back(read_leg(
        e, [&](const XmlElement& at, const char* kind) { return asset(at, *at.attribute("template"), kind); },
        made_.findings));
  a.close(made_.findings);
  find(survey->where(),
       strf("the field of view is taken as twice the beam's divergence, %.6g mrad", 2e3 * scanner_.divergence_rad));
  if (scanner_.quality != 1) find(survey->where(), "beamQualityFactor is in the divergence already");
  add("scene: " + yaml_quoted(files_.prepared(scene.substr(0, scene.find('#')))), survey->where());
  add("sensors:", survey->where());
  for (size_t k = 0; k < legs.size(); ++k) add_leg(legs[k], k + 1 < legs.size() ? &legs[k + 1] : nullptr, k);
  if (made_.text.origins.size() == 2) throw survey->fault("no leg of the survey measures anything");
  return std::move(made_);
}

}  // namespace
}  // namespace helios

HeliosSurvey parse_helios_survey(std::string_view text, const std::string& file, const HeliosSurveyFiles& files) {
  return helios::Maker(files, file).run(XmlElement::parse(text, file));
}

bool is_helios_survey(const std::string& path, std::string_view head) {
  return path.ends_with(".xml") && head.find("<survey") != std::string_view::npos;
}

}  // namespace suite
