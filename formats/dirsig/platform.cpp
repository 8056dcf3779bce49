// Platforms (.platform): attachments, mounts, instruments and their optics.
#include <cmath>

#include "formats/dirsig/simulation_writer.h"
#include "math/dualquat.h"

namespace suite::dirsig {

namespace {

// Turns about the fixed axes x, then y, then z, that make the rotation; degrees.
std::vector<double> xyz_degrees(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  const double sine = std::clamp(2 * (w * y - z * x), -1.0, 1.0);
  return {std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) / kDegree, std::asin(sine) / kDegree,
          std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) / kDegree};
}

std::array<double, 3> optional_triple(const Item& item) {
  for (const char* name : {"point", "cartesiantriple"})
    if (const Item* inner = item.find(name)) return optional_triple(*inner);
  std::array<double, 3> v{};
  constexpr const char* axes[] = {"x", "y", "z"};
  for (size_t i = 0; i < 3; ++i)
    if (const Item* one = item.find(axes[i])) v[i] = one->number();
  return v;
}

Tree rotation_of(const Item& from, const std::array<double, 3>& angles, const std::string& order) {
  return Tree::numbers(xyz_degrees(turned(angles, order)), from.where);
}

std::array<double, 3> mount_angles(const Item& in, double unit) {
  std::array<double, 3> v{};
  constexpr const char* axes[] = {"xrotation", "yrotation", "zrotation"};
  for (size_t i = 0; i < 3; ++i)
    if (const Item* one = in.find(axes[i])) v[i] = one->number() * unit;
  if (const Item* turn = in.find("rotation")) {
    v = optional_triple(*turn);
    for (double& angle : v) angle *= unit;
  }
  return v;
}

// Scans a second: said by itself or by a clock.
const Item* rate_of(const Item& from) {
  if (const Item* rate = from.any({"scanrate", "rate", "frequency"})) return rate;
  const Item* clock = from.find("clock");
  if (!clock) return nullptr;
  expect_word(clock->find("@type"), {"independent"}, "taken as a clock of its own");
  expect_word(clock->find("@temporalunits"), {"hertz", "hz"}, "rates are taken in hertz");
  return clock->find("rate");
}

const char* axis_of(const Item* axis) {
  if (!axis) return "across";
  const std::string low = lower_case(axis->text(Fate::converted, "y turns across the track, x along it"));
  return low == "x" ? "along" : low == "z" ? "vertical" : "across";
}

}  // namespace

void SimulationWriter::read_platform(const PlatformParts& parts) {
  const Item& platform = *parts.platform;
  if (platform.name != "platform")
    throw platform.error("the root is <" + platform.name + ">", "<platform> is expected");
  Tree sensor = Tree::map(platform.where), jitter = Tree::map(platform.where), carried = Tree::list(platform.where);
  image_.clear(), truth_.clear(), planes_ = 0;
  if (const Item* name = platform.find("@name")) name->mark(Fate::ignored, "images are named by their files");
  for (const char* extra : {"metadata", "editor"})
    if (const Item* item = platform.find(extra)) item->mark_all(Fate::ignored, "for people");
  sensor.set("kind", Tree::word("platform", platform.where));
  sensor.set("name", Tree::word("", platform.where));
  const MotionPlace place{import_, {folder_of(parts.motion->where.file), folder_of(file_)}, &epoch_};
  sensor.set("motion", track_of(*parts.motion, place, &jitter));
  if (!jitter.empty()) sensor.set("jitter", std::move(jitter));
  sensor.set("tasks", tasks_of(*parts.tasks));
  for (const Item* attachment : platform.all("attachment")) {
    attachment->mark(Fate::exact);
    Tree one = Tree::map(attachment->where);
    read_attachment(*attachment, one);
    carried.push(std::move(one));
  }
  if (!planes_) throw platform.error("no focal plane of an instrument that is known here", "<instrument><focalplane>");
  if (!truth_.empty()) {
    Tree& list = sensor.set("truth", Tree::list(platform.where));
    for (const std::string& name : truth_) list.push(Tree::word(name, platform.where));
  }
  sensor.set("attachments", std::move(carried));
  std::string name = parts.prefix + (planes_ == 1 && !image_.empty() ? image_ : stem_of(platform.where.file));
  for (char& c : name)
    if (c == '/' || static_cast<unsigned char>(c) < 0x20) c = '_';
  name = name.substr(0, 40);
  if (name.empty() || name[0] == '.') name = "image" + name;
  for (int k = 2; !names_.insert(name).second; ++k) name += strf("_%d", k);
  sensor.set("name", Tree::word(name, platform.where));
  root_.list_at("sensors", where_).push(std::move(sensor));
}

void SimulationWriter::read_attachment(const Item& attachment, Tree& to) {
  if (const Item* name = attachment.find("@name"))
    name->mark(Fate::exact), to.set("name", Tree::word(name->value, name->where));
  if (const Item* affine = attachment.find("affinetransform")) {
    if (const Item* move = affine->find("translation")) {
      const auto t = optional_triple(*move);
      to.set("offset_m", Tree::numbers({t[0], t[1], t[2]}, move->where));
    }
    if (const Item* turn = affine->find("rotation")) {
      const double unit = radians_of(turn->any({"@units", "@angularunits"}), true);
      const std::string order = order_of(turn->find("@rotationorder"));
      auto r = optional_triple(*turn);
      for (double& v : r) v *= unit;
      to.set("rotate_deg", rotation_of(*turn, r, order));
    }
    if (const Item* scale = affine->find("scale")) {
      const auto s = optional_triple(*scale);
      scale->mark(s[0] == 1 && s[1] == 1 && s[2] == 1 ? Fate::exact : Fate::unsupported, "instruments are not scaled");
    }
  }
  // What is carried stands beside the mount or in it.
  const Item* mount = attachment.find("mount");
  Tree inner = Tree::list(attachment.where);
  std::vector<const Item*> carriers{&attachment};
  if (mount) carriers.push_back(mount);
  for (const Item* carrier : carriers) {
    for (const Item* more : carrier->all("attachment")) {
      more->mark(Fate::exact);
      Tree one = Tree::map(more->where);
      read_attachment(*more, one);
      inner.push(std::move(one));
    }
    for (const Item* instrument : carrier->all("instrument")) read_instrument(*instrument, to);
  }
  if (mount) read_mount(*mount, to);
  if (!inner.empty()) to.set("attachments", std::move(inner));
}

// Angles over seconds, or over the fraction of a scan that a clock repeats.
void SimulationWriter::read_tabulated_mount(const Item& from, double unit, const std::string& order, Tree& to) {
  // Ours does not begin again: so many scans are written out.
  constexpr size_t kScans = 200, kMostEntries = 20000;
  std::vector<std::pair<double, Tree>> rows;
  const Item* rate = rate_of(from);
  const double period = rate ? 1 / rate->number_in(1e-9, 1e9) : 0;
  for (const Item* entry : from.all("entry")) {
    const Item* fraction = entry->find("fraction");
    if (fraction && !rate) throw entry->error("fractions of a scan without a clock", "<clock><rate>");
    const double t =
        fraction ? period * fraction->number_in(0, 1) : seconds_of(entry->at("datetime"), {import_, folders_, &epoch_});
    rows.emplace_back(t, rotation_of(*entry, mount_angles(*entry, unit), order));
  }
  if (rows.empty()) throw from.error("a tabulated mount without entries", "<entry><datetime/><xrotation/>...");
  const size_t scans = rate ? std::max<size_t>(1, std::min(kScans, kMostEntries / rows.size())) : 1;
  if (rate) from.mark(Fate::approximated, strf("%zu scans are written out, from second 0 on", scans));
  // As the ends of motions are held.
  if (!rate) {
    auto before = rows.front(), after = rows.back();
    before.first -= kHeld, after.first += kHeld;
    rows.insert(rows.begin(), std::move(before));
    rows.push_back(std::move(after));
    from.mark(Fate::approximated, strf("its ends are held for %g s", kHeld));
  }
  Tree times = Tree::list(from.where), turns = Tree::list(from.where);
  double last = -1e300;
  for (size_t scan = 0; scan < scans; ++scan)
    for (const auto& [t, turn] : rows) {
      // The end of a scan and the beginning of the next are one moment.
      const double at = std::max(t + static_cast<double>(scan) * period, last + (scan ? period * 1e-9 : 0));
      last = at;
      times.push(Tree::number(at, from.where)), turns.push(turn);
    }
  to.set("times_s", std::move(times)), to.set("rotate_deg", std::move(turns));
}

void SimulationWriter::read_mount(const Item& mount, Tree& to) {
  mount.mark(Fate::exact);
  const Item& type = mount.at("@type");
  const std::string kind = lower_case(type.text());
  const Item* data = mount.find("data");
  const Item& from = data ? *data : mount;
  const double unit = radians_of(from.any({"@angularunits", "@units"}), false);
  const std::string order = order_of(from.find("@rotationorder"));
  const auto degrees = [&](const Item& item) { return item.number() * unit / kDegree; };
  Tree made = Tree::map(mount.where);
  const auto finish = [&](const char* ours) { made.set("kind", Tree::word(ours, mount.where)); };
  if (const Item* name = mount.find("@name")) name->mark(Fate::ignored, "for people");
  if (kind == "static") {
    finish("static");
    made.set("rotate_deg", rotation_of(from, mount_angles(from, unit), order));
  } else if (kind == "tabulated") {
    finish("tabulated");
    read_tabulated_mount(from, unit, order, made);
  } else if (const Item* rate = rate_of(from); rate && (kind == "whisk" || kind == "line")) {
    const Item *low = from.any({"minimum", "min", "start", "startangle"}),
               *high = from.any({"maximum", "max", "stop", "stopangle"});
    if (!low || !high) throw mount.error("a scan without its range", "<minimum> and <maximum>");
    const double a = degrees(*low), b = degrees(*high),
                 hz = rate->number_in(1e-9, 1e9, Fate::approximated, "taken as scans a second");
    made.set("axis", Tree::word(axis_of(from.any({"axis", "scanaxis", "@axis"})), mount.where));
    if (kind == "whisk") {
      finish("whisk");
      made.set("amplitude_deg", Tree::number(std::fabs(b - a) / 2, low->where)),
          made.set("center_deg", Tree::number((a + b) / 2, low->where));
      made.set("rate_hz", Tree::number(hz, rate->where)), made.set("shape", Tree::word("sine", mount.where));
    } else {
      finish("line_scan");
      made.set("start_deg", Tree::number(a, low->where)),
          made.set("rate_deg_s", Tree::number((b - a) * hz, rate->where));
      made.set("period_s", Tree::number(1 / hz, rate->where));
    }
  } else if (const Item* target = from.any({"target", "location"}); target && kind == "tracking") {
    finish("look_at");
    Tree& at = made.set("target", Tree::map(target->where));
    set_location(target->has("location") ? target->at("location") : *target, at);
  } else {
    type.mark(Fate::unsupported, "this mount is not known here: the instrument does not turn");
    if (data) data->mark_all(Fate::unsupported, "of a mount that is not known here");
    return;
  }
  to.set("mount", std::move(made));
}

void SimulationWriter::read_instrument(const Item& instrument, Tree& to) {
  instrument.mark(Fate::exact);
  const Item* type = instrument.find("@type");
  if (type && lower_case(type->text()) != "generic") {
    type->mark(Fate::unsupported, "only instruments of type generic are known here");
    return instrument.mark_all(Fate::unsupported, "of an instrument that is not known here");
  }
  const Item* name = instrument.find("@name");
  if (name) name->mark(Fate::exact);
  Tree lens = Tree::map(instrument.where);
  read_lens(instrument.at("properties"), lens);
  for (const Item* plane : instrument.all("focalplane")) {
    if (const Item* enabled = plane->find("@enabled"); enabled && !enabled->boolean()) {
      plane->mark_all(Fate::ignored, "disabled");
      continue;
    }
    plane->mark(Fate::exact);
    read_focal_plane(*plane, lens, name ? name->value : "", to);
  }
}

void SimulationWriter::read_lens(const Item& properties, Tree& to) {
  const Item& focal = properties.at("focallength");
  to.set("focal_length_mm", Tree::number(focal.number_in(1e-3, 1e6, Fate::exact, "mm"), focal.where));
  const double focal_m = *number_in_text(focal.value) * 1e-3;
  light_ = 0;
  if (const Item* wide = properties.find("aperturediameter"); wide && number_in_text(wide->value).value_or(1) > 0) {
    const double metres = wide->number_in(1e-6, 1e4, Fate::converted, "metres, though the focal length is in mm");
    to.set("aperture_mm", Tree::number(metres * 1000, wide->where));
    const Item* through = properties.find("aperturethroughput");
    const double share = through ? through->number_in(1e-9, 1) : 1;
    if (through) to.set("throughput", Tree::number(share, through->where));
    const double n = focal_m / metres;
    light_ = share * kPi / (1 + 4 * n * n);
  } else if (const Item* through = properties.find("aperturethroughput")) {
    through->mark(Fate::ignored, "without an aperture the image is radiance");
  }
  if (const Item* focus = properties.find("focusdistance"))
    to.set("focus_distance_m", Tree::number(focus->number_in(1e-6, 1e12), focus->where));
  if (const Item* d = properties.find("distortion")) {
    expect_word(d->find("@type"), {"brown", "brownconrady", "brown-conrady"}, "taken as that of Brown and Conrady");
    Tree& made = to.set("distortion", Tree::map(d->where));
    for (const char* key : {"k1", "k2", "k3", "p1", "p2"})
      if (const Item* value = d->find(key)) made.set(key, Tree::number(value->number(), value->where));
  }
  if (const Item* t = properties.find("telecentricity"))
    t->mark_all(Fate::unsupported, "chief rays go through one point");
}

}  // namespace suite::dirsig
