# Needs Python 3.10 or later, make, and a network to the package index. Everything else goes to .venv.

PYTHON ?= python3
JOBS ?= 2
# The many processes of a test run import the same modules: they share what Python compiled.
unexport PYTHONDONTWRITEBYTECODE

VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
DOCS_READY := $(VENV)/.ready-docs
BENCH_READY := $(VENV)/.ready-bench
PHYSICS_READY := $(VENV)/.ready-physics
EXPERIMENTS_READY := $(VENV)/.ready-experiments
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
# Runs a command and, however it ends, leaves none of its descendants behind.
ALONE := $(BIN)/python tools/supervise.py
BEGAN := $(shell $(PYTHON) -c 'import time; print(time.time())')
TESTS = $(ALONE) $(BIN)/python -m tools.run_tests --began $(BEGAN) --ready $(READY)
CHECKED := src tests tools benchmarks examples
BENCHMARKS := $(filter-out $(addprefix benchmarks/,big_system.py experiments.py speed.py),$(wildcard benchmarks/*.py))

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:

.PHONY: help
help:  ## Show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

ROBOT := feeding_robot
DEMO = examples/$(if $(filter feeding_robot--,$(ROBOT)-$(PHYSICS)-$(CLOCK)),feeding_robot/demo.py,faults/demo.py $(ROBOT) \
  $(if $(PHYSICS),--physics) $(if $(CLOCK),--clock $(CLOCK)))

.PHONY: demo
demo: $(READY) $(if $(PHYSICS),$(PHYSICS_READY))  ## Start the feeding robot in its fifteen test cases; ROBOT=frobit, kobuki, intelligent_one, or PHYSICS=1: in its faults
	@$(ALONE) $(BIN)/python $(DEMO)

.PHONY: test
test: $(READY)  ## Run the tests, those on the real middleware included
	@$(TESTS) --slow-share=0

.PHONY: test-all
test-all: $(READY)  ## Run the slow tests too, and 500 examples of each property instead of 50
	@$(TESTS) --hypothesis-profile=ci

.PHONY: test-rest
test-rest: $(READY)  ## After make test: a tenth of the slow tests, and what lacked a program then
	@$(TESTS) --slow-share=0.1 --draw=$$(git rev-parse HEAD) --hypothesis-profile=drawn \
	  --after=.tmp/tests.json --record=.tmp/tests-rest.json

.PHONY: physics
physics: $(PHYSICS_READY)  ## Install MuJoCo, without which the robots in physics are not tested

.PHONY: pairs
pairs: $(READY)  ## Compare monitors with the reference on 120,000 random pairs (nightly)
	@$(ALONE) $(BIN)/python -m tools.property --jobs $(JOBS)

.PHONY: property
property: $(READY)  ## Run 5,000 new examples of each property (nightly)
	@$(ALONE) $(BIN)/python -m pytest -n $(JOBS) -m hypothesis --hypothesis-profile nightly

.PHONY: repeat
repeat: $(READY)  ## Run tests on ROS in ten rounds on a busy machine (nightly)
	@$(ALONE) $(BIN)/python -m tools.repeat --jobs $(JOBS) --draw=$$(git rev-parse HEAD)

.PHONY: gate-times
gate-times: $(READY)  ## Kill and stop the safety node 100 times, and time the gate's zeros (nightly)
	@DEROS_REPEATS=100 $(ALONE) $(BIN)/python -m pytest -q -s \
	  tests/generators/gate/python/test_dead_safety_node.py

.PHONY: sanitize
sanitize: $(READY)  ## Compare monitors in C with the reference, watched by gcc's sanitizers
	@$(ALONE) $(BIN)/python -m tools.sanitize $(if $(PROGRAMS),--programs $(PROGRAMS))

.PHONY: fuzz
fuzz: $(READY)  ## Fuzz the monitors in C of the examples, 30 seconds each; needs clang
	@$(ALONE) $(BIN)/python -m tools.fuzz

.PHONY: fuzz-models
fuzz-models: $(READY)  ## Fuzz models, definitions, traces and messages for a minute; FUZZ="--seconds 36000" at night
	@$(ALONE) $(BIN)/python -m tools.fuzz_models --jobs $(JOBS) $(FUZZ)

.PHONY: misra
misra: $(READY)  ## Hold the emitted C against MISRA C:2012; needs cppcheck
	@$(ALONE) $(BIN)/python -m tools.misra

.PHONY: prove
prove: $(READY)  ## Prove what the ledger lacks of the monitors in C of the examples; needs Frama-C
	@$(ALONE) $(BIN)/python -m tools.prove --new $(if $(RECORD),--record) --jobs $(JOBS) $(RULES)

.PHONY: prove-all
prove-all: $(READY)  ## Prove that the monitors in C of the examples do what the rules mean
	@$(ALONE) $(BIN)/python -m tools.prove --check --jobs $(JOBS) $(RULES)

.PHONY: slips
slips: $(READY)  ## Put every single slip into the C that is proved, and see the proof find each; takes hours
	@$(ALONE) $(BIN)/python -m tools.mutate_proof --jobs $(JOBS) $(if $(SHARE),--share $(SHARE))

.PHONY: chaos
chaos: $(READY)  ## Break the driving robot at random 200 times, two faults at a time (nightly)
	@$(ALONE) $(BIN)/python -m tools.chaos --rounds 200 $(CHAOS)

.PHONY: reruns
reruns: $(READY)  ## List the tests on ROS that passed only when run again, in the last week
	@$(BIN)/python -m tools.reruns

.PHONY: nightly
nightly: $(READY)  ## Run all that takes too long for a change, and print one table; takes hours
	@$(ALONE) $(BIN)/python -m tools.nightly

.PHONY: lint
lint: $(READY)  ## Check format, style, types and the layering of the packages
	$(BIN)/ruff format --check $(CHECKED)
	$(BIN)/ruff check $(CHECKED)
	$(BIN)/mypy
	MYPYPATH=benchmarks $(BIN)/mypy benchmarks
	$(BIN)/lint-imports

.PHONY: elkjs
elkjs: $(READY)  ## Fetch what lays out the page of deros graph --format html; needs npm
	@$(BIN)/python -m tools.fetch_elkjs

.PHONY: vscode
vscode: $(READY)  ## Package the extension for VS Code into dist/; needs npm
	@$(BIN)/python -m tools.vscode

.PHONY: editor
editor: $(READY)  ## See the extension in a real VS Code, which npm installs (600 MB, once); needs chromium
	@$(ALONE) $(BIN)/python -m pytest -q -m slow tests/editors $(if $(PICTURES),--refresh-golden)

.PHONY: distribution
distribution: elkjs  ## Build sdist and wheel; use them with the lowest and the newest versions
	@$(ALONE) $(BIN)/python -m tools.distribution

.PHONY: docs
docs: $(DOCS_READY)  ## Build the documentation into site/; a warning is an error
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --strict

.PHONY: bench
bench: $(BENCH_READY)  ## Measure; prints ratios against a floor measured in the same run
	@for each in $(BENCHMARKS); do echo "== $$each"; $(ALONE) $(BIN)/python $$each || exit 1; done

.PHONY: experiments
experiments: $(EXPERIMENTS_READY)  ## Repeat the paper's experiments; page, Parquet and recordings in .tmp/experiments
	@$(ALONE) $(BIN)/python benchmarks/experiments.py --output .tmp/experiments $(EXPERIMENTS)

.PHONY: golden
golden: $(READY)  ## Refresh the expectations in tests/golden and tests/cases, to be reviewed as a diff
	$(BIN)/python tests/cases/refresh.py
	$(BIN)/python -m pytest -q tests/generators -k 'match_golden or matches_golden' --refresh-golden

.PHONY: killing-pairs
killing-pairs: $(READY)  ## Search again for the pairs that kill the slips planted in monitors; takes half an hour
	$(BIN)/python -m pytest -q tests/generators/monitor -k mutation_is_detected -m "not slow" --refresh-killing-pairs

.PHONY: speed
speed: $(READY)  ## Compare the speed of generated monitors with that of an earlier version (nightly)
	@$(ALONE) $(BIN)/python benchmarks/speed.py $(if $(AGAINST),--against=$(AGAINST))

.PHONY: clean
clean:  ## Remove the environment and everything built
	rm -rf $(VENV) build dist site .demo .tmp .mypy_cache .ruff_cache .pytest_cache .hypothesis

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || \
	  { echo "deros needs Python 3.10 or later; name one with: make PYTHON=python3.12 …" >&2; exit 1; }
	@echo "setting up $(VENV) (once; about 300 MB, most of it ROS 2 Jazzy)"
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); exit 1; }

$(READY): pyproject.toml | $(BIN)/python
	@$(PIP) install --editable '.[dev]'
	@$(BIN)/python -m tools.fetch_elkjs --if-possible
	@$(BIN)/python -c 'open("$@", "w")'

$(BENCH_READY): pyproject.toml | $(READY)
	@$(PIP) install --editable '.[bench]'
	@$(BIN)/python -c 'open("$@", "w")'

$(PHYSICS_READY): pyproject.toml | $(READY)
	@$(PIP) install --editable '.[physics]'
	@$(BIN)/python -c 'open("$@", "w")'

$(EXPERIMENTS_READY): pyproject.toml | $(READY)
	@$(PIP) install --editable '.[experiments]'
	@$(BIN)/python -c 'open("$@", "w")'

$(DOCS_READY): pyproject.toml | $(READY)
	@$(PIP) install --editable '.[docs]'
	@$(BIN)/python -c 'open("$@", "w")'
