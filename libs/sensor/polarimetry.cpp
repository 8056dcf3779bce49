#include "sensor/polarimetry.h"

#include <algorithm>
#include <cmath>

#include "sensor/analyser.h"
#include "sensor/sensors.h"

namespace suite {

namespace {

void read_components(const Params& stokes, std::vector<std::string>& add) {
  std::vector<std::string> names;
  if (stokes.kind() == Params::Kind::list) {
    for (const Params& item : stokes.items()) {
      static const std::vector<std::string> known{"i", "q", "u", "v"};
      names.push_back(known[item.as_choice(known)]);
      if (std::count(names.begin(), names.end(), names.back()) > 1)
        throw item.error("the component '" + names.back() + "' is listed twice");
    }
    if (std::find(names.begin(), names.end(), "i") == names.end())
      throw stokes.error("the intensity is missing", "give [i, q, u], [i, q, u, v] or linear");
  } else {
    stokes.as_choice({"linear"});
    names = {"i", "q", "u"};
  }
  for (const char* component : {"q", "u", "v"})
    if (std::find(names.begin(), names.end(), component) != names.end())
      add.push_back(std::string("stokes_") + component);
}

}  // namespace

std::optional<Polarimetry> read_polarimetry(const Params& params, std::vector<std::string>& channels) {
  const auto stokes = params.find("stokes"), analyser = params.find("analyser"), frame = params.find("stokes_frame");
  if (!stokes && !analyser) {
    if (frame) throw frame->error("nothing is measured in this frame", "give `stokes` or `analyser`, too");
    return std::nullopt;
  }
  Polarimetry how;
  std::vector<std::string> add;
  if (stokes) read_components(*stokes, add);
  add.push_back("depolarised");
  for (const std::string& name : add)
    if (std::find(channels.begin(), channels.end(), name) != channels.end())
      throw params.error("`stokes` has the channel '" + name + "' already");
  channels.insert(channels.begin() + 1, add.begin(), add.end());
  if (frame) how.frame = static_cast<StokesFrame>(frame->as_choice({"meridian", "image", "scattering_plane"}));
  if (analyser) {
    const AnalyserTrain train = read_train(*analyser);
    if (train.follows_wavelength())
      throw analyser->error("the phase of this retarder follows the wavelength, which arrays of a platform know",
                            "kind: platform, or retarder_deg");
    how.analyser = train.at(1);
  }
  return how;
}

double joint_reach(double confidence, double degrees) {
  return degrees * std::expm1(-2 / (degrees - 1) * std::log1p(-confidence));
}

bool in_region(double q_off, double u_off, const double (&C)[6], double reach) {
  return C[5] * q_off * q_off - 2 * C[4] * q_off * u_off + C[3] * u_off * u_off <= reach * (C[3] * C[5] - C[4] * C[4]);
}

LinearPolarisation linear_polarisation(const double (&S)[3], const double (&C)[6]) {
  const auto [I, Q, U] = S;
  LinearPolarisation r{NAN, NAN, NAN, NAN, NAN, true};
  if (!(I > 0)) return r;
  const double P = std::hypot(Q, U), p = P / I;
  // Along (Q, U) and across; where both are 0 any direction will do.
  const double c = P > 0 ? Q / P : 1, s = P > 0 ? U / P : 0;
  const double along = c * c * C[3] + 2 * c * s * C[4] + s * s * C[5],
               across = s * s * C[3] - 2 * c * s * C[4] + c * c * C[5], with = c * C[1] + s * C[2];
  r.degree = p;
  r.degree_error = std::sqrt(std::max(0.0, along - 2 * p * with + p * p * C[0])) / I;
  r.angle = std::fmod(0.5 * std::atan2(U, Q) / kDegree + 180, 180.0);
  if (!std::isfinite(along + across + with + C[0])) {  // nothing is known of the errors
    r.degree_error = r.angle_error = INFINITY;
    r.debiased = 0;
    return r;
  }
  const double b2 = std::max(0.5 * (along + across), 0.0) / (I * I);
  r.debiased = p > 0 && b2 > 0 ? p - b2 * -std::expm1(-p * p / b2) / (2 * p) : p;
  r.angle_error = P > 0 ? 0.5 * std::sqrt(std::max(0.0, across)) / P / kDegree : INFINITY;
  r.undefined = !(p >= 3 * r.degree_error && P > 0);
  return r;
}

size_t channel_of(std::span<const std::string> channels, const char* name) {
  return static_cast<size_t>(std::find(channels.begin(), channels.end(), name) - channels.begin());
}

void covariances(const CaptureResult& r, size_t problem, size_t band, const double (&error)[3], double (&C)[6]) {
  const double* const raw = &r.stokes_covariance[(problem * r.bands + band) * 6];
  const double diagonal[3] = {raw[0], raw[3], raw[5]};
  for (size_t a = 0, at = 0; a < 3; ++a)
    for (size_t b = a; b < 3; ++b, ++at) {
      const double size = std::sqrt(diagonal[a] * diagonal[b]);
      C[at] = a == b ? error[a] * error[a] : size > 0 ? raw[at] / size * error[a] * error[b] : 0;
    }
}

void add_polarisation(Delivery& d) {
  const CaptureResult& r = d.result;
  const auto channels = d.sensor.channels();
  const size_t q = channel_of(channels, "stokes_q"), u = channel_of(channels, "stokes_u"),
               lost = channel_of(channels, "depolarised");
  if (q >= r.channels || u >= r.channels || r.bins != 1 || r.stokes_covariance.empty()) return;
  Product product{"polarisation", "1, or degrees of angles", false, {}, {}};
  for (const Band& b : d.bands)
    for (const char* what :
         {" dolp", " dolp_error", " dolp_debiased", " aolp", " aolp_error", " aolp_undefined", " depolarised_share"})
      product.bands.push_back(b.name + what);
  Product together{"covariance", "(W/(m2 sr um))^2", false, {}, {}};
  for (const Band& b : d.bands)
    for (const char* what : {" II", " IQ", " IU", " QQ", " QU", " UU"}) together.bands.push_back(b.name + what);
  for (size_t i = 0; i < r.problems(); ++i)
    for (size_t b = 0; b < r.bands; ++b) {
      const auto at = [&](size_t channel) { return (i * r.channels + channel) * r.bands + b; };
      const double S[3] = {r.radiance[at(0)], r.radiance[at(q)], r.radiance[at(u)]};
      const double error[3] = {r.standard_error[at(0)], r.standard_error[at(q)], r.standard_error[at(u)]};
      double C[6];
      covariances(r, i, b, error, C);
      together.values.insert(together.values.end(), std::begin(C), std::end(C));
      const LinearPolarisation p = linear_polarisation(S, C);
      const double share = lost < r.channels && S[0] > 0 ? r.radiance[at(lost)] / S[0] : 0;
      product.values.insert(product.values.end(), {p.degree, p.degree_error, p.debiased, p.angle, p.angle_error,
                                                   p.undefined ? 1.0 : 0.0, share});
    }
  d.products.push_back(std::move(product));
  d.products.push_back(std::move(together));
}

std::string text_of(const Polarimetry& how) {
  const char* const frames[] = {"+Q in the plane of the vertical and the ray", "+Q up in the picture",
                                "+Q in the plane of the sun and the ray"};
  return std::string("Stokes vectors: ") + frames[static_cast<size_t>(how.frame)] +
         ", +U half-way on counter-clockwise and +V turning so, as the receiver sees it" +
         (how.analyser ? "; radiance is the intensity behind the analyser" : "");
}

}  // namespace suite
