"""The cache of compiled kernels: what an edit makes stale, whose folder is used, and what is removed."""

import ast
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from numba.core import bytecode

import physicslab
from physicslab.kernels import cache, keys, loading, motion, warm

PACKAGE = Path(physicslab.__file__).parent
KERNELS = PACKAGE / "kernels"
COMPILE = """
import sys
from importlib import import_module
from physicslab.kernels import cache_directory, compile_kernels
for name in sys.argv[1:]:
    module, _, kernel = name.partition(":")
    jitted = getattr(import_module(f"physicslab.kernels.{module}"), kernel)
    compile_kernels((jitted,))
    print(cache_directory(), sum(jitted.stats.cache_hits.values()))
"""


def run(code: str, *arguments: str, folder: Path | None = None, **environment: str) -> str:
    """Run Python in a folder, whose packages come before all others; return what it printed."""
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments], cwd=folder, env=os.environ | environment,
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return done.stdout


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """Return the folder of a copy of the package that may be edited."""
    shutil.copytree(PACKAGE, tmp_path / "physicslab", ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Let this process keep kernels in an empty folder."""
    folder = tmp_path / "kernels"
    folder.mkdir(mode=0o700)
    monkeypatch.setattr(cache, "_directory", folder)
    return folder


# ---- what an edit makes stale ------------------------------------------------------------------------------


def folders(monkeypatch: pytest.MonkeyPatch, edited: str) -> dict[str, str]:
    """Return the folders of all modules as they would be if one of them were another."""
    sources = dict(keys._sources())
    if edited:
        sources[f"physicslab.kernels.{edited}"] += "\n_EDITED = True\n"
    monkeypatch.setattr(keys, "_sources", lambda: sources)
    keys.depends_on.cache_clear()
    keys.folder_of.cache_clear()
    found = keys.current_folders()
    monkeypatch.undo()
    keys.depends_on.cache_clear()
    keys.folder_of.cache_clear()
    return {module.removeprefix("physicslab.kernels."): folder for module, folder in found.items()}


@pytest.mark.parametrize(
    ("module", "stale", "kept"),
    [
        ("geometry.sweep", {"geometry.sweep"}, {"motion", "raster", "solver.impulse", "ode.dop853"}),
        ("ode.compensated", {"ode.compensated", "ode.dop853", "events.events"}, {"raster", "geometry.sweep"}),
        ("raster", {"raster"}, {"motion", "energy", "solver.soft"}),
        ("compiler", {"motion", "raster", "solver.soft", "forces.drag"}, set()),
        ("loading", set(), {"motion", "raster", "solver.soft", "forces.drag"}),
    ],
)
def test_an_edit_makes_stale_what_depends_on_it(
    monkeypatch: pytest.MonkeyPatch, module: str, stale: set[str], kept: set[str]
) -> None:
    before, after = folders(monkeypatch, ""), folders(monkeypatch, module)
    changed = {name for name in before if before[name] != after[name]}
    assert stale | kept <= before.keys()
    assert stale <= changed
    assert not kept & changed
    assert bool(changed) == bool(stale)


def test_after_an_edit_only_what_depends_on_it_is_compiled(copied: Path, tmp_path: Path) -> None:
    """What was compiled is found wherever the program lies; in the copy a module is edited."""
    place, names = str(tmp_path / "cache"), ("motion:clear", "energy:motion_totals")

    def compiled(folder: Path | None) -> list[str]:
        return run(COMPILE, *names, folder=folder, PHYSICSLAB_KERNELS=place).splitlines()

    assert compiled(None) == [f"{place} 0", f"{place} 0"]
    assert compiled(copied) == [f"{place} 1", f"{place} 1"]
    with (copied / "physicslab" / "kernels" / "energy.py").open("a") as source:
        source.write("\n_EDITED = True\n")
    assert compiled(copied) == [f"{place} 1", f"{place} 0"]


def imported(path: Path) -> set[str]:
    """Return the modules of kernels that Python's own parser finds imported in a source."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: a relative import, which the cache does not follow"
            assert node.module is not None
            found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return found & keys._sources().keys()


@pytest.mark.parametrize("path", sorted(KERNELS.rglob("*.py")), ids=lambda path: path.stem)
def test_every_import_is_seen(path: Path) -> None:
    assert imported(path) <= set(keys._imports(path.read_text()))


def test_modules_without_code_make_no_kernels() -> None:
    """An edit of these makes nothing stale, so no machine code may come from them."""
    warm.load_all()
    made = {jitted.__module__ for jitted in warm._own()}
    assert made and not made & keys._WITHOUT_CODE
    code = {module for name in made for module in keys.depends_on(name)}
    assert not code & keys._WITHOUT_CODE


@pytest.mark.parametrize("changed", ["numba", "Python", "processor", "processor features"])
def test_another_numba_python_or_processor_has_folders_of_its_own(
    monkeypatch: pytest.MonkeyPatch, changed: str
) -> None:
    before = keys.folder_of("physicslab.kernels.motion")
    other = keys.platform_key() | {changed: "another"}
    monkeypatch.setattr(keys, "platform_key", lambda level: other)
    assert keys.folder_of.__wrapped__("physicslab.kernels.motion") != before


# ---- symbols -----------------------------------------------------------------------------------------------

IDENTITY = """
from physicslab.kernels.loading import separate_symbols
from numba.core.bytecode import FunctionIdentity
assert separate_symbols()
def f(): pass
print(FunctionIdentity.from_function(f).unique_id)
"""


def test_no_two_processes_name_machine_code_alike() -> None:
    first, second = (int(run(IDENTITY)) for _ in range(2))
    assert first != second and min(first, second) > 1_000_000


def test_a_numba_that_names_otherwise_is_left_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loading, "_separated", False)
    other = object()
    monkeypatch.setattr(bytecode.FunctionIdentity, "_unique_ids", other)
    assert not loading.separate_symbols()
    assert vars(bytecode.FunctionIdentity)["_unique_ids"] is other
    monkeypatch.delattr(bytecode, "FunctionIdentity")
    assert not loading.separate_symbols()


# ---- whose folder it is ------------------------------------------------------------------------------------

posix = pytest.mark.skipif(not hasattr(os, "geteuid"), reason="this system has no modes and owners of files")
WHERE = "from physicslab.kernels import cache_directory; print(cache_directory())"


@pytest.fixture
def places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Let kernels be kept below a folder, be it in the user's cache or among temporary files."""
    (tmp_path / "temporary").mkdir()
    monkeypatch.delenv("PHYSICSLAB_KERNELS", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    return tmp_path


@posix
def test_the_folder_is_closed_to_others(places: Path) -> None:
    found = cache._first_private()
    assert found == places / "physicslab" / "kernels"
    assert found.stat().st_mode & 0o777 == 0o700


def spoil(folder: Path, how: str) -> None:
    """Make a folder as another user would plant it."""
    if how == "link":
        elsewhere = folder.with_name("elsewhere")
        elsewhere.mkdir(mode=0o700, parents=True)
        folder.symlink_to(elsewhere)
        return
    folder.mkdir(parents=True)
    folder.chmod(0o777 if how == "open" else 0o700)
    if how == "owner":
        os.chown(folder, 12345, 12345)


HOW = [
    "link", "open",
    pytest.param("owner", marks=pytest.mark.skipif(
        not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root gives files away"
    )),
]  # fmt: skip


@posix
@pytest.mark.parametrize("how", HOW)
def test_a_folder_that_others_may_have_filled_is_refused(
    places: Path, caplog: pytest.LogCaptureFixture, how: str
) -> None:
    """Of the folder among temporary files the name is public: another user can make it first."""
    (places / "physicslab").write_text("no folder, so that the temporary one is next")
    planted = places / "temporary" / f"physicslab-{os.getuid()}"
    spoil(planted, how)
    found = cache._first_private()
    assert found.parent == places / "temporary" and found != planted
    assert found.stat().st_mode & 0o777 == 0o700
    assert not list(planted.iterdir())
    assert str(planted) in caplog.text and "not used" in caplog.text


@posix
@pytest.mark.parametrize("how", HOW)
def test_so_is_the_users_own_and_one_that_was_named(
    places: Path, monkeypatch: pytest.MonkeyPatch, how: str
) -> None:
    spoil(places / "physicslab" / "kernels", how)
    assert cache._first_private() == places / "temporary" / f"physicslab-{os.getuid()}" / "kernels"
    named = places / "named" / "kernels"
    spoil(named, how)
    monkeypatch.setenv("PHYSICSLAB_KERNELS", str(named))
    assert cache._first_private().name.startswith("physicslab-kernels-")


@posix
@pytest.mark.parametrize("named", [False, True])
@pytest.mark.parametrize("how", HOW[1:])
def test_whoever_can_replace_a_folder_above_it_could_have_filled_it(
    places: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, how: str, named: bool
) -> None:
    """They rename ours after it was checked and put another in its place."""
    above = places / "physicslab"
    spoil(above, how)
    (above / "between" / "kernels" if named else above / "kernels").mkdir(mode=0o700, parents=True)
    if named:
        monkeypatch.setenv("PHYSICSLAB_KERNELS", str(above / "between" / "kernels"))
    found = cache._first_private()
    assert above not in found.parents and f"{above} " in caplog.text
    above.chmod(0o1777)  # sticky: others can add to it, and neither rename nor remove what is ours
    found = cache._first_private()
    assert (above in found.parents) is (how == "open")


@posix
@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root gives links away")
def test_a_link_of_another_user_on_the_way_is_not_followed(places: Path) -> None:
    own = places / "unpacked" / "kernels"
    own.mkdir(mode=0o700, parents=True)
    link = places / "physicslab"
    link.symlink_to(own.parent)
    assert cache._first_private() == own, "a link of this user's is its own choice"
    os.lchown(link, 12345, 12345)
    assert own not in (found := cache._first_private(), *found.parents)


@posix
def test_a_group_is_others_unless_it_is_the_users_own(places: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    above = places / "physicslab"
    above.mkdir()
    above.chmod(0o775)
    monkeypatch.setattr(cache, "_is_own_group", lambda group: True)
    assert cache._first_private().parent == above
    monkeypatch.setattr(cache, "_is_own_group", lambda group: False)
    assert above not in cache._first_private().parents


@posix
def test_one_that_cannot_be_written_is_used_if_it_holds_every_kernel(
    places: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As where an administrator has compiled them for a classroom, or a container was built as root."""
    shared, name = places / "shared", cache._mark_name()
    folder = keys.folder_of("physicslab.kernels.motion")
    (shared / folder).mkdir(parents=True, mode=0o755)
    monkeypatch.setenv("PHYSICSLAB_KERNELS", str(shared))
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != shared)
    with fresh_directory(monkeypatch):
        assert cache.place_of(folder).is_relative_to(places / "temporary"), "one would be compiled each time"
    (shared / name).write_text("")
    with fresh_directory(monkeypatch):
        assert cache.cache_directory() == places / "physicslab" / "kernels", "those of users' own go there"
        assert cache.place_of(folder) == shared / folder and cache.mark() == shared / name
        assert cache.place_of("other.force-1") == places / "physicslab" / "kernels" / "other.force-1"
    shared.chmod(0o777)
    with fresh_directory(monkeypatch):
        assert shared not in cache.place_of(folder).parents, "anyone could have filled it"


@posix
def test_those_that_came_with_python_are_used(places: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "prefix", str(places / "python"))
    shared = places / "python" / "share" / "physicslab" / "kernels"
    shared.mkdir(parents=True, mode=0o755)
    (shared / cache._mark_name()).write_text("")
    with fresh_directory(monkeypatch):
        assert cache.mark().parent == shared


@contextmanager
def fresh_directory(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let the folders be chosen again, as at the start of a process."""
    with monkeypatch.context() as patch:
        patch.setattr(cache, "_directory", None)
        patch.setattr(cache, "_shared", None)
        yield


@posix
@pytest.mark.skipif(not keys.supported_levels(), reason="this processor has no levels")
def test_those_for_a_kind_of_processors_are_used_where_there_are_none_for_this_one(tmp_path: Path) -> None:
    code = "from physicslab.kernels import cache, keys; cache.cache_directory(); "
    code += "print(keys.platform_key()['processor'], cache._mark_name(), cache._mark_name('x86-64-v2'))"
    native, mark, other = run(code, PHYSICSLAB_KERNELS=str(tmp_path)).split()
    assert native not in keys.LEVELS and other.startswith("complete-x86-64-v2-")
    (tmp_path / other).write_text("")
    assert run(code, PHYSICSLAB_KERNELS=str(tmp_path)).split() == ["x86-64-v2", other, other]
    (tmp_path / mark).write_text("")
    assert run(code, PHYSICSLAB_KERNELS=str(tmp_path)).split()[0] == native


@posix
def test_a_temporary_folder_is_removed_at_the_end(places: Path) -> None:
    spoil(places / "named", "open")
    found = Path(run(WHERE, PHYSICSLAB_KERNELS=str(places / "named")).strip())
    assert found.name.startswith("physicslab-kernels-") and not found.exists()


@posix
def test_planted_code_is_not_run(tmp_path: Path) -> None:
    """A pickle can run anything when it is read."""
    place, ran = tmp_path / "planted", tmp_path / "ran"
    spoil(place, "open")
    folder = place / keys.folder_of("physicslab.kernels.motion")
    folder.mkdir()
    function = motion.clear.py_func  # type: ignore[attr-defined]
    version = f"{sys.version_info[0]}{sys.version_info[1]}"
    name = f"motion.{function.__qualname__}-{function.__code__.co_firstlineno}.py{version}.nbi"
    (folder / name).write_bytes(b"cposix\nsystem\n(S'touch " + str(ran).encode() + b"'\ntR.")
    found = run(COMPILE, "motion:clear", PHYSICSLAB_KERNELS=str(place)).split()
    assert Path(found[0]) != place and not ran.exists()
    place.chmod(0o700)  # the test would notice: in a folder that is trusted the code runs
    run(COMPILE, "motion:clear", PHYSICSLAB_KERNELS=str(place))
    assert ran.exists()


# ---- what is torn, and what cannot be kept -----------------------------------------------------------------

USE = """
from physicslab.kernels import compile_kernels, motion
from physicslab.kernels.forces import packed_forces
compile_kernels((motion.clear, packed_forces.uniform_gravity))
print(sum(motion.clear.stats.cache_hits.values()))
"""


def test_a_file_that_a_crash_has_torn_is_made_again(tmp_path: Path) -> None:
    tmp_path.chmod(0o700)
    kept = str(tmp_path)
    assert run(USE, PHYSICSLAB_KERNELS=kept) == "0\n"
    for ending in ("nbi", "nbc"):
        torn = [*tmp_path.glob(f"*/*.{ending}")]
        assert len(torn) == 2
        for path in torn:
            path.write_bytes(path.read_bytes()[:9])
        assert [run(USE, PHYSICSLAB_KERNELS=kept) for _ in range(2)] == ["0\n", "1\n"], ending


@posix
def test_what_a_full_disk_does_not_take_runs_all_the_same(tmp_path: Path) -> None:
    tmp_path.chmod(0o700)
    limit = (
        "import resource, signal; resource.setrlimit(resource.RLIMIT_FSIZE, (99, 99));"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)"
    )
    assert run(limit + USE, PHYSICSLAB_KERNELS=str(tmp_path), PYTHONDONTWRITEBYTECODE="1") == "0\n"
    assert not [*tmp_path.glob("*/*.nbc")]


# ---- what is removed ---------------------------------------------------------------------------------------


def test_what_is_not_used_for_long_is_removed(root: Path) -> None:
    day = 86400.0
    own = root / keys.folder_of("physicslab.kernels.motion")
    ages = {own: 90.0, root / "motion-00000000000000aa": 31.0, root / "unrelated": 90.0}
    ages |= {root / f"motion-{number:016x}": 1.0 + number for number in range(10)}
    legacy = root.parent / f"kernels-{7:016x}"
    for folder, age in (ages | {legacy: 40.0}).items():
        folder.mkdir()
        (folder / "f.nbc").write_bytes(b"")
        os.utime(folder, (time.time() - age * day,) * 2)
    cache.prune()
    left = {path.name for path in root.iterdir()}
    assert left == {own.name, "unrelated", *(f"motion-{number:016x}" for number in range(7))}
    assert not legacy.exists()


def test_what_is_used_is_noted(root: Path) -> None:
    function = motion.clear.py_func  # type: ignore[attr-defined]
    folder = root / keys.folder_of("physicslab.kernels.motion")
    folder.mkdir()
    os.utime(folder, (time.time() - 20 * 86400.0,) * 2)
    cache.note_use.__wrapped__(function)
    assert time.time() - folder.stat().st_mtime < 3600.0


def test_a_build_without_sources_is_known_by_its_code_in_every_process() -> None:
    """Two frozen programs of one version had the same kernels, though one was older."""
    source = "def f(x):\n    return x in {'one', 'two', 'three'} and (x, 2.5)\n"
    there = keys._digest(compile(source, "/here/f.py", "exec"))
    assert keys._digest(compile(source.replace("2.5", "2.6"), "/here/f.py", "exec")) != there
    program = (
        "from physicslab.kernels import keys\n"
        f"print(keys._digest(compile({source!r}, '/elsewhere/f.py', 'exec')))"
    )
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        run = [sys.executable, "-c", program]
        done = subprocess.run(run, env=environment, capture_output=True, text=True, check=True)
        assert done.stdout.strip() == there
