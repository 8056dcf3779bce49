#include "lidar/instrument.h"

namespace suite {

std::string fault_of(const LidarInstrument& i) {
  const LidarReceiver& r = i.receiver;
  if (!(r.aperture > 0)) return "the aperture must be above 0";
  if (!(r.obscuration >= 0 && r.obscuration < 1)) return "the obscuration must be from 0 to below 1";
  if (!(r.throughput > 0 && r.throughput <= 1)) return "the throughput must be above 0 and at most 1";
  if (r.columns == 0 && !(r.field_of_view > 0 && r.field_of_view <= 2))
    return "the field of view must be above 0 and at most 2 rad";
  if (r.columns > 0 && !(r.rows > 0 && r.pitch > 0 && r.focal > 0))
    return "an array needs rows, and a pitch and a focal length above 0";
  if (uint64_t{r.columns} * r.rows > 10000000)
    return strf("the array has %u x %u pixels, at most 1e7 are traced", r.columns, r.rows);
  const auto& s = i.laser.stokes;
  if (!(s[0] == 1 && s[1] * s[1] + s[2] * s[2] + s[3] * s[3] <= 1 + 1e-12))
    return "the Stokes vector must be [1, Q, U, V] with Q2 + U2 + V2 at most 1";
  if (polarised(i) && i.start_from == StartFrom::laser)
    return "paths that carry polarisation begin at the receiver (`start_from: receiver` or `auto`)";
  if (!(i.gate.bin >= 1e-13 && i.gate.bin <= 1e-6)) return "range bins must be 1e-4 to 1000 ns wide";
  if (!(i.gate.start >= 0 && i.gate.stop > i.gate.start))
    return "the gate must start at 0 or later and stop after that";
  if (const double bins = (i.gate.stop - i.gate.start) / i.gate.bin; bins > 1e8)
    return strf("the gate has %.3g range bins, at most 1e8 are kept", bins);
  if (i.paths < 2) return "at least 2 paths a pulse are needed for a standard error";
  if (i.orders < 1) return "at least one order of scattering is needed";
  return {};
}

}  // namespace suite
