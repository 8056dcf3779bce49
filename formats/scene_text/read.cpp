#include <filesystem>
#include <iterator>

#include "base/files.h"
#include "base/placed.h"
#include "formats/scene_text/reader.h"
#include "motion/time.h"
#include "spectral/wavelength.h"

namespace suite {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

namespace scene_text {

void Reader::item(const char* code, const Params& p, const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& e) {
    report_.add(placed(e, p.where()), draft_.file, code);  // what libraries refuse has no place of its own
    p.mark_read();
  }
}

std::string Reader::input(const Params& p) {
  const std::string name = p.as_text();
  TrackedInputs::Added added;
  try {
    added = inputs_.add(name);
  } catch (const Error& e) {
    // Where it is named says more than where it was looked for.
    throw Error(p.where(), "file '" + name + "' " + e.message(), e.hint(), "SP003");
  }
  if (added.first && (ends_with(added.path, ".sli") || ends_with(added.path, ".img"))) header_input(name);
  return added.path;
}

// The header of an ENVI image or library decides as much as its values; so would one that is found before it.
void Reader::header_input(const std::string& name) {
  const std::string file = std::filesystem::path(name).filename().string();
  for (const std::string& header : {file + ".hdr", std::filesystem::path(file).stem().string() + ".hdr"})
    inputs_.add_companion(name, header);
}

// none, wgs84, or {tolerance_m}.
void Reader::read_curvature(const Params& p, const Params& root) {
  double tolerance = 0.01;
  if (p.kind() == Params::Kind::map)
    tolerance = p.number_in("tolerance_m", 1e-6, 1e3, "m");
  else if (p.as_choice({"none", "wgs84"}) == 0)
    return;
  if (!root.has("origin")) throw p.error("'curvature' needs the scene's 'origin'");
  draft_.curvature_m = tolerance;
  draft_.curvature_where = p.where();
}

// What holds for the scene as a whole.
void Reader::read_head(const Params& root) {
  root.integer("scene", 1, 1);
  draft_.name = root.text("name", "");
  draft_.description = root.text("description", "");
  draft_.author = root.text("author", "");
  if (const auto o = root.find("origin")) item("SP001", *o, [&] { read_origin(*o); });
  if (const auto c = root.find("curvature")) item("SP001", *c, [&] { read_curvature(*c, root); });
  if (const auto e = root.find("epoch"))
    item("SP001", *e, [&] {
      try {
        draft_.epoch = to_iso8601(parse_iso8601(e->as_text()), 9);
      } catch (const Error& fault) {
        throw e->error(fault.message(), fault.hint());
      }
    });
  if (const auto t = root.find("times_s"))
    item("SP001", *t, [&] {
      const std::vector<double> edge = t->as_numbers();
      if (edge.size() != 2 || !(edge[0] <= edge[1])) throw t->error("'times_s' is [begin, end] in seconds");
      draft_.times = TimeWindowSpec{edge[0], edge[1], t->where()};
    });
  if (const auto windows = root.find("windows_um"))
    for (const Params& w : windows->items())
      item("SP001", w, [&] {
        const std::vector<double> edge = w.as_numbers();
        if (edge.size() != 2 || !(edge[0] > 0 && edge[0] < edge[1])) throw w.error("a window is [low, high] in micron");
        if (edge[1] > kLongestWave)
          throw w.error("the window is " + wavelengths_text(edge[0], edge[1]),
                        strf("windows end at %g um", kLongestWave));
        draft_.windows.push_back({edge[0], edge[1], w.where()});
      });
}

void Reader::run(const Params& root) {
  read_head(root);
  const auto each = [&](const char* key, const char* code,
                        const std::function<void(const std::string&, const Params&)>& read) {
    const auto table = root.find(key);
    if (!table) return;
    item(code, *table, [&] {
      for (const std::string& name : table->keys()) {
        const Params p = table->at(name);
        item(code, p, [&] { read(name, p); });
      }
    });
  };
  each("curves", "SP101", [&](const std::string& name, const Params& p) { curves_[name] = read_curve_value(p); });
  each("media", "SP601", [&](const std::string& name, const Params& p) { read_medium(name, p); });
  if (const auto ambient = root.find("ambient")) draft_.ambient = reference(*ambient);
  each("materials", "SP101", [&](const std::string& name, const Params& p) { read_material(name, p); });
  each("maps", "SP501", [&](const std::string& name, const Params& p) { read_map(name, p); });
  each("grids", "SP601", [&](const std::string& name, const Params& p) { read_grid(name, p); });
  if (const auto volumes = root.find("volumes"))
    for (const Params& p : volumes->items()) item("SP601", p, [&] { read_volume(p); });
  each("objects", "SP001", [&](const std::string& name, const Params& p) { read_geometry(name, p); });
  item("SP001", root.has("world") ? root.at("world") : root, [&] { read_group("world", root.at("world")); });
  each("groups", "SP001", [&](const std::string& name, const Params& p) {
    if (name == "world") throw p.error("'world' is the name of the root");
    const auto clashes = [&](const auto& objects) {
      for (const auto& o : objects)
        if (o.name == name) throw p.error("'" + name + "' is an object already", strf("see line %d", o.where.line));
    };
    clashes(draft_.geometry), clashes(models_);
    read_group(name, p);
  });
  std::move(models_.begin(), models_.end(), std::back_inserter(draft_.groups));
  for (const Error& e : root.unread()) report_.add("SP002", draft_.file, {e.where(), e.message() + "; " + e.hint()});
}

}  // namespace scene_text

Draft read_scene_text(const std::string& path, const ImportOptions& options, Report& report) {
  const Params root = Params::parse_file(path, options.settings);
  TrackedInputs inputs(path, options.search);
  return read_scene_tree(root, inputs, report);
}

Draft read_scene_tree(const Params& root, TrackedInputs& inputs, Report& report) {
  Draft draft;
  draft.file = inputs.file();
  // The root itself must be a map with a version; without it nothing else means anything.
  scene_text::Reader(inputs, report, draft).run(root);
  draft.inputs = inputs.all();
  return draft;
}

ImporterRow scene_text_importer() {
  // Any text: what is wrong with one that is no scene, YAML and its keys tell best.
  return {{"scene_text", "a scene text, YAML or JSON (formats/scene_text/FORMAT.md)", "", read_scene_text},
          [](const std::string&, std::string_view head) { return head.find('\0') == head.npos; }};
}

}  // namespace suite
