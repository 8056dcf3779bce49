"""Pages of the site that are made of sources: formats, samples, libraries, options, lists, the C interface, the SDK, the Python package."""
import ast
import os
import subprocess

PROGRAMS = ("scene-prep", "dirsig-render", "sqt-fit", "sqt-inspect")
LISTS = (("reference/truth.md", "Truth", "What else a pixel can hold, by the `truth` of a sensor.", "dirsig-render", "--list-truth"),
         ("reference/channels.md", "Channels", "Parts of the light as further bands, by the `channels` of a sensor.", "dirsig-render", "--list-channels"),
         ("reference/sensor_kinds.md", "Kinds of sensors", "What `kind` of a sensor may be; keys: [sensors](sensors.md).", "dirsig-render", "--list-sensors"),
         ("reference/deflector_kinds.md", "Kinds of scanners", "What `kind` of a scanner of a laser radar may be; keys: [laser radars](lidar.md).", "dirsig-render", "--list-deflectors"),
         ("reference/detector_kinds.md", "Kinds of detectors", "What `kind` of a detector of laser pulses may be; keys: [detection](detection.md).", "dirsig-render", "--list-detectors"),
         ("reference/image_detector_kinds.md", "Kinds of image detectors", "What `kind` of the detector of an array may be; keys: [sensors](sensors.md).", "dirsig-render", "--list-image-detectors"),
         ("reference/sources.md", "Sources of light", "Kinds of suns, skies and lamps of a simulation text.", "dirsig-render", "--list-sources"),
         ("reference/models.md", "Models of materials", "Scattering models, phase functions and temperature models with their parameters.",
          "scene-prep", "--list-models"))


def write(site, bin_folder):
    included(site)
    options(site, bin_folder)
    headers(site)
    python(site)


def included(site):
    root = site.root
    for name in folders(root, "formats", "FORMAT.md"):
        site.add(f"reference/formats/{name}.md", f"```{{include}} ../../../formats/{name}/FORMAT.md\n```\n")
    for name in folders(root, "sample_scenes", "README.md"):
        text = f"```{{include}} ../../../sample_scenes/{name}/README.md\n```\n"
        for page in ("TUTORIAL.md", "expect.md"):
            if os.path.exists(os.path.join(root, "sample_scenes", name, page)):
                text += f"\n```{{include}} ../../../sample_scenes/{name}/{page}\n:heading-offset: 1\n```\n"
        text += texts_of(os.path.join(root, "sample_scenes", name))
        site.add(f"guide/samples/{name}.md", text)
    for name in folders(root, "libs", "README.md"):
        site.add(f"develop/libraries/{name}.md", f"```{{include}} ../../../libs/{name}/README.md\n```\n")


def texts_of(folder):
    """The texts of a sample in full, for those who have the site alone."""
    text = ""
    for name in sorted(n for n in os.listdir(folder) if n.endswith(".yaml")):
        with open(os.path.join(folder, name), encoding="utf-8") as f:
            text += f"\n### {name}\n\n```yaml\n{f.read().rstrip()}\n```\n"
    return f"\n## Texts\n{text}" if text else ""


def folders(root, parent, page):
    there = os.path.join(root, parent)
    return sorted(n for n in os.listdir(there) if os.path.exists(os.path.join(there, n, page))) if os.path.isdir(there) else []


def said(bin_folder, program, option):
    path = bin_folder and os.path.join(bin_folder, program)
    if not path or not os.path.exists(path):
        return f"The programs were not built with this site: `{program} {option}` prints it.\n"
    out = subprocess.run([path, option], capture_output=True, text=True, check=True).stdout
    return f"`{program} {option}` prints:\n\n```text\n{out.rstrip()}\n```\n"


def options(site, bin_folder):
    for program in PROGRAMS:
        site.add(f"reference/options/{program}.md", f"# Options of {program}\n\nEvery option of the command line; what it is for: [{program}](../programs/{program}.md).\n\n"
                 + said(bin_folder, program, "--help"))
        site.add(f"reference/programs/{program}.md", f"```{{include}} ../../../apps/{program}/USAGE.md\n```\n")
    for page, title, purpose, program, option in LISTS:
        site.add(page, f"# {title}\n\n{purpose}\n\n" + said(bin_folder, program, option))


def headers(site):
    def header(path):
        with open(os.path.join(site.root, path)) as f:
            return f"## {os.path.basename(path)}\n\n```cpp\n{f.read().rstrip()}\n```\n"
    if not os.path.isdir(os.path.join(site.root, "apps")):
        return
    sdk = "libs/sensor/sdk"
    names = sorted(n for n in os.listdir(os.path.join(site.root, sdk)) if n.endswith(".h"))
    site.add("reference/sdk.md", "# Plug-in SDK\n\nA kind of sensor from outside: one header, installed as the package `suite_sensor_sdk`. What it is given and must give: "
             "[sensors](sensors.md). A worked example is [field_notes](../../tests/plugin/field_notes.cpp).\n\n" + "\n".join(header(f"{sdk}/{n}") for n in names))
    site.add("reference/c_interface.md", "```{include} ../../apps/in-process/USAGE.md\n```\n\n" + header("apps/in-process/remote_scenes.h"))


def python(site):
    package = os.path.join(site.root, "python/remote_scenes")
    if not os.path.isdir(package):
        return
    public = public_names(package)
    text = ["# Python API", "Everything that `import remote_scenes as rs` offers, from the docstrings. Worked examples: [Python](../start/python.md).\n\n"
            "    import remote_scenes as rs\n    help(rs.FrameCamera)"]
    for name in sorted(n for n in os.listdir(package) if n.endswith(".py") and n != "__init__.py"):
        with open(os.path.join(package, name)) as f:
            module = ast.parse(f.read())
        there = [node for node in module.body if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name in public]
        if there:
            text.append(f"## {name[:-3]}\n\n{doc(module)}")
            text += [entry(node) for node in there]
    site.add("reference/python.md", "\n\n".join(text) + "\n")


def public_names(package):
    with open(os.path.join(package, "__init__.py")) as f:
        for node in ast.parse(f.read()).body:
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__":
                return set(ast.literal_eval(node.value))
    return set()


def doc(node):
    text = ast.get_docstring(node)
    return f"```text\n{text}\n```" if text else ""


def signature(node, name):
    return f"{name}({ast.unparse(node.args)})" + (f" -> {ast.unparse(node.returns)}" if node.returns else "")


def entry(node):
    if isinstance(node, ast.FunctionDef):
        return f"### {node.name}\n\n```python\n{signature(node, 'rs.' + node.name)}\n```\n\n{doc(node)}"
    bases = ", ".join(ast.unparse(base) for base in node.bases)
    out = [f"### {node.name}\n\n```python\nclass rs.{node.name}({bases})\n```\n\n{doc(node)}"]
    for method in node.body:
        if isinstance(method, ast.FunctionDef) and (not method.name.startswith("_") or method.name == "__init__"):
            shown = ("@property " if any(getattr(d, "id", "") == "property" for d in method.decorator_list) else "") + signature(method, method.name)
            out.append(f"```python\n{shown}\n```\n\n{doc(method)}")
    return "\n\n".join(out)
