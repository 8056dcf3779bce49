"""What each feature costs where it is used, by the benches of tests/bench, short runs."""

# title, what it is, command in the root of the checkout
BENCHES = (
    ("Air", "`tests/bench/air --pairs 2 --paths 4`: CPU seconds of paths through 60 bands in vacuum, in air, and with what the scene makes of the air's light; "
            "medians of the ratios with their quartiles; baking.", ("tests/bench/air", "--pairs", "2", "--paths", "4")),
    ("Heat", "`tests/bench/heat --elements 1000,10000`: a street's day in a balance of heat, 64 paths an element, its stages, all cores.",
     ("tests/bench/heat", "--elements", "1000,10000")),
    ("Water", "`build/release/bench/refraction_bench`: a pool's floor under waves and a disk of 1 degree, the sun by manifold NEE through the surface and by chance.",
     ("build/release/bench/refraction_bench",)),
    ("Ranks", "`tests/bench/ranks build/results`: efficiency of tracing that `--dry-run --ranks` forecasts for sample scenes, 256 paths a pixel, one thread a rank.",
     ("tests/bench/ranks", "build/results", "calibration_range", "landsat_like", "night_street", "plume")),
)


def section(run):
    """run(command, log) -> what it printed."""
    text = ""
    for title, what, command in BENCHES:
        printed = run(command, f"build/results/{title.lower()}.txt")
        text += f"### {title}\n\n{what}\n\n```\n{printed.strip()}\n```\n\n"
    return text
