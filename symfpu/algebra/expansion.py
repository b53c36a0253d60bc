"""Expanded polynomials of the nodes of a program, in tables of symbol numbers.

A monomial is the list of its symbols' numbers, descending, packed into words of 64 bits: a
product merges two such lists, and like terms meet in a table of hashes that compares whole
monomials. Sizes are bounded before anything is allocated: a sum has at most as many terms as its
products, which for these series is a fifth too many.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import psutil
from numpy.typing import NDArray

from symfpu.algebra.program import Ints, Program
from symfpu.algebra.program_values import ancestors
from symfpu.errors import ExpansionTooLarge

Words = NDArray[np.uint64]
LARGEST = 2.0**62  # of the sum of moduli of the integers of one polynomial
TABLE_BYTES = (
    25  # of a place in the table of hashes with one word, four places a product at most
)


class Polynomial(NamedTuple):
    """Terms of a node: symbols (terms, degree), numbers of leaves, -1 for none; integers (terms,).

    The numbers count `Program.symbols`, descending.
    """

    symbols: Ints
    coefficients: Ints


class Size(NamedTuple):
    """Bounds of an expansion: terms of all nodes wanted, bytes while it is made."""

    terms: float
    bytes: float


class Expansion:
    """Expanded polynomials of the wanted nodes of a program, and of all that they are made of.

    Raises ExpansionTooLarge before allocating what would not fit into memory.
    """

    def __init__(self, program: Program, wanted: Ints) -> None:
        self.program = program
        self.needed = ancestors(program, wanted)
        bounds = _Bounds(program, self.needed)
        self.bits = max(1, len(program.symbols).bit_length())
        self.slots = 64 // self.bits
        self.width = max(1, -(-bounds.degree // self.slots))
        self.size = bounds.size(np.unique(wanted[wanted >= 0]), self.width)
        free = psutil.virtual_memory().available
        if self.size.bytes > free or bounds.largest >= LARGEST:
            raise ExpansionTooLarge(self.size.terms, self.size.bytes, free)
        self._words: dict[int, Words] = {0: np.zeros((1, self.width), dtype=np.uint64)}
        self._integers: dict[int, Ints] = {0: np.ones(1, dtype=np.int64)}
        for node in self.needed.tolist():
            self._expand(node)

    def polynomial(self, node: int) -> Polynomial:
        """The terms of one of the wanted nodes."""
        words = self._words[node]
        mask = np.uint64((1 << self.bits) - 1)
        columns = []
        for slot in range(self.slots):
            shift = np.uint64(slot * self.bits)
            columns.append((words >> shift) & mask)
        symbols = np.stack(columns, axis=2).reshape(len(words), self.width * self.slots)
        symbols = symbols.astype(np.int64) - 1
        used = (symbols >= 0).any(axis=0)
        return Polynomial(symbols[:, used], self._integers[node])

    def is_zero(self, node: int) -> bool:
        """Whether one of the wanted nodes is the zero polynomial."""
        return len(self._integers[node]) == 0

    def _expand(self, node: int) -> None:
        start = self.program.start
        if start[node] == start[node + 1]:
            if node:
                self._words[node] = self._leaf(node)
                self._integers[node] = np.ones(1, dtype=np.int64)
            return
        terms = self.program.terms.at(slice(start[node], start[node + 1]))
        both = np.concatenate([terms.left, terms.right])
        parts, numbers = np.unique(both, return_inverse=True)
        left, right = numbers.reshape(2, -1)
        pieces = [self._integers[part] for part in parts.tolist()]
        sizes = np.array([len(piece) for piece in pieces])
        products = int((sizes[left] * sizes[right]).sum())
        room = 1 << (2 * products - 1).bit_length()
        keys = np.zeros((room, self.width), dtype=np.uint64)
        values = np.zeros(room, dtype=np.int64)
        from symfpu.algebra.program_loops import (
            expand_sum,
        )  # lazy: numba takes long to import

        count = expand_sum(
            left,
            right,
            terms.factor,
            np.concatenate([[0], np.cumsum(sizes)]),
            np.concatenate([self._words[part] for part in parts.tolist()]),
            np.concatenate(pieces),
            self.bits,
            room,
            keys,
            values,
        )
        self._words[node], self._integers[node] = keys[:count].copy(), values[:count].copy()

    def _leaf(self, node: int) -> Words:
        words = np.zeros((1, self.width), dtype=np.uint64)
        words[0, 0] = self.program.leaf_number(node) + 1
        return words


class _Bounds:
    """Bounds of the polynomials of needed nodes: degree, terms, products, moduli of integers."""

    def __init__(self, program: Program, needed: Ints) -> None:
        start, terms = program.start, program.terms
        degrees = np.zeros(program.size, dtype=np.int64)
        degrees[program.leaves] = 1
        self._terms, self._products = np.ones((2, program.size))
        moduli = np.ones(program.size)
        for node in needed.tolist():
            own = slice(start[node], start[node + 1])
            if own.start == own.stop:
                continue
            left, right = terms.left[own], terms.right[own]
            factors = np.abs(terms.factor[own])
            degrees[node] = (degrees[left] + degrees[right]).max()
            self._terms[node] = (self._terms[left] * self._terms[right]).sum()
            moduli[node] = (factors * moduli[left] * moduli[right]).sum()
        self._needed = needed
        self.degree = int(degrees[needed].max(initial=0))
        self.largest = float(moduli[needed].max(initial=0))

    def size(self, wanted: Ints, width: int) -> Size:
        """Of the wanted nodes, with so many words a monomial."""
        row = 8 * (width + 1)
        stored = float(self._terms[self._needed].sum()) * row
        largest = float(self._terms[self._needed].max(initial=0))
        return Size(float(self._terms[wanted].sum()), stored + 4 * largest * (row + 1))
