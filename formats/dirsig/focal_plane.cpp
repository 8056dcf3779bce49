// Focal planes: detectors, read-out, exposure, images and truth.
#include <cmath>

#include "formats/dirsig/simulation_writer.h"

namespace suite::dirsig {

namespace {

// DIRSIG's own defaults of paths a pixel (its manual calls them samples).
constexpr double kFewest = 20, kMost = 100, kRelativeError = 0.01;

// Seconds of a unit of time; without one the number is seconds.
double seconds_of(const Item* units) {
  if (!units) return 1;
  constexpr double seconds[] = {1, 1, 1, 1e-3, 1e-3, 1e-3, 1e-6, 1e-6, 1e-6};
  return seconds[units->choice(
      {"seconds", "second", "s", "milliseconds", "millisecond", "ms", "microseconds", "microsecond", "us"})];
}

struct Truth {
  const char *theirs, *ours;
};
constexpr Truth kTruths[] = {{"intersection", "location"}, {"geolocation", "geodetic"},    {"material", "material"},
                             {"abundance", "abundance"},   {"temperature", "temperature"}, {"distance", "range"},
                             {"range", "range"},           {"normal", "normal"},           {"hit", "hits"},
                             {"shadow", "sun_visibility"}, {"reflectance", "reflectance"}, {"time", "time"}};

std::string file_name(const std::string& wished, const std::string& otherwise) {
  std::string name = (wished.empty() ? otherwise : wished).substr(0, 40);
  for (char& c : name)
    if (c == '/' || static_cast<unsigned char>(c) < 0x20) c = '_';
  return name.empty() || name[0] == '.' ? "plane" + name : name;
}

}  // namespace

void SimulationWriter::read_focal_plane(const Item& plane, const Tree& lens, const std::string& instrument, Tree& to) {
  ++planes_;
  const Item* name = plane.find("@name");
  if (name) name->mark(Fate::exact);
  // Every plane has a clock of its own, which ours keeps with the instrument.
  Tree made = Tree::map(plane.where), array = Tree::map(plane.where);
  made.set("name",
           Tree::word(file_name((instrument.empty() ? "" : instrument + "_") + (name ? name->value : ""), "plane") +
                          strf("_%zu", planes_),
                      plane.where));
  for (const auto& [key, value] : lens.entries) made.set(key, value);
  array.set("name", Tree::word(file_name(name ? name->value : "", "array"), plane.where));
  read_array(plane.at("detectorarray"), made, array);
  const Item& capture = plane.at("capturemethod");
  if (const Item* label = capture.find("@name")) label->mark(Fate::ignored, "for people");
  read_capture(capture, array);
  if (const Item* readout = array.find("readout") ? plane.find("detectorarray")->find("@rollingreadout") : nullptr)
    readout->mark(Fate::converted, "seconds from line to line");
  // Lines of one row that follow a clock are a strip.
  if (Tree* clock = made.find("clock");
      clock && array.find("rows")->text == "1" && array.find("columns")->text != "1") {
    Tree line = Tree::map(plane.where);
    line.set("kind", Tree::word("line", plane.where));
    line.set("line_rate_hz", *clock->find("rate_hz"));
    const Item& said = plane.at("detectorarray").at("clock");
    if (const Item* offset = said.find("offset"); offset && offset->number() != 0)
      offset->mark(Fate::approximated, "lines begin with the task");
    array.set("readout", std::move(line));
    std::erase_if(made.entries, [](const auto& e) { return e.first == "clock"; });
  }
  read_truth(plane);
  made.set("arrays", Tree::list(plane.where)).push(std::move(array));
  to.list_at("instruments", plane.where).push(std::move(made));
}

void SimulationWriter::read_array(const Item& array, Tree& instrument, Tree& made) {
  if (const Item* units = array.find("@spatialunits"))
    if (units->choice({"microns", "micrometers", "um"}) == 0) units->mark(Fate::exact);
  if (array.has("filename"))
    throw array.at("filename")
        .error("arrays of files (data-driven detectors) are not read here", "xelementcount, xelementspacing, ...");
  const Item &nx = array.at("xelementcount"), &ny = array.at("yelementcount");
  made.set("columns", Tree::number(static_cast<double>(nx.integer(1, 10000000)), nx.where));
  made.set("rows", Tree::number(static_cast<double>(ny.integer(1, 100000)), ny.where));
  const auto size = [&](const char* key, const char* other) -> double {
    const Item* item = array.find(key);
    if (!item) item = &array.at(other);
    return item->number_in(1e-3, 1e6);
  };
  const double pitch_x = size("xelementspacing", "xelementsize"), pitch_y = size("yelementspacing", "yelementsize");
  fill_ = 1;
  for (const char* key : {"xelementsize", "yelementsize"})
    if (const Item* item = array.find(key)) {
      const double own = item->number_in(1e-3, 1e6), pitch = key[0] == 'x' ? pitch_x : pitch_y;
      if (own > pitch) throw item->error(strf("detectors of %g um overlap at a spacing of %g um", own, pitch));
      fill_ *= own / pitch;
      if (own != pitch)
        item->mark(Fate::approximated, "radiance is that of the whole pitch, electrons those of the share");
    }
  made.set("pitch_um", Tree::numbers({pitch_x, pitch_y}, array.where));
  const Item *ox = array.find("xarrayoffset"), *oy = array.find("yarrayoffset");
  if (ox || oy) {
    const double x = ox ? ox->number(Fate::converted, "microns") : 0,
                 y = oy ? oy->number(Fate::converted, "microns") : 0;
    if (x != 0 || y != 0) made.set("offset_mm", Tree::numbers({x * 1e-3, y * 1e-3}, array.where));
  }
  Tree flips = Tree::list(array.where);
  for (const char* key : {"xflipaxis", "yflipaxis"})
    if (const Item* flip = array.find(key); flip && flip->boolean())
      flips.push(Tree::word(key[0] == 'x' ? "columns" : "rows", flip->where));
  if (!flips.empty()) made.set("flip", std::move(flips));
  if (const Item* rolling = array.find("@rollingreadout"))
    if (const double row = rolling->number_in(0, 3600); row > 0) {
      Tree& readout = made.set("readout", Tree::map(rolling->where));
      readout.set("kind", Tree::word("rolling", rolling->where));
      readout.set("row_time_s", Tree::number(row, rolling->where));
    }
  if (const Item* clock = array.find("clock")) read_clock(*clock, instrument);
}

void SimulationWriter::read_clock(const Item& clock, Tree& instrument) {
  const Item *type = clock.find("@type"), *rate = clock.find("rate");
  if (type) type->mark(Fate::exact);
  expect_word(clock.find("@temporalunits"), {"hertz", "hz"}, "rates are taken in hertz");
  if ((type && lower_case(type->value) != "independent") || !rate) {
    if (type) type->mark(Fate::unsupported, "only clocks of their own are known here: one capture a task");
    return clock.mark_all(Fate::unsupported, "of a clock that is not known here");
  }
  expect_word(rate->find("@units"), {"hertz", "hz"}, "rates are taken in hertz");
  if (const double hz = rate->number_in(0, 1e9); hz > 0) {
    Tree& made_clock = instrument.set("clock", Tree::map(clock.where));
    made_clock.set("rate_hz", Tree::number(hz, rate->where));
    if (const Item* offset = clock.find("offset"))
      if (const double s = offset->number_in(0, 1e9); s > 0) made_clock.set("offset_s", Tree::number(s, offset->where));
  }
}

void SimulationWriter::read_image_file(const Item& image, const Item* detector_model) {
  if (const Item* base = image.find("basename")) base->mark(Fate::exact), image_ = base->value;
  if (const Item* end = image.find("extension")) end->mark(Fate::ignored, "images end in .img");
  Tree& output = root_.map_at("output", image.where);
  output.set("interleave", Tree::word("bip", image.where));
  if (const Item* schedule = image.find("schedule")) {
    constexpr const char* ours[] = {"simulation", "task", "capture"};
    output.set("files", Tree::word(ours[schedule->choice({"simulation", "task", "capture"})], schedule->where));
  }
  if (const Item* type = image.find("datatype")) {
    const long long code = type->integer(1, 15);
    output.set("type", Tree::word(code == 5 ? "float64" : "float32", type->where));
    if (code == 12 && detector_model)
      type->mark(Fate::converted, "counts stand in NAME_dn.img");
    else if (code != 4 && code != 5)
      type->mark(Fate::approximated, "float32");
  }
}

void SimulationWriter::read_capture(const Item& method, Tree& made) {
  expect_word(method.find("@type"), {"simple", "raw"}, "taken as a simple capture");
  const Item* image = method.find("imagefile");
  const Item *flux = image ? image->find("@fluxunits") : nullptr, *area = image ? image->find("@areaunits") : nullptr;
  if (image) read_image_file(*image, method.find("detectormodel"));
  double seconds = 0;
  if (const Item* integration = method.find("temporalintegration")) {
    const Item* tdi = integration->find("@tdi");
    if (const Item* time = integration->find("time")) {
      const double unit = seconds_of(time->find("@units"));
      seconds = unit * time->number_in(0, 86400 / unit);
      if (unit != 1) time->mark(Fate::converted, strf("%g s", seconds));
      made.set("integration_time_s", Tree::number(seconds, time->where));
    }
    if (const Item* samples = integration->find("samples"))
      samples->mark(Fate::ignored, "DIRSIG5 does not use them either");
    if (tdi && tdi->boolean()) {
      made.set("tdi", Tree::map(tdi->where)).set("stages", *made.find("rows"));
      made.set("rows", Tree::number(1, tdi->where));
      tdi->mark(Fate::converted, "stages are the array's rows");
    }
  }
  const size_t kind = flux ? flux->choice({"watts", "photonspersecond", "electronspersecond"}) : 0;
  const bool centimetres = !area || area->choice({"cm2", "m2"}) == 0;
  counted_ = kind > 0 && light_ > 0 && seconds > 0;
  if (flux)
    flux->mark(kind == 0 || counted_ ? Fate::converted : Fate::unsupported,
               kind == 0  ? "ours is the mean radiance of the channel; its factor stands with the channel"
               : counted_ ? "counted in NAME_electrons.img, of a detector; DIRSIG's are of a unit of area"
                          : "counting needs an aperture and a time of integration: the image is radiance");
  if (area) area->mark(Fate::converted, "ours are the square metre for radiance and the detector for electrons");
  const double factor = (centimetres ? 1e-4 : 1) * (light_ > 0 ? light_ : 1) * (seconds > 0 ? seconds : 1);
  made.set("bands", bands_of(method.at("spectralresponse"), counted_, factor));
  Tree& paths = made.set("paths", Tree::map(method.where));
  const Item* convergence = method.find("convergence");
  const auto samples = [&](const char* key, double otherwise) {
    const Item* item = convergence ? convergence->find(key) : nullptr;
    return Tree::number(item ? static_cast<double>(item->integer(1, 1 << 30)) : otherwise,
                        item ? item->where : method.where);
  };
  paths.set("min", samples("minimumsamples", kFewest)), paths.set("max", samples("maximumsamples", kMost));
  if (const Item* threshold = convergence ? convergence->find("threshold") : nullptr)
    threshold->mark(Fate::approximated, "an error of 1 % is the target: DIRSIG's threshold has no unit");
  paths.set("relative_error", Tree::number(kRelativeError, method.where));
  for (const char* key : {"spatialresponse", "samplestrategy", "hypersamplingmultiplier"})
    if (const Item* item = method.find(key)) item->mark_all(Fate::ignored, "DIRSIG5 does not use it either");
  if (const Item* psf = method.find("psf")) psf->mark_all(Fate::unsupported, "images are sharp: give the array a psf");
  if (!read_detector(method, made) && counted_) {
    // Electrons without noise and without a converter: the response says how many a photon gives.
    made.set("detector", Tree::map(method.where)).set("quantum_efficiency", Tree::number(1, method.where));
  }
  if (Tree* detector = made.find("detector"); detector && fill_ != 1)
    detector->set("fill_factor", Tree::number(fill_, method.where));
}

namespace {

void refuse_others(const Item& model) {
  for (const char* key : {"darkcurrentdensity", "gain", "lut", "gainmodel"})
    if (const Item* item = model.find(key)) item->mark_all(Fate::unsupported, "its unit or form is not public");
}

}  // namespace

bool SimulationWriter::read_detector(const Item& method, Tree& made) {
  const Item* model = method.find("detectormodel");
  if (!model) return false;
  if (!counted_)
    return model->mark_all(Fate::unsupported, "a detector needs an aperture, a time of integration and electrons"),
           false;
  model->mark(Fate::exact);
  Tree& detector = made.set("detector", Tree::map(model->where));
  const auto number = [&](const char* key, double low, double high) -> std::optional<double> {
    const Item* item = model->find(key);
    return item ? std::optional<double>(item->number_in(low, high)) : std::nullopt;
  };
  const double bits = number("bitdepth", 1, 16).value_or(16);
  const double least = number("minelectrons", -1e12, 1e12).value_or(0),
               most = number("maxelectrons", 0, 1e12).value_or(0);
  detector.set("quantum_efficiency", Tree::number(number("quantumefficiency", 0, 1).value_or(1), model->where));
  const auto noise = number("readnoise", 0, 1e12);
  if (!(most > least)) {
    for (const char* key : {"bitdepth", "minelectrons", "maxelectrons", "readnoise"})
      if (const Item* item = model->find(key))
        item->mark(Fate::unsupported, "without maxelectrons above minelectrons a count has no size: electrons alone");
    refuse_others(*model);
    return true;
  }
  detector.set("gain_e_per_dn", Tree::number((most - least) / (std::exp2(bits) - 1), model->where));
  detector.set("bits", Tree::number(bits, model->where));
  if (most > 0) detector.set("full_well_e", Tree::number(most, model->where));
  if (noise) detector.set("read_noise_e", Tree::number(*noise, model->where));
  if (least != 0) model->find("minelectrons")->mark(Fate::approximated, "counts begin at 0 electrons");
  refuse_others(*model);
  return true;
}

void SimulationWriter::read_truth(const Item& plane) {
  for (const Item* collection : plane.all("truthcollection")) {
    if (const Item* enabled = collection->find("enabled"); enabled && !enabled->boolean()) {
      collection->mark_all(Fate::ignored, "disabled");
      continue;
    }
    if (const Item* name = collection->find("name")) name->mark(Fate::ignored, "for people");
    if (const Item* image = collection->find("imagefile"))
      for (const char* key : {"basename", "extension", "schedule", "datatype"})
        if (const Item* said = image->find(key)) said->mark(Fate::converted, "truth stands in NAME_truth.img");
    const Item* list = collection->find("collectorlist");
    for (const Item* collector : list ? list->all("collector") : std::vector<const Item*>{}) {
      collector->mark(Fate::exact);
      const Item& name = collector->at("name");
      const char* ours = nullptr;
      for (const Truth& t : kTruths)
        if (lower_case(name.text()) == t.theirs) ours = t.ours;
      if (ours)
        truth_.insert(ours), name.mark(Fate::converted, std::string("the truth '") + ours + "'");
      else
        name.mark(Fate::unsupported, "no truth of this name here; dirsig-render --list-truth");
    }
  }
}

}  // namespace suite::dirsig
