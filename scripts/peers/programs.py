"""Runs of each program: CPU seconds of all threads without what a run of one path takes (loading, building), and the image. Images lie as .npy in the folder."""
import json
import os
import re
import resource
import subprocess
import sys

from peers.scenes import ROOT

MANY = 1024  # paths a pixel
BIN = os.path.join(ROOT, "build/release/bin")


def cpu(who=resource.RUSAGE_SELF):
    use = resource.getrusage(who)
    return use.ru_utime + use.ru_stime


class Ours:
    """One scene by our program; `prepare` must have been called."""

    def __init__(self, folder, scene, edge):
        self.folder, self.scene, self.edge = folder, scene, edge
        self.name = "ours, scrambled Sobol"

    def _run(self, *command):
        start = cpu(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{' '.join(command)}: {done.stderr or done.stdout}")
        return cpu(resource.RUSAGE_CHILDREN) - start

    def command(self, paths, seed):
        base = f"{self.folder}/{self.scene.name}"
        return [f"{BIN}/dirsig-render", f"{base}_sim.yaml", "-o", f"{base}_out", "--threads", "2", "--paths", str(paths), "--seed", str(seed), "-q"]

    def _whole(self, paths, seed):
        return self._run(*self.command(paths, seed))

    def prepare(self):
        base = f"{self.folder}/{self.scene.name}"
        for name, *options in self.scene.fitted:
            self._run(f"{BIN}/sqt-fit", *options, "--swap", "-o", f"{self.folder}/{name}.sqt", "-q", "--report", f"{self.folder}/{name}_fit.json")
        self._run(f"{BIN}/scene-prep", base + "_scene.yaml", "-o", base + ".h5", "--no-crossing-check")
        self.measure_before()

    def measure_before(self):
        """Needs the prepared scene."""
        self.before = min(self._whole(1, 5) for _ in range(3))  # loading and building, and one path
        self.seconds_of_path = None

    def render(self, paths, seed):
        import numpy as np
        whole = self._whole(paths, seed)
        seconds = (whole - self.before) * paths / (paths - 1)
        if whole <= 2 * self.before:
            # What loading and building take hides the paths: one run of many tells what a path takes.
            if self.seconds_of_path is None:
                self.seconds_of_path = sorted((self._whole(MANY, 6) - self.before) / (MANY - 1) for _ in range(3))[1]
                self._whole(paths, seed)  # the image again
            seconds = self.seconds_of_path * paths
        image = np.fromfile(f"{self.folder}/{self.scene.name}_out/camera.img", dtype="<f4").astype(np.float64)
        return image.reshape(-1, self.edge, self.edge).transpose(1, 2, 0), seconds


class Mitsuba:
    """One scene by Mitsuba in this process, whose variant has been set. Raises what Mitsuba raises when it cannot load the scene."""

    def __init__(self, folder, scene, variant, sampler):
        import mitsuba as mi
        self.mi, self.scene = mi, scene
        self.loaded = mi.load_file(f"{folder}/{scene}.xml", sampler=sampler)
        self.name = f"Mitsuba {mi.__version__} {variant}, {sampler}"
        self._whole(1, 5)  # what is compiled is compiled now
        # Of every call: tracing the kernel of a scene of many emitters or instances takes seconds; and one path.
        self.before = min(self._whole(1, 5)[1] for _ in range(4))
        self.seconds_of_path = None

    def _whole(self, paths, seed):
        import numpy as np
        start = cpu()
        image = np.array(self.mi.render(self.loaded, spp=paths, seed=seed)).astype(np.float64)
        return image, cpu() - start

    def render(self, paths, seed):
        image, whole = self._whole(paths, seed)
        if whole > 2 * self.before:
            return image, (whole - self.before) * paths / (paths - 1)
        # What every call takes hides the paths: one call of many tells what a path takes.
        if self.seconds_of_path is None:
            # What a scene before this one left to be freed may have been in it.
            self.before = min(self.before, *(self._whole(1, 5)[1] for _ in range(4)))
            self.seconds_of_path = sorted((self._whole(MANY, 6)[1] - self.before) / (MANY - 1) for _ in range(3))[1]
            if not self.seconds_of_path > 0:
                sys.exit(f"{self.name} on {self.scene}: {MANY} paths took no more time than one")
        return image, self.seconds_of_path * paths


def without_holes(image):
    """Pixels that are no numbers (Mitsuba has some in volumes) become the mean of the numbers around them. -> image, how many."""
    import numpy as np
    holes = ~np.isfinite(image).all(axis=2)
    for row, column in zip(*np.nonzero(holes)):
        around = (slice(max(0, row - 1), row + 2), slice(max(0, column - 1), column + 2))
        image[row, column] = image[around][~holes[around]].mean(axis=0)
    return image, int(holes.sum())


def measure(program, scene, plan, folder, results, **also):
    """scene: its name. plan: rows (kind, paths, seeds). Adds a row per run to `results`."""
    import numpy as np
    for kind, paths, seeds in plan:
        for seed in seeds:
            image, cpu_s = program.render(paths, seed)
            image, holes = without_holes(image)
            file = f"{folder}/images/{scene}-{re.sub('[^A-Za-z0-9_.]+', '-', program.name)}-{kind}-{paths}-{seed}.npy"
            np.save(file, image)
            results.append({"scene": scene, "program": program.name, "kind": kind, "paths": paths, "seed": seed, "cpu_s": cpu_s, "image": file, "holes": holes, **also})


def run_pairs(folder, scenes, edge, chosen, variant, plan):
    """chosen: scene -> sampler. plan: numbers of paths, seeds. Ours and Mitsuba in turn, in this process's calls. -> runs, of kind "pair"."""
    import mitsuba as mi
    mi.set_variant(variant)
    mi.set_log_level(mi.LogLevel.Error)
    results = []
    for scene in scenes:
        ours, peer = Ours(folder, scene, edge), Mitsuba(folder, scene.name, variant, chosen[scene.name])
        ours.measure_before()
        for seed in plan[1]:
            for program in (ours, peer) if seed % 2 else (peer, ours):
                measure(program, scene.name, [("pair", paths, [seed]) for paths in plan[0]], folder, results)
    return results


WATCH = """import json, resource, subprocess, sys, time
start = time.monotonic()
code = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
use = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([code, time.monotonic() - start, use.ru_utime + use.ru_stime, use.ru_maxrss / 1024]))"""


def whole_program(command):
    """-> seconds on the wall, CPU seconds, and the most memory (MB) of a process that is run to its end. Watched by a small process: a
    child's memory counts what its parent held when it was started."""
    code, *figures = json.loads(subprocess.run([sys.executable, "-c", WATCH, *command], capture_output=True, text=True, check=True).stdout)
    if code:
        sys.exit(f"{' '.join(command)} ends with {code}")
    return figures


def run_mitsuba(folder, chosen, variant, plan, most_before):
    """chosen: scene -> samplers. Scenes of which every call takes more than most_before seconds are left out. -> runs, and the scenes left out with the reason."""
    import mitsuba as mi
    mi.set_variant(variant)
    mi.set_log_level(mi.LogLevel.Error)
    results, left_out = [], {}
    for scene, samplers in chosen.items():
        for sampler in samplers:
            try:
                program = Mitsuba(folder, scene, variant, sampler)
            except Exception as e:  # a variant without this scene's reflectance model
                left_out[scene] = re.sub(".*: ", "", str(e).splitlines()[-1])
                break
            if program.before > most_before:
                left_out[scene] = f"{program.before:.0f} CPU s a call before the first path"
                break
            measure(program, scene, plan, folder, results, variant=variant, sampler=sampler)
    return results, left_out
