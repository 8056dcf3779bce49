#!/usr/bin/env python3
"""signals_test.py BIN WORK [--shots N] [--seed S] [--phase NAME...]

One SIGTERM, as `timeout` and batch systems send it, at seeded random moments of every long phase of the programs: the slab's
spin-up, the air's light, the ray tracer's structures, rendering, delivery, temperatures from weather, fits, preparation. Each
ends within 2 s (on a machine with other work: with at most 1 s of CPU time), with exit code 143 unless it had finished, leaves
whole files or none and no lock, and goes on from its state where it keeps one, to the bytes of a run that nobody stopped.
"""
import argparse
import math
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
MOST_SECONDS, MOST_CPU = 2.0, 1.0
BYTES = {"1": 1, "2": 2, "3": 4, "4": 4, "5": 8, "12": 2, "13": 4}


def camera(size, paths, bands, more=""):
    return (f"sensors: [{{kind: orthographic, name: cam, columns: {size}, rows: {size}, gsd_m: {20 / size}, center_m: [0, 0], "
            f"height_m: 10, paths: {paths}, bands: {bands}{more}}}]\n")


RED = "[{name: red, center_um: 0.65, fwhm_um: 0.02}]"
GREY = "materials: {grey: {model: lambert, reflectance: 0.5}}\n"
FLAT = "objects: {p: {plane: {width: 40, depth: 40}, material: grey}}\nworld: [{place: p}]\n"


def slab(work, _):
    loads = ", ".join(f"[{1800 * i}, {max(0, 800 * math.sin(i * math.pi / 24)):.1f}, 300, {285 + 5 * math.sin(i / 100):.2f}, 2]"
                      for i in range(4 * 4380 + 1))
    temperature = f"{{model: slab, period_s: 31536000, loads: {{table: [{loads}], repeat: true}}}}"
    (work / "scene.yaml").write_text(
        "scene: 1\nwindows_um: [[8, 12]]\nmaterials:\n" +
        "".join(f"  m{k}: {{model: lambert, reflectance: 0.1, temperature: {'*year' if k else '&year ' + temperature}, thermal: "
                f"{{layers: [{{thickness_m: 0.{k + 2}, density_kg_m3: 2000, specific_heat_j_kg_k: 900, conductivity_w_m_k: 1}}]}}}}\n"
                for k in range(4)) +
        "objects:\n" + "".join(f"  p{k}: {{plane: {{width: 4, depth: 20}}, material: m{k}}}\n" for k in range(4)) +
        "world: [" + ", ".join(f"{{place: p{k}, translate: [{4 * k - 6}, 0, 0]}}" for k in range(4)) + "]\n")
    return "scene: scene.h5\n" + camera(8, 16, "[{name: t, center_um: 10, fwhm_um: 0.2}]", ", time_s: 3")


def air(work, _):
    (work / "scene.yaml").write_text("scene: 1\n" + GREY + FLAT)
    bands = ", ".join(f"{{name: b{k}, center_um: {0.42 + 0.02 * k:.2f}, fwhm_um: 0.02}}" for k in range(90))
    return ("scene: scene.h5\nsun: {direction: {zenith_deg: 40, azimuth_deg: 120}}\natmosphere: {profile: us_standard}\n" +
            camera(8, 4, f"[{bands}]"))


def tracer(work, _):
    n = 500
    z = [[0.3 * math.sin(0.37 * i) * math.cos(0.29 * j) for j in range(n + 1)] for i in range(n + 1)]
    with open(work / "hills.stl", "wb") as out:
        out.write(bytes(80) + struct.pack("<I", 2 * n * n))
        for i in range(n):
            for j in range(n):
                a, b, c, d = [(20 * x / n - 10, 20 * y / n - 10, z[x][y]) for x, y in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
                for t in ((a, b, c), (a, c, d)):
                    out.write(struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], 0))
    (work / "scene.yaml").write_text("scene: 1\n" + GREY + "objects: {p: {stl: hills.stl, material: grey}}\n"
                                     "world: [{place: p}]\n")
    return "scene: scene.h5\nsky: {radiance: 10}\n" + camera(8, 16, RED)


def rendering(work, _):
    (work / "scene.yaml").write_text(
        "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.99}}\n"
        "objects: {p: {plane: {width: 40, depth: 40}, material: grey}, b: {box: {x0: -9, y0: -9, z0: -9, x1: 9, y1: 9, z1: 9}, "
        "material: grey}}\nworld: [{place: b}]\n")
    return ("scene: scene.h5\nsky: {radiance: 10}\nmax_nodes: 200\n" +
            camera(8, 600, RED).replace("height_m: 10", "height_m: 5"))


def delivery(work, _):
    (work / "scene.yaml").write_text("scene: 1\n" + GREY + FLAT)
    bands = ", ".join(f"{{name: b{k}, center_um: {0.42 + 0.02 * k:.2f}, fwhm_um: 0.02}}" for k in range(40))
    return "scene: scene.h5\nsky: {radiance: 10}\n" + camera(256, 1, f"[{bands}]")


def weather(work, _):
    shutil.copy(ROOT / "sample_scenes/summer_street/denver_july.epw", work / "july.epw")
    thermal = ("thermal: {thickness_m: 0.2, density_kg_m3: 2300, specific_heat_j_kg_k: 900, conductivity_w_m_k: 1.4}, "
               "temperature: {model: heat, convection: mcadams}")
    (work / "scene.yaml").write_text(
        "scene: 1\norigin: {latitude_deg: 39.83, longitude_deg: -104.65, height_m: 1650}\nepoch: 2001-07-14T07:00:00Z\n"
        "windows_um: [[8, 12]]\nmaterials:\n  grey: {model: lambert, reflectance: 0.1, " + thermal + "}\n"
        "objects: {p: {plane: {width: 40, depth: 40}, material: grey}, b: {box: {x0: -6, y0: -4, z0: 0, x1: 6, y1: 4, z1: 3}, "
        "material: grey}}\nworld: [{place: p}, {place: b}]\n")
    return ("scene: scene.h5\nepoch: 2001-07-14T07:00:00Z\nweather: {file: july.epw, year: 2001}\n"
            "heat: {elements: 200, step_s: 600, keep: operator}\nsun: {direction: {time_utc: 2001-07-14T07:00:00Z}}\n" +
            camera(8, 16, "[{name: t, center_um: 10, fwhm_um: 0.2}]", ", time_s: 10800"))


def fit(*_):
    return None


def fits(work, run):
    """A folder of measured files, which are a fit's values."""
    (work / "in").mkdir()
    for k in range(2):
        run(["sqt-fit", "-q", "--model", f"ward:diffuse=0.2,specular=0.{k + 1},roughness=0.3", "--order", "3", "--views", "5", "-o", "x.sqt"], work)
        run(["sqt-inspect", "-q", "x.sqt", "--export", f"in/{k}.csv"], work)


class Phase:
    """What is run, in a folder with what it needs; state: how it goes on."""

    def __init__(self, make, command, resume):
        self.make, self.command, self.resume = make, command, resume


RENDER = ["dirsig-render", "sim.yaml", "-q", "-o", "out", "--state"]
RESUME = ["dirsig-render", "sim.yaml", "-q", "-o", "out", "--resume"]
FIT = ["sqt-fit", "-q", "--model", "ward:diffuse=0.2,specular=0.1,roughness=0.1", "--report", "out/w.json", "-o", "out/w.sqt"]
FITS = ["sqt-fit", "-q", "in", "--fits", "out/fits", "-o", "out/table.csv"]
PREPARE = ["scene-prep", "scene.yaml", "-q", "--no-crossing-check", "-o", "out/scene.h5"]
PHASES = {
    "spin_up": Phase(slab, RENDER, RESUME),
    "air": Phase(air, RENDER, RESUME),
    "tracer": Phase(tracer, RENDER, RESUME),
    "rendering": Phase(rendering, RENDER, RESUME),
    "delivery": Phase(delivery, RENDER, RESUME),
    "weather": Phase(weather, RENDER, RESUME),
    "fit": Phase(fit, FIT, FIT),
    "fits": Phase(fits, FITS, FITS),
    "preparation": Phase(tracer, PREPARE, PREPARE),
}


def cpu_seconds(pid):
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Runner:
    def __init__(self, bin_, work):
        self.bin, self.work, self.faults = bin_, work, []

    def run(self, command, cwd):
        return subprocess.run([self.bin / command[0], *command[1:]], cwd=cwd, capture_output=True, text=True, timeout=900)

    def set_up(self, phase, cwd):
        shutil.rmtree(cwd, ignore_errors=True)
        cwd.mkdir(parents=True)
        sim = phase.make(cwd, self.run)
        if sim is None:
            return
        (cwd / "sim.yaml").write_text(sim)
        if phase.command is not PREPARE:
            done = self.run(["scene-prep", "scene.yaml", "-q", "--no-crossing-check", "-o", "scene.h5"], cwd)
            assert done.returncode == 0, done.stderr

    def shoot(self, command, cwd, moment):
        """Exit code, seconds and CPU seconds from the signal to the end."""
        with open(cwd / "said", "w", encoding="utf-8") as said:
            process = subprocess.Popen([self.bin / command[0], *command[1:]], cwd=cwd, stdout=said, stderr=said)
            until = time.monotonic() + moment
            while process.poll() is None and time.monotonic() < until:
                time.sleep(min(0.01, max(0, until - time.monotonic())))
            if process.returncode is not None:
                return process.returncode, 0, 0
            before, sent = cpu_seconds(process.pid), time.monotonic()
            process.send_signal(signal.SIGTERM)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            return process.returncode, time.monotonic() - sent, used.ru_utime + used.ru_stime - before

    def wrong_files(self, folder):
        """Files that no run may leave behind."""
        wrong = []
        for path in folder.rglob("*") if folder.exists() else ():
            if re.search(r"\.part-|\.lock$|\.joined$|^\.", path.name):
                wrong.append(path.name)
            if path.suffix == ".img":
                header = Path(f"{path}.hdr")
                text = header.read_text() if header.exists() else ""
                size = math.prod(int(re.search(rf"^{k} = (\d+)", text, re.M)[1]) for k in ("samples", "lines", "bands")) if text else -1
                if not text or size * BYTES[re.search(r"data type = (\d+)", text)[1]] != path.stat().st_size:
                    wrong.append(path.name)
        return wrong

    def results(self, folder):
        return {p.name: p.read_bytes() for p in sorted(folder.rglob("*")) if p.suffix in (".img", ".sqt") or p.name == "scene.h5"}

    def phase(self, name, shots, resumed, seed):
        phase, cwd, random_ = PHASES[name], self.work / name, random.Random(f"{seed} {name}")
        self.set_up(phase, cwd)
        out = cwd / "out"
        begun = time.monotonic()
        done = self.run(phase.command, cwd)
        whole = time.monotonic() - begun
        assert done.returncode == 0, done.stderr
        wanted = self.results(out)
        assert wanted, name
        slowest, most_cpu, ended = 0.0, 0.0, 0
        for shot in range(shots):
            shutil.rmtree(out, ignore_errors=True)
            code, seconds, cpu = self.shoot(phase.command, cwd, random_.uniform(0.02, 1) * whole)
            slowest, most_cpu, ended = max(slowest, seconds), max(most_cpu, cpu), ended + (code == 143)
            fault = []
            # A process that is still being loaded has no handler yet, and has made nothing.
            if code not in (0, 143) and (code != -signal.SIGTERM or out.exists() or (cwd / "said").stat().st_size):
                fault.append(f"exit code {code}")
            if seconds > MOST_SECONDS and cpu > MOST_CPU:
                fault.append(f"{seconds:.2f} s and {cpu:.2f} s of CPU time after the signal")
            fault += [f"left {n}" for n in self.wrong_files(out)]
            if code == 143 and shot < resumed:
                # A run that was stopped before it had a state begins anew.
                again = phase.resume if phase.resume is not RESUME or (out / "result.state.h5").exists() else phase.command
                done = self.run(again, cwd)
                if done.returncode != 0:
                    fault.append(f"does not go on: {done.stderr}")
                elif self.results(out) != wanted:
                    fault.append("goes on to other bytes")
            if fault:
                self.faults.append(f"{name}, shot {shot}: {'; '.join(fault)}\n{(cwd / 'said').read_text()[-500:]}")
        print(f"{name:12s} {whole:6.2f} s whole; {ended} of {shots} stopped; the slowest {slowest:.2f} s, {most_cpu:.2f} s of CPU time, "
              "after the signal", flush=True)
        shutil.rmtree(cwd)
        return ended


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bin", type=Path)
    parser.add_argument("work", type=Path)
    parser.add_argument("--shots", type=int, default=3, help="signals to each phase")
    parser.add_argument("--resumed", type=int, default=1, help="of them so many go on and are compared with a run of one piece")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--phase", nargs="*", default=list(PHASES), choices=PHASES)
    given = parser.parse_args()
    runner = Runner(given.bin.resolve(), given.work.resolve())
    ended = sum(runner.phase(name, given.shots, given.resumed, given.seed) for name in given.phase)
    print("\n".join(runner.faults))
    if ended == 0:
        print("no signal met a program at work")
    return 1 if runner.faults or ended == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
