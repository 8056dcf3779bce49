// Flexible motion: engines of location and of orientation; jitter.
#include <algorithm>
#include <cmath>

#include "formats/dirsig/motion.h"
#include "math/vec.h"

namespace suite::dirsig {

Tree held(Tree keys, const Where& where);
Tree flexible_track(const Item& motion, const MotionPlace& place);
void read_jitter(const Item& motion, Tree* jitter);

namespace {

// A straight motion as two records so far from its start, s.
constexpr double kLong = 1e5;

// Rows of numbers between line ends, their first column a time.
std::vector<std::vector<double>> rows_of(const Item& data, size_t columns, const MotionPlace& place) {
  const Item* delimiter = data.find("@delimiter");
  const std::string separators = (delimiter ? delimiter->value : std::string()) + " \t\r,";
  if (delimiter) delimiter->mark(Fate::exact);
  if (const Item* source = data.find("@source"))
    if (lower_case(source->text()) != "internal")
      throw source->error("records from '" + source->value + "' are not read here", "source=\"internal\"");
  const Item* dates = data.find("@datetime");
  const bool absolute = dates && dates->choice({"relative", "absolute"}) == 1;
  std::vector<std::vector<double>> rows;
  for (const std::string_view line : words_of(data.text(), "\n")) {
    const auto words = words_of(line, separators);
    if (words.empty() || words[0].starts_with('#')) continue;
    if (words.size() != columns)
      throw data.error(strf("a record of %zu values, %zu are expected", words.size(), columns));
    std::vector<double>& row = rows.emplace_back();
    for (size_t i = 0; i < columns; ++i) {
      if (i == 0 && absolute) {
        Item date = data;
        date.children.clear(), date.value = std::string(words[0]);
        row.push_back(seconds_of(date, place));
        continue;
      }
      const auto value = number_in_text(words[i]);
      if (!value) throw data.error("'" + std::string(words[i].substr(0, 60)) + "' is no number");
      row.push_back(*value);
    }
    if (rows.size() > 1 && !(row[0] > rows[rows.size() - 2][0]))
      throw data.error("the times of the records do not ascend");
  }
  if (rows.empty()) throw data.error("no record");
  return rows;
}

void set_place(const Item& data, const std::vector<double>& row, Tree& key) {
  const Item* frame = data.find("@frame");
  const size_t kind = frame ? frame->choice({"scene", "sceneenu", "ecef", "geodetic"}) : 0;
  const auto number = [&](const char* name, double v) { key.set(name, Tree::number(v, data.where)); };
  if (kind <= 1) return void(key.set("position_m", Tree::numbers({row[1], row[2], row[3]}, data.where)));
  constexpr const char* names[2][3] = {{"ecef_x_m", "ecef_y_m", "ecef_z_m"},
                                       {"latitude_deg", "longitude_deg", "height_m"}};
  for (size_t i = 0; i < 3; ++i) number(names[kind - 2][i], row[1 + i]);
}

Tree waypoints(const Item& engine, const MotionPlace& place) {
  const Item& data = engine.at("data");
  Tree keys = Tree::list(data.where);
  for (const auto& row : rows_of(data, 4, place)) {
    Tree key = Tree::map(data.where);
    key.set("time_s", Tree::number(row[0], data.where));
    set_place(data, row, key);
    keys.push(std::move(key));
  }
  return held(std::move(keys), data.where);
}

double speed_of(const Item& engine) {
  const Item* speed = engine.any({"velocity", "speed"});
  return (speed ? *speed : engine.at("velocity")).number();
}

// The <location> of an element that leads to one under one of several names.
void set_named_location(const Item& engine, std::initializer_list<std::string_view> names, Tree& to) {
  const Item* at = engine.any(names);
  if (!at) throw engine.error("the motion has no place", "<" + std::string(*names.begin()) + "><location>...");
  set_location(at->has("location") ? at->at("location") : *at, to);
}

Tree straight(const Item& engine) {
  Tree made = Tree::map(engine.where);
  made.set("kind", Tree::word("straight", engine.where));
  set_named_location(engine, {"start", "startlocation", "location"}, made);
  made.set("heading_deg", Tree::number(engine.at("heading").number(), engine.where));
  made.set("speed_m_s", Tree::number(speed_of(engine), engine.where));
  return made;
}

Tree circling(const Item& engine) {
  Tree made = Tree::map(engine.where);
  made.set("kind", Tree::word("circle", engine.where));
  set_named_location(engine, {"center", "location", "centerlocation"}, made);
  made.set("radius_m", Tree::number(engine.at("radius").number_in(1e-6, 1e9), engine.where));
  made.set("speed_m_s", Tree::number(speed_of(engine), engine.where));
  if (const Item* start = engine.any({"startazimuth", "startangle", "azimuth"}))
    made.set(
        "start_azimuth_deg",
        Tree::number(start->number(Fate::approximated, "taken as a compass azimuth from the centre"), start->where));
  if (const Item* way = engine.any({"direction", "@direction"}))
    made.set("direction",
             Tree::word(lower_case(way->text()).starts_with("counter") ? "counterclockwise" : "clockwise", way->where));
  return made;
}

Tree orbit(const Item& engine) {
  const Item *one = engine.any({"tle1", "line1"}), *two = engine.any({"tle2", "line2"});
  if (!one || !two) throw engine.error("an orbit without its two lines", "<tle1> and <tle2>");
  Tree made = Tree::map(engine.where);
  made.set("kind", Tree::word("orbit", engine.where));
  Tree& lines = made.set("tle_lines", Tree::list(engine.where));
  lines.push(Tree::word(one->text(Fate::converted, "UT1 - UTC is that of the simulation"), one->where));
  lines.push(Tree::word(two->text(), two->where));
  return made;
}

Tree location_track(const Item& engine, const MotionPlace& place, bool& turns) {
  const size_t kind = engine.at("@type").choice({"fixed", "waypoints", "straight", "circling", "sgp4"});
  turns = kind >= 2;
  if (kind == 1) return waypoints(engine, place);
  if (kind == 2) return straight(engine);
  if (kind == 3) return circling(engine);
  if (kind == 4) return orbit(engine);
  Tree made = Tree::map(engine.where);
  made.set("kind", Tree::word("static", engine.where));
  set_location(engine.at("location"), made);
  return made;
}

Tree composed(Tree outer, Tree inner, const Where& where) {
  Tree made = Tree::map(where);
  made.set("kind", Tree::word("composed", where));
  made.set("outer", std::move(outer));
  made.set("inner", std::move(inner));
  return made;
}

// A straight motion whose body does not turn with it: two records.
Tree unturned(Tree straight, const Item& engine) {
  Tree* at = straight.find("position_m");
  if (!at) throw engine.error("a straight motion with an orientation of its own needs a start in the scene's frame");
  const double azimuth = *number_in_text(straight.find("heading_deg")->text) * kDegree,
               way = kLong * *number_in_text(straight.find("speed_m_s")->text);
  Tree keys = Tree::list(engine.where);
  for (const double side : {-1.0, 1.0}) {
    std::vector<double> p;
    for (const auto& [none, v] : at->entries) p.push_back(*number_in_text(v.text));
    p[0] += side * way * std::sin(azimuth), p[1] += side * way * std::cos(azimuth);
    Tree key = Tree::map(engine.where);
    key.set("time_s", Tree::number(side * kLong, engine.where));
    key.set("position_m", Tree::numbers(p, engine.where));
    keys.push(std::move(key));
  }
  Tree made = Tree::map(engine.where);
  made.set("kind", Tree::word("keyframes", engine.where));
  made.set("keys", std::move(keys));
  return made;
}

Tree orientation_keys(const Item& engine, const MotionPlace& place, bool quaternions) {
  const Item* data = engine.find("data");
  Tree keys = Tree::list(engine.where);
  const auto put = [&](double t, const std::array<double, 4>& q) {
    Tree key = Tree::map(engine.where);
    key.set("time_s", Tree::number(t, engine.where));
    key.set("position_m", Tree::numbers({0, 0, 0}, engine.where));
    key.set("quaternion", Tree::numbers({q[0], q[1], q[2], q[3]}, engine.where));
    keys.push(std::move(key));
  };
  const Item& said = data ? *data : engine;
  const double unit = radians_of(said.any({"@angularunits", "@units"}), false);
  const std::string order = order_of(said.find("@rotationorder"));
  if (data)
    for (const auto& row : rows_of(*data, quaternions ? 5 : 4, place))
      put(row[0], quaternions ? std::array<double, 4>{row[1], row[2], row[3], row[4]}
                              : turned({row[1] * unit, row[2] * unit, row[3] * unit}, order));
  else {
    const Item* angles = engine.any({"cartesiantriple", "eulerangles"});
    const Item& from = angles ? (angles->has("cartesiantriple") ? angles->at("cartesiantriple") : *angles) : engine;
    put(0, turned({from.at("x").number() * unit, from.at("y").number() * unit, from.at("z").number() * unit}, order));
  }
  return held(std::move(keys), engine.where);
}

// The direction that a pointed body keeps as nearly up as it can: a fixed vector, here always the zenith.
void read_up(const Item& up) {
  const Item* vector = up.find("@vector");
  const Item* frame = up.find("@frame");
  const Item* type = up.find("@type");
  const bool fixed = vector && type && (lower_case(type->value) == "constant" || lower_case(type->value) == "fixed");
  if (!fixed || !frame || lower_case(frame->value) != "scene")
    return up.mark_all(Fate::approximated, "up is the zenith");
  const std::vector<double> v = vector->numbers();
  if (v.size() != 3) throw vector->error("a direction is three numbers", "\"0,0,1\"");
  const bool zenith = v[0] == 0 && v[1] == 0 && v[2] > 0;
  for (const Item* item : {vector, frame, type})
    item->mark(zenith ? Fate::exact : Fate::approximated, zenith ? "" : "up is the zenith");
}

}  // namespace

Tree flexible_track(const Item& motion, const MotionPlace& place) {
  const Item& location = motion.at("locationengine");
  bool turns = false;
  Tree track = location_track(location, place, turns);
  const Item* orientation = motion.find("orientationengine");
  if (!orientation) return track;
  const size_t kind = orientation->at("@type").choice({"euler", "lookat", "spin", "velocity", "quaternions"});
  if (kind == 1 || kind == 3) {
    if (const Item* up = orientation->any({"up", "constraint"})) read_up(*up);
    Tree& pointing =
        track.set("pointing", kind == 3 ? Tree::word("velocity", orientation->where) : Tree::map(orientation->where));
    if (kind == 3) return track;
    Tree& target = pointing.set("look_at", Tree::map(orientation->where));
    set_location(orientation->at("location"), target);
    orientation->find("@type")->mark(Fate::converted, "the body's -z looks there");
    return track;
  }
  if (turns) {
    if (track.find("kind")->text != "straight") {
      orientation->mark_all(Fate::unsupported, "on circles and orbits the body keeps to its way");
      return track;
    }
    track = unturned(std::move(track), location);
  }
  if (kind == 2) {
    Tree spin = Tree::map(orientation->where);
    spin.set("kind", Tree::word("spin", orientation->where));
    spin.set("position_m", Tree::numbers({0, 0, 0}, orientation->where));
    const Item& axis = orientation->at("axis");
    const Item& from = axis.has("cartesiantriple") ? axis.at("cartesiantriple")
                       : axis.has("point")         ? axis.at("point")
                                                   : axis;
    spin.set("axis", Tree::numbers({from.at("x").number(), from.at("y").number(), from.at("z").number()}, axis.where));
    const Item& rate = orientation->at("rate");
    spin.set(
        "rate_deg_s",
        Tree::number(rate.number() * radians_of(rate.any({"@units", "@angularunits"}), true) / kDegree, rate.where));
    return composed(std::move(track), std::move(spin), motion.where);
  }
  return composed(std::move(track), orientation_keys(*orientation, place, kind == 4), motion.where);
}

namespace {

// One axis: {sigma, mean} or a density.
Tree axis_jitter(const Item& axis, const char* sigma, const char* mean, const char* density, double unit) {
  Tree made = Tree::map(axis.where);
  if (const Item* psd = axis.find("psd")) {
    std::vector<double> f, d;
    for (const Item* entry : psd->all("entry")) {
      f.push_back(entry->at("frequency").number());
      d.push_back(entry->at("magnitude").number(Fate::approximated, "taken as a one-sided density") * unit * unit);
      if (const Item* phase = entry->find("phase")) phase->mark(Fate::approximated, "phases are drawn");
    }
    Tree table = Tree::map(psd->where);
    table.set("frequency_hz", Tree::numbers(f, psd->where));
    table.set(density, Tree::numbers(d, psd->where));
    made.set("psd", std::move(table));
    return made;
  }
  if (const Item* spread = axis.any({"sigma", "standarddeviation", "stddev"}))
    made.set(sigma, Tree::number(spread->number_in(0, 1e9) * unit, spread->where));
  if (const Item* middle = axis.find("mean"))
    if (const double m = middle->number() * unit; m != 0 || made.empty())
      made.set(mean, Tree::number(m, middle->where));
  return made;
}

}  // namespace

void read_jitter(const Item& motion, Tree* jitter) {
  for (const bool turn : {false, true}) {
    const Item* from = motion.find(turn ? "orientationjitter" : "locationjitter");
    if (!from) continue;
    if (!jitter && !from->children.empty()) {
      from->mark_all(Fate::unsupported, "things of a scene do not shake");
      continue;
    }
    const char* kept = "read by what stands in it";
    expect_word(from->find("@type"), {"uncorrelated", "correlated", "none", "gaussian"}, kept);
    const double unit = turn ? radians_of(from->any({"@angularunits", "@units"}), false) : 1;
    for (const char* name : {"x", "y", "z"})
      if (const Item* axis = from->any({name, std::string(name) + "axis", std::string(name) + "jitter"})) {
        expect_word(axis->find("@type"), {"uncorrelated", "correlated", "none", "gaussian", "normal"}, kept);
        expect_word(axis->find("@distribution"), {"gaussian", "normal"}, "taken as gaussian");
        Tree made = axis_jitter(*axis, turn ? "sigma_rad" : "sigma_m", turn ? "mean_rad" : "mean_m",
                                turn ? "density_rad2_hz" : "density_m2_hz", unit);
        if (!made.empty()) jitter->set((turn ? "rotate_" : "") + std::string(name), std::move(made));
      }
  }
}

}  // namespace suite::dirsig
