#!/usr/bin/env python3
"""Tries deploy/on_hyperqueue.py for real, with two HyperQueue workers on this machine, against a single process.

    python3 deploy/test_hyperqueue.py target/release/retune

Where the command `hq` is there too, its workers are processes of their own, and one of them is killed. (It comes with
HyperQueue's releases; the workers of the Python package live in the process of the script.)
"""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from trial import HERE, RETUNE, SHARDS, a_task, ok, parts, run, same, single, study, tasks, wait_until


def tune(out, *cluster):
    """The command that a person types."""
    return subprocess.Popen(
        [sys.executable, HERE / "on_hyperqueue.py", "study.json", "--shards", str(SHARDS), "--out", out, "--retune", RETUNE, *cluster],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )


def tuned(out, *cluster):
    process = tune(out, *cluster)
    assert process.wait() == 0, process.stderr.read()
    return same(out)


def without_failures(*cluster):
    begun = time.monotonic()
    words = tuned("out", *cluster)
    ok(f"{SHARDS} shards on two workers, {time.monotonic() - begun:.1f} s: {words}")


def a_task_is_killed(*cluster):
    process = tune("killed", *cluster)
    os.kill(a_task("killed", 2, process), signal.SIGKILL)
    process.wait()
    said = process.stderr.read()
    assert process.returncode == 2 and "no part holds points" in said, said
    ok("a task was killed (SIGKILL) half-way; the merge refuses: " + said.strip().splitlines()[-1])
    ok(f"the same command again goes on: {tuned('killed', *cluster)}")


def all_is_killed(*cluster):
    process = tune("crash", *cluster)
    a_task("crash", 3, process)
    os.killpg(process.pid, signal.SIGKILL)
    for task in tasks("crash"):
        os.kill(task, signal.SIGKILL)
    process.wait()
    kept = len(parts("crash"))
    assert kept < SHARDS, "all parts were made before the kill"
    ok(f"server, both workers and their tasks were killed with {kept} of {SHARDS} parts there; the same command again: "
       f"{tuned('crash', *cluster)}")


def a_worker_is_killed():
    """Two workers in processes of their own; one goes, the other takes over what it had."""
    if shutil.which("hq") is None:
        print("no hq here: no worker was killed by itself", flush=True)
        return
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    here = Path("server").resolve()
    hq = ["hq", "--server-dir", str(here)]
    server = subprocess.Popen([*hq, "server", "start"], **quiet)
    wait_until((here / "hq-current" / "access.json").exists, "the server")
    workers = [subprocess.Popen([*hq, "worker", "start", "--cpus", "1"], start_new_session=True, **quiet) for _ in range(2)]
    try:
        process = tune("worker", "--server-dir", str(here / "hq-current"))
        wait_until(lambda: len(parts("worker")) >= 2 and len(tasks("worker")) == 2, "two workers at work", process=process)
        workers[0].kill()
        assert workers[0].wait() == -signal.SIGKILL
        kept = len(parts("worker"))
        assert kept < SHARDS, "all parts were made before the kill"
        assert process.wait() == 0, process.stderr.read()
        assert workers[1].poll() is None, "the other worker has gone too"
        ok(f"one of two workers was killed (SIGKILL) with {kept} of {SHARDS} parts there; the other took over its share, "
           f"and nothing had to be started again: {same('worker')}")
    finally:
        for process in (*workers, server):
            process.kill()


def parts_go_wrong():
    lost = parts("out")[3]
    content = lost.read_bytes()
    lost.rename("lost.part")
    _, said = run("merge", "study.json", "--out", "out", "--quiet", expect=2)
    assert "i/N = 4/8" in said, said
    ok(f"a part is lost: {said}")
    Path("lost.part").rename(lost)

    double = lost.with_name("00009-of-00008-" + lost.name.rsplit("-", 1)[1])
    double.write_bytes(content)
    _, said = run("merge", "study.json", "--out", "out", "--quiet", expect=2)
    assert "keep one of the two" in said, said
    ok(f"a part is there twice: {said}")
    double.unlink()

    Path("other.json").write_text(study(k1=30000))
    run("optimize", "other.json", "--out", "foreign", "--shard", "4/8", "--quiet")
    lost.rename("lost.part")
    foreign = parts("foreign")[0]
    foreign.rename(lost.with_name(foreign.name))
    _, said = run("merge", "study.json", "--out", "out", "--quiet", expect=2)
    assert "of another study" in said, said
    ok(f"a part of another study: {said}")
    lost.with_name(foreign.name).unlink()
    Path("lost.part").rename(lost)

    run("merge", "study.json", "--out", "out", "--quiet")
    ok(f"with all parts back: {same('out')}")
    text, _ = run("verify", "out")
    ok("retune verify says: " + " | ".join(line.strip() for line in text.splitlines()))


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as directory:
        os.chdir(directory)
        single()
        without_failures("--local", "2")
        a_task_is_killed("--local", "2")
        a_worker_is_killed()
        all_is_killed("--local", "2")
        parts_go_wrong()
