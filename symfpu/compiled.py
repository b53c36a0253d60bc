"""The decorator of all compiled loops: numba's, with a cache on disk.

Machine code of this package lies in the user's cache folder, under a digest of all sources that
have a part in it: a clone, another branch or a file that was written anew finds it there. Numba
would keep it beside the source, and compile it anew where the time of a file has changed. What is
no file of this package, and everything where NUMBA_CACHE_DIR is set, numba places as it would.
Where nothing can be written, as in a read-only installation without a home, the cache is a folder
of temporary files of this user, or there is none. Importing this module imports numba.

Numba finds machine code by the classes of the arguments. Laws of bonds are such classes, also those
of a user's file, whose functions are compiled into the loops. Here machine code is found by the
names of the classes and what their functions do: an index needs no class to be read, and a law
that has changed is compiled anew.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import inspect
import os
import pickle
import re
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import numba
from numba.core import caching
from numba.misc.appdirs import AppDirs

try:
    import fcntl
except ImportError:  # there is no such lock
    fcntl = None  # type: ignore[assignment]

CONFIG: Any = numba.config
PACKAGE = Path(__file__).parent
MOST_KEPT = 8  # digests of sources whose machine code is kept, about 15 MB each
JIT = not CONFIG.DISABLE_JIT  # with NUMBA_DISABLE_JIT=1 loops run as Python, slowly


def compiled(*, keep: bool = True, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """A decorator of loops that release the interpreter. options : of numba.njit.

    keep : whether machine code is cached. A function that several modules compile, each with
    options of its own, must not be: numba's cache knows functions by file and name, and would
    give one module the code of another.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        made = numba.njit(nogil=True, **options)(function)
        if JIT and keep:
            _keep(made)
        return made

    return decorate


def _keep(made: Any) -> None:
    """Caches machine code where numba would, else in the temporary folder, if there is one."""
    if _kept(made):
        return
    folder, before = temporary_folder(), CONFIG.CACHE_DIR
    if folder is None:
        return
    try:
        CONFIG.CACHE_DIR = folder
        _kept(made)
    finally:
        CONFIG.CACHE_DIR = before


def _kept(made: Any) -> bool:
    try:
        made._cache = LoopCache(made.py_func)  # as Dispatcher.enable_caching does
    except RuntimeError as error:
        if "no locator available" in str(error):
            return False
        raise
    return True


class _PackageLocator(caching._CacheLocator):
    """The place of machine code of a file of this package: a folder for all of its sources."""

    def __init__(self, function: Any, room: str) -> None:
        self._path = os.path.join(room, function.__module__)
        self._line = function.__code__.co_firstlineno

    def get_cache_path(self) -> str:
        return self._path

    def get_source_stamp(self) -> str:
        return loops_digest()

    def get_disambiguator(self) -> str:
        return str(self._line)

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> _PackageLocator | None:
        file = Path(py_file)
        if CONFIG.CACHE_DIR or PACKAGE not in file.parents or not file.is_file():
            return None
        room = kept_folder()
        return None if room is None else cls(py_func, room)


class _Files(caching.CompileResultCacheImpl):
    _locator_classes = [_PackageLocator, *caching.CompileResultCacheImpl._locator_classes]  # noqa: RUF012


def loop_sources(package: Path) -> dict[str, bytes]:
    """Files with compiled loops, and those that they import from: all that may be compiled."""
    texts = {path: path.read_bytes() for path in sorted(package.rglob("*.py"))}
    names = {_dotted(path, package): path for path in texts}
    found: set[Path] = set()
    left = [path for path, text in texts.items() if COMPILES.search(text)]
    while left:
        path = left.pop()
        if path not in found:
            found.add(path)
            left += [names[name] for name in _imported(texts[path]) if name in names]
    return {path.relative_to(package).as_posix(): texts[path] for path in sorted(found)}


COMPILES = re.compile(
    rb"^\s*(?:import numba|from numba|from symfpu\.compiled) ?", re.MULTILINE
)
IMPORT = re.compile(rb"^\s*from (symfpu[\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)


def _dotted(path: Path, package: Path) -> str:
    parts = path.relative_to(package.parent).with_suffix("").parts
    return ".".join(part for part in parts if part != "__init__")


def _imported(text: bytes) -> Iterator[str]:
    """Modules that a file may import; a name that is imported may be one itself."""
    for module, names in IMPORT.findall(text):
        yield module.decode()
        for name in re.findall(rb"\w+", names):
            yield f"{module.decode()}.{name.decode()}"


@functools.cache
def loops_digest() -> str:
    """A digest of all that machine code is made of: sources, numba and Python."""
    made = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    for name, text in loop_sources(PACKAGE).items():
        made.update(f"{name} {len(text)} ".encode() + text)
    return made.hexdigest()[:16]


@functools.cache
def kept_folder() -> str | None:
    """The folder of machine code of these sources, of this user alone; None if there is none."""
    places: Any = AppDirs(appname="symfpu", appauthor=False)  # type: ignore[no-untyped-call]
    top = Path(places.user_cache_dir) / "loops"
    try:
        top.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _is_private(top):
            return None
        room = top / loops_digest()
        room.mkdir(mode=0o700, exist_ok=True)
        os.utime(room)
    except OSError:
        return None
    _remove_stale(top)
    return str(room)


def _remove_stale(top: Path) -> None:
    """Only what was used last stays; another process may remove the same."""
    with contextlib.suppress(OSError):
        rooms = sorted(top.iterdir(), key=lambda room: room.stat().st_mtime, reverse=True)
        for room in rooms[MOST_KEPT:]:
            shutil.rmtree(room, ignore_errors=True)


class LoopCache(caching.FunctionCache):
    """Numba's cache of a function, whose keys hold names and digests in place of classes."""

    _impl_class = _Files

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)  # type: ignore[no-untyped-call]
        self._cache_file.__class__ = _CacheFile

    def _index_key(self, signature: Any, codegen: Any) -> tuple[Any, ...]:
        _, *machine = super()._index_key(signature, codegen)  # type: ignore[no-untyped-call]
        digests = tuple(map(class_digest, _classes(signature)))
        return str(signature), digests, *machine


class _CacheFile(caching.IndexDataCacheFile):
    """Files of numba's cache; those that need what is gone count as empty."""

    def save(self, key: Any, data: Any) -> None:
        """One process at a time: two would give their code the same number in the index."""
        with _alone(f"{self._index_path}.lock"):
            super().save(key, data)  # type: ignore[no-untyped-call]

    def _load_index(self) -> dict[Any, str]:
        try:
            found: dict[Any, str] = super()._load_index()  # type: ignore[no-untyped-call]
        except GONE:
            return {}
        return found

    def load(self, key: Any) -> Any:
        try:
            return super().load(key)  # type: ignore[no-untyped-call]
        except GONE:
            return None


@contextlib.contextmanager
def _alone(path: str) -> Iterator[None]:
    """No other process is in such a block of the same path."""
    if fcntl is None:
        yield
        return
    with open(path, "wb") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


# classes that are not found any more, and files that were cut
GONE = (ImportError, AttributeError, EOFError, pickle.UnpicklingError)


def _classes(signature: Any) -> Iterator[Any]:
    """The classes of named tuples among the types of arguments."""
    for kind in getattr(signature, "args", signature):
        own = getattr(kind, "instance_class", None)
        if own is not None:
            yield own


@functools.cache
def class_digest(kind: Any) -> str:
    """A digest of the name of a class and of what its functions do."""
    text = hashlib.sha256(f"{kind.__module__}.{kind.__qualname__}".encode())
    known: set[FunctionType] = set()
    for name, function in inspect.getmembers(kind, inspect.isfunction):
        if not name.startswith("__"):
            text.update(name.encode())
            for part in _meaning(function, known):
                text.update(part.encode())
    return text.hexdigest()


def _meaning(function: FunctionType, known: set[FunctionType]) -> Iterator[str]:
    """The code of a function, and of the functions and numbers that it calls by name."""
    if function in known:
        return
    known.add(function)
    yield from _code(function.__code__)
    yield repr(function.__defaults__)
    for name in function.__code__.co_names:
        value = function.__globals__.get(name)
        value = getattr(value, "py_func", value)
        if isinstance(value, FunctionType):
            yield from _meaning(value, known)
        elif isinstance(value, bool | int | float | complex | str | tuple):
            yield f"{name} = {value!r}"


def _code(code: CodeType) -> Iterator[str]:
    yield code.co_code.hex()
    yield repr(code.co_names)
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _code(constant)
        else:
            yield repr(constant)


@functools.cache
def temporary_folder() -> str | None:
    """A folder that outlives the run; None if there is none that is this user's alone.

    Whoever writes to a cache runs code as the one who reads it.
    """
    if os.name != "posix":
        return None
    try:
        folder = os.path.join(tempfile.gettempdir(), f"symfpu-{os.getuid()}")
        os.makedirs(folder, mode=0o700, exist_ok=True)
        return folder if _is_private(folder) else None
    except OSError:
        return None


def _is_private(folder: str | Path) -> bool:
    """Whether it is a folder, no link, that no other user may read or write."""
    if os.name != "posix":
        return True  # the user's cache folder; there are no such rights
    found = os.lstat(folder)
    return (
        stat.S_ISDIR(found.st_mode)
        and found.st_uid == os.getuid()
        and not found.st_mode & (stat.S_IRWXG | stat.S_IRWXO)
    )
