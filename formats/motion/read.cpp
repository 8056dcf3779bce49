#include "base/files.h"
#include "base/run_app.h"
#include "formats/motion/fields.h"
#include "formats/motion/track_files.h"

namespace suite {

namespace {

constexpr int kDeepest = 64;  // tracks within tracks

// Runs `make` and gives an Error without a place the place of the node.
template <class F>
auto located(const Params& node, F make) {
  try {
    return make();
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw node.error(e.message(), e.hint());
  }
}

// YAML lists stand for several numbers: position_m for east, north, up; quaternion for qw, qx, qy, qz.
PoseFields fields_of(const Params& node) {
  PoseFields f;
  auto in_list = [](const char* name, const char* list_name, std::initializer_list<const char*> names) {
    int i = 0;
    for (const char* n : names) {
      if (std::string_view(n) == name) return std::pair{list_name, i};
      ++i;
    }
    return std::pair<const char*, int>{nullptr, 0};
  };
  auto list_of = [in_list](const char* name) {
    const auto p = in_list(name, "position_m", {"east_m", "north_m", "up_m"});
    return p.first ? p : in_list(name, "quaternion", {"qw", "qx", "qy", "qz"});
  };
  f.has = [node, list_of](const char* name) {
    if (node.has(name)) return true;
    const auto list = list_of(name);
    return list.first && node.has(list.first);
  };
  f.number = [node, list_of](const char* name) {
    const auto list = list_of(name);
    if (list.first && node.has(list.first)) {
      const Params values = node.at(list.first);
      const size_t size = std::string_view(list.first) == "quaternion" ? 4 : 3;
      if (node.has(name)) throw node.error(std::string("both ") + name + " and " + list.first, "use one of them");
      if (values.kind() != Params::Kind::list || values.size() != size)
        throw values.error(std::string(list.first) + strf(" needs a list of %zu numbers", size));
      return values.as_numbers()[static_cast<size_t>(list.second)];
    }
    return node.number(name);
  };
  f.text = [node](const char* name) { return node.text(name); };
  f.error = [node](std::string what, std::string hint) {
    const std::vector<std::string> known{"position_m", "east_m",    "north_m",      "up_m",     "ecef_x_m",
                                         "ecef_y_m",   "ecef_z_m",  "latitude_deg", "height_m", "longitude_deg",
                                         "utm_zone",   "easting_m", "northing_m"};
    for (const std::string& key : node.keys())
      if (const std::string near = nearest_name(key, known); !near.empty() && !node.has(near))
        hint = "is '" + key + "' meant to be '" + near + "'?";
    return node.error(std::move(what), std::move(hint));
  };
  return f;
}

TrackPtr make_track(const Params& node, const MotionContext& context, int depth);

// A table of timed poses, or one thing of a file of tracks.
TrackPtr track_of_file(const Params& file, const Params& node, const MotionContext& context) {
  const std::string path = motion_file(file, context), text = read_text(path);
  const TrackFileRow* row = track_file_of(text);
  if (!row) return keyframe_track(parse_pose_keys(text, path, context));
  std::vector<MovingThing> things = row->make(text, path, track_file_options(node, context));
  // A file of one thing need not be told its name.
  if (things.size() == 1 && !node.has("object")) return things.front().track;
  const std::string id = node.text("object");
  std::vector<std::string> known;
  std::vector<MovingThing> mine;
  for (MovingThing& thing : things) {
    known.push_back(thing.id);
    if (thing.id == id) mine.push_back(std::move(thing));
  }
  if (mine.empty()) throw node.at("object").error("nothing of the id '" + id + "' moves there", name_hint(id, known));
  if (mine.size() > 1)
    throw node.at("object").error("'" + id + "' is not there all the time between its first record and its last",
                                  "let the scene text's 'traffic' place it");
  return mine.front().track;
}

TrackPtr make_keyframes(const Params& node, const MotionContext& context) {
  if (const auto file = node.find("file")) return located(*file, [&] { return track_of_file(*file, node, context); });
  std::vector<PoseKey> keys;
  for (const Params& item : node.at("keys").items()) {
    const double time = time_from(item, context);
    if (!keys.empty() && !(time > keys.back().time))
      throw item.error("the times do not ascend", "each key later than the one before");
    keys.push_back({time, pose_from(item, context)});
  }
  return located(node, [&] { return keyframe_track(std::move(keys)); });
}

TrackPtr make_straight(const Params& node, const MotionContext& context) {
  StraightMotion m;
  m.start = position_from(node, context);
  m.azimuth = azimuth_from_compass_deg(node.number_in("heading_deg", -360, 360, "degrees"));
  m.climb = node.number_in("climb_deg", -90, 90, "degrees", 0) * kDegree;
  m.speed = node.number_in("speed_m_s", 0, 1e6, "m/s");
  m.t0 = node.number("t0_s", 0);
  if (node.boolean("follow_earth", false)) {
    if (!context.frame) throw node.at("follow_earth").error("following the Earth needs a scene with an origin on it");
    m.curved = &*context.frame;
  }
  return located(node, [&] { return straight_track(m); });
}

TrackPtr make_circle(const Params& node, const MotionContext& context) {
  CircleMotion m;
  m.center = position_from(node, context);
  m.radius = node.number("radius_m");
  m.speed = node.number("speed_m_s");
  m.azimuth = azimuth_from_compass_deg(node.number_in("start_azimuth_deg", -360, 360, "degrees", 0));
  m.bank = node.number_in("bank_deg", -90, 90, "degrees", 0) * kDegree;
  m.t0 = node.number("t0_s", 0);
  if (const auto d = node.find("direction")) m.clockwise = d->as_choice({"counterclockwise", "clockwise"}) == 1;
  return located(node, [&] { return circle_track(m); });
}

TrackPtr make_spin(const Params& node, const MotionContext& context) {
  SpinMotion m;
  m.base = pose_from(node, context);
  const auto axis = node.at("axis").as_vec3();
  m.axis = {axis[0], axis[1], axis[2]};
  if (const auto through = node.find("through_m")) {
    const auto p = through->as_vec3();
    m.through = {p[0], p[1], p[2]};
  }
  m.rate = node.number("rate_deg_s") * kDegree;
  m.t0 = node.number("t0_s", 0);
  return located(node, [&] { return spin_track(m); });
}

TrackPtr make_orbit(const Params& node, const MotionContext& context) {
  if (!context.frame) throw node.error("an orbit needs a scene with an origin on the Earth");
  if (!context.clock) throw node.error("an orbit needs the date of the simulation");
  const auto lines = node.find("tle_lines");
  if (lines && (lines->size() != 2 || !context.satellite_lines))
    throw lines->error("'tle_lines' are the two lines of an element set");
  SUITE_CHECK(lines || context.satellites != nullptr);
  return located(node, [&] {
    const OrbitElements elements =
        lines
            ? context.satellite_lines((*lines)[0].as_text() + "\n" + (*lines)[1].as_text() + "\n", lines->where().file)
            : context.satellites(motion_file(node.at("tle"), context), node.text("satellite"));
    const double dut1 = node.number_in("dut1_s", -0.9, 0.9, "s", context.dut1);
    // The equator turns by 465 m in a second.
    if (!node.has("dut1_s") && !context.dut1_given)
      note(strf(
          "satellite %s: dut1_s (UT1 - UTC) is not given and taken as 0; each 0.1 s of it moves the ground track by "
          "47 m along the equator, by definition at most 0.9 s and 419 m",
          elements.satellite.c_str()));
    return orbit_track(std::make_shared<const Sgp4>(elements), *context.frame, *context.clock, dut1);
  });
}

// Replaces the orientation when the node says so.
TrackPtr apply_pointing(TrackPtr track, const Params& node, const MotionContext& context, int depth) {
  const auto pointing = node.find("pointing");
  if (!pointing) return track;
  PointingRule rule;
  if (context.frame) rule.frame = &*context.frame;
  if (pointing->kind() == Params::Kind::scalar) {
    rule.kind = pointing->as_choice({"nadir", "velocity"}) == 0 ? Pointing::nadir : Pointing::velocity;
  } else {
    rule.kind = Pointing::look_at;
    const Params target = pointing->at("look_at");
    rule.target = target.has("kind") ? make_track(target, context, depth + 1)
                                     : static_track({{}, position_from(target, context)});
  }
  return pointed_track(std::move(track), rule);
}

TrackPtr make_track(const Params& node, const MotionContext& context, int depth) {
  if (depth > kDeepest) throw node.error("tracks are nested too deeply", strf("at most %d", kDeepest));
  const Params kind = node.at("kind");
  TrackPtr track;
  switch (kind.as_choice({"static", "keyframes", "straight", "circle", "spin", "orbit", "composed"})) {
    case 0:
      track = static_track(pose_from(node, context));
      break;
    case 1:
      track = make_keyframes(node, context);
      break;
    case 2:
      track = make_straight(node, context);
      break;
    case 3:
      track = make_circle(node, context);
      break;
    case 4:
      track = make_spin(node, context);
      break;
    case 5:
      track = make_orbit(node, context);
      break;
    default: {
      // The inner track lives in the outer one's axes, which have no place on the Earth.
      const MotionContext inside{
          std::nullopt,    context.clock, context.dut1,      context.satellites, context.satellite_lines,
          context.resolve, false,         context.dut1_given};
      track = composed_track(make_track(node.at("outer"), context, depth + 1),
                             make_track(node.at("inner"), inside, depth + 1));
    }
  }
  return apply_pointing(std::move(track), node, context, depth);
}

}  // namespace

std::string motion_file(const Params& file, const MotionContext& context) {
  if (context.resolve) return context.resolve(file);
  const std::string path = file.as_path();
  if (!file_exists(path))
    throw file.error("there is no file '" + path + "'", "relative names start at this file's folder");
  return path;
}

TrackPtr track_from(const Params& node, const MotionContext& context) {
  TrackPtr track = make_track(node, context, 0);
  const auto outside = node.find("outside");
  if (!outside || outside->as_choice({"error", "absent"}) == 0) return track;
  if (!context.may_end) throw outside->error("only placements of a scene can be absent", "leave out 'outside'");
  return ending_track(std::move(track));
}
Vec3 position_from(const Params& node, const MotionContext& context) { return fields_of(node).position(context); }
Pose pose_from(const Params& node, const MotionContext& context) { return fields_of(node).pose(context); }

namespace {
double date_from(const Params& utc, const MotionContext& context) {
  if (!context.clock)
    throw utc.error("a time in UTC needs the date of the simulation",
                    "use seconds, or give the text an epoch: 2026-06-21T10:30:00Z");
  return located(utc, [&] { return context.clock->seconds(parse_iso8601(utc.as_text())); });
}
}  // namespace

double time_from(const Params& node, const MotionContext& context) {
  const auto seconds = node.find("time_s"), utc = node.find("utc");
  if (seconds.has_value() == utc.has_value()) throw node.error("a time is needed once", "time_s or utc");
  return seconds ? seconds->as_number() : date_from(*utc, context);
}

TimeSpan read_life(const Params& p, const MotionContext& context) {
  const auto appears = p.find("appears"), disappears = p.find("disappears");
  TimeSpan life = kAlways;
  if (appears) life.begin = time_value(*appears, context);
  if (disappears) life.end = time_value(*disappears, context);
  if (!(life.begin < life.end))
    throw disappears->error(strf("it disappears at %.9g s and appears at %.9g s", life.end, life.begin),
                            "a lifetime ends after it begins", "SP412");
  return life;
}

double time_value(const Params& p, const MotionContext& context) {
  return p.as_text().find_first_of(":T") == std::string::npos ? p.as_number() : date_from(p, context);
}

}  // namespace suite
