// Motions of nodes as tracks. Places between keys lie on a straight line and turns go evenly the shorter way round,
// which is what the file means by LINEAR; jumps and splines are approached by more keys, and that is told.
// Based on: Khronos Group, "glTF 2.0 Specification", 2021, section 3.11 and appendix C.
#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "formats/gltf/load.h"
#include "motion/track.h"

namespace suite::gltf {

namespace {

constexpr double kJump_s = 1e-6;      // how long a jump takes here
constexpr size_t kSplinePieces = 32;  // straight pieces in place of one of a spline
constexpr size_t kMostKeys = 10'000'000;

enum class Between { linear, step, spline };

// One channel: a vector of 3 or 4 numbers over time.
struct Channel {
  std::vector<double> time, value;
  size_t width = 3;
  Between between = Between::linear;

  const double* key(size_t k) const { return &value[(between == Between::spline ? 3 * k + 1 : k) * width]; }
  std::array<double, 4> at(double t) const;
};

Quat quat_of(const double* q) { return normalized(Quat{q[3], q[0], q[1], q[2]}); }

std::array<double, 4> Channel::at(double t) const {
  std::array<double, 4> v{};
  const auto after = static_cast<size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin());
  if (after == 0 || after == time.size() || between == Between::step) {
    std::copy_n(key(after == 0 ? 0 : after - 1), width, v.begin());
    return v;
  }
  const size_t k = after - 1;
  const double d = time[after] - time[k], s = (t - time[k]) / d;
  if (between == Between::linear && width == 4) {
    const Quat q = sclerp({quat_of(key(k)), {}}, {quat_of(key(after)), {}}, s).rotation;
    return {q.x, q.y, q.z, q.w};
  }
  for (size_t c = 0; c < width; ++c)
    if (between == Between::linear) {
      v[c] = key(k)[c] + s * (key(after)[c] - key(k)[c]);
    } else {  // Hermite's, with the tangents stored beside the keys
      const double out = value[(3 * k + 2) * width + c], in = value[3 * after * width + c];
      v[c] = (2 * s * s * s - 3 * s * s + 1) * key(k)[c] + d * (s * s * s - 2 * s * s + s) * out +
             (-2 * s * s * s + 3 * s * s) * key(after)[c] + d * (s * s * s - s * s) * in;
    }
  return v;
}

struct Moving {
  std::optional<Channel> place, turn;
};

class Animator {
 public:
  Animator(const tinygltf::Model& model, const std::string& file, const tinygltf::Animation& animation, size_t number)
      : model_(model), file_(file), animation_(animation), pointer_(strf("animations[%zu]", number)) {}
  void read(Report& report);
  void apply(const SourceModelOptions& options, std::vector<Local>& locals, Report& report) const;

 private:
  Channel channel(const tinygltf::AnimationChannel& c, const std::string& at, size_t width);
  std::set<double> times_of(const Moving& moving) const;
  void add_finding(const char* code, size_t count, const std::string& what, Report& report) const {
    if (count) report.add(code, file_, {Where{file_, 0, 0, {}, -1}, pointer_ + ": " + what}, count);
  }

  const tinygltf::Model& model_;
  const std::string& file_;
  const tinygltf::Animation& animation_;
  const std::string pointer_;
  std::map<size_t, Moving> moving_;
  double begin_ = INFINITY, end_ = -INFINITY;
  size_t jumps_ = 0, splines_ = 0;
};

Channel Animator::channel(const tinygltf::AnimationChannel& c, const std::string& at, size_t width) {
  const tinygltf::AnimationSampler& sampler =
      item_of(animation_.samplers, c.sampler, file_, at + "/sampler", "sampler");
  const std::string where = strf("%s/samplers[%d]", pointer_.c_str(), c.sampler);
  Channel made;
  made.width = width;
  if (sampler.interpolation == "STEP")
    made.between = Between::step, ++jumps_;
  else if (sampler.interpolation == "CUBICSPLINE")
    made.between = Between::spline, ++splines_;
  else if (!sampler.interpolation.empty() && sampler.interpolation != "LINEAR")
    throw fault(file_, where + "/interpolation", "'" + printable(sampler.interpolation).substr(0, 40) + "'",
                "LINEAR, STEP or CUBICSPLINE");
  made.time = values_of(model_, file_, sampler.input, where + "/input", {1}).numbers;
  const Values values = values_of(model_, file_, sampler.output, where + "/output", {width});
  const size_t each = made.between == Between::spline ? 3 : 1;
  if (made.time.empty() || values.count != each * made.time.size())
    throw fault(file_, where, strf("%zu values for %zu times", values.count, made.time.size()),
                each == 3 ? "three for each time" : "one for each time, and one at least");
  made.value = values.numbers;
  for (size_t k = 1; k < made.time.size(); ++k)
    if (!(made.time[k] > made.time[k - 1])) throw fault(file_, where + "/input", "times do not go up");
  if (width == 4)
    for (size_t k = 0; k < made.time.size(); ++k) {
      const double* q = made.key(k);
      if (!(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] > 1e-12))
        throw fault(file_, where + "/output", strf("key %zu is a quaternion without length", k));
    }
  begin_ = std::min(begin_, made.time.front()), end_ = std::max(end_, made.time.back());
  return made;
}

void Animator::read(Report& report) {
  size_t scales = 0, weights = 0, others = 0;
  for (size_t k = 0; k < animation_.channels.size(); ++k) {
    const tinygltf::AnimationChannel& c = animation_.channels[k];
    const std::string at = strf("%s/channels[%zu]", pointer_.c_str(), k);
    if (c.target_node < 0) continue;  // to be ignored, says the specification
    const tinygltf::Node& node = item_of(model_.nodes, c.target_node, file_, at + "/target/node", "node");
    const bool place = c.target_path == "translation", turn = c.target_path == "rotation";
    scales += c.target_path == "scale", weights += c.target_path == "weights";
    if (!place && !turn) {
      others += c.target_path != "scale" && c.target_path != "weights";
      continue;
    }
    if (!node.matrix.empty())
      throw fault(file_, at + "/target/node", strf("node %d is placed by a matrix", c.target_node),
                  "what moves has translation, rotation and scale");
    std::optional<Channel>& to =
        place ? moving_[static_cast<size_t>(c.target_node)].place : moving_[static_cast<size_t>(c.target_node)].turn;
    if (to) throw fault(file_, at, strf("a second %s of node %d", c.target_path.c_str(), c.target_node));
    to = channel(c, at, place ? 3 : 4);
  }
  add_finding("SP705", scales, "scales that change with time; sizes stay those of the nodes", report);
  add_finding("SP705", weights, "weights of morph targets that change with time", report);
  add_finding("SP705", others, "channels of an unknown kind", report);
}

// The times at which poses become keys.
std::set<double> Animator::times_of(const Moving& moving) const {
  std::set<double> times{begin_, end_};
  for (const auto* c : {&moving.place, &moving.turn}) {
    if (!*c) continue;
    const std::vector<double>& time = (*c)->time;
    for (size_t k = 0; k < time.size(); ++k) {
      times.insert(time[k]);
      if (k == 0) continue;
      const double d = time[k] - time[k - 1];
      if ((*c)->between == Between::step) times.insert(time[k] - std::min(kJump_s, d / 2));
      if ((*c)->between == Between::spline)
        for (size_t i = 1; i < kSplinePieces; ++i)
          times.insert(time[k - 1] + d * static_cast<double>(i) / kSplinePieces);
    }
  }
  if (times.size() > kMostKeys) throw fault(file_, pointer_, "more than 1e7 keys");
  return times;
}

void Animator::apply(const SourceModelOptions& options, std::vector<Local>& locals, Report& report) const {
  for (const auto& [n, moving] : moving_) {
    const tinygltf::Node& node = model_.nodes[n];
    Pose rest;
    if (const auto& t = node.translation; !t.empty()) rest.translation = {t[0], t[1], t[2]};
    if (const auto& r = node.rotation; !r.empty()) rest.rotation = normalized(Quat{r[3], r[0], r[1], r[2]});
    const auto pose_at = [&](double t) {
      Pose pose = rest;
      if (moving.place) {
        const auto v = moving.place->at(t);
        pose.translation = {v[0], v[1], v[2]};
      }
      if (moving.turn) {
        const auto v = moving.turn->at(t);
        // A spline of quaternions may pass through 0, where nothing is turned in any way.
        if (const Quat q{v[3], v[0], v[1], v[2]}; dot(q, q) > 1e-24) pose.rotation = normalized(q);
      }
      pose.translation = pose.translation * options.unit_m;
      return pose;
    };
    if (!(begin_ < end_)) {
      locals[n].at_rest = pose_at(begin_).affine() * locals[n].scale;
      continue;
    }
    InterpolatedMotion motion{{}, 1, {begin_, end_}};
    for (const double t : times_of(moving)) motion.keys.push_back({t, pose_at(t)});
    locals[n].motion = interpolated_track(std::move(motion));
  }
  add_finding("SP707", jumps_, strf("jumps take %g s", kJump_s), report);
  add_finding("SP707", splines_, strf("splines are %zu straight pieces from key to key", kSplinePieces), report);
}

// The animation that is asked for; nothing when none is, or there is none.
std::optional<size_t> chosen(const tinygltf::Model& model, const std::string& file, const SourceModelOptions& options,
                             Report& report) {
  const std::string& name = options.animation;
  const size_t count = model.animations.size();
  const Where where{file, 0, 0, {}, -1};
  std::vector<std::string> names;
  for (const tinygltf::Animation& a : model.animations) names.push_back(a.name);
  if (name.empty()) {
    if (count > 1)
      report.add("SP707", file,
                 {where, strf("animations: the first of %zu is taken; 'animation' names another one", count)});
    return count ? std::optional<size_t>(0) : std::nullopt;
  }
  if (name == "none") {
    if (count) report.add("SP706", file, {where, strf("animations: %zu are left out, as asked for", count)});
    return std::nullopt;
  }
  if (const auto found = std::find(names.begin(), names.end(), name); found != names.end())
    return static_cast<size_t>(found - names.begin());
  size_t number = 0;
  const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (code == std::errc() && end == name.data() + name.size() && number < count) return number;
  throw Error(options.where, "'" + file + "' has no animation '" + name + "'",
              count ? name_hint(name, names) : "it has none", "SP001");
}

}  // namespace

void animate(const tinygltf::Model& model, const std::string& file, const SourceModelOptions& options,
             std::vector<Local>& locals, Report& report) {
  const auto number = chosen(model, file, options, report);
  if (!number) return;
  Animator animator(model, file, model.animations[*number], *number);
  animator.read(report);
  animator.apply(options, locals, report);
}

}  // namespace suite::gltf
