// Generic motion, and what all motions share: places, times, turns.
#include "formats/dirsig/motion.h"

#include <cmath>

#include "math/dualquat.h"
#include "motion/scene_frame.h"
#include "motion/time.h"

namespace suite::dirsig {

Tree flexible_track(const Item& motion, const MotionPlace& place);
void read_jitter(const Item& motion, Tree* jitter);

namespace {

const Item* word_of(const Item& item, std::initializer_list<std::string_view> keys) { return item.any(keys); }

double angle_of(const Item& item) {
  const double unit = radians_of(item.any({"@units", "@angularunits"}), true);
  return item.number() * unit / kDegree;
}

void set_geodetic(const Geodetic& at, const Where& where, Tree& to) {
  to.set("latitude_deg", Tree::number(at.latitude_deg, where));
  to.set("longitude_deg", Tree::number(at.longitude_deg, where));
  to.set("height_m", Tree::number(at.height_m, where));
}

void set_utm(const Item& location, Tree& to) {
  const Item& zone = location.at("zone");
  const Item* half = word_of(location, {"hemisphere", "@hemisphere"});
  const std::string digits = zone.text();
  const bool south = half ? lower_case(half->text()).starts_with('s') : lower_case(digits).ends_with('s');
  const auto number = number_in_text(std::string_view(digits).substr(0, digits.find_first_not_of("0123456789")));
  if (!number) throw zone.error("'" + digits + "' is no zone", "1 to 60");
  const Item* height = word_of(location, {"altitude", "height"});
  const UtmPoint point{{static_cast<int>(*number), !south},
                       location.at("easting").number(Fate::converted),
                       location.at("northing").number(Fate::converted),
                       height ? height->number() : 0};
  try {
    set_geodetic(geodetic_from_utm(point), location.where, to);
  } catch (const Error& e) {
    throw location.error(e.message(), e.hint());
  }
}

}  // namespace

std::string order_of(const Item* attribute) {
  if (!attribute) return "xyz";
  const std::string order =
      lower_case(attribute->text(Fate::converted, "the first letter is turned about first, about fixed axes"));
  if (order.size() != 3 || order.find_first_not_of("xyz") != order.npos)
    throw attribute->error("an order of turns is three of x, y, z");
  return order;
}

double radians_of(const Item* attribute, bool degrees_unless_said) {
  if (!attribute) return degrees_unless_said ? kDegree : 1;
  return attribute->choice({"degrees", "radians", "deg", "rad"}) % 2 ? 1 : kDegree;
}

std::array<double, 4> turned(const std::array<double, 3>& angles, const std::string& order) {
  Quat q{1, 0, 0, 0};
  for (size_t i = 0; i < 3; ++i) {
    Vec3 axis;
    axis[order[i] - 'x'] = 1;
    q = quat_about(axis, angles[static_cast<size_t>(order[i] - 'x')]) * q;
  }
  return {q.w, q.x, q.y, q.z};
}

void set_location(const Item& location, Tree& to) {
  const Item* kind = location.any({"@frame", "@type"});
  const size_t frame = kind ? kind->choice({"scene", "sceneenu", "enu", "geodetic", "wgs84", "utm", "ecef"})
                            : (location.has("latitude") ? 3 : 0);
  if (frame <= 2) {
    const Item* inner = word_of(location, {"point", "cartesiantriple"});
    const Item& from = inner ? *inner : location;
    to.set("position_m",
           Tree::numbers({from.at("x").number(), from.at("y").number(), from.at("z").number()}, location.where));
  } else if (frame <= 4) {
    const Item* height = word_of(location, {"altitude", "height"});
    set_geodetic({angle_of(location.at("latitude")), angle_of(location.at("longitude")), height ? height->number() : 0},
                 location.where, to);
  } else if (frame == 5) {
    set_utm(location, to);
  } else {
    const Item* inner = word_of(location, {"point", "cartesiantriple"});
    const Item& from = inner ? *inner : location;
    set_geodetic(geodetic_from_ecef({from.at("x").number(Fate::converted), from.at("y").number(Fate::converted),
                                     from.at("z").number(Fate::converted)}),
                 location.where, to);
  }
}

double seconds_of(const Item& datetime, const MotionPlace& place) {
  const Item* type = datetime.find("@type");
  if (type ? type->choice({"relative", "absolute"}) == 0 : number_in_text(datetime.value).has_value())
    return datetime.number();
  const std::string& text = datetime.text(Fate::converted, "seconds from second 0");
  try {
    const Utc date = parse_iso8601(text);
    if (!place.epoch) throw Error("a date where none is known", "give seconds");
    if (place.epoch->empty()) *place.epoch = to_iso8601(date, 3);
    return Clock(parse_iso8601(*place.epoch)).seconds(date);
  } catch (const Error& e) {
    throw datetime.error(e.message(), e.hint());
  }
}

// keys of a track that holds its ends.
Tree held(Tree keys, const Where& where) {
  Tree made = Tree::map(where);
  if (keys.entries.size() == 1) {
    Tree only = std::move(keys.entries.front().second);
    made.set("kind", Tree::word("static", where));
    for (auto& [key, value] : only.entries)
      if (key != "time_s") made.set(key, std::move(value));
    return made;
  }
  Tree before = keys.entries.front().second, after = keys.entries.back().second;
  before.set("time_s", Tree::number(*number_in_text(before.find("time_s")->text) - kHeld, where));
  after.set("time_s", Tree::number(*number_in_text(after.find("time_s")->text) + kHeld, where));
  keys.entries.insert(keys.entries.begin(), {"", std::move(before)});
  keys.push(std::move(after));
  made.set("kind", Tree::word("keyframes", where));
  made.set("keys", std::move(keys));
  return made;
}

namespace {

Tree generic_track(const Item& motion, const MotionPlace& place) {
  if (const Item* method = motion.find("method"))
    if (const Item* type = method->find("@type"))
      type->mark(type->value == "raw" ? Fate::exact : Fate::unsupported,
                 type->value == "raw" ? "" : "records are taken as they are");
  const Item& data = motion.at("data");
  const std::string order = order_of(data.find("@rotationorder"));
  const double unit = radians_of(data.find("@angularunits"), false);
  if (const Item* frame = data.find("@rotationframe"))
    frame->mark(
        lower_case(frame->value) == "sceneenu" || lower_case(frame->value) == "scene" ? Fate::exact : Fate::unsupported,
        "orientations count in the scene's axes");
  if (const Item* type = data.find("@angletype"))
    type->mark(lower_case(type->value) == "absolute" ? Fate::exact : Fate::unsupported, "angles are taken as absolute");
  if (const Item* metres = data.find("@spatialunits"))
    metres->mark(lower_case(metres->value) == "meters" ? Fate::exact : Fate::unsupported, "places are taken in metres");
  Tree keys = Tree::list(data.where);
  const auto entries = data.all("entry");
  for (const Item* entry : entries) {
    entry->mark(entries.size() > 1 ? Fate::approximated : Fate::exact,
                entries.size() > 1
                    ? "between records the body moves on a screw; its place is linear where it does not turn"
                    : "");
    Tree key = Tree::map(entry->where);
    key.set("time_s", Tree::number(seconds_of(entry->at("datetime"), place), entry->where));
    const Item& position = entry->at("position");
    set_location(position.at("location"), key);
    if (const Item* orientation = entry->find("orientation")) {
      const Item& angles = orientation->at("eulerangles").at("cartesiantriple");
      const auto q = turned(
          {angles.at("x").number() * unit, angles.at("y").number() * unit, angles.at("z").number() * unit}, order);
      key.set("quaternion", Tree::numbers({q[0], q[1], q[2], q[3]}, orientation->where));
    }
    keys.push(std::move(key));
  }
  if (keys.entries.empty()) throw data.error("a motion without a record", "<entry>");
  return held(std::move(keys), data.where);
}

}  // namespace

Tree track_of(const Item& motion, const MotionPlace& place, Tree* jitter) {
  const Item* type = motion.find("@type");
  read_jitter(motion, jitter);
  const size_t kind = type ? type->choice({"generic", "flexible", "flex"}) : motion.has("locationengine");
  return kind == 0 ? generic_track(motion, place) : flexible_track(motion, place);
}

Tree track_of_mov(const Item& mov, const MotionPlace& place) {
  expect_word(mov.find("DIRSIG_MOV"), {"1.0", "1"}, "read as version 1.0");
  if (const Item* options = mov.find("OPTIONS")) options->mark_all(Fate::unsupported, "options of delta motion");
  const Item& init = mov.at("INIT_POSITION");
  double t = 0;
  if (const Item* date = init.find("DATE")) {
    const auto d = date->numbers(Fate::converted, "seconds from second 0");
    const Item *offset = init.find("GMT_OFFSET"), *local = init.find("LOCAL_TIME"), *gmt = init.find("GMT_TIME");
    if (d.size() != 3) throw date->error("a date is month, day and year");
    const double hours =
        gmt ? gmt->number_in(0, 24) : (local ? local->number_in(0, 24) : 0) + (offset ? offset->number_in(-14, 14) : 0);
    try {
      const Instant at =
          instant_from_utc({static_cast<int>(d[2]), static_cast<int>(d[0]), static_cast<int>(d[1]), 0, 0, 0}) +
          hours * 3600;
      if (place.epoch && place.epoch->empty()) *place.epoch = to_iso8601(utc_from_instant(at), 3);
      if (place.epoch) t = Clock(parse_iso8601(*place.epoch)).seconds(at);
    } catch (const Error& e) {
      throw date->error(e.message(), "month day year");
    }
  }
  const auto triple = [&](const char* key, double otherwise) {
    const Item* item = init.find(key);
    const auto v = item ? item->numbers() : std::vector<double>(3, otherwise);
    if (v.size() != 3) throw item->error("three numbers are expected");
    return std::array<double, 3>{v[0], v[1], v[2]};
  };
  std::array<double, 3> at = triple("TRANSLATION", 0), turn = triple("ROTATION", 0);
  const auto scale = triple("SCALE", 1);
  if (const Item* s = init.find("SCALE"); s && (scale[0] != 1 || scale[1] != 1 || scale[2] != 1))
    s->mark(Fate::unsupported, "what moves keeps its size");
  Tree keys = Tree::list(mov.where);
  const auto put = [&](const Where& where) {
    Tree key = Tree::map(where);
    key.set("time_s", Tree::number(t, where));
    key.set("position_m", Tree::numbers({at[0], at[1], at[2]}, where));
    const auto q = turned(turn, "xyz");
    key.set("quaternion", Tree::numbers({q[0], q[1], q[2], q[3]}, where));
    keys.push(std::move(key));
  };
  put(init.where);
  for (const Item* move : mov.at("MOVES").all("MOVE")) {
    const auto v = move->numbers(Fate::converted, "steps are added up; rotations in radians");
    if (v.size() != 10 || !(v[0] > 0))
      throw move->error("a MOVE is ten numbers", "seconds (above 0), translation, scale, rotation");
    t += v[0];
    for (size_t i = 0; i < 3; ++i) at[i] += v[1 + i], turn[i] += v[7 + i];
    if (v[4] != 0 || v[5] != 0 || v[6] != 0) move->mark(Fate::unsupported, "what moves keeps its size");
    put(move->where);
  }
  return held(std::move(keys), mov.where);
}

}  // namespace suite::dirsig
