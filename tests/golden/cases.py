"""What is rendered: every case with the commands that prepare it, its values, its paths and how it is compared.

Pictures are made small by fewer and larger detectors, so that they show the whole of the sample scene.
"""
from dataclasses import dataclass, field
from typing import Dict, List, Tuple

PREP = "scene-prep scene.yaml -o scene.h5 -q"


@dataclass
class Case:
    folder: str                                  # of the scene, from the top of the sources
    sets: Dict[str, object] = field(default_factory=dict)  # PATH: VALUE of --set
    prepare: Tuple[str, ...] = (PREP,)           # shell commands, in a copy of the folder
    simulation: str = "sim.yaml"
    options: str = ""                            # more options of dirsig-render
    paths: int = 16                              # of the test; what is stored took MORE times as many, for each of its seeds
    edges: Tuple[int, ...] = (1, 4)              # of the blocks that are compared; heavy tails: 8 alone (README.md)
    brighter: float = 0.01                       # control: so much more radiance is noticed in the mean of the picture
    spot: float = 1.0                            # control: so much of the mean radiance more in one block is noticed


def camera(number: int, columns: int, rows: int, pitch_um: float) -> Dict[str, object]:
    return {f"sensors.{number}.columns": columns, f"sensors.{number}.rows": rows, f"sensors.{number}.pitch_um": pitch_um}


def array(number: int, instrument: int, columns: int, rows: int, pitch_um: float) -> Dict[str, object]:
    at = f"sensors.{number}.instruments.{instrument}.arrays.0."
    return {at + "columns": columns, at + "rows": rows, at + "pitch_um": pitch_um}


HEAVY = (8,)
RAMI_PREP = ("python3 make_inputs.py --half-width 2", "scene-prep scene_nir.yaml -o scene_nir.h5 -q")
CROSSING = {**array(0, 0, 25, 18, 384), "sensors.0.instruments.0.arrays.0.readout.row_time_s": 0.016, "sensors.0.tasks": "[{start: 20}]",
            "sensors.0.instruments.0.clock": "null",
            **{f"sensors.1.instruments.0.arrays.{k}.{key}": value for k in range(3)
               for key, value in (("columns", 18), ("pitch_um", 500), ("readout.line_rate_hz", 15))}}
CROSSING_PREP = ("python3 make_traffic.py", PREP)
BALLS = {"gloss": "ward:diffuse=0.15,specular=0.25,roughness=0.25", "soil": "rpv:rho0=0.2,k=0.7,asymmetry=-0.2,rho_c=0.2"}

CASES: Dict[str, Case] = {
    "calibration_range": Case("sample_scenes/calibration_range", camera(0, 32, 18, 148),
                              ("sqt-fit satin_purple_rgb.bsdf -o satin.sqt -q --order 4", PREP), brighter=0.02),
    "crossing_day": Case("sample_scenes/crossing", CROSSING, CROSSING_PREP, "day.yaml", brighter=0.04),
    "crossing_night": Case("sample_scenes/crossing", CROSSING, CROSSING_PREP, "night.yaml", paths=64, edges=HEAVY, brighter=0.6, spot=3),
    "landsat_like": Case("sample_scenes/landsat_like", {"max_nodes": 8,
                         **{f"sensors.0.instruments.0.arrays.{k}.readout.line_rate_hz": 6 for k in range(9)}},
                         ("cp $SOURCES/sample_scenes/calibration_range/dem_hd_sub.tif .", "python3 make_inputs.py", PREP)),
    "map_gallery": Case("sample_scenes/map_gallery", {**camera(0, 26, 18, 500), **camera(1, 26, 18, 500)}),
    "night_street": Case("sample_scenes/night_street", prepare=("python3 make_scene.py . 32 18", PREP),
                         sets={"sensors.0.pitch_um": 300}, paths=64, brighter=0.6, spot=3),
    "orbit_pass": Case("sample_scenes/orbit_pass", {**array(0, 1, 12, 12, 351), **array(1, 1, 12, 12, 351), **array(2, 1, 12, 12, 351)}),
    "plume": Case("sample_scenes/plume", camera(0, 24, 16, 400), paths=32, edges=HEAVY, brighter=0.3),
    "sqt_spheres": Case("sample_scenes/sqt_spheres", prepare=(
        "mkdir fits", *(f"sqt-fit --model {model} --order 4 -o fits/{name}.sqt -q" for name, model in BALLS.items()),
        'python3 make_scene.py fits . --columns 32 --paths 1 --bin "$BIN"'), brighter=0.02),
    "uas_tribar": Case("sample_scenes/uas_tribar", array(0, 0, 32, 18, 260), ("python3 make_inputs.py", PREP), "moving.yaml", brighter=0.04),
    "warm_roof": Case("sample_scenes/warm_roof", {**camera(0, 16, 12, 800), **camera(1, 16, 12, 800), **camera(2, 16, 12, 800)}),
    "study_smooth": Case("sample_scenes/study/smooth", camera(0, 24, 24, 26.7), brighter=0.02),
    "study_terrain": Case("sample_scenes/study/terrain", brighter=0.02),
    "study_gap": Case("sample_scenes/study/gap", camera(0, 24, 24, 26.7), paths=256, edges=HEAVY, brighter=0.05),
    "study_glint": Case("sample_scenes/study/glint", camera(0, 24, 24, 26.7), paths=256, edges=HEAVY, brighter=0.2, spot=4),
    "paper_method": Case("sample_scenes/study/terrain", options="--method paper --stop plan", brighter=0.03),
    "rami_hom03": Case("sample_scenes/rami_hom03", {}, RAMI_PREP, "sim_nir_20.yaml", paths=512, edges=HEAVY, brighter=0.03),
    "rami_reciprocal": Case("sample_scenes/rami_hom03", {"sensors.0.by_reciprocity": "true", "sensors.0.strata": 4}, RAMI_PREP,
                            "sim_nir_20.yaml", paths=64, edges=(4,), brighter=0.25),
    "furnace": Case("tests/golden/scenes/furnace", brighter=0.02),
    "slab": Case("tests/golden/scenes/slab", paths=64, brighter=0.08),
    "slab_in_air": Case("tests/golden/scenes/slab", {"sky": "null", "atmosphere": "{aerosol: {optical_depth_550: 0.3}}"},
                        paths=64, brighter=0.08),
    "forest": Case("tests/golden/scenes/forest", prepare=("python3 make_tables.py", PREP), paths=64, brighter=0.02),
}
