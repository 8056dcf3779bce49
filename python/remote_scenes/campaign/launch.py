"""Other ways to spread samples than workers of one's own: ranks of a launcher (MPI, Slurm), and executors (concurrent.futures, Dask)."""
from __future__ import annotations

import os
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from functools import lru_cache
from pathlib import Path
from typing import Any, Callable, Iterable, Mapping

from .answers import answer_of
from .campaign import Campaign, read_campaign
from .sample import Maker
from .text import CampaignError

RANKS = (("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"), ("PMI_RANK", "PMI_SIZE"), ("SLURM_PROCID", "SLURM_NTASKS"))
"""Rank from 0 and number of ranks, as Open MPI, MPICH (and what follows its process manager) and Slurm's srun state them."""
WAITING = 256
"""Samples that are given to an executor at a time."""


def shard_of_rank(environment: Mapping[str, str] = os.environ) -> tuple[int, int]:
    """The shard (i, n) of this process among those that a launcher has started. CampaignError: no launcher has."""
    for rank, size in RANKS:
        if rank in environment and size in environment:
            try:
                i, n = int(environment[rank]), int(environment[size])
            except ValueError:
                i, n = 0, 0
            if not 0 <= i < n:
                raise CampaignError(f"{rank} is '{environment[rank]}' of {size} '{environment[size]}'", "a rank from 0, below their number")
            return i + 1, n
    raise CampaignError("no launcher says which rank this is", "mpirun, mpiexec or srun before the command, or --shard I/N")


def leave_launcher() -> None:
    """Takes a launcher's variables out of the environment: the programs that this process starts are no ranks, and each would wait for the others."""
    for name in [n for n in os.environ if n.startswith(("OMPI_", "PMIX_", "PMI_", "PRTE_"))]:
        del os.environ[name]


def run_by(executor: Executor, campaign: Campaign, folder: Path, numbers: Iterable[int], version: str,
           done: Callable[[dict[str, Any]], None]) -> None:
    """Has an executor make samples, in processes that see the same files; done: gets the answer of each. CampaignError: what `done` raises, or an
    executor that has lost its workers; what is finished stays."""
    arguments = (os.path.abspath(campaign.path), os.path.abspath(folder), version)
    numbers = iter(numbers)
    waiting: set[Future[dict[str, Any]]] = set()
    try:
        while True:
            for number in numbers:
                waiting.add(executor.submit(make_one, *arguments, number))
                if len(waiting) >= WAITING:
                    break
            if not waiting:
                return
            ended, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            for future in ended:
                done(future.result())
    except RuntimeError as broken:  # BrokenExecutor, and what Dask says of workers that are gone
        raise CampaignError(f"the executor has ended: {str(broken).splitlines()[0]}", "what is finished stays; the same call goes on") from None
    finally:
        for future in waiting:
            future.cancel()


def make_one(campaign: str, folder: str, version: str, sample: int) -> dict[str, Any]:
    """Makes a sample in whichever process this is called; prepared scenes stay open there."""
    return answer_of(_maker(campaign, folder, version), sample)


@lru_cache(maxsize=4)
def _maker(campaign: str, folder: str, version: str) -> Maker:
    return Maker(read_campaign(campaign), Path(folder), version)
