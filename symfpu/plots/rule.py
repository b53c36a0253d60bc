"""The propagation of an excitation: mode against order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from symfpu.errors import InputError
from symfpu.numbers.typed import integer, length_of
from symfpu.plots.legends import legend
from symfpu.plots.style import MARK, Axes, axes_for, subject, whole_numbers
from symfpu.proofs.certificates import PropagationProof

ROOM = 170.0  # points of the height of the axes that markers share


def propagation(result: Any, ax: Axes | None = None, *, N: int | None = None) -> Axes:
    """The propagation map: the modes q of D_k against the order k (Eq. dk).

    result : what `excitation_sequence`, `coupling_sequence` or `reachable_modes` gave, modes by
        order, or a PropagationProof, whose rule and actual orders are both shown. Dimensionless.
    ax : axes of matplotlib; default new ones.
    N : number of bonds, up to which the axis of modes goes; default the largest mode. A proof has
        its own.

    Of a proof, squares are the rule of the Proposition, dots what is so, and modes that are
    excited at another order than predicted stand out. Returns the axes. Raises InputError.

    >>> from matplotlib.figure import Figure
    >>> from symfpu import excitation_sequence
    >>> propagation(excitation_sequence(32, (3, 5), 4), Figure().add_subplot()).get_ylabel()
    '$q$'
    """
    if isinstance(result, PropagationProof):
        rule, actual, bonds = _modes(result.rule), _modes(result.actual), result.N
        of = f"N={bonds}, {result.model}"
    else:
        rule, actual = None, _modes(result)
        largest = max((q for modes in actual for q in modes), default=0)
        bonds = largest + 1 if N is None else length_of(N, largest + 1)
        of = "" if N is None else f"N={bonds}"
    with axes_for(ax, subject(of, actual[0])) as axes:
        size = float(np.clip(ROOM / bonds, 2.2, 7.0))
        dots = {"marker": "o", "ls": "none", "ms": size}
        if rule is None:
            axes.plot(*_points(actual), color="C0", **dots)
        else:
            _draw_proof(axes, rule, actual, dots)
        axes.set_xlim(-0.5, len(actual) - 0.5)
        axes.set_ylim(0.25, bonds - 0.25)
        whole_numbers(axes.xaxis)
        whole_numbers(axes.yaxis)
        axes.set_xlabel("order $k$")
        axes.set_ylabel("$q$")
        legend(axes, most=0)
    return axes


Sets = list[tuple[int, ...]]


def _draw_proof(axes: Axes, rule: Sets, actual: Sets, dots: dict[str, Any]) -> None:
    squares = {"marker": "s", "ls": "none", "mfc": "none", "mec": "0.35"}
    axes.plot(*_points(rule), ms=1.8 * dots["ms"], label="rule", **squares)
    pairs = zip(rule, actual, strict=True)
    others = [tuple(q for q in there if q not in said) for said, there in pairs]
    same = [
        tuple(q for q in modes if q not in odd)
        for modes, odd in zip(actual, others, strict=True)
    ]
    axes.plot(*_points(same), color="C0", label="excited", **dots)
    if any(others):
        diamonds = dots | {"marker": "D"}
        axes.plot(*_points(others), color=MARK, label="against the rule", **diamonds)


def _points(sets: Sets) -> tuple[list[int], list[int]]:
    """Orders and modes of all members."""
    pairs = [(k, q) for k, modes in enumerate(sets) for q in modes]
    return [k for k, _ in pairs], [q for _, q in pairs]


def _modes(result: Any) -> Sets:
    """Modes by order; InputError for anything else."""
    given = type(result).__name__
    advice = "pass what excitation_sequence or prove_propagation gave"
    problem = InputError("result", given, "modes by order, or a proof", advice)
    if not isinstance(result, Sequence) or isinstance(result, (str, bytes)) or not result:
        raise problem
    if not all(isinstance(modes, (tuple, list)) for modes in result):
        raise problem
    return [tuple(integer(q, "result", 1) for q in modes) for modes in result]
