"""scripts/movie: frames in the order of their numbers go to ffmpeg; what it cannot do is one line.

movie_test.py SCRIPT. ffmpeg is played by a script that keeps what it was given, so that none is needed; where the real one
is on the PATH films are made, too.
"""
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

SCRIPT = os.path.abspath(sys.argv.pop(1))
FAKE = """#!/usr/bin/env python3
import sys, pathlib
here = pathlib.Path(__file__).parent
(here / "frames").write_bytes(sys.stdin.buffer.read())
(here / "arguments").write_text("\\n".join(sys.argv[1:]))
if (here / "broken").exists():
    sys.exit("no such codec")
pathlib.Path(sys.argv[-1]).write_bytes(b"film")
"""


def png(width, height, grey):
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress((b"\0" + bytes([grey]) * width) * height)) + chunk(b"IEND", b""))


class Movie(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.tools = self.folder / "tools"
        self.tools.mkdir()
        (self.tools / "ffmpeg").write_text(FAKE)
        (self.tools / "ffmpeg").chmod(0o755)
        for k in (0, 2, 10):
            (self.folder / f"cam_{k}.png").write_bytes(png(5, 3, k))

    def run_movie(self, *arguments, path=None):
        frames = sorted(str(f) for f in self.folder.glob("cam_*.png"))
        path = f"{self.tools}:{os.environ['PATH']}" if path is None else path
        done = subprocess.run([sys.executable, SCRIPT, *frames, *arguments], cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "PATH": path}, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_order_and_rate(self):
        for kind in ("mp4", "gif", "webm"):
            code, said = self.run_movie("-o", f"cam.{kind}", "--rate", "4")
            self.assertEqual(code, 0, said)
            self.assertIn(f"wrote cam.{kind}: 3 frames, 0.75 s", said)
            self.assertEqual((self.folder / f"cam.{kind}").read_bytes(), b"film")
            # cam_2 before cam_10, which sorting by letters turns round.
            self.assertEqual((self.tools / "frames").read_bytes(), png(5, 3, 0) + png(5, 3, 2) + png(5, 3, 10))
            self.assertIn("-framerate\n4\n", (self.tools / "arguments").read_text())

    def refused(self, words, *arguments, path=None):
        code, said = self.run_movie(*arguments, path=path)
        self.assertEqual(code, 1, said)
        self.assertEqual(said.count("\n"), 1, said)
        self.assertIn(words, said)

    def test_one_line_for_what_cannot_be(self):
        self.refused("ffmpeg is not there", "-o", "a.mp4", path=str(self.folder))
        self.refused("a film is one of .mp4, .webm, .gif", "-o", "a.avi")
        self.refused("0.01 to 1000 frames a second", "-o", "a.mp4", "--rate", "nan")
        (self.folder / "a.mp4").write_bytes(b"mine")
        self.refused("--force replaces it", "-o", "a.mp4")
        self.assertEqual((self.folder / "a.mp4").read_bytes(), b"mine")
        (self.tools / "broken").write_text("")
        self.refused("ffmpeg made no film: no such codec", "-o", "b.gif")
        self.assertEqual([f.name for f in self.folder.glob("b.*")], [])
        (self.folder / "cam_3.png").write_bytes(png(6, 3, 1))
        self.refused("frames have one size", "-o", "c.gif")
        (self.folder / "cam_3.png").write_bytes(b"text")
        self.refused("is no PNG", "-o", "c.gif")

    @unittest.skipUnless(shutil.which("ffmpeg"), "ffmpeg is not installed")
    def test_real_films(self):
        for kind, begins in (("mp4", b"ftyp"), ("gif", b"GIF8"), ("webm", b"\x1aE\xdf\xa3")):
            code, said = self.run_movie("-o", f"real.{kind}", path=os.environ["PATH"])
            self.assertEqual(code, 0, said)
            self.assertIn(begins, (self.folder / f"real.{kind}").read_bytes()[:16])


if __name__ == "__main__":
    unittest.main()
