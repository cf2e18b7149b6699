# Requirements: make and Python 3.11 or newer with its venv module (Debian: python3-venv).
# Another interpreter: make run PYTHON=python3.12
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: run test test-slow test-all test-rounding test-changed lint lint-style lint-types check docs benchmark pictures screens requests faults clean
.DELETE_ON_ERROR:

run: $(VENV)/.installed
	$(BIN)/slidercrank optimise runs/feeder.toml

# Tests start hundreds of processes, and each would compile all sources.
export PYTHONDONTWRITEBYTECODE :=
# Tests already use every processor; further threads of OpenBLAS spin while they wait, a sixth of the processor time.
export OPENBLAS_NUM_THREADS := 1

# Three for two processors, because many tests wait for processes and pages; each takes a quarter of a minute to collect
# all tests, and imports what they need. At most 8, because each loads its own numba.
WORKERS := $(shell expr \( $$(getconf _NPROCESSORS_ONLN) \* 3 + 1 \) / 2)
PYTEST := $(BIN)/python -m pytest -n $(WORKERS) --maxprocesses 8 --dist worksteal
MARKED := not slow
test: $(VENV)/.installed-test
	@$(BIN)/python -m slidercrank.model.kernel.compile_all slidercrank.optimise slidercrank.model
	$(PYTEST) -m '$(MARKED)'

# Faults, installed copies, long runs through API and documentation, and every other test over a second.
test-slow: $(VENV)/.installed-test
	$(PYTEST) -m slow

# Both at once, so that the other tests fill the pauses of the slow ones.
test-all: MARKED :=
test-all: test

# Results under different rounding, without fused multiply-add or this processor's wide vectors. A part that takes a
# minute; all of them: make test-rounding ROUNDING="tests/model tests/objectives tests/optimise"
ROUNDING ?= tests/optimise/test_shipped_jobs.py tests/optimise/test_known_optima.py
test-rounding: $(VENV)/.installed-test
	NUMBA_CPU_NAME=generic OPENBLAS_CORETYPE=Nehalem $(BIN)/python -m pytest $(ROUNDING)

lint: lint-style lint-types

lint-style: $(VENV)/.installed-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

lint-types: $(VENV)/.installed-test
	$(BIN)/mypy

# While working: lint, types, and the tests of files that differ from a branch, chosen by tests/changed.py. If all of
# them are slow, they run anyway.
BASE ?= main
CHECKS := lint-types test-changed lint-style
check: $(VENV)/.installed-test
	@$(MAKE) --no-print-directory --jobs=$$(getconf _NPROCESSORS_ONLN) --output-sync=target $(CHECKS)

test-changed: $(VENV)/.installed-test
	@files=$$($(BIN)/python -m tests.changed $(BASE)) || exit; \
	if test -z "$$files"; then echo 'no source file differs from $(BASE)'; \
	else $(BIN)/python -m pytest -q -m 'not slow' $$files; code=$$?; \
	  if test $$code -eq 5; then $(BIN)/python -m pytest -q $$files; else exit $$code; fi; fi

# The documentation site, into site/. A warning is an error.
docs: $(VENV)/.installed-test
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet --strict

benchmark: $(VENV)/.installed-benchmark
	$(BIN)/python -m benchmarks

# The pictures in README and docs; use a quiet machine, because they show times.
pictures: $(VENV)/.installed-benchmark
	$(BIN)/python -m benchmarks.pictures

# Every view of the page on four screens, light and dark, into docs/screens, to be looked at one by one.
screens: $(VENV)/.installed-test
	$(BIN)/python -m benchmarks.screens

# Requests generated from the API description: about twenty minutes.
requests: $(VENV)/.installed-test
	$(BIN)/python -m tests.service.api.schema_cases 10000 1

# Kills, pauses, crashes of databases, full disks: about half an hour.
faults: $(VENV)/.installed-test
	$(BIN)/python -m tests.faults

clean:
	rm -rf $(VENV) .package/typing build dist site *.egg-info .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find .package model objectives optimise service tests benchmarks -name __pycache__ -prune -exec rm -rf {} +

# The pip included with Python may be years old and take twice as long.
$(VENV)/.created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and \
	  "Python 3.11 or newer is needed, this is %d.%d; name another one: make PYTHON=python3.12" % sys.version_info[:2])'
	@$(PYTHON) -m venv --clear $(VENV) || \
	  { rm -rf $(VENV); echo 'Python without venv; on Debian: apt install python3-venv' >&2; exit 1; }
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt pip
	@touch $@

, := ,

# Editable: the folders are used where they are, so that a change needs no new installation. pip would compile all
# sources on one processor, which is half of its time; a third of the sources are the packages' own tests.
define install
	@echo 'Installing into $(VENV) (about a minute) ...'
	@$(BIN)/python .package/links.py
	@PYTHONWARNINGS=ignore $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile -c constraints.txt -e '.$(1)'
	@$(BIN)/python -m compileall -qq -j 0 -x '[/\\]tests[/\\]' '$(CURDIR)/$(VENV)/lib' || true
	@touch $(VENV)/.installed $@
endef

$(VENV)/.installed: $(VENV)/.created pyproject.toml constraints.txt
	$(call install,[all])

$(VENV)/.installed-test: $(VENV)/.created pyproject.toml constraints.txt
	$(call install,[test])

$(VENV)/.installed-benchmark: $(VENV)/.created pyproject.toml constraints.txt
	$(call install,[test$(,)benchmark])

include .javascript/rules.mk
