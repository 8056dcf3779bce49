#include "header.h"

#include <charconv>
#include <limits>

#include "base/params.h"
#include "base/progress.h"

namespace suite {

namespace {

const char* name_of(sqt::Quantity q) {
  return q == sqt::Quantity::bsdf ? "bsdf" : q == sqt::Quantity::phase ? "phase" : "intensity";
}
const char* name_of(sqt::Domain d) { return d == sqt::Domain::hemisphere ? "hemisphere" : "sphere"; }

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double v : values) list.push(v);
  return list;
}

// The stored header again as JSON: provenance and error figures of the fit.
Json to_json(const Params& p) {
  switch (p.kind()) {
    case Params::Kind::map: {
      Json j = Json::object();
      for (const std::string& key : p.keys()) j.set(key, to_json(p.at(key)));
      return j;
    }
    case Params::Kind::list: {
      Json j = Json::array();
      for (const Params& item : p.items()) j.push(to_json(item));
      return j;
    }
    case Params::Kind::null:
      return Json(std::numeric_limits<double>::quiet_NaN());
    case Params::Kind::scalar:
      break;
  }
  const std::string text = p.as_text();
  if (text == "true" || text == "false") return Json(text == "true");
  double number = 0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  return code == std::errc() && stop == text.data() + text.size() ? Json(number) : Json(text);
}

// Which angles matrices stand at, how possible they are, and the degree to which the mirror direction polarises.
std::string mueller_text(const sqt::MuellerTable& table) {
  const sqt::HalfGrid& g = table.data().grid;
  const std::vector<double>& um = table.data().wavelength_um;
  std::string t = strf("  matrices   theta_h %zu, theta_d %zu, phi_d %zu angles, %g to %g um; least eigenvalue %.2g\n",
                       g.theta_h.size(), g.theta_d.size(), g.phi_d.size(), um.front(), um.back(), table.least());
  std::vector<Mueller> m(um.size());
  for (const double deg : {30.0, 55.0, 75.0}) {
    table.at(dir_from_angles(deg * kDegree, 0), dir_from_angles(deg * kDegree, kPi), m);
    t += strf("  m12/m11 %2.0f", deg);
    for (const Mueller& x : m) t += strf(" %.4f", x(0, 1));
    t += '\n';
  }
  return t;
}

}  // namespace

Json header_json(const SqtFile& file, const std::string& path) {
  const sqt::Bundle& bundle = *file.bundle;
  const sqt::Bundle::Info& i = bundle.info();
  Json j = Json::object();
  j.set("schema", "suite.sqt-header/1");
  j.set("file", path);
  j.set("bytes", file.bytes);
  j.set("version", file.version);
  j.set("name", i.function.name);
  j.set("source", i.function.source);
  j.set("quantity", name_of(i.function.quantity));
  j.set("domain", name_of(i.function.domain));
  j.set("isotropic", i.function.isotropic);
  j.set("bilateral", i.function.bilateral);
  j.set("method", i.method);
  j.set("frame", i.frame);
  j.set("wavelength_um", numbers(i.function.wavelength_um));
  Json names = Json::array();
  for (const std::string& n : i.function.channel_names) names.push(n);
  j.set("channel_names", std::move(names));
  j.set("magnitude_um", numbers(i.magnitude_um));
  Json views = Json::array();
  for (const sqt::Bundle::View& v : i.views) {
    Json one = Json::object();
    one.set("theta_deg", v.theta / kDegree);
    one.set("phi_deg", v.phi / kDegree);
    views.push(std::move(one));
  }
  j.set("views", std::move(views));
  j.set("max_order", i.max_order);
  j.set("leaves", i.leaves);
  j.set("has_delta", i.has_delta());
  j.set("has_matrices", i.mueller != nullptr);
  j.set("stored_header", to_json(Params::parse_text(file.header, path)));
  return j;
}

std::string header_text(const SqtFile& file, const std::string& path) {
  const sqt::Bundle& bundle = *file.bundle;
  const sqt::Bundle::Info& i = bundle.info();
  std::string t =
      strf("%s: %s, %s\n", path.c_str(), i.function.name.c_str(), human_bytes(static_cast<double>(file.bytes)).c_str());
  t += strf("  source     %s\n", i.function.source.c_str());
  t += strf("  quantity   %s over the %s, %s%s\n", name_of(i.function.quantity), name_of(i.function.domain),
            i.function.isotropic ? "isotropic" : "anisotropic",
            i.function.isotropic && i.function.bilateral ? ", bilateral" : "");
  t +=
      strf("  method     %s, cells in the %s frame, finest order %d\n", i.method.c_str(), i.frame.c_str(), i.max_order);
  t += strf("  channels   %zu: %g to %g um; totals at %zu wavelengths\n", i.function.wavelength_um.size(),
            i.function.wavelength_um.front(), i.function.wavelength_um.back(), i.magnitude_um.size());
  t += strf("  slices     %zu views, %.1f to %.1f deg\n", i.views.size(), i.views.front().theta / kDegree,
            i.views.back().theta / kDegree);
  t += strf("  leaves     %zu%s\n", i.leaves, i.has_delta() ? ", and a Dirac lobe" : "");
  if (i.mueller) t += mueller_text(*i.mueller);
  for (const double deg : {0.0, 45.0, 75.0}) {
    t += strf("  total %2.0f  ", deg);
    for (size_t c = 0; c < bundle.channels(); ++c)
      t += strf(" %.4f", bundle.total(dir_from_angles(deg * kDegree, 0), c));
    t += '\n';
  }
  return t;
}

}  // namespace suite
