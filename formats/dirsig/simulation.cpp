// Simulations: .sim (XML) and .jsim (JSON), the files they name, and their tasks.
#include "base/files.h"
#include "formats/dirsig/grammar.h"
#include "formats/dirsig/simulation_writer.h"
#include "motion/time.h"

namespace suite::dirsig {

namespace {

std::string utc_of(const Item& datetime) {
  try {
    return to_iso8601(parse_iso8601(datetime.text(Fate::converted, "UTC")), 3);
  } catch (const Error& e) {
    throw datetime.error(e.message(), e.hint());
  }
}

}  // namespace

MadeText simulation_of(Import& import, const std::string& file, const SimulationHelp& help) {
  return SimulationWriter(import, file, help).run();
}

SimulationWriter::SimulationWriter(Import& import, std::string file, const SimulationHelp& help)
    : import_(import), file_(std::move(file)), help_(help) {
  where_ = {file_, 1, 1, {}, -1};
  folders_ = {folder_of(file_)};
  root_ = Tree::map(where_), sun_ = Tree::map(where_), lamps_ = Tree::list(where_);
}

MadeText SimulationWriter::run() {
  const std::string low = lower_case(file_);
  if (low.ends_with(".jsim"))
    read_jsim(import_.json(file_));
  else if (low.ends_with(".sim"))
    read_sim(import_.xml(file_, "simulation"));
  else
    throw Error(where_, "of configurations of DIRSIG3 only the scene is read",
                "scene-prep reads it; write a .sim for the rest");
  finish();
  return print(root_, {"made from " + file_ + " by the import of DIRSIG's files"});
}

// An element that may stand in a file of its own.
const Item& SimulationWriter::part_of(const Item& sim, const char* name, const char* kind) {
  const Item& part = sim.at(name);
  const Item* file = part.find("@externalfile");
  if (!file) return part;
  part.mark(Fate::exact);
  const Item& root = import_.xml(import_.file_of(*file, folders_), kind);
  // Flexible motion has a name of its own.
  const bool motion = root.name == "motion" && std::string_view(name) == "platformmotion";
  if (root.name != name && !motion)
    throw root.error("the root is <" + root.name + ">", std::string("<") + name + "> is expected");
  return root;
}

void SimulationWriter::read_sim(const Item& sim) {
  if (sim.name != "simulation") throw sim.error("the root is <" + sim.name + ">", "<simulation> is expected");
  for (const char* name : {"metadata", "options"})
    if (const Item* extra = sim.find(name))
      extra->mark_all(Fate::ignored, "options of DIRSIG's own solvers and windows");
  const Item& scene = sim.at("scene");
  scene.mark(Fate::exact);
  const Item& named = scene.at("@externalfile");
  add_scene(named, import_.file_of(named, folders_), {});
  PlatformParts parts;
  parts.tasks = &part_of(sim, "tasklist", "tasks");
  find_epoch(*parts.tasks);
  read_atmosphere(part_of(sim, "atmosphericconditions", "atmosphere"));
  parts.platform = &part_of(sim, "platform", "platform");
  parts.motion = &part_of(sim, "platformmotion", "platform motion");
  platforms_.push_back(parts);
}

void SimulationWriter::read_jsim(const Item& jsim) {
  const auto jobs = jsim.all("item");
  if (jobs.empty() && jsim.has("scene_list")) return read_job(jsim);
  if (jobs.empty()) throw jsim.error("a simulation without anything in it", "scene_list and plugin_list");
  read_job(*jobs[0]);
  for (size_t i = 1; i < jobs.size(); ++i)
    jobs[i]->mark_all(Fate::unsupported, "the first simulation of a file is run");
}

void SimulationWriter::read_job(const Item& job) {
  job.mark(Fate::exact);
  for (const Item* scene : job.at("scene_list").all("item")) {
    scene->mark(Fate::exact);
    const Item& named = scene->at("inputs");
    std::array<double, 3> at{};
    if (const Item* offset = scene->find("offset")) {
      std::vector<double> v;
      if (offset->value.empty())
        for (const Item* one : offset->all("item")) v.push_back(one->number());
      else
        v = offset->numbers();
      if (v.size() != 3) throw offset->error("an offset is three numbers", "\"x,y,z\"");
      at = {v[0], v[1], v[2]};
    }
    add_scene(named, import_.file_of(named, folders_), at);
  }
  const auto plugins = job.at("plugin_list").all("item");
  // Dates and ephemerides first, which the others count from.
  for (const Item* plugin : plugins)
    if (plugin->has("name") && plugin->at("name").value == "BasicPlatform" && plugin->has("inputs"))
      if (const Item* tasks = plugin->at("inputs").find("tasks_filename"))
        find_epoch(import_.xml(import_.file_of(*tasks, folders_), "tasks"));
  const Item* fixed = nullptr;
  for (const Item* plugin : plugins) {
    read_plugin(*plugin);
    const std::string& name = plugin->at("name").value;
    if (name == "FixedEphemeris") fixed = plugin->find("inputs");
    if (fixed && (name == "BasicAtmosphere" || name == "SpiceEphemeris"))
      fixed->at("solar_zenith")
          .mark(Fate::approximated, "the fixed Sun holds here wherever it stands; in DIRSIG the last ephemeris does, " +
                                        name + " behind it brings that of the date");
  }
  if (const Item* media = job.find("medium_list"); media && !media->children.empty())
    media->mark_all(Fate::unsupported, "media of plugins are not read: give the scene volumes");
}

void SimulationWriter::read_plugin(const Item& plugin) {
  plugin.mark(Fate::exact);
  const Item& name = plugin.at("name");
  const Item* inputs = plugin.find("inputs");
  if (const Item* file = plugin.find("input_filename"); file && !inputs)
    inputs = &import_.json(import_.file_of(*file, folders_));
  const std::string kind = name.text();
  if (!inputs) {
    name.mark(kind == "SpiceEphemeris" ? Fate::exact : Fate::unsupported, "a plugin without inputs");
  } else if (kind == "BasicAtmosphere") {
    const Item& file = inputs->at("atmosphere_filename");
    read_atmosphere(import_.xml(import_.file_of(file, folders_), "atmosphere"));
  } else if (kind == "NewAtmosphere") {
    read_new_atmosphere(*inputs);
  } else if (kind == "FourCurveAtmosphere") {
    const Item* file = inputs->any({"hdf_filename", "filename", "input_filename"});
    if (!file) throw inputs->error("an atmosphere without its file", "hdf_filename");
    Tree& tables = root_.set("atmosphere", Tree::map(plugin.where)).set("tables", Tree::list(plugin.where));
    Tree one = Tree::map(file->where);
    one.set("file", Tree::word(import_.name_of(import_.file_of(*file, folders_)), file->where));
    if (const Item* condition = inputs->any({"condition", "condition_name"}))
      one.set("condition", Tree::word(condition->text(), condition->where));
    tables.push(std::move(one));
  } else if (kind == "BasicPlatform") {
    read_platform_plugin(*inputs);
  } else if (kind == "FixedEphemeris") {
    read_ephemeris(*inputs);
  } else if (kind == "SpiceEphemeris") {
    inputs->mark_all(Fate::ignored, "Sun and Moon stand where their theories of ERFA have them");
  } else if (kind == "ThermWeather") {
    read_weather(*inputs);
  } else if (kind == "NsrdbWeather") {
    inputs->mark_all(heat_ ? Fate::unsupported : Fate::ignored,
                     heat_ ? "this weather is not read: write it as CSV (formats/weather) for a converted simulation"
                           : "no temperature of the scene follows from weather");
  } else {
    name.mark(Fate::unsupported, "a plugin that is not known here");
    inputs->mark_all(Fate::unsupported, "of a plugin that is not known here");
  }
}

void SimulationWriter::read_platform_plugin(const Item& inputs) {
  PlatformParts parts;
  const auto part = [&](const char* key, const char* kind) {
    return &import_.xml(import_.file_of(inputs.at(key), folders_), kind);
  };
  parts.platform = part("platform_filename", "platform");
  parts.motion = part("motion_filename", "platform motion");
  parts.tasks = part("tasks_filename", "tasks");
  if (const Item* split = inputs.find("split_channels")) split->mark(Fate::ignored, "bins are chosen for all channels");
  if (const Item* prefix = inputs.find("output_prefix")) prefix->mark(Fate::exact), parts.prefix = prefix->value;
  if (const Item* folder = inputs.find("output_folder"))
    folder->mark(Fate::ignored, "dirsig-render -o names the folder");
  platforms_.push_back(parts);
}

void SimulationWriter::read_ephemeris(const Item& inputs) {
  const Item &zenith = inputs.at("solar_zenith"), &azimuth = inputs.at("solar_azimuth");
  Tree direction = Tree::map(zenith.where);
  direction.set("zenith_deg", Tree::number(zenith.number_in(0, 180), zenith.where));
  direction.set("azimuth_deg", Tree::number(azimuth.number(Fate::exact, "a compass azimuth"), azimuth.where));
  sun_.set("direction", std::move(direction));
  fixed_sun_ = true;
  for (const Item& more : inputs.children)
    if (more.name.starts_with("lunar_")) more.mark(Fate::ignored, "no Moon is set up");
}

void SimulationWriter::add_scene(const Item& named, const std::string& path, const std::array<double, 3>& offset) {
  const SceneMade scene = scene_of(import_, path);
  for (const auto& [none, lamp] : scene.lamps.entries) lamps_.push(lamp);
  if (!origin_) origin_ = scene.origin;
  heat_ = heat_ || scene.heat;
  Tree one = Tree::map(named.where);
  one.set("file", Tree::word(import_.name_of(help_.prepared(path, scene)), named.where));
  one.set("translate", Tree::numbers({offset[0], offset[1], offset[2]}, named.where));
  root_.list_at("scenes", named.where).push(std::move(one));
}

void SimulationWriter::find_epoch(const Item& tasks) {
  const Item* reference = tasks.find("reference");
  const Item* date = reference ? reference->find("datetime") : nullptr;
  if (!date || !epoch_.empty()) return;
  if (const Item* type = date->find("@type"); type && type->choice({"relative", "absolute"}) == 0)
    throw date->error("the reference of the tasks is no date", "type=\"absolute\"");
  epoch_ = utc_of(*date);
  zone_h_ = zone_of(date->value);
}

Tree SimulationWriter::tasks_of(const Item& tasks) {
  find_epoch(tasks);
  Tree list = Tree::list(tasks.where);
  const MotionPlace place{import_, folders_, &epoch_};
  for (const Item* task : tasks.all("task")) {
    task->mark(Fate::exact);
    if (const Item* extra = task->find("metadata")) extra->mark_all(Fate::ignored, "for people");
    if (const Item* name = task->find("@name")) name->mark(Fate::ignored, "for people");
    const auto time = [&](const char* key) {
      const Item& edge = task->at(key);
      return seconds_of(edge.has("datetime") ? edge.at("datetime") : edge, place);
    };
    Tree one = Tree::map(task->where);
    one.set("start", Tree::number(time("start"), task->where));
    one.set("stop", Tree::number(time("stop"), task->where));
    list.push(std::move(one));
  }
  if (list.entries.empty()) throw tasks.error("no task", "<task><start/><stop/>");
  return list;
}

void SimulationWriter::finish() {
  root_.list_at("sensors", where_);
  if (platforms_.empty()) throw Error(where_, "nothing looks at the scene", "a platform (BasicPlatform) is needed");
  for (const PlatformParts& parts : platforms_) read_platform(parts);
  Tree whole = Tree::map(where_);
  Tree* scenes = root_.find("scenes");
  if (!scenes) throw Error(where_, "no scene");
  const Tree& first = scenes->entries[0].second;
  bool alone = scenes->entries.size() == 1;
  for (const auto& [key, value] : first.entries)
    if (key == "translate")
      for (const auto& [none, v] : value.entries) alone = alone && v.text == "0";
  if (alone)
    whole.set("scene", first.entries[0].second);
  else
    whole.set("scenes", *scenes);
  if (!epoch_.empty()) whole.set("epoch", Tree::word(epoch_, where_));
  if (!no_sun_) {
    if (!fixed_sun_) {
      if (epoch_.empty())
        throw Error(where_, "neither the Sun's place nor a date is given", "FixedEphemeris, or tasks with a date");
      sun_.map_at("direction", where_).set("time_utc", Tree::word(epoch_, where_));
    }
    whole.set("sun", sun_);
  }
  for (auto& [key, value] : root_.entries)
    if (key != "scenes" && key != "sensors") whole.set(key, std::move(value));
  if (!lamps_.empty()) whole.set("lamps", lamps_);
  whole.set("sensors", *root_.find("sensors"));
  root_ = std::move(whole);
}

}  // namespace suite::dirsig
