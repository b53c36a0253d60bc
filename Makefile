# Every target makes the environment it needs: .venv with the package and its development tools.
PYTHON ?= python3
BIN := .venv/bin
OUT ?= out
CACHE := $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/symfpu# of this user: a fresh clone finds machine code and types there
ONE_THREAD := OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 # workers of pytest share the cores
OLD := -W ignore::DeprecationWarning -W ignore::PendingDeprecationWarning # old releases call newer ones of each other

.PHONY: install reproduce test lowest bench fuzz sweeps atlas long fingerprint generated equations citation doors verdicts docs links clean

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
	$(BIN)/mypy --cache-dir $(CACHE)/mypy
	$(BIN)/lint-imports
	$(ONE_THREAD) $(BIN)/python -m pytest -n auto --dist loadfile

lowest: .venv-lowest/installed  ## tests with the lowest versions that pyproject.toml allows
	$(ONE_THREAD) .venv-lowest/bin/python -m pytest -n auto --dist loadfile $(OLD)

.venv-lowest/installed: pyproject.toml .ci/lowest.py
	$(PYTHON) -m venv .venv-lowest
	$(PYTHON) .ci/lowest.py > .venv-lowest/constraints.txt
	.venv-lowest/bin/python -m pip install --quiet --constraint .venv-lowest/constraints.txt --editable '.[dev]'
	touch $@

sweeps: install  ## decide the propagation rule for all seed sets: N <= 12, up to 3 seeds, both models
	mkdir -p $(OUT)
	$(BIN)/symfpu sweep --model alpha --longest 12 --largest 3 --order 5 --file $(OUT)/alpha.jsonl -o $(OUT)/sweep-alpha.md
	$(BIN)/symfpu sweep --model beta --longest 12 --largest 3 --order 3 --file $(OUT)/beta.jsonl -o $(OUT)/sweep-beta.md

atlas: install  ## where tori end, docs/atlas.md: what its data lack first (about 125 minutes of processor time from nothing), tables, pictures
	$(ONE_THREAD) $(BIN)/python docs/make_atlas.py --data

long: install  ## tests that `make test` leaves out: minutes of exact checks, notebooks, whole figures
	$(ONE_THREAD) $(BIN)/python -m pytest -m long -n auto --dist worksteal

fingerprint: install  ## the numbers of every function beside those of tests/fingerprint; UPDATE=1 writes what has changed, with a reason
	$(ONE_THREAD) $(BIN)/python -m tests.fingerprint $(if $(UPDATE),--update)

fuzz: install  ## 20,000 calls of the public face with odd types and sizes, with the counts
	$(ONE_THREAD) $(BIN)/python -m tests.fuzz.run 0 20000

bench: install  ## speed and memory, each beside a matrix product; kept, and compared with the last run on a like machine
	$(BIN)/python -m pytest tests/benchmarks --benchmark-only --benchmark-autosave --benchmark-columns=median,min,max -o addopts=--strict-markers
	$(BIN)/python docs/make_performance.py

generated: install  ## the gallery of exported evaluators, byte for byte
	$(BIN)/python -m symfpu.codegen.gallery generated

equations: install  ## docs/equations.md from the docstrings
	$(BIN)/python docs/make_equations.py

citation: install  ## CITATION.cff from symfpu/results/citation.py
	$(BIN)/python -c 'import symfpu; print(symfpu.cite("cff"))' > CITATION.cff

doors: install  ## the table of docs/chains.md, by calling every door
	$(BIN)/python docs/make_doors.py

verdicts: install  ## the tables of verdicts in docs/errata.md, from $(OUT)/report.json of all targets
	$(BIN)/python docs/make_verdicts.py $(OUT)/report.json

docs: install  ## the site, build/site/html/index.html; warnings are errors
	$(BIN)/python docs/make_site.py build/site

links: install  ## whether the links of the site to elsewhere lead somewhere; asks the network
	$(BIN)/python docs/make_site.py build/site --links

clean:
	rm -rf .venv .venv-lowest out build *.egg-info .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
