"""Makes the two wheels of an installed tree (scripts/wheel): one is packed with everything and repaired by auditwheel, so that each
library is bundled once, and then parted by licence: what only scene-prep needs goes into its own wheel, under the GPL."""
from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from elftools.elf.elffile import ELFFile

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PLATFORM = "manylinux_2_35_x86_64"
PROGRAMS = "remote_scenes_programs"
LIBRARIES = "remote_scenes.libs"
PREP = {"scene-prep", "assimp.so", "vdb.so"}
"""What is part of the GPL's wheel, with the libraries that nothing else needs: scene-prep alone reads models and volumes."""
COMPILED_IN = {"remote-scenes": ["libcli11-dev", "nlohmann-json3-dev", "libtinygltf-dev", "libfmt-dev"],
               "remote-scenes-prep": ["libcgal-dev"]}
"""Debian packages of which code is in the binaries themselves."""


def run(*command: str | Path, **more: object) -> str:
    """What the command prints; its failure ends the program."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, **more)  # type: ignore[call-overload]
    if done.returncode:
        sys.exit(f"make_wheels: {' '.join(map(str, command))}:\n{done.stdout}{done.stderr}")
    return done.stdout


def unpack(wheel: Path, into: Path) -> Path:
    """The folder of what the wheel holds, with the rights of its files."""
    with zipfile.ZipFile(wheel) as packed:
        for entry in packed.infolist():
            path = packed.extract(entry, into)
            if mode := entry.external_attr >> 16:
                os.chmod(path, mode & 0o777)
    return into


def is_elf(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(4) == b"\x7fELF"


def needed(path: Path) -> set[str]:
    """Names of the libraries that a program or library asks for."""
    with path.open("rb") as file:
        dynamic = ELFFile(file).get_section_by_name(".dynamic")
        return {tag.needed for tag in dynamic.iter_tags() if tag.entry.d_tag == "DT_NEEDED"} if dynamic else set()


def closure(roots: list[Path], libraries: Path) -> set[Path]:
    """The bundled libraries that `roots` need, directly or through others."""
    found: set[Path] = set()
    waiting = list(roots)
    while waiting:
        for name in needed(waiting.pop()):
            library = libraries / name
            if library.exists() and library not in found:
                found.add(library)
                waiting.append(library)
    return found


def dist_info(folder: Path) -> Path:
    return next(folder.glob("*.dist-info"))


def write_programs(tree: Path, into: Path) -> None:
    """bin, lib and lib/suite below the package of the programs; a wheel has no symbolic links."""
    shutil.copytree(HERE / PROGRAMS, into, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(tree / "bin", into / "bin")
    (into / "lib").mkdir()
    shutil.copy2(tree / "lib/libremote_scenes.so.1", into / "lib/libremote_scenes.so.1")
    shutil.copytree(tree / "lib/suite", into / "lib/suite")
    shutil.copytree(tree / "include", into / "include")


def combined(tree: Path, work: Path) -> Path:
    """The wheel of everything, not yet repaired."""
    source = work / "source"
    shutil.copytree(ROOT / "python", source, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info", "build", "notebooks"))
    run(sys.executable, "-m", "pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-build-isolation", "-w", work / "pure", source)
    folder = unpack(next((work / "pure").glob("*.whl")), work / "all")
    write_programs(tree, folder / PROGRAMS)
    info = dist_info(folder)
    (info / "WHEEL").write_text("Wheel-Version: 1.0\nGenerator: scripts/wheel\nRoot-Is-Purelib: false\nTag: py3-none-linux_x86_64\n")
    # Without compression and checksums: auditwheel goes by the list of files, and rewrites both.
    files = sorted(p.relative_to(folder) for p in folder.rglob("*") if p.is_file())
    (info / "RECORD").write_text("".join(f"{p},,\n" for p in files))
    wheel = work / f"{info.name.removesuffix('.dist-info')}-py3-none-linux_x86_64.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_STORED) as packed:
        for path in files:
            packed.write(folder / path, path)
    return wheel


def repaired(wheel: Path, libraries: list[Path], work: Path, report: Path) -> Path:
    """Every library outside of the policy bundled; auditwheel fails where one cannot be. `report`: what it says of the result."""
    paths = os.pathsep.join(str(p.resolve()) for p in libraries)
    # x86-64-v3 is asked for on purpose: programs and library say on a lesser processor what it lacks.
    run(sys.executable, "-m", "auditwheel", "repair", "--strip", "--disable-isa-ext-check", "--zip-compression-level", "0", "--plat", PLATFORM, "--only-plat", "-w", work / "repaired", wheel,
        env={**os.environ, "LD_LIBRARY_PATH": paths})
    wheel = next((work / "repaired").glob("*.whl"))
    # Of the whole: each part refers to libraries in the other.
    told = run(sys.executable, "-m", "auditwheel", "show", "--disable-isa-ext-check", wheel)
    report.write_text(told.strip() + "\n", encoding="utf-8")
    return wheel


def package_of(library: str) -> str | None:
    """The Debian package of a bundled library: libpng16-0123abcd.so.16.39 is of libpng16.so.16.39; None = of no package."""
    name = re.sub(r"-[0-9a-f]{8}(?=\.)", "", library)
    stem = name.split(".so")[0]
    for folder in ("/usr/lib/x86_64-linux-gnu", "/lib/x86_64-linux-gnu"):
        for file in [Path(folder) / name, *sorted(Path(folder).glob(stem + ".so*"))]:
            if not file.exists():
                continue
            for path in (file, file.resolve()):
                for as_named in (str(path), str(path).removeprefix("/usr")):
                    told = subprocess.run(["dpkg-query", "-S", as_named], capture_output=True, text=True)
                    if told.returncode == 0:
                        return told.stdout.split(":")[0]
    return None


def write_licences(info: Path, distribution: str, libraries: set[Path], openimageio: Path) -> None:
    """The terms of everything in a wheel; fails where those of a library are not found."""
    folder = info / "licenses"
    third = folder / "third_party"
    third.mkdir(parents=True, exist_ok=True)
    shutil.copy2(ROOT / "LICENSE", folder / "LICENSE")
    rows = []
    for library in sorted(libraries):
        if library.name.startswith("libOpenImageIO"):
            for file in openimageio.iterdir():
                shutil.copy2(file, third / f"OpenImageIO.{file.name}")
            rows.append(f"- {library.name}: OpenImageIO, as its authors publish it; licenses/third_party/OpenImageIO.*")
            continue
        if library.name.startswith(("libcurl", "libproj")):
            rows.append(f"- {library.name}: only stands in for that library, without any of its code (packaging/wheel/stand_in of the suite)")
            continue
        package = package_of(library.name)
        if not package:
            sys.exit(f"make_wheels: {library.name} is of no Debian package, so its licence is not known")
        shutil.copy2(f"/usr/share/doc/{package}/copyright", third / f"{package}.txt")
        changed = " (built without JBIG)" if package == "libtiff6" else ""
        rows.append(f"- {library.name}: Debian package {package}{changed}; licenses/third_party/{package}.txt")
    for package in COMPILED_IN[distribution]:
        shutil.copy2(f"/usr/share/doc/{package}/copyright", third / f"{package}.txt")
        rows.append(f"- in the binaries: Debian package {package}; licenses/third_party/{package}.txt")
    notice = (ROOT / "NOTICE").read_text(encoding="utf-8")
    head = "" if distribution == "remote-scenes" else (HERE / "notice_of_prep.txt").read_text(encoding="utf-8") + "\n"
    (folder / "NOTICE").write_text(head + notice + "\nLibraries of others in this wheel, each under its own licence:\n\n" + "\n".join(rows) + "\n", encoding="utf-8")
    if distribution == "remote-scenes-prep":
        shutil.copy2("/usr/share/common-licenses/GPL-3", folder / "COPYING.GPL-3")


def version_of(info: Path) -> str:
    return info.name.removesuffix(".dist-info").split("-")[1]


def entry_points(names: list[str]) -> str:
    return "[console_scripts]\n" + "".join(f"{n} = {PROGRAMS}:{n.replace('-', '_')}\n" for n in names)


def part(wheel: Path, openimageio: Path, work: Path) -> list[Path]:
    """The two wheels' folders, of the one that was repaired."""
    folder = unpack(wheel, work / "remote-scenes")
    info, libraries = dist_info(folder), folder / LIBRARIES
    version = version_of(info)
    elf = [p for p in (folder / PROGRAMS).rglob("*") if p.is_file() and is_elf(p)]
    ours = closure([p for p in elf if p.name not in PREP], libraries)
    all_of_them = set(libraries.iterdir())
    gone = all_of_them - closure(elf, libraries)
    if gone:
        sys.exit(f"make_wheels: bundled, and needed by nothing: {', '.join(sorted(p.name for p in gone))}")
    prep = work / "remote-scenes-prep"
    for path in [p for p in elf if p.name in PREP] + sorted(all_of_them - ours):
        to = prep / path.relative_to(folder)
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.move(path, to)
    write_licences(info, "remote-scenes", ours, openimageio)
    metadata = (info / "METADATA").read_text(encoding="utf-8")
    first = metadata.index("Requires-Dist:")
    (info / "METADATA").write_text(metadata[:first] + f"Requires-Dist: remote-scenes-prep=={version}\n" + metadata[first:], encoding="utf-8")
    (info / "entry_points.txt").write_text(entry_points(["dirsig-render", "sqt-fit", "sqt-inspect"]))
    prep_info = prep / f"remote_scenes_prep-{version}.dist-info"
    prep_info.mkdir()
    (prep_info / "METADATA").write_text((HERE / "prep_metadata.txt").read_text(encoding="utf-8").replace("@VERSION@", version), encoding="utf-8")
    shutil.copy2(info / "WHEEL", prep_info / "WHEEL")
    (prep_info / "entry_points.txt").write_text(entry_points(["scene-prep"]))
    write_licences(prep_info, "remote-scenes-prep", {prep / p.relative_to(folder) for p in all_of_them - ours}, openimageio)
    return [folder, prep]


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--tree", type=Path, required=True, help="of cmake --install")
    options.add_argument("--libraries", type=Path, action="append", default=[], help="folders of libraries that go before the system's")
    options.add_argument("--openimageio-licenses", type=Path, required=True)
    options.add_argument("--out", type=Path, required=True)
    given = options.parse_args()
    with tempfile.TemporaryDirectory(dir=given.tree.parent) as folder:
        work = Path(folder)
        for each in part(repaired(combined(given.tree, work), given.libraries, work, given.tree.parent / "auditwheel.txt"), given.openimageio_licenses, work):
            run(sys.executable, "-m", "wheel", "pack", each, "-d", given.out)


if __name__ == "__main__":
    main()
