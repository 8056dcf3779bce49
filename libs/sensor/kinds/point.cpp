// Instruments at a point: irradiance of a plane, radiance from a direction, flux through a small sphere. Each is one
// problem of a capture without neighbours.
#include "sensor/kinds/simple.h"

namespace suite {

namespace {

struct Collector {
  enum class Kind { irradiance, radiance, actinic } kind;
  std::string name;
  Vec3 position;
  Frame frame;  // z: normal of the plane, or where it looks
};

class PointCollectors final : public SimpleSensor {
 public:
  PointCollectors(const Params& p, const SensorContext& context) : SimpleSensor(p, context, "point") {
    for (const Params& c : p.at("collectors").items()) {
      Collector k;
      k.kind = static_cast<Collector::Kind>(c.at("quantity").as_choice({"irradiance", "radiance", "actinic_flux"}));
      k.name = c.text("name", strf("%zu", collectors_.size() + 1));
      const auto [x, y, z] = c.at("position_m").as_vec3();
      k.position = {x, y, z};
      if (k.kind != Collector::Kind::actinic) {
        const Params d = c.at(k.kind == Collector::Kind::irradiance ? "normal" : "look");
        const auto [dx, dy, dz] = d.as_vec3();
        if (!(length({dx, dy, dz}) > 0)) throw d.error("a direction of length 0");
        k.frame = Frame::around(normalized(Vec3{dx, dy, dz}));
      }
      collectors_.push_back(std::move(k));
    }
    if (collectors_.empty()) throw p.at("collectors").error("there is no collector in the list");
    capture_.columns = static_cast<uint32_t>(collectors_.size());
    capture_.rows = 1;
    capture_.neighbours = false;
    done();
  }
  SensorRay ray(const RayRequest& r) const override {
    const Collector& c = collectors_[r.problem];
    SensorRay out{{c.position, c.frame.z, moment(r.u[2])}};
    if (c.kind == Collector::Kind::irradiance) out.receiver = SensorRay::Receiver::plane, out.weight = kPi;
    if (c.kind == Collector::Kind::actinic) out.receiver = SensorRay::Receiver::sphere, out.weight = 4 * kPi;
    return out;
  }

 private:
  void finish(Delivery& d) const override {
    std::string text =
        "# irradiance and actinic flux hold direct and diffuse light; a radiance that looks at the sun its disk\n";
    text += "name,quantity,unit,band,wavelength_um,value,standard_error\n";
    static constexpr const char* kNames[][2] = {
        {"irradiance", "W/(m2 um)"}, {"radiance", "W/(m2 sr um)"}, {"actinic_flux", "W/(m2 um)"}};
    for (size_t i = 0; i < collectors_.size(); ++i)
      for (size_t b = 0; b < bands_.size(); ++b) {
        const auto& n = kNames[static_cast<size_t>(collectors_[i].kind)];
        text += strf("%s,%s,%s,%s,%.9g,%.9g,%.9g\n", collectors_[i].name.c_str(), n[0], n[1], bands_[b].name.c_str(),
                     bands_[b].center_um, d.result.radiance[i * bands_.size() + b],
                     d.result.standard_error[i * bands_.size() + b]);
      }
    d.texts.push_back({name_ + ".csv", std::move(text)});
    d.description = "one column a collector; irradiance and actinic flux are W/(m2 um), see the CSV";
  }
  std::vector<Collector> collectors_;
};

}  // namespace

SensorRow point_row() {
  return {"point", "irradiance, radiance and flux at points, as CSV", "", make_kind<PointCollectors>};
}

}  // namespace suite
