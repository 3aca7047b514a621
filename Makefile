# Everything sets up its own .venv; every path is relative, so a checkout may live under a name with spaces.
PYTHON ?= python3
PY := .venv/bin/python
PIP := $(PY) -m pip --disable-pip-version-check --quiet install --no-compile
NEEDED := --require-hashes --constraint pins.txt --build-constraint pins.txt --requirement .venv/needs.txt
EDITABLE := $(PIP) --no-deps --build-constraint pins.txt --editable . # a folder has no digest, its builders have
export OMP_WAIT_POLICY := passive
unexport PYTHONDONTWRITEBYTECODE # without bytecode every process would read all sources again: 5 s instead of 1

.PHONY: reproduce test test-all check single double space lint types contract tests mutate validate atlas league evidence converge stale renew bench docs page
.PHONY: release reliability version tag pins licences matrix sizes clean

reproduce: .venv/.runtime
	$(PY) -m suchus reproduce --out out

test: # tests/README.md lists what it leaves out; the processor time is that of everything below it, installation included
	@test -e .venv/.dev && from=here || from=fresh; \
	$(MAKE) --no-print-directory -j2 -O check && $(MAKE) --no-print-directory tests; result=$$?; \
	mkdir -p .venv && times > .venv/.times && tools/processor_time.sh $$from $$result .venv/.times; exit $$result

test-all: test double .venv/.docs # before a release: also what takes long for what it tells
	SUCHUS_EXAMPLES=100 $(PY) -m pytest -n auto --dist worksteal -m slow
	SUCHUS_EXAMPLES=100 $(PY) -m pytest -n auto --dist worksteal -m "hypothesis and not validate and not slow"

check: single space types lint contract

lint: .venv/.dev
	$(PY) -m ruff check .
	$(PY) -m ruff format --check .

types: .venv/.dev
	$(PY) -m mypy

contract: .venv/.dev
	$(PY) -c "from importlinter.cli import lint_imports_command; lint_imports_command()" --no-cache

single double space: .venv/.dev # the flow's kernels, compiled once; else every test worker would: double for test-all
	SUCHUS_THREADS=1 $(PY) tools/compile_flow.py $@

page: .venv/.runtime # the engine of `suchus page`, which npm fetches into the user's cache
	$(PY) tools/fetch_engine.py

tests: .venv/.dev # without npm the engine of the page is not tried; what fails runs again with the values in its message
	@$(PY) tools/fetch_engine.py || true
	$(PY) -m pytest -n auto --dist worksteal --assert=plain -m "not validate and not slow" || \
	{ $(PY) -m pytest -n0 --last-failed --last-failed-no-failures none -m "not validate and not slow"; exit 1; }

mutate: .venv/.dev # every rule of a verdict and every measure broken in every way; also a part of the tests
	$(PY) -m pytest tests/shelves/test_every_rule.py tests/shelves/test_every_measure.py -k break -m "slow or not slow" -v -n0

validate: .venv/.dev
	$(PY) -m pytest -m validate -s

league: .venv/.dev # predictions of real machines and animals, into docs/league.md; NAME=amphibot predicts one alone
	$(PY) -m evidence.league $(NAME) --out out/league
	$(if $(NAME),,$(PY) tools/league_page.py out/league)

evidence: atlas league validate # everything that stands beside the tests, and takes hours

atlas: .venv/.runtime # published flows beside ours, into docs/atlas.md; goes on where it stopped
	$(PY) -m evidence.atlas --out out/atlas
	$(PY) tools/atlas_page.py out/atlas

.venv/.base: pins.txt # only a pip of today compares digests of what is asked for by name
	$(PYTHON) -m venv .venv
	sed -n '/^pip==/,/[^\\]$$/p' pins.txt > .venv/pip.txt
	$(PIP) --require-hashes --requirement .venv/pip.txt
	touch $@

.venv/.runtime: .venv/.base pyproject.toml pins.txt
	@echo "Installing suchus into .venv (once, about a minute) ..."
	$(PY) tools/needs.py > .venv/needs.txt
	$(PIP) $(NEEDED)
	$(EDITABLE)
	touch $@

.venv/.dev: .venv/.base pyproject.toml pins.txt
	@echo "Installing suchus and what its tests need into .venv (once, half a minute) ..."
	$(PY) tools/needs.py dev > .venv/needs.txt
	$(PIP) $(NEEDED)
	$(EDITABLE)
	touch .venv/.runtime $@

.venv/.docs: .venv/.dev
	$(PY) tools/needs.py dev docs > .venv/needs.txt
	$(PIP) $(NEEDED)
	touch $@

stale: .venv/.dev # which results are old, and what it costs to compute them again; in under three minutes
	@SUCHUS_THREADS=1 $(PY) -m evidence.stale $(NAME)

renew: .venv/.dev # make renew NAME="turning rehearsal": computes results again, and writes the pages that state them
	@$(PY) -m evidence.renew $(NAME)

converge: .venv/.dev # every measure at its time step, a half and a quarter of it; goes on where it stopped
	@$(PY) -m evidence.converge $(NAME)

bench: .venv/.dev
	@for f in bench/bench_*.py; do echo; echo "== $$f"; $(PY) "$$f" || exit 1; done

docs: .venv/.docs # with the laboratory in one page, unless npm is missing
	@$(PY) tools/fetch_engine.py || true
	NO_MKDOCS_2_WARNING=1 $(PY) -m mkdocs build --strict
	@echo site/index.html

release: .venv/.dev # wheel and sdist, tried in fresh environments; nothing is published
	$(PY) tools/make_release.py

reliability: .venv/.dev # the batteries again, and their table in docs/reliability.md
	$(PY) tools/reliability.py

version: .venv/.dev # whether all places and the tag of this commit say the same version
	$(PY) tools/make_release.py --check

tag: .venv/.dev # an annotated tag of the version, for a commit that is to be released; nothing is pushed
	$(PY) tools/make_release.py --tag

pins: .venv/.dev # pins.txt anew, after a version in constraints.txt has changed
	$(PY) tools/pins.py

licences: .venv/.dev # of every package of every extra and of the development tools, installed or not
	@$(PY) tools/licences.py

matrix: .venv/.dev # every Python that is here, newest and lowest versions
	$(PY) tools/matrix.py $(TESTS)

sizes: .venv/.dev # tables in CONTRIBUTING.md and tests/README.md anew
	$(PY) tools/sizes.py
	SUCHUS_LISTS=write $(PY) -m pytest -n0 -k test_the_list_says_what_is_left_out tests

clean:
	rm -rf .venv out build dist site
