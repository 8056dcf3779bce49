"""read_las.py FOLDER: full.las of --detect through laspy, against full_pulse_3.csv and itself; waveforms by their bytes."""
import csv
import os
import struct
import sys

import laspy
import numpy as np

folder = sys.argv[1]
path = os.path.join(folder, "full.las")
las = laspy.read(path)
header = las.header
assert header.version.major == 1 and header.version.minor == 4 and header.point_format.id == 9, header
assert header.global_encoding.gps_time_type == laspy.header.GpsTimeType.STANDARD and header.global_encoding.wkt
names = ["amplitude", "width_ns", "deviation_m", "range_m", "return_number", "pixel", "tag", "multiple", "signal"]
extra = {d.name: d for d in header.point_format.extra_dimensions}
assert len(extra) == len(names), extra
assert np.all(np.abs(np.diff(las.gps_time.reshape(-1, 2)[:, 0]) - 1e-3) < 2e-7), "times of emissions"
assert set(las.return_number) == {1, 2} and set(las.number_of_returns) == {2}
assert np.all(las.scan_angle == 0) and np.all(las["signal"] == 1)
assert list(las["tag"][:2]) == [3, 2], las["tag"][:2]  # roof, then grass

# Packets: of the file beside, or of the record behind the points.
with open(path, "rb") as f:
    whole = f.read()
start = struct.unpack_from("<Q", whole, 227)[0]
beside = path.replace(".las", ".wdp")
data = whole[start:] if start else open(beside, "rb").read()
assert bool(start) != os.path.exists(beside)
assert struct.unpack_from("<H", data, 18)[0] == 65535 and struct.unpack_from("<Q", data, 20)[0] == len(data) - 60
descriptor = [v for v in header.vlrs if v.record_id == 100]
assert len(descriptor) == 1, header.vlrs
bits, compression, samples, spacing, gain, offset = struct.unpack("<BBIIdd", descriptor[0].record_data_bytes())
assert (bits, compression, spacing, gain, offset) == (16, 0, 500, 1, 0)
offsets, sizes = np.array(las["wavepacket_offset"]), np.array(las["wavepacket_size"])
assert np.all(sizes == 2 * samples) and len(set(offsets)) == 40 and offsets.min() == 60

rows = list(csv.DictReader(open(os.path.join(folder, "full_pulse_3.csv"))))
stored = np.array([float(r["sample"]) for r in rows])
times = np.array([float(r["time_ns"]) for r in rows])
packet = np.frombuffer(data, "<u2", samples, int(offsets[6]))
assert np.array_equal(packet, stored), "waveform of pulse 3"
returns = [r for r in csv.DictReader(open(os.path.join(folder, "full_pulse_3_returns.csv"))) if r["ideal"] == "0"]
for k, r in enumerate(returns):
    location = float(las["return_point_wave_location"][6 + k])
    assert abs(location * 1e-3 - (float(r["time_ns"]) - times[0])) < 1e-4, (location, r)
    assert abs(las["range_m"][6 + k] - float(r["range_m"])) < 1e-6
    # From the target back to the sensor, c / 2 a picosecond: upwards but for the curved Earth, 100 km from the origin, and for the
    # scale of UTM.
    back = [float(las[axis][6 + k]) for axis in ("x_t", "y_t", "z_t")]
    size = np.linalg.norm(back)
    assert abs(size - 299792458e-12 / 2) < 5e-4 * size and back[2] > 0.999 * size, back
# The reference system as PROJ understands it, and the same points packed as LAZ.
try:
    import pyproj
    assert pyproj.CRS.from_wkt([v for v in header.vlrs if v.record_id == 2112][0].string).to_epsg() == 25832
except ImportError:
    pass
if laspy.LazBackend.detect_available():
    packed = os.path.join(folder, "packed.laz")
    las.write(packed)
    again = laspy.read(packed)
    for name in header.point_format.dimension_names:
        assert np.array_equal(np.array(las[name]), np.array(again[name])), name
print("%d points and %d waveforms agree" % (len(las), len(set(offsets))))
