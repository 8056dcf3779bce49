"""A Slurm of the test's own: munged, slurmctld and slurmd of one node, as the user who runs the test, in a folder that is thrown away."""
import os
import shutil
import socket
import subprocess
import tempfile
import time
from pathlib import Path

DAEMONS = ("munged", "slurmctld", "slurmd")
# cred_expire: how long a requeued job waits, s. No cgroups, which containers seldom have.
_CONF = """\
ClusterName=test
SlurmctldHost={host}
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
KillWait=2
NodeName={host} CPUs={cores} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def _program(name):
    return shutil.which(name, path=os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/usr/local/sbin"]))


def missing():
    """What of Slurm is not installed, or None."""
    return next((name for name in (*DAEMONS, "sbatch", "scontrol") if not _program(name)), None)


def _free_ports(count):
    doors = [socket.socket() for _ in range(count)]
    for door in doors:
        door.bind(("127.0.0.1", 0))
    found = [door.getsockname()[1] for door in doors]
    for door in doors:
        door.close()
    return found


class Slurm:
    """with Slurm() as cluster: cluster.call('sbatch', ...). RuntimeError with the end of its logs: it does not start."""

    def __enter__(self):
        self._folder = Path(tempfile.mkdtemp(prefix="slurm-"))
        self._daemons = []
        try:
            self._start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for daemon in reversed(self._daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _start(self):
        for name in ("state", "spool", "munge"):
            (self._folder / name).mkdir(mode=0o700)
        munge = self._folder / "munge"
        (munge / "key").write_bytes(os.urandom(128))
        (munge / "key").chmod(0o600)
        self._begin("munged", "--foreground", "--force", "--socket", munge / "socket", "--key-file", munge / "key", "--log-file", munge / "log",
                    "--pid-file", munge / "pid", "--seed-file", munge / "seed")
        self._until(lambda: (munge / "socket").exists(), "munged")
        text = _CONF.format(host=socket.gethostname().partition(".")[0], user=subprocess.check_output(["id", "-un"], text=True).strip(), folder=self._folder,
                            ports=_free_ports(2), cores=os.cpu_count())
        (self._folder / "slurm.conf").write_text(text)
        os.environ["SLURM_CONF"] = str(self._folder / "slurm.conf")
        self._begin("slurmctld", "-D", "-c")
        self._begin("slurmd", "-D", "-c")
        self._until(lambda: self.call("sinfo", "--noheader", "--format=%t", check=False).strip() == "idle", "slurmd")

    def _begin(self, name, *options):
        with open(self._folder / f"{name}.said", "w") as said:
            self._daemons.append(subprocess.Popen([_program(name), *map(str, options)], stdin=subprocess.DEVNULL, stdout=said, stderr=said))

    def _until(self, ready, name):
        for _ in range(300):
            if ready():
                return
            if any(d.poll() is not None for d in self._daemons):
                break
            time.sleep(0.2)
        said = "".join(p.read_text(errors="replace")[-400:] for p in sorted(self._folder.glob(f"{name}.*")) if p.suffix in (".said", ".log"))
        raise RuntimeError(f"{name} does not start: {said}")

    def call(self, name, *options, check=True):
        """Standard output of one of Slurm's commands."""
        return subprocess.run([_program(name), *map(str, options)], check=check, capture_output=True, text=True).stdout

    def version(self):
        return self.call("sinfo", "--version").split()[1]

    def states(self, job):
        """State and number of restarts of every task of an array: {task: (state, restarts)}."""
        said = [dict(word.split("=", 1) for word in line.split() if "=" in word) for line in self.call("scontrol", "--oneliner", "show", "job", job).splitlines()]
        return {int(task["ArrayTaskId"]): (task["JobState"], int(task["Restarts"])) for task in said if task.get("ArrayTaskId", "").isdecimal()}
