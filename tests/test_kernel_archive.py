"""Compiled kernels for a classroom: an archive that fits is taken over, and nothing else is written."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from base64 import urlsafe_b64encode
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any
from unittest.mock import ANY

import compile_budget
import pytest

import physicslab
from physicslab import cli
from physicslab.commands import kernels as command
from physicslab.kernels import archive, cache, keys
from physicslab.kernels.archive import ArchiveError, pack, unpack

MODULES = ("motion", "energy")
CONTENT = {
    f"{keys.folder_of(f'physicslab.kernels.{name}')}/{name}.f-1.py312.{ending}": f"{name} {ending}"
    for name in MODULES
    for ending in ("nbi", "1.nbc")
}
COMPILE = """
from physicslab.kernels import compile_kernels, energy
compile_kernels((energy.motion_totals,))
print(sum(energy.motion_totals.stats.cache_hits.values()))
"""


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Let this process keep kernels in an empty folder."""
    folder = tmp_path / "kernels"
    folder.mkdir(mode=0o700)
    monkeypatch.setattr(cache, "_directory", folder)
    return folder


@pytest.fixture
def packed(root: Path, tmp_path: Path) -> Path:
    """Return an archive of a few files, which are then gone from the cache."""
    for name in MODULES:
        folder = root / keys.folder_of(f"physicslab.kernels.{name}")
        folder.mkdir()
        for ending in ("nbi", "1.nbc"):
            (folder / f"{name}.f-1.py312.{ending}").write_text(f"{name} {ending}")
        (folder / "left.tmp.12").write_text("of a process that was killed")
    path = tmp_path / "kernels.zip"
    path.write_bytes(pack())
    for file in root.rglob("*.*.*"):
        file.unlink()
    return path


def kept(root: Path) -> dict[str, str]:
    return {str(path.relative_to(root)): path.read_text() for path in root.rglob("*") if path.is_file()}


def changed(path: Path, change: Callable[[dict[str, Any], dict[str, bytes]], None]) -> Path:
    """Write an archive in which something of the manifest or the files is another; return its path."""
    with zipfile.ZipFile(path) as source:
        files = {name: source.read(name) for name in source.namelist()}
    manifest = json.loads(files.pop("manifest.json"))
    change(manifest, files)
    other = path.with_name("other.zip")
    with zipfile.ZipFile(other, "w") as target:
        target.writestr("manifest.json", json.dumps(manifest))
        for name, content in files.items():
            target.writestr(name, content)
    return other


def rename(manifest: dict[str, Any], files: dict[str, bytes]) -> None:
    name = next(iter(files))
    files[name.replace(".f-", ".g-")] = files.pop(name)


def drop(manifest: dict[str, Any], files: dict[str, bytes]) -> None:
    files.pop(next(iter(files)))


def swap(manifest: dict[str, Any], files: dict[str, bytes]) -> None:
    files[next(iter(files))] = b"another program"


def test_what_was_packed_is_there_again(root: Path, packed: Path) -> None:
    assert unpack(packed) == 4
    assert kept(root) == CONTENT


@pytest.mark.parametrize("name", sorted(keys.platform_key()))
def test_an_archive_for_another_computer_is_refused(root: Path, packed: Path, name: str) -> None:
    other = changed(packed, lambda manifest, files: manifest["platform"].update({name: "another"}))
    with pytest.raises(ArchiveError, match=f"does not fit: it is for {name} 'another', and here is") as error:
        unpack(other)
    assert "\n" not in str(error.value)
    assert not kept(root)


def no_manifest(manifest: dict[str, Any], files: dict[str, bytes]) -> None:
    manifest.clear()


def other_sources(manifest: dict[str, Any], files: dict[str, bytes]) -> None:
    manifest["sources"] = "0" * 16


def no_platform(manifest: dict[str, Any], files: dict[str, bytes]) -> None:
    manifest["platform"] = None


def empty(manifest: dict[str, Any], files: dict[str, bytes]) -> None:
    files.clear()


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (no_manifest, "format"),
        (other_sources, "another version of physicslab"),
        (no_platform, "does not fit"),
        (empty, "holds no kernels"),
        (rename, "is damaged"),
        (drop, "is damaged"),
        (swap, "is damaged"),
    ],
)
def test_what_does_not_fit_is_named(root: Path, packed: Path, change: Any, reason: str) -> None:
    with pytest.raises(ArchiveError, match=reason):
        unpack(changed(packed, change))
    assert not kept(root)


FOLDER = keys.folder_of("physicslab.kernels.motion")


@pytest.mark.parametrize(
    "name",
    [
        "../outside.nbi", f"{FOLDER}/../../outside.nbi", "/tmp/outside.nbi", f"{FOLDER}/..", f"{FOLDER}/",
        f"{FOLDER}/deeper/f.nbi", f"{FOLDER}\\..\\f.nbi", f"{FOLDER}/f.py", "motion-0000000000000000/f.nbi",
        "f.nbi", f"{FOLDER}/f\n.nbi", "C:f.nbi", f"./{FOLDER}/f.nbi",
    ],
)  # fmt: skip
def test_nothing_is_written_anywhere_else(root: Path, packed: Path, name: str, tmp_path: Path) -> None:
    before = sorted(tmp_path.rglob("*"))
    other = changed(packed, lambda manifest, files: files.update({name: b"planted"}))
    with pytest.raises(ArchiveError, match="holds what no kernel is"):
        unpack(other)
    assert sorted(set(tmp_path.rglob("*")) - {other}) == before


def test_an_archive_that_would_fill_the_disk_is_refused(
    root: Path, packed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(archive, "_LIMIT", 10)
    with pytest.raises(ArchiveError, match="MiB"):
        unpack(packed)
    assert not kept(root)


def test_a_damaged_archive_changes_nothing(root: Path, packed: Path) -> None:
    whole, refused = packed.read_bytes(), 0
    damaged = [b"", b"no archive", whole[: len(whole) // 2]]
    damaged += [whole[:i] + bytes((whole[i] ^ 0x55,)) + whole[i + 1 :] for i in range(len(whole))]
    for content in damaged:
        packed.write_bytes(content)
        try:
            unpack(packed)
        except ArchiveError:
            refused += 1
            assert not kept(root)
        else:  # what was damaged is no part of what is kept: a date, say
            assert kept(root) == CONTENT
            shutil.rmtree(root)
            root.mkdir()
    assert refused > len(whole) // 2


def test_kernels_of_one_process_are_loaded_by_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the archive alone: one computer compiles, another finds all that it needs."""

    def hits(place: Path) -> int:
        environment = os.environ | {"PHYSICSLAB_KERNELS": str(place)}
        done = subprocess.run(
            [sys.executable, "-c", COMPILE], env=environment, capture_output=True, text=True, check=True
        )
        return int(done.stdout)

    one, other = tmp_path / "one", tmp_path / "other"
    assert hits(one) == 0
    monkeypatch.setattr(cache, "_directory", one)
    (tmp_path / "kernels.zip").write_bytes(pack())
    other.mkdir(mode=0o700)
    monkeypatch.setattr(cache, "_directory", other)
    unpack(tmp_path / "kernels.zip")
    assert hits(other) == 1


STACK = """
import hashlib, pathlib, sys
from physicslab.kernels.archive import pack, unpack
path = pathlib.Path(sys.argv[2])
if sys.argv[1] == "unpack":
    unpack(path)
from physicslab import load_scene
from physicslab.components import Transform, Velocity
from physicslab.kernels import KERNELS
from physicslab.kernels.keys import platform_key
world = load_scene("newtons_cradle")
world.run(seconds=1.0)
if sys.argv[1] == "pack":
    path.write_bytes(pack())
bits = [world.table(Transform)["position"], world.table(Transform)["angle"], world.table(Velocity)["linear"]]
digest = hashlib.sha256(b"".join(column.tobytes() for column in bits)).hexdigest()
missed = sum(sum(k.stats.cache_misses.values()) for k in KERNELS if hasattr(k, "stats"))
print(digest, missed, platform_key()["processor"])
"""


@pytest.mark.slow
@pytest.mark.skipif("x86-64-v2" not in keys.supported_levels(), reason="this processor has no levels")
def test_kernels_for_a_kind_of_processors_give_the_same_bits_on_this_one(tmp_path: Path) -> None:
    """A processor without AVX and FMA compiles them, any other loads them."""

    def run(what: str, **variables: str) -> list[str]:
        command = [sys.executable, "-c", STACK, what, str(tmp_path / "kernels.zip")]
        done = subprocess.run(command, env=os.environ | variables, capture_output=True, text=True, check=True)
        return done.stdout.split()

    one, other = {cache.VARIABLE: str(tmp_path / "one")}, {cache.VARIABLE: str(tmp_path / "other")}
    digest, _, native = run("neither")
    assert native not in keys.LEVELS
    old = run("pack", NUMBA_CPU_NAME="x86-64-v2", NUMBA_CPU_FEATURES="", **one)
    assert old[0] == digest and int(old[1]) > 3 and old[2] == "x86-64-v2"
    assert run("unpack", **other) == [digest, "0", "x86-64-v2"]


TARGET = """
import physicslab.kernels.motion
from numba.core.registry import cpu_target
print(*cpu_target.target_context.codegen().magic_tuple()[1:])
"""


@pytest.mark.skipif("x86-64-v2" not in keys.supported_levels(), reason="this processor has no levels")
def test_kernels_that_were_imported_are_loaded_for_their_kind_alone(tmp_path: Path) -> None:
    """The features of the processor were noted before its kind was: all was compiled again."""
    folder = tmp_path / "kernels"
    folder.mkdir(mode=0o700)
    (folder / cache._mark_name("x86-64-v2")).touch()
    command = [sys.executable, "-c", TARGET]
    environment = os.environ | {cache.VARIABLE: str(folder)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["x86-64-v2"]


# ---- the command -------------------------------------------------------------------------------------------


@pytest.fixture
def compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let nothing be compiled."""
    monkeypatch.setattr(command, "_fill", lambda: None)


def test_export_and_import(
    root: Path, packed: Path, compiled: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["kernels", "import", str(packed)]) == 0
    said = capsys.readouterr()
    assert said.err.count("\n") == 1 and "compiled kernels are programs" in said.err
    assert "some kernels are missing" in said.out
    before = kept(root)
    assert cli.main(["kernels", "export", str(tmp_path / "again.zip")]) == 0
    assert "numba" in capsys.readouterr().out
    for path in root.rglob("*.nb*"):
        path.unlink()
    assert cli.main(["kernels", "import", str(tmp_path / "again.zip")]) == 0
    assert kept(root) == before


def test_a_wheel_is_installed_where_kernels_are_looked_for(
    root: Path, packed: Path, compiled: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its record is checked by hand here, as an installer does."""
    unpack(packed)
    before = kept(root)
    cache.mark().write_text("\n".join(path.name for path in root.iterdir() if path.is_dir()))
    out = tmp_path / "dist"
    out.mkdir()
    assert cli.main(["kernels", "wheel", str(out)]) == 0
    (file,) = out.iterdir()
    name, version, tag, *_ = file.name.split("-")
    assert (name, version) == ("physicslab_kernels_native", physicslab.__version__)
    assert tag == f"cp{sys.version_info[0]}{sys.version_info[1]}"
    with zipfile.ZipFile(file) as archive:
        lines = archive.read(f"{name}-{version}.dist-info/RECORD").decode().splitlines()
        assert sorted(line.split(",")[0] for line in lines) == sorted(archive.namelist())
        for path, digest, size in (line.split(",") for line in lines[:-1]):
            content = archive.read(path)
            assert len(content) == int(size)
            assert digest == f"sha256={urlsafe_b64encode(sha256(content).digest()).decode().rstrip('=')}"
        archive.extractall(tmp_path / "there")
    prefix = tmp_path / "there" / f"{name}-{version}.data" / "data"
    assert kept(prefix / "share" / "physicslab" / "kernels") == {**before, cache.mark().name: ANY}
    monkeypatch.setattr(sys, "prefix", str(prefix))
    monkeypatch.setattr(cache, "_is_safe", lambda *_: True)  # the folder of a test may be anywhere
    assert cache._first_shared() == prefix / "share" / "physicslab" / "kernels"


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["wheel"], "FILE is missing"),
        (["wheel", "nowhere"], "must be a folder that is there"),
        (["--cpu", "x86-64-v2", "import", "kernels.zip"], "must go with export or wheel"),
        (["export"], "FILE is missing"),
        (["import"], "FILE is missing"),
        (["foo"], "argument ACTION: invalid choice: 'foo' (choose from 'export', 'import', 'wheel')"),
        (["import", "nothing"], "No such file"),
        (["import", "a\0b"], "null"),
        (["import", "."], "directory"),
        (["export", "nowhere/kernels.zip"], "cannot be written"),
    ],
)
def test_bad_usage_is_one_line(
    root: Path, compiled: None, capsys: pytest.CaptureFixture[str], arguments: list[str], reason: str
) -> None:
    assert cli.main(["kernels", *arguments]) == 2
    *before, last = capsys.readouterr().err.splitlines()
    assert reason in last and last.startswith("physicslab: ")
    assert not any("programs" in line for line in before), "no warning of a file that cannot be read"
    assert not before or "usage" in before[0]


def test_what_does_not_fit_ends_with_2(root: Path, packed: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["kernels", "import", str(changed(packed, other_sources))]) == 2
    said = capsys.readouterr().err
    assert "does not fit" in said and said.count("\n") == 1


def test_alone_it_says_where_kernels_are(
    root: Path, compiled: None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["kernels"]) == 0
    assert str(root) in capsys.readouterr().out


# ---- the budget --------------------------------------------------------------------------------------------


def test_the_budget_names_what_exceeds_it() -> None:
    costs = [(6.0, "physicslab.kernels.a.big"), (0.5, "physicslab.kernels.b.small")]
    assert compile_budget.check(costs, each=7.0, total=7.0) == []
    assert compile_budget.check(costs, each=5.0, total=7.0) == [
        "physicslab.kernels.a.big: 6.0 s, more than 5 s"
    ]
    assert compile_budget.check(costs, each=7.0, total=6.0) == ["all kernels: 6.5 s, more than 6 s"]
    first, second, last = compile_budget.table(costs).splitlines()
    assert "a.big" in first and "b.small" in second and "6.50" in last
    assert keys.platform_key()["processor"] in last


def test_what_the_budget_compiled_is_kept(root: Path, tmp_path: Path) -> None:
    fresh = tmp_path / "fresh"
    for place, text in ((fresh, "new"), (root, "old")):
        (place / FOLDER).mkdir(parents=True)
        (place / FOLDER / "f.nbi").write_text(text)
    compile_budget._keep(fresh, root)
    assert kept(root) == {f"{FOLDER}/f.nbi": "new"}


@pytest.mark.parametrize(("slowness", "over"), [(1.0, True), (1.5, False)])
def test_the_budget_is_that_of_an_idle_machine_and_is_told(
    slowness: float, over: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    took = 1.4 * compile_budget.LIMIT_EACH_S
    monkeypatch.setattr(compile_budget, "measure", lambda: ([(took, "physicslab.kernels.a.slow")], slowness))
    compile_budget.main()
    said = f"physicslab.kernels.a.slow: {took:.1f} s, more than {compile_budget.LIMIT_EACH_S:g} s"
    assert (said in capsys.readouterr().out) is over
