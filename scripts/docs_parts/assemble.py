"""Pages of the site from docs/ and from the pages that these include, with links that hold in both places.

Sources keep their links as they stand in the checkout, so that they can be read there. Here a link to a page that the site has becomes
one to the site's page, a link to any other file one to a copy of it (`files/`), pictures are those of the checkout.
"""
import fnmatch
import html
import os
import re
import shutil

INCLUDE = re.compile(r"^```\{include\} (\S+)\n((?::.*\n)*)```$", re.M)
LINK = re.compile(r"(?P<code>`+[^`\n]*`+)|(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")  # or code, which has none
TOCTREE = re.compile(r"^```\{toctree\}\n((?::.*\n)*)\n?((?:[^`].*\n)*)```\n?", re.M)
IMAGE_TAG = re.compile(r'(<img [^>]*?src=")([^"]+)(")')
FENCE = re.compile(r"^(```|~~~).*?^\1[ \t]*$", re.S | re.M)
BEGINNING = re.compile(r"# .+\n\n(?!```|[|#\s])(?:.+\n)+\n(?:```|    \S|Example)")  # of a page of the guide
WORDS = 120  # of a paragraph
PAPER = "paper/"  # a manuscript keeps to the rules of its journal
FILES = "files"


def outside_of_code(text, change):
    """change() of all that is no block of code."""
    parts, at = [], 0
    for fence in FENCE.finditer(text):
        parts += [change(text[at:fence.start()]), fence[0]]
        at = fence.end()
    return "".join([*parts, change(text[at:])])


def paragraphs(text):
    """Paragraphs of prose: no code, tables, lists' items apart."""
    prose = FENCE.sub("\n\n", text)
    for block in re.split(r"\n\s*\n", prose):
        lines = [line for line in block.splitlines() if not re.match(r"\s*(\||#|:|    )", line)]
        for item in re.split(r"\n(?=\s*(?:[-*]|\d+\.) )", "\n".join(lines)):
            if item.strip():
                yield item


def anchor_of(heading):
    """The anchor that MyST (as GitHub) gives a heading."""
    return re.sub(r"[^\w\- ]", "", re.sub(r"`|\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()).replace(" ", "-")


def under_one_heading(text):
    """A manuscript, whose sections are all first headings, as one page: without a heading of its own every section would stand in the navigation."""
    head = re.match(r"---\n.*?\n---\n", text, re.S)
    at = head.end() if head else 0
    deeper = outside_of_code(text[at:], lambda t: re.sub(r"^(#+ )", r"#\1", t, flags=re.M))
    return f"{text[:at]}\n# Paper (draft)\n{deeper}"


class Site:
    def __init__(self, root, source):
        self.root, self.source = root, source
        self.pages, self.own, self.faults, self.files = {}, set(), [], set()
        for folder, folders, names in os.walk(os.path.join(root, "docs")):
            folders.sort()
            for name in sorted(names):
                if name.endswith(".md"):
                    path = os.path.relpath(os.path.join(folder, name), os.path.join(root, "docs"))
                    with open(os.path.join(folder, name)) as f:
                        self.pages[path] = f.read()
                    self.own.add(path)

    def add(self, path, text):
        """A page that is made, not written."""
        self.pages[path] = text

    def homes(self):
        """Where files of the checkout stand in the site: file to page. A file that several pages include parts of has its first."""
        homes = {os.path.join("docs", page): page for page in self.pages}
        if "index.md" in self.pages:
            homes["README.md"] = "index.md"
        for page, text in self.pages.items():
            for include in INCLUDE.finditer(text):
                homes.setdefault(self.of_include(page, include[1]), page)
        return homes

    @staticmethod
    def of_include(page, target):
        return os.path.normpath(os.path.join("docs", os.path.dirname(page), target))

    def included(self, page, match):
        target = self.of_include(page, match[1])
        path = os.path.join(self.root, target)
        if not os.path.isfile(path):
            self.faults.append(f"docs/{page}: includes {match[1]}, which is not there")
            return ""
        with open(path) as f:
            text = f.read()
        options = dict(re.findall(r"^:([\w-]+): ?(.*)$", match[2], re.M))
        for option, keep in (("start-after", 1), ("end-before", 0)):
            if option in options:
                parts = text.split(options[option].strip('"').replace("\\n", "\n"), 1)
                if len(parts) < 2:
                    self.faults.append(f"docs/{page}: {target} has no '{options[option]}'")
                text = parts[keep] if len(parts) > 1 else text
        shift = "#" * int(options.get("heading-offset", "0"))
        if shift:
            text = outside_of_code(text, lambda t: re.sub(r"^(#+ )", shift + r"\1", t, flags=re.M))
        return self.linked(text, target, page)

    def linked(self, text, origin, page):
        """text, which stands in the file `origin` of the checkout, for `page` of the site."""
        def target(link):
            name, _, anchor = link.partition("#")
            path = os.path.normpath(os.path.join(os.path.dirname(origin), name)) if name else origin
            if re.match(r"[a-z]+:", link):
                return None, link
            if path.startswith("..") or not os.path.exists(os.path.join(self.root, path)) and path not in self.home:
                self.faults.append(f"{origin}: link to {link}, which is not there")
                return None, link
            home = self.home.get(path) or self.home.get(os.path.join(path, "README.md"))
            if home:
                here = os.path.dirname(page)
                return "page", (os.path.relpath(home, here or ".") if home != page or not anchor else "") + (f"#{anchor}" if anchor else "")
            return "file", path

        def link(match):
            code, picture, label, to = match.groups()
            if code:
                return code
            kind, where = target(to)
            if kind is None:
                return match[0]
            here = os.path.dirname(os.path.join(self.source, page))
            if picture:
                return f"![{label}]({os.path.relpath(os.path.join(self.root, where), here)})"
            if kind == "page":
                return f"[{label}]({where})"
            if os.path.isdir(os.path.join(self.root, where)):
                return label
            self.files.add(where)
            up = os.path.relpath(".", os.path.dirname(page) or ".")
            words = re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(label, quote=False))
            return f'<a class="file" href="{up}/{FILES}/{where}.txt">{words}</a>'

        def image(match):
            where = os.path.normpath(os.path.join(os.path.dirname(origin), match[2]))
            self.faults.append(f"{origin}: the site takes pictures as ![]() only: {where}")
            return match[0]

        return outside_of_code(text, lambda t: IMAGE_TAG.sub(image, LINK.sub(link, t)))

    def without_empty_globs(self, text, page):
        """Pages that may be there or not are named by patterns; one that nothing matches is left out."""
        here = os.path.dirname(page)

        def kept(match):
            entries = match[2].split()
            there = [e for e in entries if any(fnmatch.fnmatch(p, os.path.normpath(os.path.join(here, e)) + ".md") for p in self.pages)]
            return match[0] if ":glob:" not in match[1] or there == entries else ""
        return TOCTREE.sub(kept, text)

    def write(self):
        self.home = self.homes()
        for page, text in sorted(self.pages.items()):
            text = self.without_empty_globs(text, page)
            if page.startswith(PAPER):
                text = under_one_heading(text)
            elif page in self.own:
                self.check_shape(page, text)
            parts, at = [], 0
            for match in INCLUDE.finditer(text):
                parts += [self.linked(text[at:match.start()], f"docs/{page}", page), self.included(page, match)]
                at = match.end()
            parts.append(self.linked(text[at:], f"docs/{page}", page))
            path = os.path.join(self.source, page)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w") as f:
                f.write("".join(parts))
        if os.path.isdir(self.source):
            with open(os.path.join(self.source, "files.list"), "w") as f:
                f.writelines(sorted(name + "\n" for name in self.files))

    def check_shape(self, page, text):
        for paragraph in paragraphs(text):
            words = len(paragraph.split())
            if words > WORDS:
                self.faults.append(f"docs/{page}: a paragraph of {words} words, {WORDS} at most: {' '.join(paragraph.split()[:8])} ...")
        if not INCLUDE.search(text) and not re.search(r"^(```|    \S|> )|\bExample\b", text, re.M):
            self.faults.append(f"docs/{page}: no worked example (a block, a quotation, or a sentence that begins with 'Example')")
        elif page.startswith("guide/") and not BEGINNING.match(text):
            self.faults.append(f"docs/{page}: begins with something else than what it is for, in a paragraph, and a worked example")


def copy_files(root, out):
    """The files that pages link to, as text beside the site."""
    with open(os.path.join(os.path.dirname(out), "source/files.list")) as f:
        for name in f.read().splitlines():
            path = os.path.join(out, FILES, name + ".txt")
            os.makedirs(os.path.dirname(path), exist_ok=True)
            shutil.copyfile(os.path.join(root, name), path)
