"""What a process that makes a sample says of it."""
from __future__ import annotations

import ctypes
import json
import os
import resource
import time
from pathlib import Path

from ..errors import Interrupted, ProgramError
from .sample import Maker, refusal
from .text import CampaignError


def answer_of(maker: Maker, sample: int) -> dict[str, object]:
    """Makes a sample; what it took, why it was refused alone (`refused`), or why all are to end (`error`)."""
    begun, cpu = time.monotonic(), _cpu_s()
    answer: dict[str, object] = {"sample": sample}
    try:
        if not _is_of(maker.folder, maker.campaign.digest):
            answer["error"] = str(CampaignError("the texts were changed while the run went on", "the texts as they were, or another folder", str(maker.campaign.path)))
        else:
            maker.make(sample)
    except (Interrupted, OSError) as problem:
        answer["error"] = refusal(sample, problem)
    except (CampaignError, ProgramError) as problem:
        answer["refused"] = refusal(sample, problem)
    _give_back()
    return answer | {"seconds": time.monotonic() - begun, "cpu_s": _cpu_s() - cpu, "rss_kb": _rss_kb()}


def _is_of(folder: Path, digest: str) -> bool:
    """Whether a dataset is of a campaign with these texts; previews have no record of it."""
    record = folder / "campaign.json"
    return not record.exists() or json.loads(record.read_text(encoding="utf-8")).get("campaign") == digest


def _give_back() -> None:
    """Has glibc return what is free. HDF5 and the heap keep pieces of every size that came up, which would be some MiB after thousands of samples."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)


def _cpu_s() -> float:
    return sum(u.ru_utime + u.ru_stime for u in (resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)))


def _rss_kb() -> int:
    """What is resident now, not at most."""
    try:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024
    except OSError:
        return 0
