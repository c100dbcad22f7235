"""Ensembles on a cluster, and ensembles of which processes are killed."""

import multiprocessing
import os
import random
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from physicslab import World, ensemble
from physicslab.cli import main
from physicslab.components import Mass
from physicslab.ensembles.runs import task_of
from physicslab.ensembles.workers import Workers

SWEEP = (
    "drop", "--sample", "ball.Material.restitution=normal:0.7:0.2", "--samples", "4000",
    "--measure", "y=ball.y", "--measure", "n=collisions", "--seconds", "2",
)  # fmt: skip
"""Some runs are refused: a restitution is at most 1."""


INTERRUPTED = re.compile(
    r"physicslab: interrupted(; after [\d,]+ of 4,000 runs; the same call goes on there)?\n"
)


def command(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "physicslab", "sweep", *SWEEP, *arguments]


def kept(path: Path) -> dict[str, bytes]:
    """Return the bytes of every column but the time that runs took."""
    with np.load(path) as columns:
        return {name: columns[name].tobytes() for name in columns.files if name != "wall_s"}


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Return the columns of the sweep, made without a disturbance."""
    out = tmp_path_factory.mktemp("whole") / "whole.npz"
    assert main(["sweep", *SWEEP, "--out", str(out), "--workers", "1"]) == 0
    return kept(out)


@contextmanager
def scheduler(workers: int) -> Iterator[str]:
    """Start a scheduler and workers on this machine; give its address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    dask = [sys.executable, "-W", "ignore", "-m", "distributed.cli"]
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    port = address.rpartition(":")[2]
    begun = [
        subprocess.Popen(
            [
                *dask[:-1],
                "distributed.cli.dask_scheduler",
                "--host",
                "127.0.0.1",
                "--port",
                port,
                "--no-dashboard",
            ],
            **quiet,
        )
    ]
    begun += [
        subprocess.Popen(
            [
                *dask[:-1],
                "distributed.cli.dask_worker",
                address,
                "--nthreads",
                "1",
                "--no-dashboard",
                "--no-nanny",
            ],
            **quiet,
        )
        for _ in range(workers)
    ]
    try:
        yield address
    finally:
        for process in begun:
            process.kill()
            process.wait()


@pytest.mark.cluster
def test_a_cluster_makes_the_rows_that_one_process_makes(tmp_path: Path, whole: dict[str, bytes]) -> None:
    import distributed

    many = tmp_path / "many.npz"
    with scheduler(2) as address:
        client = distributed.Client(address, timeout=60)
        client.wait_for_workers(2, timeout=120)
        client.close()
        subprocess.run(command("--out", str(many), "--dask", address), check=True, timeout=900)
    assert kept(many) == whole


@pytest.mark.cluster
@pytest.mark.parametrize(
    ("address", "why"),
    [("tcp://127.0.0.1:1", "no scheduler answers there"), ("nonsense", "must be as tcp://host:8786")],
)
def test_a_scheduler_that_is_not_there_is_refused_in_one_line(address: str, why: str, tmp_path: Path) -> None:
    arguments = command("--out", str(tmp_path / "x.npz"), "--dask", address)
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=300)
    assert done.returncode == 2 and not done.stdout and not [*tmp_path.iterdir()]
    assert done.stderr.count("\n") == 1 and why in done.stderr


@pytest.mark.cluster
def test_a_scheduler_that_goes_away_is_told_in_one_line(tmp_path: Path) -> None:
    import distributed

    with scheduler(1) as address:
        arguments = command("--out", str(tmp_path / "x.npz"), "--dask", address, "--samples", "1000000")
        sweep = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        with distributed.Client(address, timeout=60) as client:
            while not client.call_stack():  # until a worker makes rows
                time.sleep(0.1)
    out, err = sweep.communicate(timeout=120)
    assert sweep.returncode == 1 and not out and err.count("\n") == 1 and "the scheduler is gone" in err


@pytest.mark.cluster
def test_results_are_tables_of_pandas_xarray_and_parquet(tmp_path: Path) -> None:
    import pyarrow.parquet as parquet

    space: dict[str, Any] = {"ball.Mass.mass": [1.0, 2.0], "ball.Material.restitution": [0.5, 0.7, 0.9]}
    out = tmp_path / "x.parquet"
    result = ensemble("drop", space, measure={"y": "ball.y"}, seconds=1.0, executor="serial", out=out)
    assert result.to_pandas()["y"].tolist() == result.columns["y"].tolist()
    cube = result.to_xarray()
    assert cube["y"].shape == (2, 3)
    assert (
        float(cube["y"].sel({"ball.Mass.mass": 2.0, "ball.Material.restitution": 0.9}))
        == result.columns["y"][5]
    )
    assert parquet.read_table(out).to_pydict()["y"] == result.columns["y"].tolist()


def children(process: int) -> list[int]:
    """Return the worker processes that a process has started, in whichever of its threads."""
    try:
        threads = Path(f"/proc/{process}/task").glob("*/children")
        listed = [child for thread in threads for child in thread.read_text().split()]
        return [int(child) for child in listed if "spawn_main" in Path(f"/proc/{child}/cmdline").read_text()]
    except OSError:  # one has ended meanwhile
        return []


def disturbances(config: pytest.Config) -> int:
    """Return how often a sweep is killed or interrupted: by kills, the sweep itself and a worker in turn."""
    effort: float = config.getoption("effort")
    return max(2, round(4 * effort))


def killed_and_resumed(out: Path, kills: int, rng: random.Random) -> int:
    """Run the sweep, kill a worker or the sweep itself at random moments, and let it come to its end.

    Returns how many of the kills are left.
    """
    while True:
        process = subprocess.Popen(command("--out", str(out), "--workers", "2"), stdout=subprocess.DEVNULL)
        while process.poll() is None and kills:
            time.sleep(rng.uniform(0.2, 3.0))
            victims = [process.pid]
            while kills % 2 and not (victims := children(process.pid)) and process.poll() is None:
                time.sleep(0.05)
            if process.poll() is None:
                try:
                    os.kill(rng.choice(victims), signal.SIGKILL)
                except ProcessLookupError:
                    continue
                kills -= 1
        if process.wait(timeout=900) == 0:
            return kills
        assert process.returncode == -signal.SIGKILL


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="children are listed in /proc")
def test_killed_at_random_moments_it_comes_to_the_same_bytes(
    tmp_path: Path, whole: dict[str, bytes], pytestconfig: pytest.Config
) -> None:
    out = tmp_path / "killed.npz"
    kills, rng = disturbances(pytestconfig), random.Random(1)
    for _ in range(5 * kills):
        kills = killed_and_resumed(out, kills, rng)
        assert kept(out) == whole
        assert not (tmp_path / "killed.npz.parts").exists()
        out.unlink()  # or the next sweep would find it finished
        if not kills:
            break
    assert not kills, "no worker was found"


@pytest.mark.slow
@pytest.mark.skipif(
    not hasattr(os, "killpg"), reason="needs groups of processes, to which a terminal signals"
)
def test_ctrl_c_at_random_moments_says_one_line_and_the_rest_comes_to_the_same_bytes(
    tmp_path: Path, whole: dict[str, bytes], pytestconfig: pytest.Config
) -> None:
    out, rng = tmp_path / "interrupted.npz", random.Random(2)
    for _ in range(disturbances(pytestconfig)):
        process = subprocess.Popen(
            command("--out", str(out), "--workers", "1"), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            text=True, start_new_session=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )  # fmt: skip
        time.sleep(rng.uniform(1.0, 5.0))
        os.killpg(process.pid, signal.SIGINT)
        said = process.communicate(timeout=60)[1]
        # Before Python can take it, or in a string that an import executes, Python ends by the signal.
        if (process.returncode, said) != (-signal.SIGINT, ""):
            interrupted = process.returncode in (130, -signal.SIGINT) and INTERRUPTED.fullmatch(said)
            assert interrupted or not process.returncode, (process.returncode, said)
        out.unlink(missing_ok=True)  # or the next sweep would find it finished
    assert main(["sweep", *SWEEP, "--out", str(out), "--workers", "1"]) == 0
    assert kept(out) == whole and not (tmp_path / "interrupted.npz.parts").exists()


def test_all_processes_start_with_the_first_row() -> None:
    task = task_of("drop", {"ball.Mass.mass": [1.0, 2.0, 3.0]}, measure="ball.y", steps=2)
    with Workers("processes", 2) as workers:
        block = next(workers.blocks(task, iter([(0, 3)])))
        assert len(block.values) == 1 and len(multiprocessing.active_children()) == 2


def ends_its_process(world: World) -> float:
    mass = world.component("ball", Mass).mass
    if mass == 3.0:
        os.kill(os.getpid(), signal.SIGKILL)
    return mass


@pytest.mark.slow
def test_the_run_that_ends_its_process_is_found_and_kept_as_a_failure() -> None:
    space = {"ball.Mass.mass": [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]}
    result = ensemble("drop", space, measure={"m": ends_its_process}, seconds=0.1, workers=2)
    assert result.failures == {2: "the process that made this run ended"}
    assert np.isnan(result.columns["m"][2]) and np.nansum(result.columns["m"]) == 25.0


@pytest.mark.slow
def test_a_script_that_processes_would_run_again_is_told_so_in_one_line(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(
        "from physicslab import ensemble\n"
        'ensemble("drop", {"ball.Mass.mass": [1, 2]}, measure="ball.y", steps=2, workers=1)\n'
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert 'call it under if __name__ == "__main__":' in done.stderr.splitlines()[-1]
    assert "bootstrapping" not in done.stderr
