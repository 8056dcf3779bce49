"""A script for Slurm: an array of jobs, each of which makes one shard of a campaign in the folder that all share."""
from __future__ import annotations

import os
import shlex
import sys
from pathlib import Path

from .campaign import Campaign

_SCRIPT = """#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --array=1-{shards}
#SBATCH --cpus-per-task={workers}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={log}
# Every task makes shard i of {shards}; what is finished stays, so that a task that is requeued goes on where it was.
# When all are done: {finish}
exec {python} -m remote_scenes.campaign {campaign} -o {folder} --shard "$SLURM_ARRAY_TASK_ID/{shards}" --workers {workers}
"""


def slurm_script(campaign: Campaign, folder: Path, shards: int, workers: int) -> str:
    """The text of the script, for `sbatch`."""
    name = "".join(c if c.isalnum() else "_" for c in campaign.name)
    quoted = {"python": shlex.quote(sys.executable), "campaign": shlex.quote(os.path.abspath(campaign.path)), "folder": shlex.quote(os.path.abspath(folder))}
    finish = f"{quoted['python']} -m remote_scenes.campaign {quoted['campaign']} -o {quoted['folder']}"
    # Beside the dataset, whose folder Slurm would want to be there. It reads its own lines without a shell, and writes other things for % and a letter.
    beside = os.path.abspath(folder).replace("\\", "\\\\").replace('"', '\\"').replace("%", "%%")
    log = f'"{beside}-slurm-%A_%a.log"'
    return _SCRIPT.format(name=name, shards=shards, workers=workers, log=log, finish=finish, **quoted)
