"""Numbers on pages that the sources decide: each stands on its page as the source has it."""
import os
import re

# Page, what it must say (%s: the number), the file that decides, and where it stands there.
FACTS = (
    ("guide/run_time.md", "| nothing | %s |", "libs/sensor/sensor.h", r"min_paths = \d+, max_paths = (\d+);"),
    ("guide/outputs.md", "`paths` of the sensor, %s where it says nothing", "libs/sensor/sensor.h", r"min_paths = \d+, max_paths = (\d+);"),
    ("guide/run_time.md", "`min: %s`", "libs/sensor/sensors.cpp", r'integer\("min", 1, most, (\d+)\)'),
    ("guide/run_time.md", "`max: %s`", "libs/sensor/sensors.cpp", r'integer\("max", 1, most, (\d+)\)'),
    ("guide/run_time.md", "`relative_error: %s`", "libs/sensor/sensors.cpp", r'number_in\("relative_error", 0, 1, "\(fraction\)", ([\d.]+)\)'),
    ("guide/run_time.md", "from %s to", "libs/estimate/budget.h", r"kDefaultPilot = (\d+)"),
    ("guide/run_time.md", "to %s |", "libs/estimate/budget.h", r"kDefaultMost = (\d+)"),
    ("start/systems.md", "`%s`", "packaging/wheel/make_wheels.py", r'PLATFORM = "(\w+)"'),
    ("start/systems.md", "(%s:", "CMakeLists.txt", r'set\(SUITE_ARCH "([\w-]+)"'),
    ("start/systems.md", "CMake %s or later", "CMakeLists.txt", r"cmake_minimum_required\(VERSION ([\d.]+)"),
    ("start/systems.md", "Python %s or later", "python/pyproject.toml", r'requires-python = ">=([\d.]+)"'),
)
FAULTS = "start/faults.md"
NO_ADDRESS = "This version names no public address"


def text_of(root, path):
    with open(os.path.join(root, path)) as f:
        return f.read()


def differs(root):
    """Faults: a page says another number than its source, or another address than CITATION.cff."""
    faults = []
    for page, words, source, where in FACTS:
        found = re.search(where, text_of(root, source))
        if not found:
            faults.append(f"{source}: has no {where}, which docs/{page} quotes")
        elif words % found[1] not in text_of(root, f"docs/{page}"):
            faults.append(f"docs/{page}: does not say '{words % found[1]}', as {source} has it")
    address = re.search(r'^repository-code: *"?([^"\s]+)', text_of(root, "CITATION.cff"), re.M)
    page = text_of(root, f"docs/{FAULTS}")
    if address and (address[1] not in page or NO_ADDRESS in page):
        faults.append(f"docs/{FAULTS}: does not name {address[1]}, the repository of CITATION.cff")
    if not address and NO_ADDRESS not in page:
        faults.append(f"docs/{FAULTS}: names a repository, CITATION.cff has none")
    return faults
