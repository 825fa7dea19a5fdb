# `make report` and `make test` set everything up on a fresh machine with Python >= 3.11 (with venv) and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# Imports compile the few modules that we use, so pip need not compile all. The warning concerns sibling folders.
INSTALL = PYTHONWARNINGS=ignore $(BIN)/python -m pip install --quiet --no-compile --editable

NUMERICAL := tests/reference_model tests/exudyn_models tests/fmu_models tests/compare/studies tests/compare/claims
SIMD := 'import numpy; print(*numpy.show_config("dicts")["SIMD Extensions"].get("found", ()))'

# If it is set, as in many images, every process compiles all these modules again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: report findings test test-plain lint docs paper dist benchmarks clean

report: $(VENV)/installed
	$(BIN)/friction-discs report

# Writes docs/findings.md and its numbers from the last report. .ci/run fails if a report deviates from them.
findings: $(VENV)/installed
	$(BIN)/python builders/findings.py write report/results.json

test: $(VENV)/for-tests
	$(BIN)/pytest --numprocesses auto --dist worksteal

# Rounds as a processor without AVX and FMA does: BLAS, numpy and compiled kernels then sum in another order.
test-plain: $(VENV)/for-tests
	OPENBLAS_CORETYPE=Nehalem NUMBA_CPU_NAME=generic NPY_DISABLE_CPU_FEATURES="$$($(BIN)/python -c $(SIMD))" \
	$(BIN)/pytest --numprocesses auto --dist worksteal $(NUMERICAL)

lint: $(VENV)/for-tests
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python builders/check_prose.py

# Builds the site in site/index.html, with the last report if it exists. A warning is an error.
docs: $(VENV)/for-docs
	$(BIN)/python docs/site/build.py

# Builds the paper about the findings, docs/paper/paper.pdf, with the figures of the last report.
paper: $(VENV)/for-docs
	$(BIN)/python docs/paper/build.py

# Builds and checks the wheel and the source archive.
dist: $(VENV)/installed
	$(INSTALL) '.[release]'
	rm -rf dist
	$(BIN)/python builders/release.py dist

benchmarks: $(VENV)/for-tests
	$(BIN)/python benchmarks/exudyn_contact.py
	$(BIN)/python benchmarks/exudyn_solvers.py
	$(BIN)/python benchmarks/reference_evaluations.py
	$(MAKE) --directory benchmarks/limit
	$(BIN)/python benchmarks/ensemble.py
	$(BIN)/python benchmarks/ensemble_discs.py
	$(BIN)/python benchmarks/single_runs.py
	$(BIN)/python benchmarks/sweep_cost.py
	$(BIN)/python benchmarks/sweep_cluster.py

clean:
	rm -rf $(VENV) report report.data report-part report-part.data site docs/paper/paper.pdf build dist *.egg-info

$(VENV)/installed: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(INSTALL) '.[sweep]'
	touch $@

# A report does not need the packages for tests.
$(VENV)/for-tests: $(VENV)/installed
	$(INSTALL) '.[test,lint]'
	touch $@

$(VENV)/for-docs: $(VENV)/installed
	$(INSTALL) '.[docs]'
	touch $@
