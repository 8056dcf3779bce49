"""Rows of what surfaces are: spectra, models, temperatures, phase functions, media."""

FIT = "ward_fit.sqt"          # made by `run` from sqt-fit --model, beside the worlds
PHASE_FIT = "hg_fit.sqt"


# --- spectrum: where the bands lie ---
def spectrum(wavelength, kelvin, level):
    def make(d):
        d.wavelength, d.width, d.kelvin, d.level = wavelength, wavelength * 0.01, round(kelvin * d.u(0.9, 1.1), 2), level
    return make


# --- models of surfaces ---
def lambert(d):
    return {"model": "lambert", "reflectance": d.curve(d.u(0.05, 0.9))}


def lambert_through(d):
    r = d.u(0.1, 0.5)
    return {"model": "lambert", "reflectance": r, "transmittance": d.u(0.1, 0.9 - r)}


def mirror(d):
    return {"model": "mirror", "reflectance": d.u(0.3, 0.95)}


def ward(d):
    spec = {"model": "ward", "diffuse": d.curve(d.u(0, 0.4)), "specular": d.u(0.05, 0.5), "roughness": d.u(0.12, 0.5)}
    return dict(spec, roughness_y=d.u(0.12, 0.5)) if d.chance(0.5) else spec


def ggx(d):
    optics = {"f0": d.u(0.3, 0.95)} if d.chance(0.5) else {"n": d.u(0.2, 3), "k": d.u(1, 5)}
    spec = {"model": "ggx", **optics, "roughness": d.roughness}
    return dict(spec, roughness_y=d.u(0.15, 0.7)) if d.chance(0.08) else spec  # its tables take a second


def oren_nayar(d):
    return {"model": "oren_nayar", "reflectance": d.curve(d.u(0.1, 0.8)), "sigma": d.u(0.1, 0.8)}


def rpv(d):
    return {"model": "rpv", "rho0": d.u(0.05, 0.15), "k": d.u(0.75, 1.1), "asymmetry": d.u(-0.3, 0.2), "rho_c": d.u(0.3, 1)}


def ross_li(d):
    return {"model": "ross_li", "isotropic": d.u(0.1, 0.3), "volume": d.u(0, 0.1), "geometry": d.u(0, 0.04)}


def roujean(d):
    return {"model": "roujean", "isotropic": d.u(0.1, 0.3), "geometry": d.u(0, 0.03), "volume": d.u(0, 0.3)}


def priest_germer(d):
    return {"model": "priest_germer", "index": d.u(1.3, 2), "absorption": d.u(0, 3), "sigma": d.u(0.1, 0.4), "diffuse": d.u(0, 0.2)}


def maxwell(model):
    def make(d):
        return {"model": model, "index": d.u(1.3, 1.8), "absorption": d.u(0, 0.5), "sigma": d.u(0.1, 0.3), "bias": d.u(0.05, 0.1) if model ==
                "beard_maxwell" else d.u(0.3, 0.8), "tau_deg": d.u(5, 20), "omega_deg": d.u(20, 60), "diffuse": d.u(0, 0.2),
                "volume": d.u(0, 0.02)}
    return make


def leaf(d):
    t = d.u(0.05, 0.4)
    return {"model": "leaf", "reflectance_front": d.u(0.05, 0.5), "reflectance_back": d.u(0.05, 0.5), "transmittance_front": t,
            "transmittance_back": t}


def coated(d):
    """Paint under varnish: the body is a share of what has entered, the skin may be as rough as cuticles are."""
    return {"model": "coated", "index": d.curve(d.u(1.2, 1.8), 1.01, 5), "sigma": d.u(0.1, 0.5), "reflectance": d.curve(d.u(0, 0.9))}


def coated_through(d):
    """A leaf under its cuticle."""
    r = d.u(0.05, 0.5)
    return {"model": "coated", "index": d.u(1.3, 1.6), "sigma": d.u(0.2, 0.4), "reflectance": r, "transmittance": d.u(0.05, 0.9 - r)}


def bpdf(d):
    """Natural ground of which some is mirrored; with the published coefficients and about them."""
    how = d.one(f"breon cover {d.u(0, 1)}", f"maignan c {d.u(4.7, 7.6)} ndvi {d.u(0, 0.8)}", f"nadal_breon rho {d.u(0.005, 0.03)} beta {d.u(40, 200)}",
                f"litvinov alpha {d.u(0.3, 1.5)} variance {d.u(0.1, 0.4)} shadow {d.u(0, 1)}")
    return {**d.one(rpv, ross_li, roujean)(d), "bpdf": how}


def sea(d):
    spec = {"model": "sea", "wind_m_s": d.wind, "below": d.u(0, 0.05)}
    return dict(spec, directed=1) if d.chance(0.06) else spec  # its tables take five seconds


def sqt(d):
    return {"model": "sqt", "file": FIT, "outside": "hold"}


# --- temperatures ---
def constant(d, kelvin):
    return {"temperature_k": kelvin}


def table(d, kelvin):
    end = kelvin if d.furnace else round(kelvin * 1.02, 2)
    return {"temperature": {"table": [[-1000, kelvin], [1000, end]]}}


def slab(d, kelvin):
    """Layers in balance: sky and air are as warm as they are, nothing else warms them."""
    sky = 5.670374419e-8 * kelvin ** 4
    loads = {"table": [[-1000, 0, sky, kelvin, 2], [1000, 0, sky, kelvin, 2]], "repeat": False}
    layers = [{"thickness_m": 0.05, "density_kg_m3": 2000, "specific_heat_j_kg_k": 900, "conductivity_w_m_k": 1.2}]
    return {"temperature": {"model": "slab", "loads": loads, "start_s": -900, "initial_k": kelvin, "deep_temperature_k": kelvin}, "thermal": {"layers": layers}}


# --- phase functions ---
def hg(d):
    return {"model": "hg", "g": d.curve(d.u(-0.7, 0.8), -0.99, 0.99)}


def double_hg(d):
    return {"model": "double_hg", "g1": d.u(0.3, 0.8), "g2": d.u(-0.6, 0), "share": d.u(0.3, 0.95)}


def rayleigh(d):
    return {"model": "rayleigh", "depolarisation": d.one(0, 0.0279)}


def tabulated(d):
    return {"model": "tabulated", "table": f"0 {d.u(5, 12)}, 5 4.2, 30 1.5, 90 {d.u(0.1, 0.6)}, 150 0.15, 180 0.3"}


def isotropic(d):
    return None


def forand(d):
    return {"model": "fournier_forand", "backscatter": d.u(0.005, 0.05)}


def petzold(d):
    return {"model": "petzold"}


def leaves_phase(d):
    return {"model": "leaves", "transmitted": d.u(0, 1)}


def sqt_phase(d):
    return {"model": "sqt", "file": PHASE_FIT, "outside": "hold"}


# --- media; index: 1, or what bends light ---
def finish(d, medium, index, emits, scatters):
    if scatters:
        phase = d.pick("phase").make(d)
        if phase:
            medium["phase"] = phase
    if index != 1:
        medium["index"] = index
    elif d.maybe("priority", 0.25):  # haze hides haze; what bends light holds before any: else its surface is not what its material says
        medium["priority"] = d.one(-2, -1)
    if emits and (d.furnace or d.chance(0.3)):
        medium["temperature_k"] = d.kelvin
    return medium


def absorbing(d, index):
    return finish(d, {"absorption": d.curve(d.u(0.02, 0.8), 0, 10)}, index, True, False)


def scattering(d, index):
    return finish(d, {"scattering": d.u(0.02, 0.8), "absorption": 0}, index, False, True)


def hazy(d, index):
    s, a = d.u(0.02, 0.8), d.u(0.02, 0.4)
    medium = {"scattering": s, "absorption": a} if d.chance(0.5) else {"extinction": round(s + a, 5), "albedo": round(s / (s + a), 4)}
    return finish(d, medium, index, True, True)


def clear(d, index):
    return finish(d, {"absorption": 0}, index, False, False)


def leaves(d, index):
    medium = {"leaves": {"reflectance": d.u(0.05, 0.5), "transmittance": d.u(0.05, 0.45)}}
    return finish(d, medium, index, True, False)


def water(d, index):
    spec = {"chlorophyll": d.u(0.1, 3), "cdom": d.u(0.01, 0.2), "mineral": d.u(0, 2), "salinity": d.one(0, 35),
            "phase": d.one("fournier_forand", "petzold", "hg")}
    medium = {"water": spec, "temperature_k": d.kelvin} if d.furnace else {"water": spec}
    return medium


def dispersive(d, index):
    w, n = d.wavelength, index if index != 1 else d.u(1.3, 1.7)
    curve = {"wavelength_um": [w * 0.5, w, w * 2], "value": [round(n * 1.02, 4), n, round(n * 0.98, 4)], "outside": "hold"}
    return finish(d, {"absorption": d.u(0, 0.3), "index": curve}, 1, True, False)


THERMAL_ONLY = {"without": ("thermal",)}  # its data end before 10 um
ROWS = [
    ("visible", "spectrum", spectrum(0.55, 1700, 60.0), {"weight": 3}),
    ("infrared", "spectrum", spectrum(2.2, 500, 3.0)),
    ("thermal", "spectrum", spectrum(10.0, 300, 8.0)),
    ("curves", "curves", None), ("priority", "detail", None),
    ("lambert", "model", lambert, {"weight": 2}), ("lambert_through", "model", lambert_through), ("mirror", "model", mirror, {"without": ("reciprocal",)}),  # of a point's light it sends on, no path from the other end finds any
    ("ward", "model", ward), ("ggx", "model", ggx),
    ("oren_nayar", "model", oren_nayar), ("rpv", "model", rpv), ("ross_li", "model", ross_li),
    ("roujean", "model", roujean), ("priest_germer", "model", priest_germer), ("beard_maxwell", "model", maxwell("beard_maxwell")),
    ("shell", "model", maxwell("shell")), ("leaf", "model", leaf),
    ("coated", "model", coated), ("coated_through", "model", coated_through), ("bpdf", "model", bpdf), ("sea", "model", sea),
    ("sqt", "model", sqt, {"without": ("reciprocal",)}),  # a fit is reciprocal but for its own error
    ("temperature_constant", "temperature", constant, {"weight": 2}), ("temperature_table", "temperature", table),
    ("temperature_slab", "temperature", slab),
    ("hg", "phase", hg), ("double_hg", "phase", double_hg), ("rayleigh", "phase", rayleigh), ("tabulated", "phase", tabulated),
    ("isotropic", "phase", isotropic), ("fournier_forand", "phase", forand), ("petzold", "phase", petzold),
    ("leaves_phase", "phase", leaves_phase), ("sqt_phase", "phase", sqt_phase),
    ("absorbing", "medium", absorbing), ("scattering", "medium", scattering), ("hazy", "medium", hazy, {"weight": 2}), ("clear", "medium", clear),
    ("leaves", "medium", leaves), ("water", "medium", water, {"what": ("refracts",)}),
    ("dispersive", "medium", dispersive, {"what": ("refracts",)}),
]
