#include <cmath>
#include <filesystem>
#include <limits>

#include "base/bytes.h"
#include "base/files.h"
#include "formats/merl/merl.h"

namespace suite {

namespace {

constexpr double kScale[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

size_t bin_count(int phi_d) { return size_t{MerlTable::kThetaH} * MerlTable::kThetaD * static_cast<size_t>(phi_d); }

int clamp_bin(double x, int n) { return std::min(n - 1, std::max(0, static_cast<int>(x))); }

// Compares each pair of bins that mirroring the azimuth exchanges, weighted as an integral over both hemispheres.
double mirror_difference(const std::vector<std::array<float, 3>>& bins, int phi_d) {
  double difference = 0, sum = 0;
  for (int i = 0; i < MerlTable::kThetaH; ++i)
    for (int j = 0; j < MerlTable::kThetaD; ++j)
      for (int k = 0; k < phi_d / 2; ++k) {
        const MerlPair p = merl_bin_directions(i, j, k, phi_d);
        if (std::min(p.in.z, p.out.z) < std::cos(80 * kDegree)) continue;
        const size_t row = static_cast<size_t>(phi_d) * (static_cast<size_t>(j) + 90 * static_cast<size_t>(i));
        const double a = bins[row + static_cast<size_t>(k)][1], b = bins[row + static_cast<size_t>(phi_d - 1 - k)][1];
        if (!std::isfinite(a) || !std::isfinite(b)) continue;
        // dw_in dw_out = 4 cos(theta_d) dw_h dw_d; theta_h = (pi/2) x^2 makes d(theta_h) grow with i.
        const double x = (i + 0.5) / 90, th = x * x * kPi / 2, td = (j + 0.5) / 90 * kPi / 2;
        const double weight = std::cos(td) * std::sin(th) * x * std::sin(td) * p.in.z * p.out.z;
        difference += weight * std::fabs(a - b);
        sum += weight * (a + b) / 2;
      }
  return sum > 0 ? difference / sum : 0;
}

}  // namespace

MerlPair merl_bin_directions(int i, int j, int k, int phi_d_bins, double fraction) {
  const double x = (i + fraction) / 90, th = x * x * (kPi / 2), td = (j + fraction) / 90 * (kPi / 2);
  const double pd = (k + fraction) / 180 * kPi;
  SUITE_CHECK(phi_d_bins == 180 || phi_d_bins == 360);
  // in = R_y(theta_h) d, out = its mirror image about the half vector (both with phi_h = 0).
  const double sd = std::sin(td), cd = std::cos(td), sh = std::sin(th), ch = std::cos(th);
  const double dx = sd * std::cos(pd), dy = sd * std::sin(pd);
  return {{dx * ch + cd * sh, dy, cd * ch - dx * sh}, {-dx * ch + cd * sh, -dy, cd * ch + dx * sh}};
}

size_t merl_bin(Dir out, Dir in, int phi_d_bins) {
  const Vec3 sum = in + out;
  const Dir h = sum / length(sum);
  const double theta_h = polar_angle(h), s = std::hypot(h.x, h.y);
  // Rotate the difference frame: by -phi_h about z, then by -theta_h about y. At the pole phi_h is taken as 0.
  const double cp = s > 0 ? h.x / s : 1, sp = s > 0 ? h.y / s : 0;
  const double x = in.x * cp + in.y * sp, y = -in.x * sp + in.y * cp;
  const Vec3 d{x * h.z - in.z * s, y, x * s + in.z * h.z};
  const double theta_d = polar_angle(d);
  double phi_d = std::atan2(d.y, d.x);
  const double turn = phi_d_bins == 180 ? kPi : 2 * kPi;
  if (phi_d < 0) phi_d += turn;
  const int i = clamp_bin(90 * std::sqrt(theta_h / (kPi / 2)), 90), j = clamp_bin(90 * theta_d / (kPi / 2), 90);
  const int k = clamp_bin(phi_d_bins * phi_d / turn, phi_d_bins);
  return static_cast<size_t>(k) +
         static_cast<size_t>(phi_d_bins) * (static_cast<size_t>(j) + 90 * static_cast<size_t>(i));
}

MerlTable::MerlTable(std::string name, int phi_d, std::span<const double> raw) : phi_d_(phi_d) {
  SUITE_CHECK(phi_d == 180 || phi_d == 360);
  const size_t n = bin_count(phi_d);
  SUITE_CHECK_EQ(raw.size(), 3 * n);
  bins_.resize(n);
  for (size_t b = 0; b < n; ++b) {
    const int k = static_cast<int>(b) % phi_d, j = static_cast<int>(b) / phi_d % 90,
              i = static_cast<int>(b) / phi_d / 90;
    const MerlPair p = merl_bin_directions(i, j, k, phi_d);
    bool good = true;
    for (size_t c = 0; c < 3; ++c) {
      const double v = raw[c * n + b] * kScale[c];
      good = good && v >= 0 && v <= std::numeric_limits<float>::max();
      bins_[b][c] = good ? static_cast<float>(v) : 0.0f;
    }
    if (!good) bins_[b].fill(static_cast<float>(kNan));
    if (p.in.z > 0 && p.out.z > 0) ++(good ? valid_ : invalid_);
  }
  asymmetry_ = mirror_difference(bins_, phi_d);
  info_.name = std::move(name);
  info_.source = strf("MERL .binary 90 x 90 x %d, nearest bin, values at bin centres, negative triples invalid", phi_d);
  info_.wavelength_um = {0.65, 0.55, 0.45};
  info_.channel_names = {"R", "G", "B"};
  info_.isotropic = true;
  info_.bilateral = asymmetry_ < kBilateralLimit;
}

void MerlTable::value(Dir out, Dir in, std::span<double> f) const {
  const bool above = in.z > 0 && out.z > 0;
  const std::array<float, 3>* bin = above ? &bins_[merl_bin(out, in, phi_d_)] : nullptr;
  for (size_t c = 0; c < 3; ++c) f[c] = bin ? static_cast<double>((*bin)[c]) : kNan;
}

std::shared_ptr<const MerlTable> parse_merl(std::span<const std::byte> bytes, const std::string& file_name) {
  ByteReader reader(bytes, file_name);
  int32_t dims[3];
  for (int32_t& d : dims) d = reader.get<int32_t>("the three dimensions");
  if (dims[0] != 90 || dims[1] != 90 || (dims[2] != 180 && dims[2] != 360)) {
    reader.seek(0, "the start");
    throw reader.error(strf("dimensions %d x %d x %d are not those of a MERL table", dims[0], dims[1], dims[2]),
                       "90 x 90 x 180, or 90 x 90 x 360 for non-reciprocal data");
  }
  const size_t expected = 12 + 3 * bin_count(dims[2]) * sizeof(double);
  if (bytes.size() != expected)
    throw reader.error(strf("the file has %zu bytes, a 90 x 90 x %d table has %zu", bytes.size(), dims[2], expected),
                       "is it complete?");
  const std::vector<double> raw = reader.get_many<double>(3 * bin_count(dims[2]), "the table");
  auto table = std::make_shared<const MerlTable>(std::filesystem::path(file_name).stem().string(), dims[2], raw);
  if (table->valid_bins() == 0)
    throw reader.error("no bin above the horizon holds valid data", "negative triples mark missing data");
  return table;
}

std::shared_ptr<const MerlTable> read_merl(const std::string& path) {
  return parse_merl(read_bytes(path, size_t{1} << 27), path);
}

}  // namespace suite
