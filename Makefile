# Every target makes the environment it needs: .venv with the package and its development tools.
PYTHON ?= python3
BIN := .venv/bin
OUT ?= out
ONE_THREAD := OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 # workers of pytest share the cores

.PHONY: install reproduce test bench sweeps long generated equations clean

install: .venv/installed

.venv/installed: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --editable '.[dev]'
	touch $@

reproduce: install  ## the main job: the paper's table and figures, into $(OUT)/
	$(BIN)/symfpu reproduce all -o $(OUT)

test: install  ## lint, types, floors, tests
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(ONE_THREAD) $(BIN)/python -m pytest -n auto --dist loadfile

sweeps: install  ## decide the propagation rule for all seed sets: N <= 12, up to 3 seeds, both models
	mkdir -p $(OUT)
	$(BIN)/symfpu sweep --model alpha --longest 12 --largest 3 --order 5 --file $(OUT)/alpha.jsonl -o $(OUT)/sweep-alpha.md
	$(BIN)/symfpu sweep --model beta --longest 12 --largest 3 --order 3 --file $(OUT)/beta.jsonl -o $(OUT)/sweep-beta.md

long: install  ## exact checks that take minutes
	$(BIN)/python -m pytest -m long

bench: install  ## speed and memory, each beside a matrix product
	$(BIN)/python -m pytest tests/benchmarks --benchmark-only --benchmark-columns=median,min,max -o addopts=--strict-markers

generated: install  ## the gallery of exported evaluators, byte for byte
	$(BIN)/python -m symfpu.codegen.gallery generated

equations: install  ## docs/equations.md from the docstrings
	$(BIN)/python docs/make_equations.py

clean:
	rm -rf .venv out build *.egg-info .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
