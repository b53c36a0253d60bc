"""Command line: parses, calls one public function, prints or writes.

Exit code 0 for success, 1 for an honest failure (no root, no convergence), 2 for bad input; errors are one line on
standard error, progress goes there too when it is a terminal, and --json leaves standard output machine-readable.
"""

from __future__ import annotations

import json
import shlex
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from symfpu.amplitudes import solve_amplitudes
from symfpu.arithmetic import text
from symfpu.bundle import load, save
from symfpu.certificates import PropagationProof, prove_propagation, write_text
from symfpu.chain import Chain
from symfpu.codegen.export import export as export_source
from symfpu.errors import InputError, SymfpuError
from symfpu.lindstedt import lindstedt
from symfpu.propagation import excitation_sequence
from symfpu.report import assessment_text, output_file, output_folder, sweep_markdown, torus_record
from symfpu.sweeps import sweep_propagation
from symfpu.targets import TARGETS
from symfpu.torus import QTorus
from symfpu.verdict import assess
from symfpu.verify import CertificateError
from symfpu.verify import verify as verify_certificate

app = typer.Typer(
    name="symfpu",
    help="Poincare-Lindstedt series of q-tori in Fermi-Pasta-Ulam chains.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

UsageProblem: Any = typer.BadParameter.__mro__[2]  # click's ClickException, which typer may carry inside itself

BondsOption = Annotated[str, typer.Option("-N", help="Number of bonds; the chain has N-1 moving particles.", metavar="N")]
SeedsOption = Annotated[str, typer.Option("--seeds", help="Seed modes D_0, such as 1,2.", metavar="Q,Q,...")]
OrderOption = Annotated[str, typer.Option("--order", help="Order k of the series.", metavar="K")]
JsonOption = Annotated[bool, typer.Option("--json", help="Machine-readable result on standard output.")]


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"symfpu {version('symfpu')}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and stop.")] = False,
) -> None:
    """Options that come before the verb."""


@app.command(epilog="Example: symfpu propagate -N 32 --model alpha --seeds 3,5 --order 4")
def propagate(
    bonds: BondsOption,
    seeds: SeedsOption,
    order: OrderOption,
    model: Annotated[str, typer.Option(help="alpha, beta or alpha+beta.")] = "alpha",
    as_json: JsonOption = False,
) -> None:
    """Which modes the propagation rule D_k excites at each order."""
    chosen = _whole_numbers("seeds", seeds)
    sequence = excitation_sequence(_whole("N", bonds), chosen, _whole("order", order), model=model)
    if as_json:
        record = {"N": _whole("N", bonds), "model": model, "seeds": sorted(chosen), "order": _whole("order", order)}
        _print_json(record | {"excitation_sequence": [list(modes) for modes in sequence]})
        return
    for k, modes in enumerate(sequence):
        print(f"D_{k} = {{{', '.join(map(str, modes))}}}")


@app.command(epilog="Example: symfpu prove -N 8 --model beta --seeds 1,4 --order 3 -o certificate.json")
def prove(
    bonds: BondsOption,
    seeds: SeedsOption,
    order: OrderOption,
    model: Annotated[str, typer.Option(help="alpha or beta.")] = "alpha",
    points: Annotated[str, typer.Option(help="Independent primes and random frequencies.")] = "1",
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write the certificate to this file.")] = None,
    as_json: JsonOption = False,
) -> None:
    """Prove or refute the propagation rule by exact arithmetic; exit code 1 where it stays undecided."""
    number, chosen, highest = _whole("N", bonds), _whole_numbers("seeds", seeds), _whole("order", order)
    with _progress() as advance:
        proof = prove_propagation(
            number,
            chosen,
            highest,
            model=model,
            points=_whole("points", points),
            progress=lambda done, total: advance("recursion modulo a prime", done / max(total, 1)),
        )
    if output:
        proof.write(output)
    if as_json:
        _print_json({key: value for key, value in proof.certificate().items() if key not in ("excited", "vanishing", "points", "digest")})
    else:
        _print_proof(proof)
        if output:
            print(f"certificate: {output}")
    raise typer.Exit(1 if proof.verdict == "undecided" else 0)


def _print_proof(proof: PropagationProof) -> None:
    open_modes = {u.mode: u for u in proof.undecided}
    for k, (rule, actual) in enumerate(zip(proof.rule, proof.actual, strict=True)):
        same = "" if rule == actual else f"   actually {{{', '.join(map(str, actual))}}}"
        print(f"D_{k} = {{{', '.join(map(str, rule))}}}{same}")
    for e in proof.exceptions:
        doubt = f" (undecided, error probability {open_modes[e.mode].error_probability:.1e})" if e.mode in open_modes else ""
        print(f"mode {e.mode}: predicted at order {e.predicted}, actually {'at no order' if e.actual is None else e.actual}{doubt}")
    print(f"verdict: {proof.verdict}")


@app.command(epilog="Example: symfpu verify certificate.json")
def verify(
    file: Annotated[Path, typer.Argument(help="A certificate written by symfpu prove.", metavar="FILE")],
    as_json: JsonOption = False,
) -> None:
    """Check a certificate by another route: mode space, the tensors B and C, Python's integers, nothing of the prover."""
    try:
        checked = verify_certificate(file)
    except CertificateError as error:
        raise InputError("certificate", str(file), "one written by symfpu prove, unaltered", str(error)) from error
    if as_json:
        _print_json({"file": str(file), "valid": True, "checked": checked})
        return
    print("\n".join([*checked, "the certificate is valid"]))


@app.command(epilog="Example: symfpu sweep --model beta --longest 12 --largest 3 --order 3 --file beta.jsonl")
def sweep(
    order: OrderOption,
    model: Annotated[str, typer.Option(help="alpha or beta.")] = "alpha",
    longest: Annotated[str, typer.Option(help="All chains with 2 up to this many bonds.", metavar="N")] = "12",
    largest: Annotated[str, typer.Option(help="All seed sets with up to this many modes.", metavar="S")] = "3",
    file: Annotated[Path | None, typer.Option(help="Keep every decided case here; an interrupted sweep goes on from it.")] = None,
    markdown: Annotated[Path | None, typer.Option("-o", "--output", help="Write the summary to this Markdown file.")] = None,
    as_json: JsonOption = False,
) -> None:
    """Decide the propagation rule for all seed sets of a range of chains."""
    lengths = range(2, _whole("longest", longest) + 1)
    if not lengths:
        raise InputError("longest", longest, "2 or more", "take a longer chain")
    with _progress() as advance:
        result = sweep_propagation(
            lengths,
            _whole("largest", largest),
            _whole("order", order),
            model=model,
            file=file,
            progress=lambda done, total: advance("seed sets", done / total),
        )
    if markdown:
        write_text(markdown, sweep_markdown(result))
    if as_json:
        _print_json(
            {"model": model, "order": result.order, "cases": len(result.cases), "exceptions": [asdict(c) for c in result.exceptions]}
        )
        return
    print(result)
    for case in result.exceptions:
        print(f"N={case.N} seeds {case.seeds}: " + ", ".join(f"mode {q} at {a}, predicted {p}" for q, p, a in case.exceptions))


@app.command(epilog="Example: symfpu solve -N 16 --alpha 0.33 --seeds 1,2 --omega 0.19626,0.39046 --order 24")
def solve(
    context: typer.Context,
    bonds: BondsOption,
    seeds: SeedsOption,
    omega: Annotated[str, typer.Option(help="Frequencies, one for each seed, such as 0.19626,0.39046.", metavar="W,W,...")],
    order: OrderOption,
    alpha: Annotated[str, typer.Option(help="Cubic coupling.")] = "0",
    beta: Annotated[str, typer.Option(help="Quartic coupling.")] = "0",
    frequency_order: Annotated[
        str | None, typer.Option(help="Order of the frequency series that gives the amplitudes.  Default: --order.", metavar="K")
    ] = None,
    coordinate_order: Annotated[
        str | None, typer.Option(help="Order at which the coordinates Q(t) are cut.  Default: --order.", metavar="K")
    ] = None,
    digits: Annotated[str | None, typer.Option(help="Any number of digits, proved.  Default: doubles.", metavar="D")] = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Keep series, torus and verdict in this file.")] = None,
    as_json: JsonOption = False,
) -> None:
    """Amplitudes and energies of the q-torus with the given frequencies, and a verdict on its series."""
    chain = Chain(_whole("N", bonds), alpha=alpha, beta=beta)
    chosen = _whole_numbers("seeds", seeds)
    highest, cut = _optional("frequency-order", frequency_order), _optional("coordinate-order", coordinate_order)
    places, file = _optional("digits", digits), output_file(output) if output else None
    with _progress() as advance:
        series = lindstedt(
            chain,
            chosen,
            omega.split(","),
            _whole("order", order),
            digits=places,
            progress=lambda done, total: advance("series", done / total),
        )
        advance("amplitudes", None)
        torus = solve_amplitudes(series, frequency_order=highest, order=cut)
        assessment = assess(series, torus, progress=lambda done, total: advance("verdict", done / total))
        record = torus_record(torus, assessment)
        if file:
            advance("writing", None)
            save(file, torus, verdict=assessment.record(), command=shlex.join(["symfpu", *context.obj]))
    if as_json:
        _print_json(record)
    else:
        print(f"verdict: {assessment.headline}")
        _print_torus(torus, record)
        print(assessment_text(assessment))
        if file:
            print(f"written: {file}")


def _print_torus(torus: QTorus, record: dict[str, Any]) -> None:
    print(torus.series)
    for q, amplitude in record["amplitudes"].items():
        print(f"seed {q:<4} omega {record['frequencies'][q]:<20} amplitude {amplitude}")
    if torus.certificate is not None:
        radius = text(max(torus.certificate.radius.values()), 2)
        print(
            f"exactly one root within {radius}: certified"
            if torus.certificate.certified
            else f"root not certified: {torus.certificate.reason}"
        )
    print(f"frequency order {torus.frequency_order}, coordinate order {torus.order}")
    print(f"energy H           {record['energy']}   (at t = 0)")
    print(f"harmonic energy    {record['harmonic_energy']}   (at t = 0; time average {record['average_harmonic_energy']})")
    print(f"residual           {record['residual']:.3g}   (equations of motion, relative to the largest acceleration)")
    for warning in torus.warnings:
        _console().print(f"warning: {warning}", style="yellow", highlight=False)


@app.command(epilog="Example: symfpu show torus.symfpu")
def show(
    file: Annotated[Path, typer.Argument(help="A file written by symfpu solve -o.", metavar="FILE")],
    as_json: JsonOption = False,
) -> None:
    """What a result file holds: series, torus, verdict, and what made it."""
    bundle = load(file)
    record = {} if bundle.torus is None else torus_record(bundle.torus)
    if as_json:
        _print_json(record | {"provenance": dict(bundle.provenance), "assessment": bundle.verdict, "test_vectors": bundle.test_vectors})
        return
    if bundle.verdict:
        print(f"verdict: {bundle.verdict.get('verdict')}")
    if bundle.torus is None:
        print(bundle.series)
    else:
        _print_torus(bundle.torus, record)
    for reason in (bundle.verdict or {}).get("reasons", []):
        print(f"  {reason}")
    for key, value in bundle.provenance.items():
        print(f"{key:<18} {value}")


@app.command(epilog="Example: symfpu export torus.symfpu --lang c -o my_torus")
def export(
    context: typer.Context,
    file: Annotated[Path, typer.Argument(help="A torus written by symfpu solve -o.", metavar="FILE")],
    language: Annotated[str, typer.Option("--lang", help="c, fortran, numpy or mpmath.", metavar="LANGUAGE")],
    output: Annotated[Path, typer.Option("-o", "--output", help="The source file; its name names the functions.")],
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """The torus as source code that needs nothing of symfpu: Q(t), P(t), E_q(t), H(t), with a self-test."""
    bundle = load(file)
    if bundle.torus is None:
        raise InputError("FILE", str(file), "a file with a torus in it", "write one with symfpu solve -o")
    with _progress() as advance:
        advance("source code", None)
        written = export_source(bundle.torus, language, output, force=force, command=shlex.join(["symfpu", *context.obj]))
    print(f"written: {written}")


def _optional(argument: str, text: str | None) -> int | None:
    return None if text is None else _whole(argument, text)


@app.command(epilog="Example: symfpu reproduce table fig1 -o out")
def reproduce(
    targets: Annotated[list[str], typer.Argument(help="table, fig1, fig6, convergence, or all.", metavar="TARGET...")],
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for the report, pictures and data.")] = Path("out"),
    as_json: JsonOption = False,
) -> None:
    """The paper's numbers from its printed frequencies, beside the printed ones."""
    for target in targets:
        if target not in (*TARGETS, "all"):
            raise InputError("target", target, f"{', '.join(TARGETS)} or all", "name one or more of these")
    folder = output_folder(output)
    pages = {}
    with _progress() as advance:
        for target in TARGETS:
            if target in targets or "all" in targets:
                pages[target] = TARGETS[target](folder, lambda label: advance(label, None))
    record = {target: page.record for target, page in pages.items()}
    title = "# The paper's numbers, computed from its printed frequencies"
    write_text(folder / "report.md", "\n\n".join([title, *(page.markdown for page in pages.values())]))
    write_text(folder / "report.json", json.dumps(record, indent=1) + "\n")
    if as_json:
        _print_json(record)
        return
    _print_rows(record.get("table", []))
    for key, claim in record.get("fig1", {}).get("claims", {}).items():
        print(f"Fig. 1, {key.replace('_', ' ')}: printed {claim['printed']}; computed {claim['computed']}")
    pictures = [page.files for page in pages.values() if page.files]
    print(f"written: {folder / 'report.md'}, report.json" + (f", {', '.join(pictures)} as PNG, PDF and CSV" if pictures else ""))


def _print_rows(rows: Sequence[dict[str, Any]]) -> None:
    for row in rows:
        print(f"{row['label']}  (Appendix F: {row['printed_label']})")
        for q, printed in row["printed_amplitudes"].items():
            print(f"  A_{q:<3} printed {printed:<24} computed {row['torus']['amplitudes'][q]}")
        energies = ", ".join(f"{name} {float(value):.9g}" for name, value in row["energies"].items())
        print(f"  E    printed {row['printed_energy']:<24} computed {energies}")
        print(f"  {row['verdict']}\n")


def _whole(argument: str, text: str) -> int:
    try:
        return int(text)
    except ValueError as error:
        raise InputError(argument, text, "a whole number", "write digits only") from error


def _whole_numbers(argument: str, text: str) -> list[int]:
    return [_whole(argument, part) for part in text.split(",")] if text.strip() else []


def _print_json(record: dict[str, Any]) -> None:
    print(json.dumps(record, indent=1))


def _console() -> Console:
    return Console(stderr=True, soft_wrap=True)


@contextmanager
def _progress() -> Iterator[Callable[[str, float | None], None]]:
    """A function (label, fraction done or None) that moves a bar on standard error, if that is a terminal."""
    console = _console()
    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("", total=None)
        yield lambda label, done: progress.update(task, description=label, total=None if done is None else 1.0, completed=done)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    command = typer.main.get_command(app)
    words = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    try:
        code = command.main(args=words, prog_name="symfpu", standalone_mode=False, obj=words)
    except InputError as error:
        return _fail(str(error), 2)
    except SymfpuError as error:
        return _fail(str(error), 1)
    except OSError as error:
        return _fail(f"{error.filename}: {error.strerror}; name another file or folder", 2)
    except (KeyboardInterrupt, EOFError, typer.Abort):
        return _fail("interrupted", 130)
    except UsageProblem as error:
        return _fail(f"{error.format_message()} (see symfpu --help)", int(error.exit_code))
    return _fail("interrupted", 130) if code == 130 else int(code or 0)


def _fail(message: str, code: int) -> int:
    print("symfpu: " + " ".join(message.split()), file=sys.stderr)
    return code


def run() -> None:
    """Entry point of the console script."""
    sys.exit(main())
