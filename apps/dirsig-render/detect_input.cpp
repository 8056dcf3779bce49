#include "detect_input.h"

#include <cmath>
#include <cstdio>
#include <memory>

#include "formats/dirsig_bin/dirsig_bin.h"
#include "formats/response/response_file.h"

namespace suite {

namespace {

// The rotation of a matrix as a quaternion; where it is none (a mirrored one, zeros) the body is left unturned.
Quat rotation_of(const Affine3& a) {
  const double d = a.determinant();
  return std::fabs(d - 1) < 1e-3 ? quat_from_matrix(a) : Quat{};
}
Affine3 affine_of(const Matrix4& m) {
  return {{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, {m[3], m[7], m[11]}};
}

Pose pose_of(const LidarBinPulse& p, const LidarBinPlace& place) {
  const auto turned = [](Vec3 angles) {  // about y, then z, then x
    return rotation({1, 0, 0}, angles.x) * rotation({0, 0, 1}, angles.z) * rotation({0, 1, 0}, angles.y);
  };
  const Affine3 all = translation(p.platform) * turned(p.euler) * affine_of(place.mount_to_platform) *
                      turned(place.pointing) * affine_of(place.to_mount);
  return {normalized(rotation_of(all)), all.b};
}

double bin_width(const LidarBinPulse& p) { return (p.gate_stop - p.gate_start) / std::max(1u, p.bins); }

// "YYYYMMDDhhmm.ss" as UTC; nothing when it is none.
std::optional<Utc> utc_of(const std::string& text) {
  Utc u;
  if (std::sscanf(text.c_str(), "%4d%2d%2d%2d%2d%lf", &u.year, &u.month, &u.day, &u.hour, &u.minute, &u.second) < 5)
    return {};
  try {
    instant_from_utc(u);
    return u;
  } catch (const Error&) {
    return {};
  }
}

ResponseHead head_of(const LidarBin& bin, const std::string& path) {
  const Where where{path, 0, 0, {}, -1};
  if (bin.tasks.size() != 1 || bin.tasks[0].pulses.empty())
    throw Error(where, strf("%zu tasks", bin.tasks.size()), "one task with at least one pulse is detected");
  const LidarBinHead& h = bin.head;
  const LidarBinTask& t = bin.tasks[0];
  ResponseHead head;
  head.bin = bin_width(t.pulses[0]);
  for (const LidarBinPulse& p : t.pulses) {
    if (p.samples != 1) throw Error(where, strf("%u samples a bin", p.samples), "one is detected");
    if (!(std::fabs(bin_width(p) - head.bin) <= 1e-6 * head.bin))
      throw Error(where, "pulses have bins of different widths", "one width for all");
    head.bins = std::max(head.bins, p.bins);
  }
  head.columns = h.columns, head.rows = h.rows;
  head.along = h.columns * h.rows > 1 ? PlacesAlong::pixel : PlacesAlong::beam;
  head.pixels.clear();
  const double f = t.focal_length_mm * 1e3;  // um
  for (uint32_t row = 0; row < h.rows; ++row)
    for (uint32_t column = 0; column < h.columns; ++column) {
      const double x = (column - 0.5 * (h.columns - 1.0)) * h.pitch_x_um + h.offset_x_um,
                   y = (0.5 * (h.rows - 1.0) - row) * h.pitch_y_um + h.offset_y_um;
      head.pixels.push_back(f > 0 ? normalized(Vec3{x, y, -f}) : Dir{0, 0, -1});
    }
  head.epoch = utc_of(t.start);
  if (std::fabs(h.latitude) <= 90 && std::fabs(h.longitude) <= 360 && std::fabs(h.height) < 1e5)
    head.origin = Geodetic{h.latitude, h.longitude, h.height};
  if (const std::string wrong = fault_of(head); !wrong.empty()) throw Error(where, "has " + wrong);
  return head;
}

ResponseBlock block_of(const LidarBin& bin, const ResponseHead& head, size_t number) {
  const LidarBinTask& t = bin.tasks[0];
  const LidarBinPulse& p = t.pulses[number];
  ResponseBlock b;
  b.first_pulse = number;
  b.pulses.push_back({p.time, t.centre_um, t.energy, p.gate_start, pose_of(p, p.transmitter), pose_of(p, p.receiver)});
  for (size_t pixel = 0; pixel < head.pixel_count(); ++pixel) {
    const double* photons = p.photons.data() + pixel * (size_t{p.bins} + 1);
    for (uint32_t k = 0; k <= p.bins; ++k) {
      if (!(photons[k] > 0)) continue;
      b.bin.push_back(k), b.contributions.push_back(0);
      // What kind of light it is, the file does not say.
      b.value.insert(b.value.end(), {photons[k], 0}), b.variance.insert(b.variance.end(), {0, 0});
    }
    b.begin.push_back(b.bin.size());
    b.bound.push_back(std::nan("")), b.paths.push_back(0);
  }
  return b;
}

}  // namespace

ResponseSource open_response(const std::string& path) {
  if (path.ends_with(".bin")) {
    const auto bin = std::make_shared<LidarBin>(read_lidar_bin(path));
    const ResponseHead head = head_of(*bin, path);
    return {head, bin->tasks[0].pulses.size(), [bin, head, path](ResponseSink& to) {
              for (size_t p = 0; p < bin->tasks[0].pulses.size(); ++p) {
                ResponseBlock b = block_of(*bin, head, p);
                if (const std::string wrong = fault_of(head, b); !wrong.empty())
                  throw Error(Where{path, 0, 0, {}, -1}, wrong);
                to.take(std::move(b));
              }
            }};
  }
  const auto reader = std::make_shared<ResponseReader>(path);
  return {reader->head(), reader->pulses(), [reader](ResponseSink& to) {
            for (size_t b = 0; b < reader->blocks(); ++b) to.take(reader->block(b));
          }};
}

}  // namespace suite
