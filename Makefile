# Every target makes the environment it needs: .venv with the package and its development tools.
PYTHON ?= python3
BIN := .venv/bin
OUT ?= out

.PHONY: install reproduce test bench clean

install: .venv/installed

.venv/installed: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --editable '.[dev]'
	touch $@

reproduce: install  ## the main job: the paper's table and Fig. 1, into $(OUT)/
	$(BIN)/symfpu reproduce table fig1 -o $(OUT)

test: install  ## lint, types, floors, tests
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python -m pytest

bench: install  ## speed and memory, each beside a matrix product
	$(BIN)/python -m pytest tests/benchmarks --benchmark-only --benchmark-columns=median,min,max -o addopts=--strict-markers

clean:
	rm -rf .venv out build *.egg-info .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
