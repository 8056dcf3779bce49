// What a survey of HELIOS++ names: the scanner, the platform, the legs. Internal to formats/helios.
//
// Based on: L. Winiwarter et al., "Virtual laser scanning with HELIOS++", Remote Sens. Environ. 269, 2022, and its
// public documentation and files (https://github.com/3dgeo-heidelberg/helios): names and units of attributes, their
// defaults, axes (x right, y ahead, z up; beams leave along y) and the order of rotations.
#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "formats/helios/survey.h"
#include "formats/xml/xml.h"
#include "math/dualquat.h"

namespace suite::helios {

// An element of which is known what has been asked for.
class Asked {
 public:
  explicit Asked(XmlElement e) : element_(std::move(e)) {}
  const XmlElement& element() const { return element_; }
  std::optional<std::string> text(const char* name);
  // Error: no number.
  std::optional<double> find(const char* name);
  double number(const char* name, double otherwise) { return find(name).value_or(otherwise); }
  bool flag(const char* name, bool otherwise);
  std::optional<XmlElement> child(const char* name);  // the first
  std::vector<XmlElement> children(const char* name);
  // A finding for each attribute and child element that nobody has asked for.
  void close(std::vector<HeliosFinding>& findings) const;

 private:
  XmlElement element_;
  std::set<std::string, std::less<>> attributes_, children_;
};

// Attributes x y z and <rot> elements.
Pose read_origin(const XmlElement& element, std::vector<HeliosFinding>& findings);

struct SurveyPrism {
  double wedge_deg = 0, index = 1, rotation_hz = 0;  // wedge: below 0 = its second face is tilted
};

struct SurveyChannel {
  std::string name;  // empty: the scanner's only one
  Pose origin;       // of the beam on the head
  double wavelength_nm = 1064;
  std::optional<Vec3> incident;  // into the prisms
  Where where;
};

struct SurveyScanner {
  std::string optics;
  double divergence_rad = 3e-4, pulse_ns = 4, power_w = 4, quality = 1, efficiency = 0.99, aperture_m = 0.15;
  double range_min_m = 0;
  std::optional<double> range_max_m;
  double scan_angle_deg = 0, effective_deg = 0, scan_hz_min = 0, scan_hz_max = 0, scan_product = 1e6;
  double head_deg_s_max = 0, bin_ns = 0.25;
  Vec3 head_axis{0, 0, 1};
  int fibres = 1, most_returns = 0;
  std::vector<SurveyPrism> prisms;
  std::vector<SurveyChannel> channels;  // at least one
};
SurveyScanner read_scanner(const XmlElement& element, std::vector<HeliosFinding>& findings);

struct SurveyPlatform {
  enum class Kind { still, straight } kind = Kind::still;
  Pose mount;
};
SurveyPlatform read_survey_platform(const XmlElement& element, std::vector<HeliosFinding>& findings);

struct SurveyLeg {
  Where where;
  Vec3 place;
  double speed = 70;  // m/s
  bool active = true;
  double pulse_hz = 0, scan_hz = 0, scan_angle_deg = 0;
  std::optional<double> low_deg, high_deg;  // vertical angles
  double head_start_deg = 0, head_stop_deg = 0, head_deg_s = 0;
  std::optional<double> seconds;  // at most
};
// template_of: the element that a template's location names.
SurveyLeg read_leg(const XmlElement& element,
                   const std::function<XmlElement(const XmlElement&, const char*)>& template_of,
                   std::vector<HeliosFinding>& findings);

}  // namespace suite::helios
