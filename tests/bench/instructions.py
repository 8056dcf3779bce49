"""Instructions of a program, counted by valgrind's exp-bbv (Debian: valgrind, binutils).

Counts do not depend on what else the machine does, but say nothing of memory and caches. exp-bbv takes a third of the time of lackey for the
same number (1 % apart: it counts a repeated instruction once), and still fifty times that of the program.
"""
import re
import shutil
import subprocess
from pathlib import Path

NEEDED = (("valgrind", "valgrind"), ("objdump", "binutils"))  # programs and the packages that have them


def lacking():
    """What is not installed of what is needed: '' or 'TOOL (Debian: apt install PACKAGE)'."""
    return next((f"{tool} (Debian: apt install {package})" for tool, package in NEEDED if not shutil.which(tool)), "")


def counting(folder: Path) -> list:
    """The words before a command that is counted; its files go into the folder."""
    return ["valgrind", "--tool=exp-bbv", "--instr-count-only=yes", f"--bb-out-file={folder / 'blocks.txt'}", f"--log-file={folder / 'instructions.txt'}"]


def counted(folder: Path) -> int:
    """Instructions of the command that ran last with counting(folder), all threads."""
    log = folder / "instructions.txt"
    found = re.findall(r"Total instructions: *(\d+)", log.read_text())
    if not found:
        raise SystemExit(f"{log} has no 'Total instructions'")
    return sum(map(int, found))


def countable(binaries: Path, folder: Path) -> Path:
    """The folder of a copy of dirsig-render that valgrind can run. Until 3.19 at least it does not know vmovq from register to register where
    it is written as a store (66 0F D6, g++ with -march=x86-64-v3). vmovapd (66 0F 29) is as long and copies the same number."""
    made = folder / "bin"
    made.mkdir(parents=True)
    (folder / "lib").symlink_to(binaries.parent / "lib")
    program = shutil.copy(binaries / "dirsig-render", made)
    sections = subprocess.run(["objdump", "-h", "-j", ".text", program], check=True, capture_output=True, text=True).stdout
    address, offset = (int(n, 16) for n in re.search(r"\.text +\w+ +(\w+) +\w+ +(\w+)", sections).groups())
    with open(program, "r+b") as file, subprocess.Popen(["objdump", "-d", "-j", ".text", program], stdout=subprocess.PIPE, text=True) as code:
        for line in code.stdout:
            found = re.match(r" *(\w+):\t([0-9a-f ]+ )d6 [0-9a-f]{2} *\tvmovq +%xmm\d+,%xmm\d+$", line)
            if found:
                file.seek(int(found[1], 16) - address + offset + len(found[2].split()))
                file.write(b"\x29")
    return made
