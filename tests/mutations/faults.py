"""The faults that tests/mutations/run puts into the libraries, one at a time: what a slip of the pen makes of a formula. Each is in one
source, whose text stands there exactly once. `tests` is a pattern of whole names of tests: the library's own, and what else is named."""
from typing import NamedTuple


class Fault(NamedTuple):
    name: str
    kind: str
    file: str
    old: str
    new: str
    tests: str


def of(library, more=""):
    """The unit and statistical tests of a library, and more."""
    return f"(unit|stat)_{library}_\\w+" + (f"|{more}" if more else "")


FAULTS = [
    Fault("control", "none", "libs/spectral/planck.cpp", "if (!(kelvin > 0)) return 0;\n  const double x",
          "if (!(kelvin > 0)) return 0;\n  const double x", of("spectral", "physics_spectral_planck")),
    # math
    Fault("sobol_bit", "off by one", "libs/math/sampling.cpp", "if ((p.coefficients >> (p.degree - 1 - k)) & 1)",
          "if ((p.coefficients >> (p.degree - k)) & 1)", of("math")),
    Fault("hemisphere_factor", "factor", "libs/math/warps.cpp", "const Four left = 1 - a * a - b * b;",
          "const Four left = 1 - a * a - 0.98 * b * b;", of("math")),
    Fault("chi_square_degrees", "off by one", "libs/math/stats.cpp", "*degrees = cells - 1;\n  return cells < 2 ? 1.0 : chi_square_tail(statistic, cells - 1);",
          "*degrees = cells;\n  return cells < 2 ? 1.0 : chi_square_tail(statistic, cells);", of("math")),
    # spectral
    Fault("planck_factor", "factor 2", "libs/spectral/planck.cpp", "constexpr double kC1 = 2 * kPlanckConstant",
          "constexpr double kC1 = kPlanckConstant", of("spectral", "physics_spectral_planck")),
    Fault("planck_slope", "sign", "libs/spectral/planck.cpp", "return x / -std::expm1(-x);", "return x / std::expm1(x);",
          of("spectral", "physics_spectral_planck")),
    Fault("curve_integral", "factor 2", "libs/spectral/curve.cpp", "dx * (y_[i - 1] + 0.5 * slope * dx);", "dx * (y_[i - 1] + slope * dx);",
          of("spectral")),
    # scattering
    Fault("hg_share", "swapped index", "libs/optics/phases/hg.cpp",
          "return u < share ? hg_sample(g1_[i], u / share) : hg_sample(g2_[i], (u - share) / (1 - share));",
          "return u < share ? hg_sample(g2_[i], u / share) : hg_sample(g1_[i], (u - share) / (1 - share));", "stat_optics_phases"),
    Fault("hg_asymmetry", "sign", "libs/optics/phases/hg.cpp", "share_[i] * g1_[i] + (1 - share_[i]) * g2_[i];",
          "share_[i] * g1_[i] - (1 - share_[i]) * g2_[i];", "stat_optics_phases|unit_air_phase_grid"),
    Fault("rayleigh_square", "missing square", "libs/optics/phases/rayleigh.cpp", "(1 + 3 * gamma_ + (1 - gamma_) * c * c));",
          "(1 + 3 * gamma_ + (1 - gamma_) * std::fabs(c)));", "stat_optics_phases"),
    Fault("fresnel_scale", "missing square", "libs/optics/models/dielectric.cpp", "return 1 / (eta * eta);", "return 1 / eta;",
          "unit_optics_fresnel"),
    Fault("refracted_side", "sign", "libs/optics/models/dielectric.cpp", "out.z > 0 ? index_[knot] : 1 / index_[knot]; }",
          "out.z < 0 ? index_[knot] : 1 / index_[knot]; }", "unit_optics_fresnel|unit_transport_refracted_ray"),
    # sensors and places
    Fault("gaussian_psf", "factor", "libs/sensor/psf.cpp", "polar(sigma * std::sqrt(-2 * std::log1p(-u)), v)",
          "polar(sigma * std::sqrt(-std::log1p(-u)), v)", "unit_sensor_\\w+|physics_sensor_mtf"),
    Fault("airy_obscuration", "missing square", "libs/sensor/psf.cpp", "const double e2 = obscuration * obscuration, step_v",
          "const double e2 = obscuration, step_v", "unit_sensor_\\w+|physics_sensor_mtf"),
    Fault("east_axis", "sign", "libs/motion/scene_frame.cpp", "return {{-sl, cl, 0}, {-sp * cl, -sp * sl, cp}",
          "return {{-sl, cl, 0}, {-sp * cl, sp * sl, cp}", "unit_motion_scene_frame"),
    Fault("southern_grid", "off by one grid", "libs/motion/scene_frame.cpp", "if (!grid.north) u.northing += kFalseNorthing;", "",
          "unit_motion_(scene_frame|map_system)"),
    Fault("daily_aberration", "sign", "libs/motion/ephemeris.cpp", "p += Vec3{-observer.y, observer.x, 0}", "p -= Vec3{-observer.y, observer.x, 0}",
          "unit_motion_ephemeris"),
    Fault("light_time", "missing term", "libs/motion/ephemeris.cpp", "tt.fraction - light_time / ERFA_DAYSEC", "tt.fraction",
          "unit_motion_ephemeris"),
    # air and water
    Fault("refractivity", "swapped index", "libs/air/refraction.cpp", "(5792105 / (238.0185 - s) + 167917 / (57.362 - s)) * (pressure",
          "(5792105 / (57.362 - s) + 167917 / (238.0185 - s)) * (pressure", "(unit_air_shells|physics_air_refraction)"),
    Fault("line_energy", "sign", "libs/air/lines.cpp", "(1 / kReference - 1 / temperature));", "(1 / temperature - 1 / kReference));", "unit_air_lines"),
    Fault("mie_orders", "missing term", "libs/air/mie.cpp", "std::ceil(x + 4.5 * std::cbrt(x) + 4)", "std::ceil(x)", "physics_air_mie"),
    Fault("sea_salinity", "factor", "libs/water/sea_water.cpp", "0.01155 / nm;", "0.1155 / nm;", "unit_water_water"),
    Fault("hidden_sky", "factor", "libs/light/sky_through_water.cpp", "tabulated() ? knots_[k].density(direction) : 0;",
          "tabulated() ? 1.05 * knots_[k].density(direction) : 0;", "physics_transport_water_chain"),
    # heat
    Fault("slab_quadratic", "factor", "libs/thermal/slab.cpp", "k2[j] * (squares + a * b) * (1.0 / 3)", "k2[j] * (squares + a * b) * (1.0 / 2)",
          "unit_thermal_models|physics_thermal_slab"),
    Fault("slab_sky", "missing factor", "libs/thermal/slab_faces.cpp", "face.emissivity * load.sky_irradiance", "load.sky_irradiance",
          "unit_thermal_models|physics_thermal_slab"),
    Fault("natural_convection", "sign", "libs/heat/convection.cpp", "(dt > 0) == (air.cosine_up > 0);", "(dt > 0) != (air.cosine_up > 0);",
          "unit_heat_convection"),
    Fault("sky_cloud", "sign", "libs/heat/sky_models.cpp", "n * (-0.0035 + n * 0.00028)", "n * (0.0035 + n * 0.00028)", "unit_heat_sky_models"),
    # estimates
    Fault("standard_error", "off by one", "libs/estimate/accumulators.cpp", "used * std::max(1, used - 1)", "used * std::max(1, used)",
          "unit_estimate_\\w+|unit_scheduler_(bins|features)"),
    Fault("error_weight", "factor 2", "libs/estimate/accumulators.cpp", "weight[s] = share * share / (1 - 2 * share);",
          "weight[s] = share * share / (1 - share);", "unit_estimate_\\w+"),
    Fault("sample_scatter", "off by one", "libs/estimate/accumulators.cpp", "? variance / (n - 1) : 0;", "? variance / n : 0;",
          "unit_estimate_\\w+"),
    Fault("pooled_likeness", "missing square", "libs/estimate/pooled_errors.cpp", "return 1 / (1 + octaves * octaves);", "return 1 / (1 + std::fabs(octaves));",
          "unit_estimate_pooled_errors"),
    # scenes, fits
    Fault("tile_split", "off by one", "libs/trace/tile_bvh.cpp", "for (const uint32_t i : order) box.grow(boxes[i]), centers",
          "for (const uint32_t i : order.subspan(order.size() > 2)) box.grow(boxes[i]), centers", "unit_trace_tile_bvh"),
    Fault("sqt_weights", "factor 2", "libs/sqt_fit/errors.cpp", "if (sphere) near = folded.z == 0 ? 0 : 0.5 * near;",
          "if (sphere) near = folded.z == 0 ? 0 : near;", "unit_sqt_fit_(phase|target|stability)|stat_sqt_(verbs|energy)"),
    Fault("sqt_entry", "swapped index", "libs/sqt/tree.cpp", "(((at.y >> shift) & mask) << bits) + ((at.x >> shift) & mask);",
          "(((at.x >> shift) & mask) << bits) + ((at.y >> shift) & mask);", "unit_sqt_\\w+"),
    # readers
    Fault("obj_relative", "off by one", "formats/obj/read.cpp", "index > 0 ? index - 1LL : static_cast<long long>(count) + index;",
          "index > 0 ? index - 1LL : static_cast<long long>(count) + index - 1;", "unit_format_obj_read"),
    Fault("hitran_widths", "swapped index", "formats/hitran/read.cpp", 'field(lines, 36, 40, "width in air", 0, 10);',
          'field(lines, 41, 45, "width in air", 0, 10);', "unit_format_hitran_read"),
    Fault("ies_mirror", "sign", "formats/ies/read.cpp", "return h < 90 ? 180 - h : h > 270 ? 540 - h : h;", "return h < 90 ? 90 - h : h > 270 ? 540 - h : h;",
          "unit_format_ies_ies"),
    Fault("envi_scale", "inverse", "formats/envi/numbers.cpp", "n.gain.assign(h.bands, 1 / factor[0]);", "n.gain.assign(h.bands, factor[0]);",
          "unit_format_envi_image"),
    Fault("merl_root", "missing root", "formats/merl/read.cpp", "clamp_bin(90 * std::sqrt(theta_h / (kPi / 2)), 90)",
          "clamp_bin(90 * (theta_h / (kPi / 2)), 90)", "unit_format_merl_merl"),
]
