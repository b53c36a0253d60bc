"""A result as a tree of JSON with arrays beside it, and back without executing anything.

A node is null, a boolean, a whole number or text, or an object of one key that says what it is.
A series inside is a part with tables of its own, each once. The classes that a file may name are
results, and of what they hold those that their annotations declare.
"""

from __future__ import annotations

import itertools
import sys
import types
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass
from fractions import Fraction
from functools import cache
from math import prod
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

import mpmath
import numpy as np
from numpy.typing import NDArray

import symfpu
from symfpu.chain.chain import Chain
from symfpu.dynamics.scheme import Scheme
from symfpu.dynamics.schemes import SCHEMES
from symfpu.errors import InputError
from symfpu.files.archive import Archive, Json
from symfpu.numbers.arithmetic import ComplexWithDigits, NumberWithDigits, with_digits
from symfpu.numbers.typed import fraction, fraction_text, integer
from symfpu.results.result import Result
from symfpu.series.series import LindstedtSeries
from symfpu.store.entries import chain_entries, chain_from, number, number_entry
from symfpu.store.many_digits import INTEGERS, is_of_many_digits, packed, unpacked
from symfpu.store.series import series_entries, series_from, series_tables

Array = NDArray[Any]

DTYPES = ("<f8", "<c16", "<i8", "|b1")
SCALARS: dict[str, type[Any]] = {"float64": np.float64, "complex128": np.complex128}
PLAIN = (bool, int, str, type(None))
CONTAINERS = ("tuple", "list", "dict")
OWN = "symfpu."


def class_name(kind: type) -> str:
    """A class as files name it: one of ours, wherever it stands, by its name alone."""
    own = kind.__module__.startswith(OWN)
    return kind.__name__ if own else f"{kind.__module__}:{kind.__qualname__}"


def class_named(name: str, hint: Any) -> type[Any]:
    """The class of a name in a file, of a type that annotations allow there.

    ValueError for any other. A public class of ours is imported; those of others must be, before.
    """
    if name in symfpu.__all__:
        getattr(symfpu, name)
    for base in _declared_in(hint):
        for kind in _with_subclasses(base):
            if class_name(kind) == name:
                return kind
    raise ValueError(f"no result is of the class {name!r:.60}")


def _declared_in(hint: Any) -> Iterator[type[Any]]:
    """The classes in an annotation that declare their fields; any result for Any."""
    if hint is Any:
        yield Result
    elif isinstance(hint, TypeVar):
        yield from _declared_in(hint.__bound__)
    elif isinstance(origin := get_origin(hint) or hint, type) and _declares(origin):
        yield origin
    else:
        for inside in get_args(hint):
            yield from _declared_in(inside)


def _declares(kind: type) -> bool:
    """Whether a class declares its fields: a result, a dataclass or a named tuple."""
    named = issubclass(kind, tuple) and hasattr(kind, "_fields")
    return named or is_dataclass(kind) or issubclass(kind, Result)


def _with_subclasses(kind: type[Any]) -> set[type[Any]]:
    """A class and those that inherit from it, as far as they are imported."""
    return {kind}.union(*map(_with_subclasses, kind.__subclasses__()))


def fields_of(kind: type[Any]) -> dict[str, bool]:
    """The fields by which a class is made, and whether each must be given."""
    if not is_dataclass(kind):
        names: tuple[str, ...] = kind._fields
        return {name: name not in kind._field_defaults for name in names}
    own = [f for f in fields(kind) if f.init]
    return {f.name: f.default is MISSING and f.default_factory is MISSING for f in own}


class Writer:
    """Nodes of values; arrays gathers what is beside them, parts the series."""

    def __init__(self) -> None:
        self.arrays: dict[str, Array] = {}
        self.parts: list[Json] = []
        self._places: dict[int, int] = {}  # of series, by identity
        self._field = "array"

    def node(self, value: Any) -> Any:
        """The node of a value; InputError for what a file does not keep."""
        if type(value) in PLAIN:
            return value
        if isinstance(value, tuple) and _declares(type(value)):
            return self._instance(value)
        for kind, write in self._writers():
            if isinstance(value, kind):
                return write(value)
        if _declares(type(value)):
            return self._instance(value)
        allowed = "numbers, arrays, chains, series, solutions and results"
        advice = "save what it holds, or its table: to_frame()"
        raise InputError("result", type(value).__name__, allowed, advice)

    def _writers(self) -> tuple[tuple[Any, Callable[[Any], Json]], ...]:
        return (
            (LindstedtSeries, self._series),
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
        if values.dtype == object and is_of_many_digits(values):
            return self._many_digits(values)
        if values.dtype == object:
            inside = [self.node(item) for item in values.flat]
            return {"objects": inside, "shape": list(values.shape)}
        dtype = values.dtype.newbyteorder("<").str
        if dtype not in DTYPES:
            allowed = f"arrays of {', '.join(DTYPES)}"
            raise InputError("result", f"an array of {dtype}", allowed, "convert it")
        name = self._array_name()
        self.arrays[name] = np.ascontiguousarray(values, dtype=dtype).reshape(-1)
        return {"array": name, "dtype": dtype, "shape": list(values.shape)}

    def _scheme(self, scheme: Scheme) -> Json:
        if SCHEMES.get(scheme.name) != scheme:
            allowed = f"one of {', '.join(SCHEMES)}"
            raise InputError("scheme", scheme.name, allowed, "integrate with one of them")
        return {"scheme": scheme.name}

    def _many_digits(self, values: Array) -> Json:
        words, exponents = packed(values)
        node = self._array(words) | {"exponents": self._array(exponents)["array"]}
        digits = getattr(values.flat[0], "digits", None)
        return {
            "mpf array": node.pop("array"),
            **node,
            "of": list(values.shape),
            "digits": digits,
        }

    def _series(self, series: LindstedtSeries) -> Json:
        if id(series) not in self._places:
            place = len(self.parts)
            members, layout = series_tables(series)
            self.parts.append(series_entries(series) | layout)
            named = {f"part{place}.{name}": array for name, array in members.items()}
            self.arrays |= named
            self._places[id(series)] = place
        return {"part": self._places[id(series)]}

    def _instance(self, value: Any) -> Json:
        kind = type(value)
        if getattr(sys.modules[kind.__module__], kind.__qualname__, None) is not kind:
            advice = "define the class at the top of a module; tori: in_doubles()"
            raise InputError(
                "result", kind.__name__, "of a class that is found again", advice
            )
        inside = {}
        for name in fields_of(kind):
            self._field = name
            inside[name] = self.node(getattr(value, name))
        return {"class": class_name(kind), "fields": inside}

    def _array_name(self) -> str:
        """That of the field that holds it, with a number where another one has it."""
        numbered = (f"{self._field}{n}" for n in itertools.count(2))
        names = itertools.chain([self._field], numbered)
        return next(name for name in names if name not in self.arrays)


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

    def __init__(self, archive: Archive, parts: list[Json]) -> None:
        self._archive, self._parts = archive, parts
        self._made: dict[int, LindstedtSeries] = {}

    def value(self, node: Any, hint: Any = Any) -> Any:
        """The value of a node. hint : the annotation of its place."""
        if type(node) in PLAIN:
            return node
        kind, *_ = node
        if kind in CONTAINERS:
            return self._container(kind, node[kind], hint)
        if kind == "class":
            return self._instance(node, hint)
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
            "array": self._array,
            "objects": self._objects,
            "chain": lambda node: chain_from(node["chain"], node["ends"]),
            "scheme": lambda node: SCHEMES[node["scheme"]],
            "part": self._part,
            "mpf array": self._array_of_many_digits,
        }

    def _container(self, kind: str, inside: list[Any], hint: Any) -> Any:
        """Of what is in it the annotation of the whole says what it may be."""
        if kind == "dict":
            return {self.value(k, hint): self.value(v, hint) for k, v in inside}
        values = [self.value(item, hint) for item in inside]
        return tuple(values) if kind == "tuple" else values

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

    def _array_of_many_digits(self, node: Json) -> Array:
        shape = tuple(integer(n, "shape", 0) for n in node["of"])
        count, words = _shape(node)
        if count != prod(shape) or not words:
            raise ValueError(f"{count} numbers of {words} words for the shape {shape}")
        flat = self._archive.array(str(node["mpf array"]), INTEGERS, count * words)
        exponents = self._archive.array(str(node["exponents"]), INTEGERS, count)
        values = unpacked(flat, exponents, shape)
        if node["digits"] is None:
            return values
        return with_digits(values, integer(node["digits"], "digits", 1))

    def _part(self, node: Json) -> LindstedtSeries:
        place = integer(node["part"], "part", 0)
        if place not in self._made:
            inside: Any = PartOfArchive(self._archive, place)
            self._made[place] = series_from(inside, self._parts[place])
        return self._made[place]

    def _instance(self, node: Json, hint: Any) -> Any:
        kind: Any = class_named(node["class"], hint)
        due, hints = fields_of(kind), types_of(kind)
        found = node["fields"]
        if not {name for name, needed in due.items() if needed} <= set(found) <= set(due):
            raise ValueError(f"the fields {sorted(found)} are not those of {kind.__name__}")
        values = {name: self.value(item, hints[name]) for name, item in found.items()}
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
    if isinstance(hint, TypeVar):
        return fits(value, hint.__bound__)
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
