"""A headless Chromium that opens one page, driven through two pipes (the DevTools protocol), with Python's own library alone."""
import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CHROMIUM = next((p for p in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if p), None)
_OPTIONS = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run", "--disable-extensions",
            "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars",
            "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]


def _high(descriptor):
    """The same pipe under a number beyond those that the shell gives away."""
    high = fcntl.fcntl(descriptor, fcntl.F_DUPFD_CLOEXEC, 20)
    os.close(descriptor)
    return high


class Ended(RuntimeError):
    """The browser's process is gone."""


class Browser:
    """with Browser() as b: b.open(path) ... b.faults is what the console and the network had to complain of."""

    def __init__(self, width=1500, height=900):
        if not CHROMIUM:
            raise RuntimeError("there is no Chromium; scripts/install brings it (Debian package chromium)")
        self._size = width, height
        self._start()

    def _start(self):
        width, height = self._size
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self._log = Path(self._folder.name, "stderr.txt")
        to_read, self._to = map(_high, os.pipe())
        self._from, from_write = map(_high, os.pipe())
        # Chromium reads commands from descriptor 3 and writes to 4.
        command = [CHROMIUM, *_OPTIONS, f"--window-size={width},{height}", f"--user-data-dir={self._folder.name}",
                   "--remote-debugging-pipe", "about:blank"]
        shell = ["bash", "-c", f'exec 3<&{to_read} 4>&{from_write} {to_read}<&- {from_write}>&-; exec "$@"', "bash", *command]
        with self._log.open("wb") as log:
            self._process = subprocess.Popen(shell, pass_fds=(to_read, from_write), stdout=subprocess.DEVNULL, stderr=log)
        os.close(to_read)
        os.close(from_write)
        self._count, self._rest, self._session = 0, b"", None
        self.faults, self.requests, self._loaded = [], [], set()
        targets = self.call("Target.getTargets")["targetInfos"]
        target = next(t["targetId"] for t in targets if t["type"] == "page")
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call("Page.setLifecycleEventsEnabled", enabled=True)
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._stop()

    def _stop(self):
        try:
            self._session = None
            self.call("Browser.close", seconds=5)
        except (OSError, RuntimeError):
            pass
        os.close(self._to)
        os.close(self._from)
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._folder.cleanup()

    def call(self, method, seconds=120, **parameters):
        """Sends a command and returns its result; events on the way are noted. RuntimeError: refused, or no answer in time."""
        self._count += 1
        message = {"id": self._count, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self._to, data):]
        until = time.monotonic() + seconds
        while True:
            answer = self._next(until)
            if answer.get("id") == self._count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def _next(self, until):
        while b"\0" not in self._rest:
            if not select.select([self._from], [], [], max(0, until - time.monotonic()))[0]:
                raise RuntimeError("the browser does not answer in time")
            piece = os.read(self._from, 1 << 20)
            if not piece:
                raise Ended(f"the browser has ended: {self._log.read_text(errors='replace')[-2000:]}")
            self._rest += piece
        text, _, self._rest = self._rest.partition(b"\0")
        message = json.loads(text)
        self._note(message.get("method"), message.get("params", {}))
        return message

    def _note(self, method, p):
        if method == "Runtime.consoleAPICalled" and p["type"] in ("error", "warning", "assert"):
            self.faults.append(f"console {p['type']}: {[a.get('value', a.get('description')) for a in p['args']]}")
        elif method == "Runtime.exceptionThrown":
            d = p["exceptionDetails"]
            self.faults.append(f"exception: {d['text']} {d.get('exception', {}).get('description', '')}")
        elif method == "Log.entryAdded" and p["entry"]["level"] in ("error", "warning"):
            # The software renderer tells that reading a picture back is slow; that is no fault of the page.
            if "GPU stall due to ReadPixels" not in p["entry"]["text"]:
                self.faults.append(f"log: {p['entry']['text']}")
        elif method == "Network.requestWillBeSent":
            self.requests.append(p["request"]["url"][:200])
        elif method == "Page.lifecycleEvent" and p["name"] == "load":
            self._loaded.add(p["loaderId"])

    def open(self, path, seconds=120):
        """Opens a file and waits until all of it is there. A browser that dies of its own in this is started once more;
        one that the page kills dies again."""
        try:
            self._open(path, seconds)
        except (Ended, BrokenPipeError) as fault:
            print(f"{path}: {fault}; once more", file=sys.stderr)
            self._stop()
            self._start()
            self._open(path, seconds)

    def _open(self, path, seconds):
        answer = self.call("Page.navigate", url=Path(path).resolve().as_uri(), seconds=seconds)
        if "loaderId" not in answer:
            raise RuntimeError(f"{path}: {answer.get('errorText', 'the browser loads nothing')}")
        until = time.monotonic() + seconds
        # The load event of the blank page before may come late: only this document's own counts.
        while answer["loaderId"] not in self._loaded:
            self._next(until)

    def cpu_seconds(self):
        """What the processes that draw pages have computed so far: a busy machine makes it no longer."""
        session, self._session = self._session, None
        try:
            processes = self.call("SystemInfo.getProcessInfo")["processInfo"]
        finally:
            self._session = session
        return sum(p["cpuTime"] for p in processes if p["type"] == "renderer")

    def run(self, expression):
        """The value of an expression of JavaScript; RuntimeError with what it threw."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {answer['exceptionDetails'].get('exception', {}).get('description')}")
        return answer["result"].get("value")

    def when(self, expression, seconds=120):
        """The value of an expression as soon as it is neither undefined nor null: what a page sets with its next frame is
        not there yet when it has loaded. RuntimeError: not in time."""
        until = time.monotonic() + seconds
        while (value := self.run(expression)) is None:
            if time.monotonic() > until:
                raise RuntimeError(f"{expression}: still undefined after {seconds} s")
            time.sleep(0.05)
        return value

    def mouse(self, kind, x, y, button="none", **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, **more)

    def click(self, x, y, **more):
        """A click of the left button at a place of the window, in its pixels."""
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, "left", clickCount=1, **more)
        self.mouse("mouseReleased", x, y, "left", clickCount=1, **more)

    def drag(self, x, y, dx, dy, steps=4):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, "left", clickCount=1, buttons=1)
        for i in range(1, steps + 1):
            self.mouse("mouseMoved", x + dx * i / steps, y + dy * i / steps, "left", buttons=1)
        self.mouse("mouseReleased", x + dx, y + dy, "left", clickCount=1)

    def box(self, selector):
        """x, y, width and height of an element in the window."""
        return self.run(f"(() => {{ const b = document.querySelector({json.dumps(selector)}).getBoundingClientRect();"
                        " return [b.x, b.y, b.width, b.height]; })()")

    def set(self, selector, value):
        """Gives a control a value, as a user would: its listeners hear of it."""
        self.run(f"(() => {{ const e = document.querySelector({json.dumps(selector)}); e.value = {json.dumps(str(value))};"
                 " e.dispatchEvent(new Event('input', {bubbles: true})); e.dispatchEvent(new Event('change', {bubbles: true})); })()")

    def screenshot(self, path):
        Path(path).write_bytes(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))


def local_only(requests):
    """Whether nothing but files and data was asked for."""
    return all(url.startswith(("file:", "data:", "blob:", "about:")) for url in requests)
