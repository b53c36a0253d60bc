"""Words that no verb takes: one line that names the argument, code 2, nothing on standard output; and honest failures, code 1."""

import shlex

import pytest

import symfpu
from symfpu import Chain, lindstedt, save, solve_amplitudes
from symfpu.cli.main import main
from tests.cli.running import refusal

SOLVE = "solve -N 16 --alpha 0.33 --seeds 1,2 --omega 0.19626,0.39046 --order 12"
WISH = "solve -N 4 --alpha 0.3 --seeds 2,1 --order 2"
FAMILY = "family -N 8 --alpha 0.4 --beta 0.1 --seeds 3 --to-energy 0.05 --from-energy 0.01"
BREATHER = "solve -N 8 --alpha 0.3 --seeds 1"
ATLAS = "atlas --beta 1 --lengths 8 --packets high:1 --order 4 --borders poles"
ORBIT = "frequencies -N 4 --beta 1 --time 500 --step 0.1"
MAP = f"{ORBIT} --energies 0.01:0.1:3"
START = "--packet 1,2 --energy 0.1"
ALL = "term -N N --alpha 1 --seeds 1,N-1 --order 2"
ONE = "term -N 8 --alpha 1 --seeds 1 --order 2"
PROVE = "prove -N 8 --seeds 1 --order 2"
POTENTIAL = "solve -N 8 --seeds 1 --omega 0.392 --order 4 --potential"
RING = "solve -N 8 --order 2 --alpha 1 --ends periodic"

# what is typed, and what the line says; of an option that stands twice the last counts; files by the words of the fixture `files`
REFUSED = {
    # verbs and options
    "conquer": "conquer",
    f"{SOLVE} --colour red": "--colour",
    "solve -N 16 --seeds 1 --order 2 --alpha 1": "--omega",
    # chains and seeds
    f"{SOLVE} -N x": "N",
    f"{SOLVE} -N N": "N = 'N'",
    f"{SOLVE} --alpha 0": "alpha, beta",
    f"{SOLVE} --seeds 1,a": "seeds",
    "propagate -N 32 --seeds 3,4.5 --order 2": "seeds",
    "propagate -N 32 --seeds 3,5 --order -1": "order",
    "propagate -N 32 --seeds 3,5 --order 2 --model gamma": "model",
    # potentials
    f"{POTENTIAL} toda:1/2 --alpha 0.33": "alpha, beta = ",
    f"{POTENTIAL} toda:x": "a = ",
    f"{POTENTIAL} spring:1": "potential = ",
    # rings
    "export RING --lang c -o exported.c": "docs/chains.md",
    f"{FAMILY} --ends periodic --method appendix-a --order 4": "docs/chains.md",
    f"{PROVE} --ends periodic": "--ends",
    "sweep --order 1 --ends periodic": "--ends",
    f"{RING} --seeds 1 --omega 0.77 --ends round": "'fixed' or 'periodic'",
    f"{RING} --seeds 1 --omega 0.77 --digits 30": "docs/chains.md",
    f"{RING} --seeds 5 --omega 0.77": "-3..4 without 0",
    "propagate -N 8 --seeds 0 --order 2 --ends periodic": "-3..4 without 0",
    "solve -N 8 --seeds=-1 --order 2 --alpha 1 --omega 0.77": "1..7",
    "orbit RING --time 10 --scheme aba864_modes": "not for ends='periodic'",
    "solve -N 16 --ends periodic --beta 1 --seeds=4,-4 --omega 1.42,1.42 --order 2": "resonance",
    # solve
    f"{SOLVE} --omega a,0.39046": "frequencies",
    f"{SOLVE} --omega 0.2,0.4": "commensurable",
    f"{SOLVE} --order 2.5": "order",
    f"{SOLVE} --seeds 1,2,3,4 --omega 0.196,0.391,0.581,0.766 --order 200": "bytes",
    f"{SOLVE} --frequency-order 13": "frequency_order",
    f"{SOLVE} --coordinate-order 13": "order",
    f"{SOLVE} --coordinate-order x": "coordinate-order",
    f"{SOLVE} --digits 0": "digits",
    f"{WISH} --energy 1 --omega 1,2": "leave the others out",
    f"{WISH} --omega 0.7,1.4 --shares 1,1": "shares = '1,1'",
    f"{WISH} --amplitudes 0.1,0.1 --harmonic": "harmonic = True",
    f"{WISH} --energy 1 --shares 1": "shares = '1': allowed is a number for each of the seeds (2, 1)",
    f"{WISH} --energy=-1": "energy = '-1'",
    f"{WISH} --energy 1 --ends periodic": "give --omega and -o FILE, then symfpu refine FILE --energy E",
    f"{WISH} --amplitudes 1,1 --ends periodic": "give --omega and -o FILE, then symfpu refine FILE --amplitudes A,A,...",
    # term
    f"{ALL} -q 1 --omega 0.1,1.9": "frequencies = ",
    f"{ONE} -q N-1": "q = ",
    f"{ONE} -q 1 --seeds N-1": "seeds = ",
    f"{ALL} -q 2 --frequency": "q = ",
    f"{ALL} -q 1 --form short": "form = ",
    f"{ALL} -q 1 --frequency --form cse": "form = ",
    f"{ALL} -q 1 --omega 0.1,1.9 --form cse": "form = ",
    f"{ONE} -q 1 --digits 20": "frequencies = ",
    f"{ONE} -q 1 -N M": "N = ",
    # refine
    "refine FILE --start 0,0": "start",
    "refine FILE --digits many": "digits",
    "refine FILE --harmonic": "harmonic",
    "refine FILE --energy 0.01 --amplitudes 0.1,0.1": "at most one of them",
    "refine FILE --amplitudes 0.1,x": "amplitudes",
    "refine FILE --energy=-1": "energy",
    "refine FILE --tolerance x": "tolerance",
    # family
    f"{FAMILY} --to-energy x": "to_energy = ",
    f"{FAMILY} --from-energy 1": "from_energy = ",
    f"{FAMILY} --members x": "members = ",
    f"{FAMILY} --method newton": "method = ",
    f"{FAMILY} --order 4": "order = ",
    f"{FAMILY} --method appendix-a": "order = ",
    f"{FAMILY} --amplitude-ratio 1,2": "amplitude-ratio = ",
    f"{FAMILY} --amplitude-ratio 1 --energy-ratio 1": "energy_ratio = ",
    f"{FAMILY} --multipliers --method appendix-a --order 4": "multipliers = ",
    f"{FAMILY} --multipliers --seeds 1,2": "multipliers = ",
    # breather
    BREATHER: "exactly one of --omega, --energy and --amplitudes; give one of them",
    f"{BREATHER} --omega 0.39 --energy 0.01 --amplitudes 1": "exactly one of",
    f"{BREATHER} --energy=-0.01": "energy = '-0.01': allowed is a positive number",
    f"{BREATHER} --omega=-1": "frequencies, omega_1 = '-1'",
    f"{BREATHER} --amplitudes 0": "amplitudes = {1: '0'}",
    f"{BREATHER} --amplitudes much": "amplitudes, 1 = 'much'",
    f"{BREATHER} --omega 0.3905 --digits 0": "digits = 0",
    f"{BREATHER} --omega 0.3905 --seeds 8": "seeds = 8",
    f"{BREATHER} --omega 0.3905 --seeds one": "seeds = 'one'",
    # starts
    "orbit --time 100": "exactly one of FILE, --state, --packet and --random; give one of them",
    f"gali FILE --time 100 {START}": "leave the others out",
    f"orbit --time 100 {START} --random 1": "leave the others out",
    "gali FILE --time 100 -N 8": "N = '8': allowed is nothing beside FILE",
    "orbit FILE --time 100 --energy 1": "energy = '1': allowed is nothing beside FILE",
    "orbit --time 100 --packet 1 -N 4 --alpha 1": "give --energy E",
    "gali --time 100 --state s --energy 1 -N 4": "nothing beside --state",
    f"orbit --time 100 {START}": "give -N, and --alpha, --beta or --potential",
    "orbit --time 100 --random x --energy 1 -N 4 --alpha 1": "random = 'x'",
    "gali --time 100 --packet 1,9 --energy 1 -N 4 --alpha 1": "seeds",
    "orbit --time 100 --state none.txt -N 4 --alpha 1": "none.txt: No such file",
    # orbit
    "orbit FILE --time soon": "time = 'soon'",
    "orbit FILE --time 10 --step 0": "step = 0.0",
    "orbit FILE --time 10 --scheme euler": "scheme = 'euler'",
    "orbit FILE --time 10 --samples few": "samples = 'few'",
    "orbit FILE --time 10 -o orbit.txt": "ends in .csv or .npz",
    # gali
    "gali FILE --time long": "time = 'long'",
    "gali FILE --time 5": "T = 5.0",
    "gali FILE --time 5 --estimate": "T = 5.0",
    "gali FILE --time 1000 --vectors 99": "vectors = 99",
    "gali FILE --time 1000 --step 0": "step = 0.0",
    # frequencies
    f"{MAP} --energy 0.1": "nothing beside --energies",
    f"{MAP} --random 1": "nothing beside --energies",
    f"{MAP} -o x.symfpu": "nothing beside --energies",
    f"{ORBIT} --energies 0.1:0.01:3": "FROM < TO",
    f"{ORBIT} --energies 0.1:1": "FROM:TO:NUMBER",
    "frequencies --time 500 --energies 0.1": "give -N",
    f"{ORBIT} --packet 1 --energy 0.1 --file x.jsonl": "nothing without --energies",
    f"{ORBIT} --packet 1 --energy 0.1 --angles 2": "nothing without -o",
    f"{ORBIT} --packet 1 --energy 0.1 -o x.symfpu --angles 9": "independent frequencies",
    **{
        f"{ORBIT} --packet 1 {more} --level={level}": "allowed is a number between 0 and 1"
        for more in ("--energy 0.1", "--energies 0.1,0.2")
        for level in ("1", "0", "-1")
    },
    # atlas
    f"{ATLAS} --lengths 8,x": "lengths",
    f"{ATLAS} --lengths ''": "lengths",
    f"{ATLAS} --order 0": "order",
    f"{ATLAS} --borders radius": "borders",
    f"{ATLAS} --by frequency": "by",
    f"{ATLAS} --places=-1": "places",
    f"{ATLAS} --reach 0.1": "reach",
    f"{ATLAS} --beta x": "beta",
    f"{ATLAS} --packets ''": "packets",
    f"{ATLAS} --most-harmonics x": "most-harmonics",
    f"{ATLAS} --time x": "time",
    f"{ATLAS} --draws 1.5": "draws",
    # proofs
    f"{PROVE} --points=-1": "points = ",
    f"{PROVE} --seeds 9": "seeds = ",
    f"{PROVE} --order x": "order = ",
    "sweep --longest 1 --order 2": "longest = ",
    "sweep --longest 4 --largest 0 --order 2": "largest_set = ",
    "certify FILE --residual --time 10": "time",
    "certify ORBIT --residual": "residual",
    "certify ORBIT --time 10": "time",
    # stability
    "certify ORBIT --stability --half-width 1e-4": "half",
    "stability ORBIT --modes 1": "no seeds",
    "stability ORBIT --members 3": "members",
    "stability ORBIT -o folder": "o",
    "stability ORBIT --series 3 --to-amplitudes 0.2": "s",
    # reproduce
    "reproduce": "TARGET",
    "reproduce fig3 fig0": "fig0",
    "reproduce all nosuch": "nosuch",
    "reproduce fig3 --full": "fig1, fig2, fig9",
    "reproduce section5 fig6 --full": "leave out",
    "workbench --port x": "port",
    # files; more of them in test_paths.py and test_other_files.py
    "show": "FILE",
    "show /": "Is a directory",
    f"{ATLAS} --file /no/such/folder/atlas.jsonl": "file",
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Tori, of fixed ends and of a ring, by the word that stands for them."""
    folder = tmp_path_factory.mktemp("refusals")
    torus = solve_amplitudes(lindstedt(Chain(8, alpha="1/3", beta="0.2"), (1, 3), ("0.3904", "1.1118"), 4))
    ring = folder / "ring.symfpu"
    waves = "solve -N 16 --ends periodic --beta 1 --seeds=1,-3 --omega 0.3904,1.1116 --order 4"
    assert main([*shlex.split(waves), "-o", str(ring)]) == 0
    breather = symfpu.torus(Chain(3, alpha="0.3"), (1,), amplitudes={1: "0.1"})
    solutions = {"FILE": torus, "ORBIT": breather}
    return {word: str(save(folder / word, solution)) for word, solution in solutions.items()} | {"RING": str(ring)}


@pytest.mark.parametrize("typed", REFUSED)
def test_bad_input_is_one_line_and_code_2(typed, files, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = [files.get(word, word) for word in shlex.split(typed)]
    assert REFUSED[typed] in refusal(capsys, *words)
    assert list(tmp_path.iterdir()) == []


FAILING = {
    "solve -N 16 --beta 0.3 --seeds 3 --omega 0.57 --order 1": "no real amplitude",
    "solve -N 16 --alpha 0.3 --seeds 8 --omega 1.42 --order 4": "determine",
    "solve -N 16 --beta 0.3 --seeds 3 --omega 0.9 --order 2": "",
    "solve -N 8 --alpha 0.3 --seeds 1 --omega 0.3": "no real amplitude",
    "refine FILE --energy 1e9 -o none.symfpu": "no torus of the seeds (1, 3)",
    "orbit FILE --time 10 --step 2": "a step of 2 of kahan_li8 is unstable at time 0 in mode ",
}


@pytest.mark.parametrize("typed", FAILING)
def test_honest_failures_are_one_line_and_code_1(typed, files, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = [files.get(word, word) for word in shlex.split(typed)]
    for options in ([], ["--json"]):
        assert FAILING[typed] in refusal(capsys, *words, *options, code=1)
    assert list(tmp_path.iterdir()) == []
