"""A worker: `python -m remote_scenes.campaign.worker CAMPAIGN FOLDER` makes the samples whose numbers it reads, a line each, and answers with a
line of JSON each. It ends when nobody writes any longer, and so does not outlive who started it."""
from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path

from .answers import answer_of
from .campaign import read_campaign
from .sample import Maker


def main(arguments: list[str]) -> int:
    """0 when the input ended."""
    campaign, folder, version = arguments
    answers = os.dup(1)
    os.dup2(2, 1)  # whatever is printed is no answer
    # Ctrl-C is for who started it; a SIGTERM ends the program that runs, and takes away what is unfinished.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    maker = Maker(read_campaign(campaign), Path(folder), version)
    for line in sys.stdin:
        try:
            os.write(answers, json.dumps(answer_of(maker, int(line))).encode() + b"\n")
        except BrokenPipeError:
            break  # who started it is no more; the sample is there
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
