"""Float32 ENVI pairs, band after band: what dirsig-render writes, and what is stored here."""
import array
import re
import sys


class Picture:
    """columns, rows, bands; values: one array of floats a band, row after row; description."""

    def __init__(self, columns, rows, values, description=""):
        self.columns, self.rows, self.values, self.description = columns, rows, values, description

    @property
    def shape(self):
        return self.columns, self.rows, len(self.values)


def read(path):
    with open(path + ".hdr") as file:
        text = file.read()
    keys = {k.strip(): v.strip() for k, v in re.findall(r"^([a-z ]+?) *= *(\{[^}]*\}|[^\n]*)", text, re.M)}
    columns, rows, bands = (int(keys[k]) for k in ("samples", "lines", "bands"))
    if keys["data type"] != "4" or keys["interleave"] != "bsq" or keys["byte order"] != "0" or keys["header offset"] != "0":
        raise SystemExit(f"{path}.hdr: error: not a little-endian float32 cube, band after band (bsq), without an offset")
    flat = array.array("f")
    with open(path, "rb") as file:
        flat.frombytes(file.read())
    if sys.byteorder == "big":
        flat.byteswap()
    if len(flat) != columns * rows * bands:
        raise SystemExit(f"{path}: error: {len(flat)} values; its header says {columns} x {rows} x {bands}")
    size = columns * rows
    return Picture(columns, rows, [flat[b * size:(b + 1) * size] for b in range(bands)], keys.get("description", "").strip("{}"))


def write(path, picture):
    columns, rows, bands = picture.shape
    description = picture.description.replace("{", "(").replace("}", ")")  # braces would close the text
    with open(path, "wb") as file:
        for band in picture.values:
            numbers = array.array("f", band)
            if sys.byteorder == "big":
                numbers.byteswap()
            file.write(numbers.tobytes())
    with open(path + ".hdr", "w") as file:
        file.write(f"ENVI\ndescription = {{{description}}}\nsamples = {columns}\nlines = {rows}\nbands = {bands}\n"
                   "header offset = 0\nfile type = ENVI Standard\ndata type = 4\ninterleave = bsq\nbyte order = 0\n"
                   "data units = W/(m2 sr um)\n")
