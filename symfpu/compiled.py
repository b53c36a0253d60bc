"""The decorator of all compiled loops: numba's, with a cache on disk.

The cache lies wherever there is a place for it.

Numba keeps machine code beside the source or in the user's cache folder, and refuses a function
where it may write to neither, as in a read-only installation without a home. There the cache is a
folder of temporary files of this user, or there is none. Importing this module imports numba.
"""

from __future__ import annotations

import functools
import os
import stat
import tempfile
from collections.abc import Callable
from typing import Any

import numba
from numba.core.registry import cpu_target

CONFIG: Any = numba.config
JIT = not CONFIG.DISABLE_JIT  # with NUMBA_DISABLE_JIT=1 loops run as Python, slowly


def vector_bits() -> int:
    """How wide the vectors are that loops are compiled for: 512 with AVX-512, else 256 or less."""
    _, _, features = cpu_target.target_context.codegen().magic_tuple()
    return 512 if "+avx512f" in features.split(",") else 256


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
        made.enable_caching()
    except RuntimeError as error:
        if "no locator available" in str(error):
            return False
        raise
    return True


@functools.cache
def temporary_folder() -> str | None:
    """A folder that outlives the run; None if there is none that is this user's alone.

    Whoever writes to a cache runs code as the one who reads it.
    """
    if os.name != "posix":
        return None
    own = os.getuid()
    try:
        folder = os.path.join(tempfile.gettempdir(), f"symfpu-{own}")
        os.makedirs(folder, mode=0o700, exist_ok=True)
        found = os.lstat(folder)
    except OSError:
        return None
    private = (
        stat.S_ISDIR(found.st_mode)
        and found.st_uid == own
        and not found.st_mode & (stat.S_IRWXG | stat.S_IRWXO)
    )
    return folder if private else None
