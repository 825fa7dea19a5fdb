# `make report` and `make test` each do all that a fresh machine needs: Python >= 3.11 with venv, and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# What is imported is compiled then: most of what libraries have is not. The warning is about folders beside this one's.
INSTALL = PYTHONWARNINGS=ignore $(BIN)/python -m pip install --quiet --no-compile --editable

# Where it is set, as in many images, each of the many processes would compile all of these modules anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: report findings test lint docs paper dist benchmarks clean

report: $(VENV)/installed
	$(BIN)/friction-discs report

# Writes docs/findings.md and its numbers from the last report; .ci/run fails where a report deviates from them.
findings: $(VENV)/installed
	$(BIN)/python builders/findings.py write report/results.json

test: $(VENV)/for-tests
	$(BIN)/python -m pytest --numprocesses auto --dist worksteal

lint: $(VENV)/for-tests
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# The site: site/index.html, with the last report if there is one. A warning is an error.
docs: $(VENV)/for-docs
	$(BIN)/python docs/site/build.py

# The paper about the findings, docs/paper/paper.pdf, with the figures of the last report.
paper: $(VENV)/for-docs
	$(BIN)/python docs/paper/build.py

# Wheel and source archive, and a check that each holds what it should.
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

# Whoever only wants a report does not wait for what tests need.
$(VENV)/for-tests: $(VENV)/installed
	$(INSTALL) '.[test,lint]'
	touch $@

$(VENV)/for-docs: $(VENV)/installed
	$(INSTALL) '.[docs]'
	touch $@
