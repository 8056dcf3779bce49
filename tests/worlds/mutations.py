#!/usr/bin/env python3
"""Are faults that are put into the libraries on purpose found by random worlds? README.md has the table of results.

    mutations.py --apply TREE [--only NAME ...]       puts them into a copy of the sources, behind the environment variable WORLDS_MUTATION; build that
    mutations.py --binaries DIR [--only NAME ...] [--worlds 200]     draws worlds of the relation until one shows the fault that the same world
                                                                     does not show without the variable
"""
import argparse
import os
import sys
import tempfile
from dataclasses import dataclass

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import evaluate  # noqa: E402
import judge  # noqa: E402
from programs import Programs, Refused  # noqa: E402
from relations import RELATIONS  # noqa: E402

VARIABLE = "WORLDS_MUTATION"
COSTLY = {"traced_air", "gases_air", "sea", "profile_air", "profile_no_adjacency"}  # worlds with these are not asked here


@dataclass(frozen=True)
class Mutation:
    """One line: `before` becomes `after`, where MUTANT is true with the fault."""
    name: str
    file: str
    before: str
    after: str
    relation: str
    needs: tuple = ()   # rows of which a world has to have one to be asked, and what its case's note says; others count as drawn
    note: str = ""
    factor: int = 6     # times the relation's paths; Q, U and V are small beside the noise of I


FACETS = ("mirror", "ggx", "priest_germer", "beard_maxwell", "shell", "sea", "coated", "coated_through", "bpdf")
GLASS = ("glass_index", "glass_medium", "pane", "pool")
POLARISED = 60  # times the paths
MUTATIONS = (
    Mutation("emission_without_n2", "libs/optics/medium.cpp", "static_cast<float>(mean * index_squared[i])", "static_cast<float>(mean * (MUTANT ? 1.0f : index_squared[i]))",
             "furnace", ("glass_medium", "rough_medium", "pool", "water")),
    Mutation("priorities_swapped", "libs/transport/media/bodies.cpp", "    stack.enter(own, behind, entered, priority(entered));\n    return held || left == kNone;\n  }\n  const Sides",
             "    stack.enter(own, behind, entered, MUTANT ? -priority(entered) : priority(entered));\n    return held || left == kNone;\n  }\n  const Sides", "body_of_the_same", note="hidden"),
    Mutation("lamp_density_without_cosine", "libs/light/kinds/lamp_shapes.cpp", "(std::max(std::fabs(cosine), 1e-12) * s.area)",
             "((MUTANT ? 1 : std::max(std::fabs(cosine), 1e-12)) * s.area)", "furnace", ("glowing", "room_glows")),
    Mutation("sky_weight_halved", "libs/light/kinds/sky.cpp", "spectrum(), density(place)};", "spectrum(), (MUTANT ? 0.5 : 1) * density(place)};", "furnace",
             ("sky_furnace",)),
    Mutation("shadow_ray_forgets_first_body", "libs/transport/media/media_sight.cpp", "  count(r, ray, way);", "  if (!MUTANT || travelled_[r] > 0) count(r, ray, way);", "furnace",
             ("haze_body", "layer", "two_layers", "volume")),
    Mutation("periodic_cell_off_by_one", "libs/trace/cell_walk.cpp", "    ray.origin[a] -= shift * size[a];", "    ray.origin[a] -= (MUTANT && shift < 0 ? shift + 1 : shift) * size[a];",
             "periodic"),
    Mutation("front_side_under_mirror", "libs/trace/packet.cpp", "  if (pose.mirrored) hit.normal = -hit.normal;", "  if (pose.mirrored && !MUTANT) hit.normal = -hit.normal;", "furnace",
             ("mirrored",)),
    Mutation("mixture_share_squared", "libs/surface/material_maps.cpp", "add_reflection(*maps.parts[p], state, place, memory.fractions[p], memory, cubes)",
             "add_reflection(*maps.parts[p], state, place, memory.fractions[p] * (MUTANT ? memory.fractions[p] : 1), memory, cubes)", "substitution", note="mixture"),
    Mutation("light_tree_first_branch", "libs/light/light_tree.cpp", "      probability *= chosen.probability;", "      probability *= MUTANT && c == &first ? 0.5 : chosen.probability;",
             "superposition"),
    Mutation("rough_passage_without_n2", "libs/optics/models/rough_interface.cpp", "(missed - reflected) * (side == 0 ? 1 : index_ * index_)",
             "(missed - reflected) * (side == 0 || MUTANT ? 1 : index_ * index_)", "furnace", ("rough_index", "rough_medium")),
    Mutation("diffuse_channel_loses_scattered", "libs/transport/channels.cpp", "return c.order > 0 && !(c.events & by_medium) && !(c.beam && c.order == 1);",
             "return c.order > (MUTANT ? 1 : 0) && !(c.events & by_medium) && !(c.beam && c.order == 1);", "channels"),
    Mutation("spin_ignores_its_start", "libs/motion/track.cpp", "std::remainder(m_.rate * (t - m_.t0), 2 * kPi)", "std::remainder(m_.rate * (MUTANT ? t : t - m_.t0), 2 * kPi)", "time_shift",
             ("spin",)),
    Mutation("phase_share_turned_round", "libs/optics/phases/hg.cpp", "    return u < share ? hg_sample(g1_[i], u / share)", "    return MUTANT || u < share ? hg_sample(g1_[i], MUTANT ? u : u / share)",
             "substitution", ("double_hg", "hg"), "other words"),
    Mutation("leaves_scene_with_bodies", "libs/transport/media/media_sight.cpp", "  if (!hit.hit()) body_rules_.leave_scene(bodies_at_[r]);", "  if (!hit.hit() && !MUTANT) body_rules_.leave_scene(bodies_at_[r]);",
             "body_of_nothing", ("layer", "two_layers", "haze_body")),
    Mutation("polarised_emission_sign", "libs/transport/surfaces_any.cpp", "m[b](j, 0) = -one(j, 0) *", "m[b](j, 0) = (MUTANT ? 1 : -1) * one(j, 0) *", "stokes_furnace", FACETS, factor=POLARISED),
    Mutation("polarised_emission_not_turned", "libs/transport/surfaces_any.cpp", "const Mueller one = to_world(scattered[of.grey ? 0 : b], at.frame, out, in);",
             "const Mueller one = MUTANT ? scattered[of.grey ? 0 : b] : to_world(scattered[of.grey ? 0 : b], at.frame, out, in);", "stokes_furnace", FACETS, factor=200),
    Mutation("surface_frame_not_turned", "libs/transport/surfaces_any.cpp", "  for (Mueller& one : of.grey ? m.first(1) : m)\n    if (one != Mueller::depolariser())",
             "  for (Mueller& one : of.grey ? m.first(1) : m)\n    if (one != Mueller::depolariser() && !MUTANT)", "stokes_furnace", FACETS + GLASS, factor=200),
    Mutation("reflection_m12_sign", "libs/optics/models/ggx_dielectric.cpp", "        once = fresnel_reflection(std::min(1.0, dot(o, h)), eta) * shape;",
             "        once = fresnel_reflection(std::min(1.0, dot(o, h)), eta) * shape, once.b *= MUTANT ? -1 : 1;", "stokes_furnace", ("rough_index", "rough_medium", "pool"), factor=POLARISED),
    Mutation("passage_m12_sign", "libs/optics/models/dielectric.cpp", "        blocks = fresnel_transmission(c, eta);", "        blocks = fresnel_transmission(c, eta), blocks.b *= MUTANT ? -1 : 1;",
             "stokes_furnace", GLASS, factor=POLARISED),
    Mutation("phase_matrix_not_turned", "libs/transport/media/space_field.cpp", "plane.matrix(sum[i] * (1 / double{whole[i]}))",
             "(MUTANT ? (sum[i] * (1 / double{whole[i]})).matrix() : plane.matrix(sum[i] * (1 / double{whole[i]})))", "stokes_furnace", ("rayleigh",), factor=POLARISED),
    Mutation("phase_matrices_last_alone", "libs/transport/media/space_field.cpp", "      whole[i] += mine, all += mine, unknown", "      whole[i] = (MUTANT ? 0 : whole[i]) + mine, all += mine, unknown",
             "stokes_scalar", ("overlapping", "volume", "ambient", "layer", "two_layers")),
    Mutation("mixture_matrices_last_alone", "libs/optics/mixed_model.cpp", "      all[i] += mine, sum += mine, unknown", "      all[i] = (MUTANT ? 0 : all[i]) + mine, sum += mine, unknown",
             "stokes_scalar", ("mixture",)),
    Mutation("picture_frame_forgets_roll", "libs/transport/block_run.cpp", "  if (how->frame == StokesFrame::image) first", "  if (how->frame == StokesFrame::image && !MUTANT) first", "stokes_roll",
             FACETS + GLASS, "picture", POLARISED),
    Mutation("roll_turns_meridian_frame", "libs/transport/block_run.cpp", "  if (how->frame == StokesFrame::scattering_plane) first = *sun_;",
             "  if (how->frame == StokesFrame::scattering_plane) first = *sun_;\n  if (MUTANT && how->frame == StokesFrame::meridian) first = upright(*how, ray.ray.direction);", "stokes_roll",
             FACETS + GLASS, "vertical", POLARISED),
    Mutation("coated_m21_sign", "libs/optics/models/coated.cpp", "    m(1, 0) = o.a > 0 ? o.b / o.a : 0;", "    m(1, 0) = (MUTANT ? -1 : 1) * (o.a > 0 ? o.b / o.a : 0);", "stokes_furnace",
             ("coated", "coated_through"), factor=POLARISED),
    Mutation("rayleigh_p12_sign", "libs/optics/phases/rayleigh.cpp", "PlaneBlocks{all, -0.75 * delta_", "PlaneBlocks{all, (MUTANT ? 0.75 : -0.75) * delta_", "stokes_furnace", ("rayleigh",), factor=POLARISED),
)
SWITCH = '''#ifndef WORLDS_MUTANT
#define WORLDS_MUTANT
#include <cstdlib>
#include <cstring>
static bool worlds_mutant(const char* name) {
  static const char* const chosen = std::getenv("%s");
  return chosen && std::strcmp(chosen, name) == 0;
}
#endif
''' % VARIABLE


def apply(tree, names):
    texts = {}
    for m in MUTATIONS:
        if m.name not in names:
            continue
        path = os.path.join(tree, m.file)
        if path not in texts:
            with open(path) as file:
                texts[path] = SWITCH + file.read()
        if texts[path].count(m.before) != 1:
            raise SystemExit(f"{m.name}: {m.file} has '{m.before}' {texts[path].count(m.before)} times, not once: the mutation has to follow the source")
        texts[path] = texts[path].replace(m.before, m.after.replace("MUTANT", f'worlds_mutant("{m.name}")'))
    for path, text in texts.items():
        with open(path, "w") as file:
            file.write(text)


def shown(programs, case, folder, seed, name, factor=6):
    """-> what is wrong with the fault, or ''; screening by FINAL, since the world without the fault is the control."""
    os.environ[VARIABLE] = name
    try:
        if case.exact:
            return case.exact(programs, os.path.join(folder, "term0"), seed)
        found = judge.screen(case, evaluate.pictures_of(programs, case, folder, [seed], factor)[0])
        return f"{100 * found.size:+.3g} % at {found.where} (p {found.p:.0e})" if found.p < judge.FINAL else ""
    except Refused as refused:
        return f"code {refused.code}: {refused.text[:80]}"
    finally:
        del os.environ[VARIABLE]


def hunt(programs, mutation, worlds, folder):
    relation = RELATIONS[mutation.relation]
    for seed in range(worlds):
        world, case = evaluate.draw(seed, relation)
        if not case or mutation.needs and not world.rows & set(mutation.needs) or mutation.note not in case.note or world.rows & COSTLY:
            continue
        programs.forget()
        wrong = shown(programs, case, folder, seed + 1, mutation.name, mutation.factor)
        if wrong and not shown(programs, case, folder, seed + 1, "none", mutation.factor):
            return f"| {mutation.name} | {mutation.relation} | {seed + 1} | {case.note}: {wrong} |"
    return f"| {mutation.name} | {mutation.relation} | none of {worlds} | |"


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--apply", metavar="TREE")
    p.add_argument("--binaries", metavar="DIR")
    p.add_argument("--only", nargs="*", default=[m.name for m in MUTATIONS])
    p.add_argument("--worlds", type=int, default=200)
    o = p.parse_args()
    if o.apply:
        apply(o.apply, o.only)
        return 0
    with tempfile.TemporaryDirectory() as scratch:
        programs = Programs(o.binaries, scratch)
        rows = []
        for m in MUTATIONS:
            if m.name in o.only:
                rows.append(hunt(programs, m, o.worlds, scratch + "/now"))
                print(rows[-1], flush=True)
    return 1 if any("none of" in r for r in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
