// What has several channels: fibres that are fed in turn, lines of lasers, focal planes, rotating heads.
#include <cmath>

#include "sensor/deflectors/deflector.h"

namespace suite {

namespace {

constexpr size_t kMostChannels = 1u << 24;

// Fibres in a row across the flight; one of them has the beam, the next one `rate_hz` later.
class Fibre : public Deflector {
 public:
  explicit Fibre(const Params& p)
      : count_(p.integer("fibres", 1, 1000000)),
        spacing_(p.number_in("spacing_deg", 0, 90, "degrees") * kDegree),
        rate_(p.number_in("rate_hz", 0, 1e9, "Hz")) {
    if (spacing_ * static_cast<double>(count_ - 1) >= kPi)
      throw p.error("fibres all around", "below 180 degrees together");
  }
  std::optional<Dir> direction(double t, size_t) const override {
    // A pulse that is meant for a fibre stays its own when its time was rounded.
    const double turn = std::floor(rate_ * t + 1e-6), n = static_cast<double>(count_);
    const double fibre = turn - n * std::floor(turn / n), angle = (fibre - (n - 1) / 2) * spacing_;
    return Dir{std::sin(angle), 0, -std::cos(angle)};
  }

 private:
  long long count_;
  double spacing_, rate_;
};

// Lasers in a row across the flight that fire together, or each after the other.
class LineArray : public Deflector {
 public:
  explicit LineArray(const Params& p) {
    if (const auto angles = p.find("angles_deg")) {
      for (const double a : angles->as_numbers()) angles_.push_back(a * kDegree);
    } else {
      const auto n = static_cast<size_t>(p.integer("lasers", 1, 1000000));
      const double spacing = p.number_in("spacing_deg", 0, 90, "degrees") * kDegree;
      for (size_t k = 0; k < n; ++k)
        angles_.push_back((static_cast<double>(k) - 0.5 * (static_cast<double>(n) - 1)) * spacing);
    }
    if (angles_.empty()) throw p.error("no laser", "angles_deg: [-1, 0, 1]");
    for (const double a : angles_)
      if (!(std::fabs(a) < kPi / 2)) throw p.error(strf("a laser at %g degrees", a / kDegree), "-90 to 90 degrees");
    interval_ = p.number_in("interval_ns", 0, 1e9, "ns", 0) * 1e-9;
  }
  size_t channels() const override { return angles_.size(); }
  double delay(size_t channel) const override { return interval_ * static_cast<double>(channel); }
  std::optional<Dir> direction(double, size_t channel) const override {
    return Dir{std::sin(angles_.at(channel)), 0, -std::cos(angles_.at(channel))};
  }

 private:
  std::vector<double> angles_;
  double interval_ = 0;
};

// Pixels of a focal plane, row by row from the far left one; all at once.
class Flash : public Deflector {
 public:
  explicit Flash(const Params& p)
      : columns_(static_cast<size_t>(p.integer("columns", 1, 65536))),
        rows_(static_cast<size_t>(p.integer("rows", 1, 65536))),
        pitch_(p.number_in("pitch_um", 1e-3, 1e6, "um") * 1e-6 /
               (p.number_in("focal_length_mm", 1e-3, 1e7, "mm") * 1e-3)) {
    if (columns_ * rows_ > kMostChannels)
      throw p.error(strf("%zu pixels", columns_ * rows_), strf("at most %zu", kMostChannels));
  }
  size_t channels() const override { return columns_ * rows_; }
  std::optional<Dir> direction(double, size_t channel) const override {
    const auto column = static_cast<double>(channel % columns_), row = static_cast<double>(channel / columns_);
    return normalized(Vec3{(column - 0.5 * (static_cast<double>(columns_) - 1)) * pitch_,
                           (0.5 * (static_cast<double>(rows_) - 1) - row) * pitch_, -1});
  }

 private:
  size_t columns_, rows_;
  double pitch_;  // rad of the central pixel
};

// Lasers at elevations above the plane of x and y, turned about z from ahead to the right; each fires at its own time.
class RotatingHead : public Deflector {
 public:
  explicit RotatingHead(const Params& p) : rate_(p.number_in("rotation_hz", -1e6, 1e6, "Hz")) {
    const std::vector<double> elevations = p.at("elevations_deg").as_numbers();
    const auto column = [&](const char* key) {
      const auto list = p.find(key);
      std::vector<double> values = list ? list->as_numbers() : std::vector<double>(elevations.size(), 0);
      if (values.size() != elevations.size())
        throw list->error(strf("%zu values for %zu elevations", values.size(), elevations.size()), "one for each");
      return values;
    };
    const std::vector<double> azimuths = column("azimuths_deg"), firing = column("firing_us");
    if (elevations.empty()) throw p.at("elevations_deg").error("no laser", "elevations_deg: [-15, -13, -11]");
    for (size_t k = 0; k < elevations.size(); ++k) {
      if (!(std::fabs(elevations[k]) <= 90))
        throw p.at("elevations_deg").error(strf("an elevation of %g degrees", elevations[k]), "-90 to 90");
      if (!(firing[k] >= 0)) throw p.at("firing_us").error(strf("a time of %g us", firing[k]), "0 or later");
      lasers_.push_back({elevations[k] * kDegree, azimuths[k] * kDegree, firing[k] * 1e-6});
    }
  }
  size_t channels() const override { return lasers_.size(); }
  double delay(size_t channel) const override { return lasers_.at(channel).firing; }
  std::optional<Dir> direction(double t, size_t channel) const override {
    const Laser& l = lasers_.at(channel);
    const double azimuth = 2 * kPi * rate_ * t + l.azimuth;
    return Dir{std::cos(l.elevation) * std::sin(azimuth), std::cos(l.elevation) * std::cos(azimuth),
               std::sin(l.elevation)};
  }

 private:
  struct Laser {
    double elevation, azimuth, firing;
  };
  double rate_;
  std::vector<Laser> lasers_;
};

template <class Kind>
std::unique_ptr<Deflector> make(const Params& p) {
  return std::make_unique<Kind>(p);
}

}  // namespace

DeflectorRow fibre_row() { return {"fibre", "fibres across the flight, fed one after the other", "", make<Fibre>}; }
DeflectorRow line_array_row() { return {"line_array", "lasers across the flight", "", make<LineArray>}; }
DeflectorRow flash_row() { return {"flash", "pixels of a focal plane, all at once", "", make<Flash>}; }
DeflectorRow rotating_head_row() {
  return {"rotating_head", "lasers at several elevations, turned about z, each with its firing time", "",
          make<RotatingHead>};
}

}  // namespace suite
