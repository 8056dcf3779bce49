"""A worker: `python -m remote_scenes.campaign.worker CAMPAIGN FOLDER` makes the samples whose numbers it reads, a line each, and answers with a
line of JSON each. It ends when nobody writes any longer, and so does not outlive who started it."""
from __future__ import annotations

import json
import os
import resource
import signal
import sys
import time
from pathlib import Path

from ..errors import ProgramError
from .campaign import read_campaign
from .sample import Maker, refusal
from .text import CampaignError


def main(arguments: list[str]) -> int:
    """0 when the input ended."""
    campaign, folder, version = arguments
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # whatever is printed is no answer
    # Ctrl-C is for who started it; a SIGTERM ends the program that runs, and takes away what is unfinished.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    maker = Maker(read_campaign(campaign), Path(folder), version)
    changed = not _is_of(Path(folder), maker.campaign.digest)
    for line in sys.stdin:
        sample = int(line)
        begun, cpu = time.monotonic(), _cpu_s()
        answer: dict[str, object] = {"sample": sample}
        try:
            if changed:
                raise CampaignError("the texts were changed while the run went on", "the texts as they were, or another folder", campaign)
            maker.make(sample)
        except (CampaignError, ProgramError, OSError) as problem:
            answer["error"] = refusal(sample, problem)
        answer |= {"seconds": time.monotonic() - begun, "cpu_s": _cpu_s() - cpu, "rss_kb": _rss_kb()}
        print(json.dumps(answer), file=answers, flush=True)
    return 0


def _is_of(folder: Path, digest: str) -> bool:
    """Whether a dataset is of a campaign with these texts; previews have no record of it."""
    record = folder / "campaign.json"
    return not record.exists() or json.loads(record.read_text(encoding="utf-8")).get("campaign") == digest


def _cpu_s() -> float:
    return sum(u.ru_utime + u.ru_stime for u in (resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)))


def _rss_kb() -> int:
    """What is resident now, not at most."""
    try:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024
    except OSError:
        return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
