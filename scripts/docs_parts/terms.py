"""Techniques by the field's words: each stands in the header that does it and on a page of the theory, so that a search finds both."""
import os

TERMS = {
    "next-event estimation (NEE)": ("libs/transport/kernel_light.h", "next_event_estimation"),
    "multiple importance sampling": ("libs/transport/shares.h", "mis"),
    "MIS weights": ("libs/transport/shares.h", "mis"),
    "Russian roulette": ("libs/transport/shares.h", "russian_roulette"),
    "manifold next-event estimation (MNEE)": ("libs/transport/techniques/manifold.h", "manifold_nee"),
    "volumetric next-event estimation": ("libs/transport/techniques/volume_chains.h", "multi_vertex_nee"),
    "splitting with a light-directed scattering vertex": ("libs/transport/techniques/side_vertex.h", "splitting"),
    "residual estimator": ("libs/transport/techniques/air_residual.h", "residual_air"),
    "photon guiding": ("libs/transport/gloss_guide.h", "caustic_guiding"),
    "control variate": ("libs/transport/known_way.h", "control_variates"),
    "hero wavelengths": ("libs/transport/shares.h", "hero_wavelengths"),
    "look-up tables (LUT)": ("libs/air/gas_table.h", "air"),
    "discrete ordinates": ("libs/air/discrete_ordinates.h", "air"),
    "NEDT": ("libs/sensor/detector.h", "../guide/temperatures"),
}


def missing(root):
    faults = []
    for term, (header, page) in TERMS.items():
        for path in (header, os.path.normpath(f"docs/theory/{page}.md")):
            with open(os.path.join(root, path)) as f:
                if term.lower() not in " ".join(f.read().replace("//", " ").split()).lower():
                    faults.append(f"{path}: does not name '{term}'")
    return faults
