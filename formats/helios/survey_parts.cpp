#include "formats/helios/survey_parts.h"

#include <cmath>

#include "base/number_text.h"

namespace suite::helios {

namespace {

double number_in(const XmlElement& e, const std::string& name, const std::string& text) {
  const auto value = number_of(text);
  if (!value || !(std::fabs(*value) <= kLargestNumber))
    throw e.fault(name + " = \"" + printable(text).substr(0, 40) + "\" is no number");
  return *value;
}

Vec3 read_vector(Asked& a) { return {a.number("x", 0), a.number("y", 0), a.number("z", 0)}; }

void read_prisms(Asked& a, SurveyScanner& s) {
  const double air = a.number("refrIndex_air", 1);
  for (const char* n : {"1", "2", "3"}) {
    const auto key = [&](const char* stem, const char* end) { return std::string(stem) + n + end; };
    const SurveyPrism p{a.number(key("angle", "_deg").c_str(), 0), a.number(key("refrIndex", "").c_str(), 1) / air,
                        a.number(key("rotorFreq", "_Hz").c_str(), 0)};
    if (std::fabs(p.wedge_deg) > 1e-6) s.prisms.push_back(p);
  }
}

void read_waveforms(const XmlElement& e, SurveyScanner& s, std::vector<HeliosFinding>& findings) {
  Asked a(e);
  s.bin_ns = a.number("binSize_ns", s.bin_ns);
  s.aperture_m = a.number("apertureDiameter_m", s.aperture_m);
  if (a.text("beamSampleQuality"))
    findings.push_back({e.where(), "beamSampleQuality is not needed: beams are sampled by paths"});
  a.close(findings);
}

SurveyChannel read_channel(const XmlElement& e, const SurveyChannel& base, SurveyScanner& s, size_t number,
                           std::vector<HeliosFinding>& findings) {
  Asked a(e);
  SurveyChannel c = base;
  c.where = e.where();
  c.name = a.text("id").value_or(strf("%zu", number));
  c.wavelength_nm = a.number("wavelength_nm", base.wavelength_nm);
  if (const auto origin = a.child("beamOrigin")) c.origin = read_origin(*origin, findings);
  if (const auto f = a.child("FWFSettings")) read_waveforms(*f, s, findings);
  if (const auto beam = a.child("incidentBeam")) {
    Asked b(*beam);
    c.incident = read_vector(b);
    b.close(findings);
    if (!(length(*c.incident) > 0)) throw beam->fault("the incident beam has no direction");
  }
  a.close(findings);
  return c;
}

void read_leg_scanner(Asked& a, SurveyLeg& leg) {
  leg.active = a.flag("active", leg.active);
  leg.pulse_hz = a.number("pulseFreq_hz", leg.pulse_hz);
  leg.scan_hz = a.number("scanFreq_hz", leg.scan_hz);
  leg.scan_angle_deg = a.number("scanAngle_deg", leg.scan_angle_deg);
  if (const auto v = a.find("verticalAngleMin_deg")) leg.low_deg = v;
  if (const auto v = a.find("verticalAngleMax_deg")) leg.high_deg = v;
  leg.head_start_deg = a.number("headRotateStart_deg", leg.head_start_deg);
  leg.head_stop_deg = a.number("headRotateStop_deg", leg.head_stop_deg);
  leg.head_deg_s = a.number("headRotatePerSec_deg", leg.head_deg_s);
  if (const auto v = a.find("max_duration")) leg.seconds = v;
  for (const char* unneeded : {"id", "name", "template", "trajectoryTimeInterval_s"}) a.text(unneeded);
}

void read_leg_platform(Asked& a, SurveyLeg& leg, std::vector<HeliosFinding>& findings) {
  if (a.text("trajectory"))
    throw a.element().fault("a platform that follows a file of poses is not read",
                            "give it as a motion of kind keyframes");
  leg.place = {a.number("x", leg.place.x), a.number("y", leg.place.y), a.number("z", leg.place.z)};
  leg.speed = a.number("movePerSec_m", leg.speed);
  if (a.flag("onGround", false))
    findings.push_back(
        {a.element().where(), "onGround: the ground is not looked for, z is taken as it is given (0 where it is not)"});
  for (const char* unneeded : {"id", "name", "template"}) a.text(unneeded);
}

}  // namespace

std::optional<std::string> Asked::text(const char* name) {
  attributes_.insert(name);
  return element_.attribute(name);
}

std::optional<double> Asked::find(const char* name) {
  const auto value = text(name);
  if (!value) return std::nullopt;
  return number_in(element_, name, *value);
}

bool Asked::flag(const char* name, bool otherwise) {
  const auto value = text(name);
  if (!value) return otherwise;
  if (*value != "true" && *value != "false" && *value != "1" && *value != "0")
    throw element_.fault(std::string(name) + " = \"" + printable(*value).substr(0, 40) +
                         "\" is neither true nor false");
  return *value == "true" || *value == "1";
}

std::optional<XmlElement> Asked::child(const char* name) {
  const std::vector<XmlElement> all = children(name);
  if (all.empty()) return std::nullopt;
  return all.front();
}

std::vector<XmlElement> Asked::children(const char* name) {
  children_.insert(name);
  std::vector<XmlElement> all;
  element_.each_child(name, [&](const XmlElement& e) { all.push_back(e); });
  return all;
}

void Asked::close(std::vector<HeliosFinding>& findings) const {
  element_.each_attribute([&](std::string_view name, std::string_view value) {
    if (!attributes_.contains(name))
      findings.push_back({element_.where(), "not used: " + std::string(name) + " = \"" +
                                                printable(std::string(value)).substr(0, 40) + "\""});
  });
  element_.each_child([&](const XmlElement& e) {
    if (!children_.contains(e.name())) findings.push_back({e.where(), "not used: <" + std::string(e.name()) + ">"});
  });
}

Pose read_origin(const XmlElement& e, std::vector<HeliosFinding>& findings) {
  Asked a(e);
  Pose pose{{}, read_vector(a)};
  const bool local = a.text("rotations").value_or("") == "local";
  for (const XmlElement& r : a.children("rot")) {
    Asked rot(r);
    const std::string axis = rot.text("axis").value_or("");
    const double angle = rot.number("angle_deg", 0) * kDegree;
    Dir about{1, 0, 0};
    if (axis == "y" || axis == "Y")
      about = {0, 1, 0};
    else if (axis == "z" || axis == "Z")
      about = {0, 0, 1};
    else if (axis != "x" && axis != "X")
      throw r.fault("axis = \"" + printable(axis).substr(0, 40) + "\"", "x, y or z");
    const Quat q = quat_about(about, angle);
    pose.rotation = local ? pose.rotation * q : q * pose.rotation;
    rot.close(findings);
  }
  a.close(findings);
  return pose;
}

SurveyScanner read_scanner(const XmlElement& e, std::vector<HeliosFinding>& findings) {
  Asked a(e);
  SurveyScanner s;
  s.optics = a.text("optics").value_or("");
  s.divergence_rad = a.number("beamDivergence_rad", s.divergence_rad);
  s.pulse_ns = a.number("pulseLength_ns", s.pulse_ns);
  s.power_w = a.number("averagePower_w", s.power_w);
  s.quality = a.number("beamQualityFactor", s.quality);
  s.efficiency = a.number("opticalEfficiency", s.efficiency);
  s.aperture_m = a.number("receiverDiameter_m", s.aperture_m);
  s.range_min_m = a.number("rangeMin_m", 0), s.range_max_m = a.find("rangeMax_m");
  s.scan_angle_deg = a.number("scanAngleMax_deg", 0);
  s.effective_deg = a.number("scanAngleEffectiveMax_deg", s.scan_angle_deg);
  s.scan_hz_min = a.number("scanFreqMin_Hz", 0), s.scan_hz_max = a.number("scanFreqMax_Hz", 0);
  s.scan_product = a.number("scanProduct", s.scan_product);
  s.head_deg_s_max = a.number("headRotatePerSecMax_deg", 0);
  s.fibres = static_cast<int>(a.number("numFibers", 1)), s.most_returns = static_cast<int>(a.number("maxNOR", 0));
  for (const char* unneeded : {"id", "name", "pulseFreqs_Hz"}) a.text(unneeded);
  if (s.optics == "risley") read_prisms(a, s);
  SurveyChannel only;
  only.where = e.where(), only.wavelength_nm = a.number("wavelength_nm", only.wavelength_nm);
  if (const auto origin = a.child("beamOrigin")) only.origin = read_origin(*origin, findings);
  if (const auto axis = a.child("headRotateAxis")) {
    Asked v(*axis);
    if (const Vec3 to = read_vector(v); length(to) > 0.1) s.head_axis = normalized(to);
    v.close(findings);
  }
  if (const auto f = a.child("FWFSettings")) read_waveforms(*f, s, findings);
  if (const auto channels = a.child("channels")) {
    Asked list(*channels);
    for (const XmlElement& c : list.children("channel"))
      s.channels.push_back(read_channel(c, only, s, s.channels.size(), findings));
    list.close(findings);
  }
  if (s.channels.empty()) s.channels.push_back(only);
  for (const char* noise : {"accuracy_m", "atmosphericVisibility_km", "receivedEnergyMin_W"})
    if (const auto value = a.text(noise))
      findings.push_back({e.where(), std::string(noise) + " = \"" + printable(*value).substr(0, 40) +
                                         "\" is not used: noise follows from detectors, and air from the simulation"});
  a.close(findings);
  return s;
}

SurveyPlatform read_survey_platform(const XmlElement& e, std::vector<HeliosFinding>& findings) {
  Asked a(e);
  SurveyPlatform p;
  const std::string type = a.text("type").value_or("static");
  if (type != "static") p.kind = SurveyPlatform::Kind::straight;
  if (type != "static" && type != "linearpath")
    findings.push_back({e.where(), "type = \"" + printable(type).substr(0, 40) +
                                       "\" moves from place to place in straight lines, upright"});
  for (const char* unneeded : {"id", "name"}) a.text(unneeded);
  if (const auto mount = a.child("scannerMount")) p.mount = read_origin(*mount, findings);
  a.close(findings);
  return p;
}

SurveyLeg read_leg(const XmlElement& e, const std::function<XmlElement(const XmlElement&, const char*)>& template_of,
                   std::vector<HeliosFinding>& findings) {
  Asked a(e);
  SurveyLeg leg;
  leg.where = e.where();
  a.text("stripId");
  const auto with_template = [&](const char* kind, const auto& read) {
    const auto settings = a.child(kind);
    if (!settings) return;
    if (settings->attribute("template")) {
      Asked base(template_of(*settings, kind));
      read(base);
      base.close(findings);
    }
    Asked own(*settings);
    read(own);
    own.close(findings);
  };
  with_template("platformSettings", [&](Asked& s) { read_leg_platform(s, leg, findings); });
  with_template("scannerSettings", [&](Asked& s) { read_leg_scanner(s, leg); });
  a.close(findings);
  return leg;
}

}  // namespace suite::helios
