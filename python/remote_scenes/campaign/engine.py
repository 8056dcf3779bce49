"""Makes all samples of a campaign by worker processes. Whatever is finished stays: a run goes on where the last one ended.

A worker that dies loses the sample it was at, which another one takes up; after three deaths the sample counts as refused. A sample that is refused
is left out, and the others are made; the run stops where ten in a row are refused, or where files cannot be written.
"""
from __future__ import annotations

import json
import os
import re
import selectors
import shutil
import socket
import subprocess
import sys
from collections import deque
from concurrent.futures import Executor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable, Iterable

from ..errors import Interrupted, ProgramError
from ..programs import version as program_version
from .campaign import Campaign, as_json
from .exports import finished
from .launch import run_by
from .sample import Maker, refusal
from .text import CampaignError, Refused
from .whole_files import write_whole

DEATHS = 3
IN_A_ROW = 10
"""So many samples that are refused one after the other have a fault in common."""
_FOLDERS = ("samples", "shared", "texts")
"""What a dataset has before its record: another shard may begin at the same time."""
Tell = Callable[[str], None]


@dataclass
class Tally:
    """What a run has done. cpu_s: of all workers and their programs; rss_kb: of a worker after each sample, in the order of their ends; refused: why, by
    sample."""

    made: int = 0
    there: int = 0
    refused: dict[int, str] = field(default_factory=dict)
    in_a_row: int = 0
    deaths: int = 0
    cpu_s: float = 0.0
    seconds: float = 0.0
    rss_kb: list[int] = field(default_factory=list)

    def refuse(self, sample: int, why: str) -> None:
        """Counts a sample that cannot be made. Refused: too many in a row."""
        self.refused[sample] = why
        self.in_a_row += 1
        if self.in_a_row >= IN_A_ROW:
            raise Refused(f"{self.first_refusal()} ({IN_A_ROW} samples in a row were refused; the run ends here)")

    def first_refusal(self) -> str:
        """Of the lowest number."""
        return self.refused[min(self.refused)]


def prepare_folder(campaign: Campaign, folder: Path) -> str:
    """Makes the folder of a dataset, or sees that it is of this campaign; returns the version of the programs. CampaignError: it is another's, or
    cannot be written."""
    version = program_version()
    wanted = {"campaign": campaign.digest, "name": campaign.name, "version": version, "samples": campaign.samples, "seed": campaign.seed}
    record = folder / "campaign.json"
    try:
        # A text may be mended as long as no sample was made of it.
        if record.exists() and (folder / "samples").is_dir() and finished(folder):
            there = json.loads(record.read_text(encoding="utf-8"))
            for key, what in (("campaign", "a campaign with other texts"), ("version", f"version {there.get('version')} of the programs")):
                if there.get(key) != wanted[key]:
                    raise CampaignError(f"it holds samples of {what}", "give another folder", str(folder))
        elif not record.exists() and folder.exists() and any(p.name not in _FOLDERS and not p.name.startswith(".") for p in folder.iterdir()):
            raise CampaignError("it holds something else", "give an empty or new folder", str(folder))
        (folder / "samples").mkdir(parents=True, exist_ok=True)
        for source in (campaign.path, campaign.scene_path, campaign.simulation_path):
            write_whole(folder / "texts" / source.name, source.read_bytes())
        write_whole(record, as_json(wanted).encode())
        _clear(folder)
    except OSError as problem:
        raise CampaignError(f"the dataset cannot be written: {problem.strerror}", "room, and the right to write", str(folder)) from None
    return version


def _clear(folder: Path) -> None:
    """Takes away what workers of this machine that are no more have left unfinished."""
    mine = re.compile(rf"\.[0-9a-f]+\.{re.escape(socket.gethostname())}\.(\d+)(\.h5|\.yaml)?")
    for path in [*(folder / "samples").iterdir(), *(folder / "shared").glob(".*")]:
        if (match := mine.fullmatch(path.name)) and not _is_alive(int(match[1])):
            if path.is_dir():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink(missing_ok=True)


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        pass  # somebody else's
    return True


def of_shard(samples: int, shard: tuple[int, int]) -> range:
    """The samples of shard i of n, counted from 1: every n-th."""
    return range(shard[0] - 1, samples, shard[1])


def run_samples(campaign: Campaign, folder: Path, numbers: Iterable[int], workers: int, version: str, tell: Tell, executor: Executor | None = None) -> Tally:
    """Makes samples; workers: processes, 0 = within this one; executor: makes them instead. What is refused alone is
    left out (Tally.refused). CampaignError: what ends the run; what is finished stays."""
    maker, tally = Maker(campaign, folder, version), Tally()
    wanted = []
    for number in numbers:
        if maker.path(number).is_dir():
            tally.there += 1
        else:
            wanted.append(number)
    if executor:
        run_by(executor, campaign, folder, wanted, version, lambda answer: _count(answer, tally, len(wanted), "the executor", tell))
    elif workers == 0:
        for number in wanted:
            try:
                maker.make(number)
            except (Interrupted, OSError) as problem:
                raise Refused(refusal(number, problem)) from None
            except (CampaignError, ProgramError) as problem:
                tally.refuse(number, refusal(number, problem))
            else:
                tally.made += 1
                tally.in_a_row = 0
    elif wanted:
        _Crew(campaign, folder, version, tell, tally, deque(wanted)).work(min(workers, len(wanted)))
    return tally


def _count(answer: dict[str, Any], tally: Tally, wanted: int, who: str, tell: Tell) -> None:
    """Counts a sample that is made or refused. Refused: an answer that ends the run."""
    if "error" in answer:
        raise Refused(str(answer["error"]))
    if "refused" in answer:
        tell(f"sample {answer['sample']}: refused")
        tally.refuse(answer["sample"], str(answer["refused"]))
        return
    tally.made += 1
    tally.in_a_row = 0
    tally.cpu_s += answer["cpu_s"]
    tally.seconds += answer["seconds"]
    tally.rss_kb.append(answer["rss_kb"])
    tell(f"sample {answer['sample']}: {tally.made} of {wanted} in {answer['cpu_s']:.3f} s of the processor, {answer['rss_kb'] / 1024:.2f} MiB in {who}")


class _Crew:
    """Workers, and the samples that wait for them."""

    def __init__(self, campaign: Campaign, folder: Path, version: str, tell: Tell, tally: Tally, waiting: deque[int]) -> None:
        self._command = [sys.executable, "-m", "remote_scenes.campaign.worker", os.path.abspath(campaign.path), os.path.abspath(folder), version]
        self._tell, self._tally, self._waiting, self._all = tell, tally, waiting, len(waiting)
        self._at: dict[subprocess.Popen[str], int | None] = {}
        self._deaths: dict[int, int] = {}
        self._folder = folder

    def work(self, count: int) -> None:
        """Until nothing waits."""
        try:
            with selectors.DefaultSelector() as selector:
                for _ in range(count):
                    self._start(selector)
                while self._at:
                    for key, _ in selector.select():
                        self._hear(key.data, selector)
        finally:
            for worker in self._at:
                worker.terminate()
            for worker in list(self._at):
                self._close(worker)
            _clear(self._folder)

    def _start(self, selector: selectors.BaseSelector) -> None:
        # The workers find this package where this process has found it.
        ways = os.pathsep.join([str(Path(__file__).resolve().parents[2]), *filter(None, [os.environ.get("PYTHONPATH")])])
        worker = subprocess.Popen(self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": ways})
        self._at[worker] = None
        selector.register(worker.stdout, selectors.EVENT_READ, worker)  # type: ignore[arg-type]
        self._give(worker, selector)

    def _give(self, worker: subprocess.Popen[str], selector: selectors.BaseSelector) -> None:
        """The next sample, or the end."""
        assert worker.stdin and worker.stdout
        if not self._waiting:
            selector.unregister(worker.stdout)
            self._close(worker)
            return
        self._at[worker] = self._waiting.popleft()
        try:
            print(self._at[worker], file=worker.stdin, flush=True)
        except BrokenPipeError:
            pass  # it is dead, which its end of the other pipe says

    def _close(self, worker: subprocess.Popen[str]) -> None:
        del self._at[worker]
        for stream in (worker.stdin, worker.stdout):
            try:
                if stream:
                    stream.close()
            except BrokenPipeError:
                pass
        worker.wait()

    def _hear(self, worker: subprocess.Popen[str], selector: selectors.BaseSelector) -> None:
        assert worker.stdout
        line = worker.stdout.readline()
        if not line.endswith("\n"):
            selector.unregister(worker.stdout)
            self._mourn(worker, selector)
            return
        answer: dict[str, Any] = json.loads(line)
        _count(answer, self._tally, self._all, f"worker {worker.pid}", self._tell)
        self._give(worker, selector)

    def _mourn(self, worker: subprocess.Popen[str], selector: selectors.BaseSelector) -> None:
        """A worker has died: its sample goes back to the front unless it has met this too often, and another worker takes its place."""
        sample = self._at[worker]
        self._close(worker)
        _clear(self._folder)
        self._tally.deaths += 1
        assert sample is not None
        self._deaths[sample] = self._deaths.get(sample, 0) + 1
        if self._deaths[sample] < DEATHS:
            self._tell(f"a worker ended with {worker.returncode} at sample {sample}, which is made again")
            self._waiting.appendleft(sample)
        else:
            self._tally.refuse(sample, str(CampaignError(f"{DEATHS} workers ended without an answer at sample {sample} (the last one with {worker.returncode})",
                                                         "memory, or a fault of a program")))
        if self._waiting:
            self._start(selector)


__all__ = ["Tally", "of_shard", "prepare_folder", "run_samples"]
