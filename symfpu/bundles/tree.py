"""A result as a tree of JSON with arrays beside it, and back without executing anything.

A node is null, a boolean, a whole number or text, or an object of one key that says what it is.
Series and solutions inside keep the format that they have as files, each once. Which classes a
tree may name, its writer and its reader are told.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, is_dataclass
from datetime import datetime
from fractions import Fraction
from functools import cache
from math import prod
from pathlib import Path
from typing import Any, Union, get_args, get_origin, get_type_hints

import mpmath
import numpy as np
from numpy.typing import NDArray

from symfpu.bundles.bundle import document, load_with, parts_from, parts_of
from symfpu.bundles.entries import chain_entries, chain_from, number, number_entry
from symfpu.chain.chain import Chain
from symfpu.dynamics.scheme import Scheme
from symfpu.dynamics.schemes import SCHEMES
from symfpu.errors import InputError
from symfpu.files.archive import Archive, Json, write_document
from symfpu.numbers.arithmetic import ComplexWithDigits, NumberWithDigits, with_digits
from symfpu.numbers.typed import fraction, fraction_text, integer
from symfpu.series.series import LindstedtSeries
from symfpu.tori.torus import Torus

Array = NDArray[Any]
Classes = Mapping[str, type[Any]]

OWN_FORMAT: tuple[type[Any], ...] = (LindstedtSeries, Torus)
DTYPES = ("<f8", "<c16", "<i8", "|b1")
SCALARS: dict[str, type[Any]] = {"float64": np.float64, "complex128": np.complex128}
PLAIN = (bool, int, str, type(None))


class Writer:
    """Nodes of values; arrays gathers what is beside them, parts the series and solutions."""

    def __init__(self, classes: Classes) -> None:
        self._classes = classes
        self.arrays: dict[str, Array] = {}
        self.parts: list[Json] = []
        self._places: dict[int, int] = {}  # of series and solutions, by identity

    def node(self, value: Any) -> Any:
        """The node of a value; InputError for what a file does not keep."""
        if type(value) in PLAIN:
            return value
        for kind, write in self._writers():
            if isinstance(value, kind):
                return write(value)
        if is_dataclass(value) and type(value).__name__ in self._classes:
            return self._instance(value)
        allowed = "numbers, arrays, chains, series, solutions and results"
        advice = "save what it holds, or its table: to_frame()"
        raise InputError("result", type(value).__name__, allowed, advice)

    def _writers(self) -> tuple[tuple[Any, Callable[[Any], Json]], ...]:
        return (
            (OWN_FORMAT, self._kept),
            (np.floating | np.complexfloating, self._scalar),
            (float, lambda x: {"float": repr(x)}),
            (complex, lambda z: {"complex": [repr(z.real), repr(z.imag)]}),
            (np.integer | np.bool_, self._scalar),
            (Fraction, lambda x: {"fraction": fraction_text(x)}),
            (NumberWithDigits, lambda x: {"mpf": number_entry(x), "digits": x.digits}),
            (mpmath.mpf, lambda x: {"mpf": number_entry(x)}),
            (ComplexWithDigits, lambda z: {**self._parts_of(z), "digits": z.digits}),
            (mpmath.mpc, self._parts_of),
            (tuple, lambda items: {"tuple": [self.node(item) for item in items]}),
            (list, lambda items: {"list": [self.node(item) for item in items]}),
            (Mapping, self._mapping),
            (np.ndarray, self._array),
            (Chain, lambda chain: {"chain": chain_entries(chain), "ends": chain.ends}),
            (Scheme, self._scheme),
        )

    def _parts_of(self, value: Any) -> Json:
        return {"mpc": [number_entry(value.real), number_entry(value.imag)]}

    def _mapping(self, value: Mapping[Any, Any]) -> Json:
        pairs = [[self.node(key), self.node(item)] for key, item in value.items()]
        return {"dict": pairs}

    def _scalar(self, value: Any) -> Json:
        name = type(value).__name__
        if name not in SCALARS:
            allowed = f"{', '.join(SCALARS)} and plain numbers"
            raise InputError("result", name, allowed, "convert it: float(x), int(x)")
        z = complex(value)
        return {"scalar": name, "parts": [repr(z.real), repr(z.imag)]}

    def _array(self, values: Array) -> Json:
        if values.dtype == object:
            inside = [self.node(item) for item in values.flat]
            return {"objects": inside, "shape": list(values.shape)}
        dtype = values.dtype.newbyteorder("<").str
        if dtype not in DTYPES:
            allowed = f"arrays of {', '.join(DTYPES)}"
            raise InputError("result", f"an array of {dtype}", allowed, "convert it")
        name = f"array{len(self.arrays)}"
        self.arrays[name] = np.ascontiguousarray(values, dtype=dtype).reshape(-1)
        return {"array": name, "dtype": dtype, "shape": list(values.shape)}

    def _scheme(self, scheme: Scheme) -> Json:
        if SCHEMES.get(scheme.name) != scheme:
            allowed = f"one of {', '.join(SCHEMES)}"
            raise InputError("scheme", scheme.name, allowed, "integrate with one of them")
        return {"scheme": scheme.name}

    def _kept(self, value: Any) -> Json:
        if id(value) not in self._places:
            entries, members = parts_of(value)
            place = len(self.parts)
            self.parts.append(entries)
            named = {f"part{place}.{name}": array for name, array in members.items()}
            self.arrays |= named
            self._places[id(value)] = place
        return {"part": self._places[id(value)]}

    def _instance(self, value: Any) -> Json:
        own = {f.name: getattr(value, f.name) for f in fields(value) if f.init}
        inside = {name: self.node(item) for name, item in own.items()}
        return {"class": type(value).__name__, "fields": inside}


class PartOfArchive:
    """An archive in which the arrays of one part stand under their own names."""

    def __init__(self, archive: Archive, place: int) -> None:
        self._archive, self._prefix = archive, f"part{place}."
        names = archive.digests.items()
        self.digests = {
            name.removeprefix(self._prefix): digest
            for name, digest in names
            if name.startswith(self._prefix)
        }

    def entries(self, name: str) -> int:
        return self._archive.entries(self._prefix + name)

    def array(self, name: str, dtype: str, count: int) -> Array:
        return self._archive.array(self._prefix + name, dtype, count)


class Reader:
    """Values of nodes; ValueError, TypeError or KeyError where they are none."""

    def __init__(self, archive: Archive, parts: list[Json], classes: Classes) -> None:
        self._archive, self._parts, self._classes = archive, parts, classes
        self._made: dict[int, Any] = {}

    def value(self, node: Any) -> Any:
        """The value of a node."""
        if type(node) in PLAIN:
            return node
        kind, *_ = node
        if kind not in self._readers:
            raise ValueError(f"no value is of the kind {kind!r:.40}")
        return self._readers[kind](node)

    @property
    def _readers(self) -> dict[str, Callable[[Json], Any]]:
        return {
            "float": lambda node: float(node["float"]),
            "complex": lambda node: complex(*map(float, node["complex"])),
            "scalar": self._scalar,
            "fraction": lambda node: fraction(node["fraction"]),
            "mpf": self._many_digits,
            "mpc": self._many_digits,
            "tuple": lambda node: tuple(map(self.value, node["tuple"])),
            "list": lambda node: list(map(self.value, node["list"])),
            "dict": lambda node: {self.value(k): self.value(v) for k, v in node["dict"]},
            "array": self._array,
            "objects": self._objects,
            "chain": lambda node: chain_from(node["chain"], node["ends"]),
            "scheme": lambda node: SCHEMES[node["scheme"]],
            "part": self._part,
            "class": self._instance,
        }

    def _scalar(self, node: Json) -> Any:
        kind = SCALARS[node["scalar"]]
        real, imaginary = map(float, node["parts"])
        if kind is np.complex128:
            return kind(complex(real, imaginary))
        return kind(real)

    def _many_digits(self, node: Json) -> Any:
        value = number(node["mpf"]) if "mpf" in node else _complex(*node["mpc"])
        if "digits" not in node:
            return value
        return with_digits(value, integer(node["digits"], "digits", 1))

    def _array(self, node: Json) -> Array:
        if node["dtype"] not in DTYPES:
            raise ValueError(f"no array is of the type {node['dtype']!r:.40}")
        shape = _shape(node)
        flat = self._archive.array(str(node["array"]), node["dtype"], prod(shape))
        return flat.reshape(shape)

    def _objects(self, node: Json) -> Array:
        values: Array = np.empty(len(node["objects"]), dtype=object)
        for i, item in enumerate(node["objects"]):
            values[i] = self.value(item)
        return values.reshape(_shape(node))

    def _part(self, node: Json) -> Any:
        place = integer(node["part"], "part", 0)
        if place not in self._made:
            inside: Any = PartOfArchive(self._archive, place)
            self._made[place] = parts_from(inside, self._parts[place])
        return self._made[place]

    def _instance(self, node: Json) -> Any:
        if node["class"] not in self._classes:
            raise ValueError(f"no result is of the class {node['class']!r:.40}")
        kind: Any = self._classes[node["class"]]
        values = {name: self.value(item) for name, item in node["fields"].items()}
        own = {f.name: f for f in fields(kind) if f.init}
        due = {name for name, f in own.items() if f.default is MISSING}
        due -= {name for name, f in own.items() if f.default_factory is not MISSING}
        if not due <= set(values) <= set(own):
            raise ValueError(
                f"the fields {sorted(values)} are not those of {kind.__name__}"
            )
        hints = types_of(kind)
        for name, value in values.items():
            if not fits(value, hints[name]):
                given = type(value).__name__
                raise TypeError(f"{kind.__name__}.{name} is of the type {given}")
        return kind(**values)


def _complex(real: Any, imaginary: Any) -> Any:
    """The mpc of two entries, to the last bit."""
    parts = tuple(number(part)._mpf_ for part in (real, imaginary))
    return mpmath.mp.make_mpc(parts)


def _shape(node: Json) -> tuple[int, ...]:
    return tuple(integer(n, "shape", 0) for n in node["shape"])


@cache
def types_of(kind: type[Any]) -> dict[str, Any]:
    """The types of the fields of a class that a file may name."""
    return get_type_hints(kind)


def fits(value: Any, hint: Any) -> bool:
    """Whether a value is of a type as annotations write it.

    >>> fits((1, 2), tuple[int, ...]), fits((1, "a"), tuple[int, ...]), fits(None, int | None)
    (True, False, True)
    """
    origin, inside = get_origin(hint), get_args(hint)
    if hint is Any:
        return True
    if origin in (Union, types.UnionType):
        return any(fits(value, one) for one in inside)
    if origin is tuple:
        if not isinstance(value, tuple):
            return False
        if inside[-1:] == (Ellipsis,):
            return all(fits(item, inside[0]) for item in value)
        return len(value) == len(inside) and all(map(fits, value, inside))
    if origin is np.ndarray:
        return isinstance(value, np.ndarray)
    if origin is not None:
        return _fits_container(value, origin, inside)
    if hint is float:
        return isinstance(value, float | int) and not isinstance(value, bool)
    if hint is int:
        return isinstance(value, int) and not isinstance(value, bool)
    return isinstance(value, hint)


def _fits_container(value: Any, origin: Any, inside: tuple[Any, ...]) -> bool:
    """Mappings and sequences."""
    if not isinstance(value, origin):
        return False
    if isinstance(value, Mapping):
        key, item = inside
        return all(fits(k, key) and fits(v, item) for k, v in value.items())
    return all(fits(item, inside[0]) for item in value)


def write_tree(
    path: Path,
    result: Any,
    classes: Classes,
    *,
    verdict: Json | None = None,
    command: str | None = None,
    created: datetime | None = None,
) -> None:
    """A result as one file, with notes that were checked."""
    writer = Writer(classes)
    root = writer.node(result)
    held = {"root": root, "parts": writer.parts}
    body = document(verdict, command, created) | {"result": held}
    write_document(path, body, writer.arrays)


def read_tree(path: Path | str, classes: Classes) -> Any:
    """What `write_tree` wrote. Raises BundleError and OSError as `load` does."""
    return load_with(path, lambda archive, held: value_of(archive, held, classes)).result


def value_of(archive: Archive, held: Json, classes: Classes) -> Any:
    """The result of a document; ValueError and the like where it is none."""
    return Reader(archive, held["parts"], classes).value(held["root"])
