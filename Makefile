# Everything a person or a machine does with a checkout. `make help` names it.
PYTHON ?= python3
PYTHONS ?= $(PYTHON)
VENV := .venv
BIN := $(VENV)/bin
# In the order of collection, pages and processes before many small files, so that both cores end together.
PARALLEL := -n auto --no-loadscope-reorder
# Each worker has a core of its own; threads of linear algebra would only take it from the other workers.
# Bytecode is stored whatever the environment says: each worker, and each program that a test starts, reads it.
PYTEST = PYTHONDONTWRITEBYTECODE= OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest $(PARALLEL)
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt

# Real scenes and maps lie beside the checkout where they are at hand; tests read this variable alone.
ifneq ($(wildcard ../shared/data),)
export LIFELORE_DATA ?= $(abspath ../shared/data)
endif

# Deep RL has an environment of its own: torch is large, and nothing else needs it.
DEEP := .venv-deep
DEEP_TESTS = $(shell grep -rl --include='*.py' 'mark\.deep' tests)

PYTHON_FILES := src reproduction benchmarks fuzz tests examples docs/conf.py docs/pictures

.PHONY: help setup setup-test demo test test-fast test-deep test-cluster coverage check format bench soak fuzz docs reproduction-pages \
	wheel-test reproduce clean

help: ## Name every target
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 20

setup: $(BIN)/.core ## The environment with the core, in .venv

setup-test: $(BIN)/.test ## The same with everything tests and checks need

$(BIN)/.core: pyproject.toml constraints.txt
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(PIP) --editable .
	$(BIN)/lifelore doctor --warm
	touch $@

$(BIN)/.test: $(BIN)/.core
	$(PIP) --editable '.[test]'
	$(PIP) --no-deps obp==0.4.1  # the logs of docs/fashion_shop.md; only its programs need its dependencies
	touch $@

demo: setup ## Hidden goals are searched, known ones driven to, in a generated office; picture out/demo/demo.png
	mkdir -p out/demo
	$(BIN)/lifelore live --memory out/demo/lifelore.db --out out/demo/hidden
	$(BIN)/lifelore live --goals examples/data/courier.csv --memory out/demo/lifelore.db --out out/demo/known
	$(BIN)/python examples/demo/picture.py out/demo

test: setup-test ## The tests and the examples in docstrings, on all cores
	$(PYTEST) -m "not soak" tests reproduction/engine src/lifelore

test-fast: setup-test ## The quick part of the tests: no claims, processes or pictures
	$(PYTEST) -m "not soak and not slow"

coverage: setup-test ## The share of lines that the tests run; the lines in out/coverage
	$(PYTEST) -m "not soak" --cov=lifelore --cov-report=html:out/coverage --cov-report=term:skip-covered tests src/lifelore

test-deep: $(DEEP)/.ready ## The tests of the extra deep (torch), in .venv-deep
	$(DEEP)/bin/python -c "import torch, stable_baselines3, sb3_contrib, minigrid"
	$(DEEP)/bin/python -m pytest -m deep $(DEEP_TESTS)

$(DEEP)/.ready: pyproject.toml constraints.txt constraints-deep.txt
	test -x $(DEEP)/bin/python || $(PYTHON) -m venv $(DEEP)
	$(DEEP)/bin/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt \
		--constraint constraints-deep.txt --editable '.[deep,envs,postgres]' pytest hypothesis
	touch $@

test-cluster: setup-test ## The tests of the extra cluster (dask.distributed), in .venv
	$(PIP) --editable '.[cluster]'
	$(BIN)/python -c "import distributed"
	$(BIN)/python -m pytest tests/reproduction/test_cluster.py

check: setup-test ## Formatting, lint, types, direction of imports
	$(BIN)/ruff format --check $(PYTHON_FILES)
	$(BIN)/ruff check $(PYTHON_FILES)
	$(BIN)/pyright
	$(BIN)/lint-imports

format: setup-test ## Mend formatting and what lint can mend
	$(BIN)/ruff format $(PYTHON_FILES)
	$(BIN)/ruff check --fix $(PYTHON_FILES)

bench: setup-test ## Speed beside peers, side by side in one process: make bench NAME=kernels
	$(BIN)/python -m benchmarks $(NAME)

soak: setup-test ## Long runs: 200 kills of lives, 50 of the service under load, 200 beside its client, 100,000 hostile clouds
	$(BIN)/python -m pytest -m soak

reproduction-pages: setup-test ## The pages of docs/reproduction and the gallery from the committed results
	$(BIN)/python -m reproduction.engine.pages

docs: reproduction-pages $(BIN)/.docs ## The site in out/docs; a name that nothing explains fails
	$(BIN)/sphinx-build -q -n -W --keep-going --fresh-env docs out/docs
	@echo "out/docs/index.html"

$(BIN)/.docs: $(BIN)/.test
	$(PIP) --editable '.[docs]'
	touch $@

wheel-test: setup-test ## The wheel in a clean environment outside the checkout; PYTHONS="python3.12 python3.13"
	BUILDER=$(abspath $(BIN)/python) .ci/wheel-test $(PYTHONS)

fuzz: setup-test ## Readers under damaged input, an hour each; NAME=pcd SECONDS=60
	$(PIP) --editable '.[fuzz]'
	$(BIN)/python -m fuzz $(NAME) --seconds $(or $(SECONDS),3600)

reproduce: setup ## Every built claim at full size
	$(BIN)/lifelore reproduce --full

clean: ## Remove the environment and caches
	rm -rf $(VENV) $(DEEP) .pytest_cache .ruff_cache .hypothesis out
