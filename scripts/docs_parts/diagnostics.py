"""The page of diagnostics, from the program's list: python3 scripts/docs_parts/diagnostics.py build/release/bin > docs/reference/diagnostics.md"""
import os
import re
import subprocess
import sys

PAGE = "docs/reference/diagnostics.md"
PARTS = {1: "Sensors and lights", 2: "Transport", 3: "Interfaces and media", 4: "Atmosphere", 5: "Spectral bins", 6: "Temperatures",
         7: "Imported files", 8: "Products", 9: "The run itself"}
HEAD = """# Diagnostics

What a run reports about its own results, by code. A code is never used again for something else.

Example: `dirsig-render --explain DR402` prints one row, `--list-diagnostics` all, `--mute DR402` keeps one out of the text.
`render.json` (`diagnostics`) holds all that a run reported, muted ones too. Findings of scene-prep (SP) and sqt-inspect (IN): their `--list-issues`.
"""
NOTES = {4: "\nMeasured errors behind DR401 to DR409: [libs/air/ACCURACY.md](../../libs/air/ACCURACY.md).\n"}


def page(listing):
    """The page of `dirsig-render --list-diagnostics`: two lines a code."""
    out, part = [HEAD], None
    for code, severity, condition, cure in re.findall(r"^DR(\d+)  (\w+) +(.*)\n +(.*)$", listing, re.M):
        if int(code) // 100 != part:
            part = int(code) // 100
            out.append(f"\n## {PARTS[part]}\n{NOTES.get(part, '')}\n| code | severity | condition | cure |\n|---|---|---|---|\n")
        out.append(f"| DR{code} | {severity} | {condition} | {cure} |\n")
    return "".join(out)


def listing(bin_folder):
    """What the program prints; None where it is not built."""
    program = os.path.join(bin_folder, "dirsig-render")
    if not os.path.exists(program):
        return None
    return subprocess.run([program, "--list-diagnostics"], capture_output=True, text=True, check=True).stdout


def differs(root, bin_folder):
    """Faults: the stored page is not that of the program."""
    text = listing(bin_folder)
    if text is None:
        return []
    with open(os.path.join(root, PAGE)) as f:
        same = f.read() == page(text)
    return [] if same else [f"{PAGE}: differs from --list-diagnostics; rewrite it: {__doc__.split(': ', 1)[1]}"]


if __name__ == "__main__":
    sys.stdout.write(page(listing(sys.argv[1])))
