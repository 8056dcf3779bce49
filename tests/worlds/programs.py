"""Runs scene-prep and dirsig-render on a world, and reads what they left. -> Pictures, or Refused with what they said."""
import glob
import os
import re
import resource
import shutil
import signal
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "../golden"))
import envi  # noqa: E402
from lidar import photons_of  # noqa: E402
from rows_model import FIT, PHASE_FIT  # noqa: E402

TIMEOUT_S = 400                # of CPU: that other programs hold the processor is no fault of a world
STUCK = 10                     # times as long by the clock, for what waits and never ends
FITS = {FIT: "ward:diffuse=0.2,specular=0.2,roughness=0.3", PHASE_FIT: "hg:g=0.5"}  # of sqt-fit --model


def limit_seconds():
    """Of the processor, for a program about to start; a tighter limit that it inherits stays."""
    _, most = resource.getrlimit(resource.RLIMIT_CPU)
    hard = TIMEOUT_S + 5 if most == resource.RLIM_INFINITY else min(most, TIMEOUT_S + 5)
    resource.setrlimit(resource.RLIMIT_CPU, (min(TIMEOUT_S, hard), hard))


class Refused(Exception):
    """A program ended with another code than 0: code, and the last lines of what it said."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code, self.text = code, text


class Picture:
    """Of a sensor: values and standard errors, a list a band; Student's degrees of the errors."""

    def __init__(self, values, errors, degrees):
        self.values, self.errors, self.degrees = values, errors, degrees


def cpu_seconds():
    use = resource.getrusage(resource.RUSAGE_CHILDREN)
    return use.ru_utime + use.ru_stime


class Programs:
    def __init__(self, binaries, scratch):
        self.binaries, self.scratch = os.path.realpath(binaries), scratch
        self.shared = os.path.join(scratch, "shared")
        self.warnings = {}
        self.prepared = {}  # scene text and files -> what scene-prep made of them
        os.makedirs(self.shared, exist_ok=True)

    def fit(self, file):
        """A fit that worlds name, made when one does first."""
        path = os.path.join(self.shared, file)
        if not os.path.exists(path):
            self.run([self.tool("sqt-fit"), "--model", FITS[file], "--order", "3", "-o", file, "-q"], self.shared)
        return path

    def tool(self, name):
        return os.path.join(self.binaries, name)

    def run(self, command, folder):
        late = Refused(-1, f"no end after {TIMEOUT_S} s of CPU: {' '.join(command)}")
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=STUCK * TIMEOUT_S, errors="replace",
                                  preexec_fn=limit_seconds)
        except subprocess.TimeoutExpired as stuck:
            raise late from stuck
        if done.returncode == -signal.SIGXCPU:
            raise late
        if done.returncode:
            text = (done.stdout + done.stderr).strip()
            at = max(text.find("error"), 0)
            raise Refused(done.returncode, text[at:at + 500] if at else text[-500:])
        return done.stdout + done.stderr

    def write(self, world, folder, paths_factor=1):
        """The world's texts and files, ready to run."""
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        scene, sim = world.texts(paths_factor)
        for name, content in {"scene.yaml": scene.encode(), "sim.yaml": sim.encode(), **world.files}.items():
            with open(os.path.join(folder, name), "wb") as file:
                file.write(content)
        for name in FITS:
            if f'"{name}"' in scene:
                shutil.copy(self.fit(name), folder)

    def prepare(self, world, folder, paths_factor=1):
        """Writes the world and prepares its scene, unless the same one was prepared since forget()."""
        self.write(world, folder, paths_factor)
        key = (world.texts()[0], tuple(sorted(world.files.items())))
        scene = os.path.join(folder, "scene.h5")
        if key not in self.prepared:
            self.hear(self.run([self.tool("scene-prep"), "scene.yaml", "-o", "scene.h5", "-q", "--no-crossing-check"], folder))
            self.prepared[key] = os.path.join(self.shared, f"scene{len(self.prepared)}.h5")
            shutil.copy(scene, self.prepared[key])
        else:
            shutil.copy(self.prepared[key], scene)

    def forget(self):
        """Scenes that were prepared; called between worlds."""
        for path in self.prepared.values():
            os.remove(path)
        self.prepared = {}

    def hear(self, told):
        for line in told.splitlines():
            if "warning" in line:
                key = re.sub(r"[0-9.]+", "#", line)[:200]
                self.warnings[key] = self.warnings.get(key, 0) + 1

    def render(self, folder, seed, options=(), out="out"):
        """-> {sensor: Picture}"""
        told = self.run([self.tool("dirsig-render"), "sim.yaml", "-o", out, "-q", "-j", "1", "--seed", str(seed), *options], folder)
        self.hear(told)
        return read(os.path.join(folder, out))

    def pictures(self, world, folder, seeds, paths_factor=1, options=()):
        """-> for each seed {sensor: Picture}; one preparation."""
        self.prepare(world, folder, paths_factor)
        return [kept(self.render(folder, seed, options), world.facts.get("kept")) for seed in seeds]


def kept(pictures, bands):
    """Of all pictures the bands [first, last) alone, where there are such."""
    if bands:
        for p in pictures.values():
            p.values, p.errors = p.values[slice(*bands)], p.errors[slice(*bands)]
    return pictures


def read(folder):
    pictures = {}
    for path in sorted(glob.glob(folder + "/*_error.img")):
        error, value = envi.read(path), envi.read(path.replace("_error.img", ".img"))
        degrees = re.search(r"\(Student, ([0-9.]+) degrees\)", error.description)
        name = os.path.basename(path)[:-len("_error.img")]
        pictures[name] = Picture([list(b) for b in value.values], [list(b) for b in error.values], float(degrees[1]) if degrees else 3.0)
    for path in sorted(glob.glob(folder + "/*_response.h5")):
        name, picture = photons_of(path, Picture)
        pictures[name] = picture
    if not pictures:
        raise Refused(0, "no NAME_error.img and no NAME_response.h5 was written")
    return pictures
