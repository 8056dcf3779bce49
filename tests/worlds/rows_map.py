"""Rows of maps: each takes a material and answers it with a map, draped over the scene; of one value where the world will be moved."""
import struct

SIDE = 4          # pixels
ORIGIN, GSD = -16.0, 8.0


def envi(d, bands, wavelengths=None, whole=False):
    """Stores an image (bands: lists of SIDE x SIDE values) and answers its name."""
    name = f"map{len(d.world.files)}.img"
    flat = [v for band in bands for v in band]
    d.world.files[name] = bytes(flat) if whole else struct.pack(f"<{len(flat)}f", *flat)
    extra = f"wavelength units = Micrometers\nwavelength = {{{', '.join(str(w) for w in wavelengths)}}}\n" if wavelengths else ""
    d.world.files[name + ".hdr"] = (f"ENVI\nsamples = {SIDE}\nlines = {SIDE}\nbands = {len(bands)}\nheader offset = 0\nfile type = ENVI Standard\n"
                                    f"data type = {1 if whole else 4}\ninterleave = bsq\nbyte order = 0\n{extra}").encode()
    return name


def tiff(d, values):
    """Stores SIDE x SIDE numbers as a TIFF of 32-bit floats in one strip and answers its name."""
    name, data = f"map{len(d.world.files)}.tif", struct.pack(f"<{len(values)}f", *values)
    # Tag, type (3: 16 bit, 4: 32 bit) and value: width, length, bits, no compression, black is zero, offset, samples, rows, bytes, floats.
    tags = ((256, 3, SIDE), (257, 3, SIDE), (258, 3, 32), (259, 3, 1), (262, 3, 1), (273, 4, 8), (277, 3, 1), (278, 3, SIDE), (279, 4, len(data)), (339, 3, 3))
    entries = b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in tags)
    d.world.files[name] = struct.pack("<2sHI", b"II", 42, 8 + len(data)) + data + struct.pack("<H", len(tags)) + entries + struct.pack("<I", 0)
    return name


def pixels(d, values):
    """SIDE x SIDE values out of a list; all the same where the world will be moved under its drapes."""
    if "moved" in d.traits:
        values = [d.one(*values)]
    return [d.one(*values) for _ in range(SIDE * SIDE)]


def add(d, spec):
    uv = getattr(d, "by_uv", False)
    where = {"projection": "uv"} if uv else {"projection": "drape", "drape": {"origin": [ORIGIN, -ORIGIN], "gsd": GSD, "extend": "clamp"}}
    return d.world.add("maps", "map", {**spec, **where})


def hung(d, material, spec):
    return {**material, "maps": [add(d, spec)]}


def grey(d, material):
    """A material with a reflectance that maps can vary, as warm as the one that is given."""
    warm = {k: v for k, v in material.items() if k.startswith(("temperature", "thermal"))}
    return {"model": "lambert" if "reciprocal" in d.traits else d.one("lambert", "mirror"), "reflectance": d.u(0.1, 0.8), **warm} if d.chance(0.7) else \
        {"model": "oren_nayar", "reflectance": d.u(0.1, 0.8), "sigma": 0.3, **warm}


def class_map(d, material):
    other = d.material({**d.pick("model").make(d), **d.emission()})
    return {"map": add(d, {"type": "class", "file": envi(d, [pixels(d, [1, 2])], whole=True), "materials": {"1": d.material(material), "2": other}})}


def mixture(d, material):
    other = d.material({**d.pick("model", lambda r: r.name != "mirror").make(d), **d.emission()})
    first = pixels(d, [0.2, 0.5, 1.0])
    parts = [d.material(material), other]
    spec = {"type": "mixture", "file": envi(d, [first, [1 - v for v in first]]), "materials": parts}
    return {"model": "lambert", "reflectance": 0, "maps": [add(d, spec)]}


def curve_index(d, material):
    spec = {"type": "curve_index", "file": envi(d, [pixels(d, [0, 1, 2])], whole=True), "family": [d.u(0.1, 0.3), d.u(0.3, 0.5), d.u(0.5, 0.8)]}
    return hung(d, grey(d, material), spec)


def texture(d, material):
    w = d.wavelength
    spec = {"type": "texture", "file": envi(d, [pixels(d, [10, 20, 30, 40])]), "family": [0.2, 0.3, 0.5, 0.6], "bands_um": [[w * 0.9, w * 1.1]]}
    return hung(d, grey(d, material), spec)


def cube(d, material):
    w = d.wavelength
    a = pixels(d, [0.2, 0.4, 0.6])
    spec = {"type": "cube", "file": envi(d, [a, [v * 0.9 for v in a]], [w * 0.5, w * 2]), "outside": "hold"}
    return hung(d, grey(d, material), spec)


def temperature(d, material):
    k = d.kelvin
    values = [k] if d.furnace else [k, round(k * 0.97, 1)]
    return hung(d, material, {"type": "temperature", "file": envi(d, [pixels(d, values)])})


def bump(d, material):
    return hung(d, material, {"type": "bump", "file": envi(d, [pixels(d, [0, 0.5, 1])]), "filter": "linear"})


def normal(d, material):
    n = [pixels(d, [0.0]), pixels(d, [0.1]), pixels(d, [0.995])]
    return hung(d, material, {"type": "normal", "file": envi(d, n)})


def opacity(d, material):
    return hung(d, material, {"type": "opacity", "file": envi(d, [pixels(d, [0, 0.4, 1])])})


SHADING = {"without": ("reciprocal",)}  # normals that are not the surface's are not reciprocal
ROWS = [
    ("class_map", "map", class_map, {"weight": 1.2}), ("mixture", "map", mixture, {"weight": 1.2}), ("curve_index", "map", curve_index, {"weight": 1.6}), ("texture", "map", texture, {"weight": 3, "without": ("moved", "periodic")}),  # pixels of one value are ranked by where they are
   
    ("cube", "map", cube, {"weight": 1.5}), ("temperature_map", "map", temperature, {"weight": 1.8}), ("bump", "map", bump, {"weight": 1.8, **SHADING}), ("normal_map", "map", normal, {"weight": 1.6, **SHADING}),
    ("opacity", "map", opacity),
]
