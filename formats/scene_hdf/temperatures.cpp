#include <cmath>

#include "formats/scene_hdf/internal.h"
#include "thermal/models.h"

namespace suite {

namespace {

const std::string kTemperaturesTable = "/temperatures";
constexpr size_t kLayer = 14;  // numbers a layer

void append(const SlabLayer& l, std::vector<double>& out) {
  out.insert(out.end(), {l.thickness, l.density});
  out.insert(out.end(), l.specific_heat.begin(), l.specific_heat.end());
  out.insert(out.end(), l.conductivity.begin(), l.conductivity.end());
  out.insert(out.end(), {l.heat_generation, l.contact_resistance, static_cast<double>(l.intervals)});
}

SlabLayer layer_of(const double* v) {
  SlabLayer l;
  l.thickness = v[0], l.density = v[1];
  std::copy(v + 2, v + 7, l.specific_heat.begin());
  std::copy(v + 7, v + 11, l.conductivity.begin());
  l.heat_generation = v[11], l.contact_resistance = v[12];
  l.intervals = static_cast<int>(std::clamp(v[13], 0.0, 1e6));
  return l;
}

}  // namespace

void write_table(h5::Writer& w, const Scene& s, TemperatureTable) {
  std::vector<uint32_t> size;
  std::vector<uint8_t> repeat;
  std::vector<double> time, kelvin, layers, value, load_time, load;
  std::vector<uint32_t> loads;
  std::vector<std::string> name, text_name, text;
  std::vector<uint32_t> text_of;
  for (const TemperatureBinding& t : s.temperatures) {
    size.insert(size.end(),
                {t.material, static_cast<uint32_t>(t.spec.times.size()), static_cast<uint32_t>(t.spec.layers.size()),
                 static_cast<uint32_t>(t.spec.numbers.size())});
    repeat.push_back(t.spec.repeat);
    time.insert(time.end(), t.spec.times.begin(), t.spec.times.end());
    kelvin.insert(kelvin.end(), t.spec.kelvins.begin(), t.spec.kelvins.end());
    for (const SlabLayer& l : t.spec.layers) append(l, layers);
    loads.insert(loads.end(), {static_cast<uint32_t>(t.spec.loads.size()), t.spec.loads_repeat});
    load_time.insert(load_time.end(), t.spec.load_times.begin(), t.spec.load_times.end());
    for (const SurfaceLoad& l : t.spec.loads)
      load.insert(load.end(), {l.sun_absorbed, l.sky_irradiance, l.air_temperature, l.wind});
    for (const auto& [key, number] : t.spec.numbers) name.push_back(key), value.push_back(number);
    for (const auto& [key, words] : t.spec.texts)
      text_of.push_back(static_cast<uint32_t>(loads.size() / 2 - 1)), text_name.push_back(key), text.push_back(words);
  }
  w.put_names(kTemperaturesTable + "/model",
              pick(s.temperatures, [](const TemperatureBinding& t) { return t.spec.model; }));
  w.put(kTemperaturesTable + "/size", size, "1", 4);
  w.put(kTemperaturesTable + "/repeat", repeat, "1");
  w.put(kTemperaturesTable + "/time", time, "s");
  w.put(kTemperaturesTable + "/kelvin", kelvin, "K");
  w.put(kTemperaturesTable + "/layers", layers, "SI", kLayer);
  w.put(kTemperaturesTable + "/loads/rows", loads, "1", 2);
  w.put(kTemperaturesTable + "/loads/time", load_time, "s");
  w.put(kTemperaturesTable + "/loads/values", load, "SI", 4);
  w.put_names(kTemperaturesTable + "/numbers/name", name);
  w.put(kTemperaturesTable + "/numbers/value", value, "SI");
  if (text.empty()) return;
  w.put(kTemperaturesTable + "/texts/temperature", text_of, "1");
  w.put_names(kTemperaturesTable + "/texts/name", text_name);
  w.put_names(kTemperaturesTable + "/texts/text", text);
}

void read_table(h5::Reader& r, Scene& s, Loading& loading, TemperatureTable) {
  const std::vector<std::string> model = r.get_names(kTemperaturesTable + "/model");
  const auto n = static_cast<long long>(model.size());
  const auto size = r.get<uint32_t>(kTemperaturesTable + "/size", "1", 4, n);
  const auto repeat = r.get<uint8_t>(kTemperaturesTable + "/repeat", "1", 1, n);
  Stretch<double> time(r, kTemperaturesTable + "/time", "s"), kelvin(r, kTemperaturesTable + "/kelvin", "K");
  const auto layers = r.get<double>(kTemperaturesTable + "/layers", "SI", kLayer);
  const auto rows = r.get<uint32_t>(kTemperaturesTable + "/loads/rows", "1", 2, n);
  Stretch<double> load_time(r, kTemperaturesTable + "/loads/time", "s");
  const auto load = r.get<double>(kTemperaturesTable + "/loads/values", "SI", 4);
  size_t at_load = 0;
  const std::vector<std::string> name = r.get_names(kTemperaturesTable + "/numbers/name");
  const auto value = r.get<double>(kTemperaturesTable + "/numbers/value", "SI", 1, static_cast<long long>(name.size()));
  std::vector<uint32_t> text_of;
  std::vector<std::string> text_name, text;
  if (r.has(kTemperaturesTable + "/texts/text")) {
    text = r.get_names(kTemperaturesTable + "/texts/text");
    const auto texts = static_cast<long long>(text.size());
    text_name = r.get_names(kTemperaturesTable + "/texts/name", texts);
    text_of = r.get<uint32_t>(kTemperaturesTable + "/texts/temperature", "1", 1, texts);
    for (const uint32_t of : text_of)
      if (of >= model.size()) r.fail("a text belongs to no temperature");
  }
  size_t layer = 0, number = 0;
  for (size_t k = 0; k < model.size(); ++k) {
    TemperatureBinding t;
    t.material = size[4 * k];
    t.spec.model = model[k];
    t.spec.repeat = repeat[k] != 0;
    t.spec.times = time.next(size[4 * k + 1]);
    t.spec.kelvins = kelvin.next(size[4 * k + 1]);
    if (size[4 * k + 2] > layers.size() / kLayer - layer || size[4 * k + 3] > name.size() - number)
      r.fail("a temperature declares more layers or numbers than there are");
    for (uint32_t i = 0; i < size[4 * k + 2]; ++i, ++layer) t.spec.layers.push_back(layer_of(&layers[kLayer * layer]));
    for (uint32_t i = 0; i < size[4 * k + 3]; ++i, ++number) t.spec.numbers[name[number]] = value[number];
    t.spec.load_times = load_time.next(rows[2 * k]);
    t.spec.loads_repeat = rows[2 * k + 1] != 0;
    if (rows[2 * k] > load.size() / 4 - at_load) r.fail("a temperature declares more loads than there are");
    for (uint32_t i = 0; i < rows[2 * k]; ++i, ++at_load)
      t.spec.loads.push_back({load[4 * at_load], load[4 * at_load + 1], load[4 * at_load + 2], load[4 * at_load + 3]});
    for (size_t i = 0; i < text_of.size(); ++i)
      if (text_of[i] == k) t.spec.texts[text_name[i]] = text[i];
    if (!t.spec.model.empty()) make_temperature_model(t.spec, Where{r.path(), 0, 0, {}, -1});
    loading.row("layers").stored += 8 * kLayer * t.spec.layers.size();
    loading.row("temperatures").stored += 16 * t.spec.times.size() + 40 * t.spec.loads.size();
    s.temperatures.push_back(std::move(t));
  }
  time.finish(), kelvin.finish(), load_time.finish();
  if (at_load * 4 != load.size()) r.fail("there are loads of no temperature");
  if (layer * kLayer != layers.size() || number != name.size()) r.fail("there are layers or numbers of no temperature");
}

}  // namespace suite
