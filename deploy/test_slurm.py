#!/usr/bin/env python3
"""Tries deploy/on_slurm.sh for real, with a Slurm of its own on this machine, against a single process.

    python3 deploy/test_slurm.py target/release/retune

Needs slurmctld, slurmd and the client's commands (Debian: slurmctld, slurmd, slurm-client), and root. The Slurm knows one node
and asks nobody who he is, so it runs in a network and among processes of its own (`unshare`), which end with this trial.
"""

import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from trial import HERE, RETUNE, SHARDS, a_task, ok, parts, same, single, tasks, wait_until

CONFIGURATION = """
ClusterName=trial
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
AuthType=auth/none
CredType=cred/none
SlurmUser=root
StateSaveLocation={here}/state
SlurmdSpoolDir={here}/spool
SlurmctldPidFile={here}/slurmctld.pid
SlurmdPidFile={here}/slurmd.pid
SlurmctldLogFile={here}/slurmctld.log
SlurmdLogFile={here}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
SlurmdTimeout=5
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=trial Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def slurm(command, *arguments):
    return subprocess.run([command, *arguments], check=True, capture_output=True, text=True).stdout


def submit(out):
    """What a person types."""
    environment = os.environ | {"STUDY": "study.json", "OUT": out, "SHARDS": str(SHARDS), "RETUNE": RETUNE}
    subprocess.run(["bash", HERE / "on_slurm.sh"], check=True, stdout=subprocess.DEVNULL, env=environment)


def finish(seconds=120):
    wait_until(lambda: (time.sleep(0.2), not slurm("squeue", "--noheader"))[1], "the end of the jobs", seconds)


def merged(out):
    return Path(out, "parts", "log-merge.txt").read_text().strip()


def start_node():
    slurm("slurmd")
    host = socket.gethostname().split(".")[0]
    wait_until(lambda: (time.sleep(0.2), slurm("sinfo", "--noheader", "--nodes", host, "--format", "%T").strip() in {"idle", "mixed", "allocated"})[1],
               "the node", 60)


def kill_node():
    """All at once, as when the power goes: the daemon, what watches the tasks, and the tasks."""
    daemon = int(Path("slurmd.pid").read_text())
    children = [int(pid) for pid in slurm("pgrep", "slurmstepd").split()]
    for process in (daemon, *children, *tasks("node")):
        try:
            os.kill(process, signal.SIGKILL)
        except ProcessLookupError:
            pass


def main():
    host = socket.gethostname().split(".")[0]
    for name in ("state", "spool"):
        Path(name).mkdir()
    Path("slurm.conf").write_text(CONFIGURATION.format(here=os.getcwd(), host=host))
    os.environ["SLURM_CONF"] = str(Path("slurm.conf").resolve())
    single()
    slurm("slurmctld")
    start_node()
    version = slurm("sinfo", "--version").strip()

    begun = time.monotonic()
    submit("out")
    finish()
    ok(f"{SHARDS} shards as a job array of {version} on one node with two cores, {time.monotonic() - begun:.1f} s: {same('out')}")

    submit("killed")
    os.kill(a_task("killed", after=2), signal.SIGKILL)
    finish()
    assert "no part holds points" in merged("killed"), merged("killed")
    ok("a task was killed (SIGKILL) half-way; the merge refuses: " + merged("killed").splitlines()[-1])
    submit("killed")
    finish()
    ok(f"the same command again goes on: {same('killed')}")

    submit("node")
    a_task("node", after=2)
    kill_node()
    kept = len(parts("node"))
    assert kept < SHARDS, "all parts were made before the kill"
    time.sleep(10)  # Slurm takes the node for lost
    start_node()
    finish(400)
    ok(f"the node was killed with {kept} of {SHARDS} parts there, and came back: Slurm started its tasks again by itself: {same('node')}")


if __name__ == "__main__":
    for command in ("slurmctld", "slurmd", "sbatch", "unshare", "ip"):
        if shutil.which(command) is None:
            raise SystemExit(f"{command} is not here: install slurmctld, slurmd, slurm-client, util-linux and iproute2")
    if os.getpid() != 1:
        alone = ["unshare", "--net", "--pid", "--fork", "--mount-proc", "--kill-child"]
        os.execvp("unshare", [*alone, sys.executable, *sys.argv])
    slurm("ip", "link", "set", "lo", "up")
    slurm("ip", "address", "add", "192.0.2.1/32", "dev", "lo")  # without any but 127.0.0.1 the C library resolves no name
    with tempfile.TemporaryDirectory() as directory:
        os.chdir(directory)
        main()
