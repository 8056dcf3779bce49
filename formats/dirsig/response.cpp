// Spectral responses of channels. As measured against DIRSIG 2026.38: a gaussian's width is its standard deviation and
// its peak 1/sqrt(2 pi); a rectangle's width is its full width and its height 1.
#include <cmath>

#include "formats/dirsig/simulation_writer.h"
#include "math/vec.h"

namespace suite::dirsig {

namespace {

constexpr double kSigmas = 4.5;  // of a gaussian, to either side: all but 7e-6 of it
constexpr int kChords = 256;

struct Response {
  std::vector<double> x, y;
  double area() const {
    double sum = 0;
    for (size_t i = 1; i < x.size(); ++i) sum += 0.5 * (y[i] + y[i - 1]) * (x[i] - x[i - 1]);
    return sum;
  }
};

Response shape_of(size_t shape, double center, double width) {
  Response r;
  if (shape == 0) {
    for (int i = 0; i <= kChords; ++i) {
      const double d = kSigmas * (2.0 * i / kChords - 1);
      r.x.push_back(center + d * width), r.y.push_back(std::exp(-0.5 * d * d) / std::sqrt(2 * kPi));
    }
  } else if (shape == 1) {
    r.x = {center - width / 2, center + width / 2}, r.y = {1, 1};
  } else {
    r.x = {center - width, center, center + width}, r.y = {0, 1, 0};
  }
  return r;
}

// What lies inside of the bandpass.
Response clipped(const Response& r, double low, double high) {
  Response out;
  const auto at = [&](size_t i, double x) {
    return r.y[i] + (r.y[i + 1] - r.y[i]) * (x - r.x[i]) / (r.x[i + 1] - r.x[i]);
  };
  for (size_t i = 0; i < r.x.size(); ++i) {
    if (i && r.x[i - 1] < low && r.x[i] > low) out.x.push_back(low), out.y.push_back(at(i - 1, low));
    if (i && r.x[i - 1] < high && r.x[i] > high) out.x.push_back(high), out.y.push_back(at(i - 1, high));
    if (r.x[i] >= low && r.x[i] <= high) out.x.push_back(r.x[i]), out.y.push_back(r.y[i]);
  }
  return out;
}

// What a channel says of its response, before the bandpass cuts it.
Response response_of(const Item& channel) {
  const Item* shape = channel.find("@shape");
  const size_t kind = shape ? shape->choice({"gaussian", "rectangular", "triangular", "tabulated"}) : 3;
  Response r;
  if (kind < 3) {
    const Item& width = channel.at("width");
    r = shape_of(kind, channel.at("center").number_in(1e-3, 1e4), width.number_in(1e-9, 1e4));
    constexpr Fate fates[] = {Fate::converted, Fate::exact, Fate::approximated};
    constexpr const char* notes[] = {"the standard deviation", "", "taken as half of the base"};
    width.mark(fates[kind], notes[kind]);
    return r;
  }
  for (const Item* entry : channel.all("entry")) {
    const Item* at = entry->any({"spectralpoint", "wavelength"});
    r.x.push_back((at ? *at : entry->at("spectralpoint")).number_in(1e-3, 1e4));
    r.y.push_back(entry->at("value").number_in(0, 1e9));
    if (r.x.size() > 1 && !(r.x.back() > r.x[r.x.size() - 2]))
      throw entry->error("the wavelengths of a channel do not ascend");
  }
  if (r.x.size() < 2)
    throw channel.error("a channel of fewer than two points", "<entry><spectralpoint/><value/></entry>");
  return r;
}

// An element whose type is the one that changes nothing, or is lost.
void plain_type(const Item& channel, const char* key, const char* plain, const char* note) {
  const Item* item = channel.find(key);
  if (!item) return;
  const Item* type = item->find("@type");
  item->mark_all(!type || lower_case(type->value) == plain ? Fate::exact : Fate::unsupported, note);
}

}  // namespace

// The band of a channel. counted: its response counts particles; factor: as in simulation_writer.h.
Tree SimulationWriter::band_of(const Item& channel, double low, double high, bool counted, double factor) {
  channel.mark(Fate::exact);
  const Item *name = channel.find("@name"), *normalize = channel.find("@normalize");
  if (name) name->mark(Fate::exact);
  Response r = clipped(response_of(channel), low, high);
  double area = r.x.size() > 1 ? r.area() : 0;
  if (!(area > 0)) throw channel.error(strf("the channel has no response between %g and %g um", low, high));
  if (normalize && normalize->boolean()) {
    normalize->mark(Fate::approximated, "taken as a response of area 1");
    for (double& y : r.y) y /= area;
    area = 1;
  }
  const Item *gain = channel.find("@gain"), *bias = channel.find("@bias");
  const double times = gain ? gain->number_in(0, 1e12, Fate::converted, "in the factor of the channel") : 1;
  if (bias && bias->number() != 0) bias->mark(Fate::unsupported, "nothing is added to radiance");
  plain_type(channel, "polarizer", "none", "give the sensor `stokes` or `analyser`");
  plain_type(channel, "dataoutput", "total", "images hold all light");
  if (!counted)
    channel.mark(Fate::converted,
                 strf("the mean radiance over the response; DIRSIG's value is %.9g times it", area * times * factor));
  else
    for (double& y : r.y) y *= times;
  Tree band = Tree::map(channel.where);
  band.set("name", Tree::word(name && !name->value.empty() ? name->value : "channel", channel.where));
  Tree& curve = band.set("response", Tree::map(channel.where));
  curve.set("wavelength_um", Tree::numbers(r.x, channel.where));
  curve.set("value", Tree::numbers(r.y, channel.where));
  curve.set("outside", Tree::word("zero", channel.where));
  return band;
}

Tree SimulationWriter::bands_of(const Item& response, bool counted, double factor) {
  const Item& pass = response.at("bandpass");
  if (const Item* units = pass.find("@spectralunits"))
    if (units->choice({"microns", "micrometers", "um"}) == 0) units->mark(Fate::exact);
  const double low = pass.at("minimum").number_in(1e-3, 1e4), high = pass.at("maximum").number_in(1e-3, 1e4);
  if (!(low < high)) throw pass.error("the bandpass ends before it begins");
  if (const Item* delta = pass.find("delta")) delta->mark(Fate::ignored, "bins of wavelength are chosen to an error");
  if (const Item* pattern = response.find("channelpattern"))
    pattern->mark_all(Fate::approximated,
                      "every detector has all channels: the pattern picks among the bands of the image");
  Tree list = Tree::list(response.where);
  std::set<std::string> names;
  for (const Item* channel : response.at("channellist").all("channel")) {
    Tree band = band_of(*channel, low, high, counted, factor);
    const Item* name = channel->find("@name");
    const std::string wished = name && !name->value.empty() ? name->value : "channel";
    std::string mine = wished;
    for (int k = 2; !names.insert(mine).second; ++k) mine = strf("%s_%d", wished.c_str(), k);
    band.set("name", Tree::word(mine, channel->where));
    list.push(std::move(band));
  }
  if (list.empty()) throw response.error("no channel", "<channellist><channel/>");
  return list;
}

}  // namespace suite::dirsig
