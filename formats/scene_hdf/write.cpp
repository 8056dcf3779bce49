#include "base/files.h"
#include "formats/scene_hdf/columns.h"
#include "formats/scene_hdf/scene_hdf.h"

namespace suite {

void write_scene(const Scene& s, const Provenance& provenance, const std::string& path,
                 const Compression& compression) {
  AtomicFile file(path);
  std::vector<std::string> names;
  {
    h5::Writer w(file.temporary(), path, [&](const std::string& name) {
      names.push_back(name);
      return compression.of_dataset(name);
    });
    w.attribute("format", h5::kFormat);
    w.attribute("version", h5::kVersionText);
    w.attribute("name", s.name);
    w.attribute("description", s.description);
    w.attribute("author", s.author);
    w.attribute("generator", provenance.generator);
    w.attribute("arguments", provenance.arguments);
    w.attribute("input_sha256", provenance.input_sha256);
    const double box[6] = {s.bounds.low.x,  s.bounds.low.y,  s.bounds.low.z,
                           s.bounds.high.x, s.bounds.high.y, s.bounds.high.z};
    w.attribute("bounds_m", box);
    const double origin[4] = {s.origin.latitude_deg, s.origin.longitude_deg, s.origin.ellipsoid_height_m,
                              s.origin.given ? 1.0 : 0.0};
    w.attribute("origin_latitude_deg_longitude_deg_height_m_given", origin);
    w.attribute("curvature", s.curved ? "wgs84" : "flat");
    w.attribute("epoch_utc", s.epoch);
    for_each_table([&]<class Table>(Table table) {
      if constexpr (requires(ColumnWriter<Material> & io) { Table::columns(io); }) {
        ColumnWriter io(w, Table::name, s.*Table::rows);
        Table::columns(io);
      } else {
        write_table(w, s, table);
      }
    });
    w.put_names("/inputs/name", pick(provenance.inputs, [](const InputFile& f) { return f.name; }));
    w.put_names("/inputs/sha256", pick(provenance.inputs, [](const InputFile& f) { return f.sha256; }));
    w.close();
  }
  compression.check_names(names);
  file.commit();
}

}  // namespace suite
