# Schuler Bench. `make run` serves the dashboard, `make test` checks and tests everything.
# Kept to what GNU make 3.81 (the one of macOS) understands.

SHELL  := /bin/sh
BIN    := .venv/bin
STAMPS := .venv/.stamps
PIP    := $(BIN)/python -m pip --disable-pip-version-check --no-input --quiet
# Says every two seconds that a step goes on: pip and venv say nothing.
TICK   := seconds=0; while sleep 2; do seconds=$$((seconds + 2)); echo "   ... $$seconds s"; done & tick=$$!; trap 'kill $$tick' EXIT
# Not compiled to bytecode: that takes half of the time, and an import compiles what it needs.
LOCKED := install --no-compile --require-hashes --only-binary :all:

# A virtual environment that was copied, moved, or has lost its Python is made anew.
MADE_HERE := $(shell test "`cat $(STAMPS)/python 2>/dev/null`" = "`pwd -P`" && $(BIN)/python -c 'import pip' 2>/dev/null && echo yes)
ifneq ($(MADE_HERE),yes)
$(STAMPS)/python: REMAKE
endif

KERNEL_SOURCES := $(shell find navcore -name '*.py' 2>/dev/null)

.PHONY: help setup run test nightly check docs format unit windows paint soak serving tour accuracy covariance tuning consistency design benchmarks mutation papers cards guide languages wheel sbom audit lock clean REMAKE

help:
	@echo 'make run      install what is needed, then serve the dashboard and open it in the browser (PORT=...: there)'
	@echo 'make test     install what is needed, then lint, check types and run the tests of all parts'
	@echo '              SLOW=yes: with the slow ones, twice as long, as continuous integration does'
	@echo 'make setup    .venv with the command .venv/bin/schuler, kernels compiled'
	@echo 'make check    lint, format and types only'
	@echo 'make unit     the fast tests only'
	@echo 'make nightly  every test, with the sweeps that make test leaves out'
	@echo 'make windows  the points of the page in all windows and languages; make test has one of the six for each'
	@echo 'make docs     build the site into build/docs: tutorial, theory, lessons, notebooks, API; a warning is an error'
	@echo 'make benchmarks  time the strapdown engine beside python-ins, which it installs into .venv'
	@echo 'make papers   run the presets of the five papers and write docs/papers.md with its pictures anew'
	@echo 'make paint    time from a slider step to the last paint of it in Chromium'
	@echo 'make soak     30 visitors for 30 minutes on one server, then floods: one table (CLIENTS=, BROWSERS=, MINUTES=)'
	@echo '              HOURS=12: ten visitors who come and go on a server that is restarted at random'
	@echo '              HOURS=12 PIECE=60: an hour of it; the next call goes on'
	@echo 'make serving  run what docs/serving.md names, and write its table from that and from the last soak'
	@echo 'make mutation  change the code of navcore at random, and see which changes no test notices (SAMPLE=, SEED=)'
	@echo 'make accuracy  what the strapdown engine is accurate to, figure by figure'
	@echo 'make covariance  the error budget beside 2,000 seeds (SEEDS=), and beside 200 seeds of 40 random ships'
	@echo 'make tuning   the tuning beside a fine grid, with its times; 200 random tunings, of which none may diverge'
	@echo 'make design   write docs/design.md with its table over the presets anew'
	@echo 'make consistency  the covariance of the Kalman filter against 500 seeds (SEEDS=)'
	@echo 'make tour     film the README pictures in Chromium: docs/tour.webp, docs/dashboard.png'
	@echo 'make format   lay the code out'
	@echo 'make languages  collect the texts of the page, and compile their translations'
	@echo 'make guide    write docs/scenario.md, docs/networks.md, the questions of docs/interface.md and the JSON Schema anew'
	@echo 'make wheel    a wheel with compiled kernels, into dist: its first start compiles nothing on most processors'
	@echo 'make sbom     write build/sbom.json (CycloneDX) from the lock: what an installation holds; needs no network'
	@echo 'make audit    look the locked packages up among the published vulnerabilities; needs the network'
	@echo 'make lock     resolve the locked requirements again (UPGRADE=--upgrade: to the newest versions)'
	@echo 'make clean    remove .venv and everything that was made'
	@echo 'PYTHON=...    the Python to make .venv with (3.11 or newer)'

setup: $(STAMPS)/kernels

# The server compiles the kernels beside itself: the first picture needs half of them.
run: $(STAMPS)/project
	@echo '== starting the server'
	@$(BIN)/schuler serve --open $(if $(findstring command,$(origin PORT)),--port $(PORT))

# SLOW=yes: the tests that are marked slow too, as before a merge.
test: setup $(STAMPS)/test
	@$(if $(SLOW),,SCHULER_QUICK=yes) $(BIN)/python -m tools.stages

nightly: setup $(STAMPS)/test
	@SCHULER_NIGHTLY=yes $(BIN)/python -m tools.stages

check: $(STAMPS)/test
	@$(BIN)/python -m tools.stages lint

# BEFORE=folder: a checkout of an earlier commit, measured beside this one.
paint: setup $(STAMPS)/test
	@$(BIN)/python -m tools.paint.last_paint
	@$(BIN)/python -m tools.paint.hand $(if $(BEFORE),--before $(BEFORE))

# CLIENTS=30 BROWSERS=3 MINUTES=30: so many visitors, so many of them browsers, for so long.
# HOURS=12: a server left alone for so long, ended and started at random, in place of the lecture.
soak: setup $(STAMPS)/test
	@$(if $(HOURS),$(BIN)/python -m tools.serving.unattended --hours $(HOURS) $(if $(PIECE),--piece $(PIECE)) \
	  --json build/unattended.json,\
	  $(BIN)/python -m tools.serving.soak --clients $(or $(CLIENTS),30) --browsers $(or $(BROWSERS),3) \
	  --minutes $(or $(MINUTES),30) --json build/soak.json)

# The tests that tools/serving/rows.toml names, and what the last `make soak` has left in build/soak.json.
serving: setup $(STAMPS)/test
	@$(BIN)/python -m tools.serving.table

tour: setup $(STAMPS)/test
	@$(BIN)/python -m tools.tour

# SAMPLE=60 SEED=1: so many changes a room, drawn by this seed. RESULTS=folder: goes on from what is kept there.
mutation: setup $(STAMPS)/test
	@$(BIN)/python -m tools.mutation --sample $(or $(SAMPLE),60) --seed $(or $(SEED),1) \
	  --folder $(or $(RESULTS),build/mutation)

# Each point of the page in each of three windows in both languages: six runs; make test has one of them for each.
windows: setup $(STAMPS)/test
	@SCHULER_NIGHTLY=yes $(BIN)/python -m pytest -q -n2 --dist=worksteal tests/browser/windows

unit: setup $(STAMPS)/test
	@$(BIN)/python -m tools.stages unit

docs: setup $(STAMPS)/docs
	@$(BIN)/python -m docs.site

accuracy: setup $(STAMPS)/test
	@$(BIN)/python -m tools.accuracy

covariance: setup $(STAMPS)/test
	@$(BIN)/python -m tools.covariance $(SEEDS)
	@$(BIN)/python -m tools.predicted

tuning: setup $(STAMPS)/test
	@$(BIN)/python -m tools.tuning

design: setup
	@$(BIN)/python -m tools.design_table

consistency: setup
	@$(BIN)/python -m tools.filter_consistency --seeds $(or $(SEEDS),500)

# YARDSTICK=FILE: a Python file whose quick(samples, repeats) gives the ns a sample of a reference.
benchmarks: setup $(STAMPS)/benchmarks
	@SCHULER_YARDSTICK='$(YARDSTICK)' $(BIN)/python -m tools.benchmarks

format: $(STAMPS)/test
	@$(BIN)/ruff check --fix --select I .
	@$(BIN)/ruff format .

# ---------------------------------------------------------------- the virtual environment, step by step

$(STAMPS)/python:
	@python=''; for candidate in $(if $(PYTHON),"$(PYTHON)",python3 python3.14 python3.13 python3.12 python3.11); do \
	  if "$$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; then python=$$candidate; break; fi; \
	done; \
	if [ -z "$$python" ]; then \
	  echo 'Schuler Bench needs Python 3.11 or newer; found: $(if $(PYTHON),$(PYTHON),python3) =' \
	    "`$(if $(PYTHON),"$(PYTHON)",python3) --version 2>/dev/null || echo none`" >&2; \
	  echo 'Install one, or name it: make PYTHON=/path/to/python3.12 $(MAKECMDGOALS)' >&2; exit 1; \
	fi; \
	if ! "$$python" -c 'import venv, ensurepip' >/dev/null 2>&1; then \
	  echo "$$python has no venv module. On Debian or Ubuntu: apt-get install python3-venv" >&2; exit 1; \
	fi; \
	echo "== virtual environment of `"$$python" --version`"; \
	rm -rf $(STAMPS); \
	if $(BIN)/python -c 'import pip, sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; then clear=; else clear=--clear; fi; \
	$(TICK); "$$python" -m venv $$clear .venv
	@mkdir -p $(STAMPS) && pwd -P > $@

$(STAMPS)/packages: requirements/run.lock requirements/build.lock $(STAMPS)/python
	@echo '== installing the locked packages'; start=`date +%s`; $(TICK); \
	$(PIP) $(LOCKED) -r requirements/run.lock -r requirements/build.lock && \
	echo "== installed in $$((`date +%s` - start)) s" && echo $$((`date +%s` - start)) > $@

# The version is in navcore/foundation/version.py, the command in pyproject.toml.
$(STAMPS)/project: pyproject.toml navcore/foundation/version.py $(STAMPS)/packages | schuler_bench
	@$(TICK); $(PIP) install --no-deps --no-build-isolation --no-index --editable . && touch $@

# The folder app by the name under which it is imported; git holds this link, the source distribution does not.
schuler_bench:
	@ln -s app $@

$(STAMPS)/kernels: $(STAMPS)/project $(KERNEL_SOURCES)
	@echo '== compiling the kernels'; start=`date +%s`; \
	$(BIN)/python -m navcore.warm && \
	echo "== compiled in $$((`date +%s` - start)) s" && echo $$((`date +%s` - start)) > $@

$(STAMPS)/test: requirements/test.lock $(STAMPS)/project
	@echo '== installing the locked packages of the tests'; start=`date +%s`; \
	$(PIP) $(LOCKED) -r requirements/test.lock && \
	echo "== installed in $$((`date +%s` - start)) s" && echo $$((`date +%s` - start)) > $@

$(STAMPS)/docs: requirements/docs.lock $(STAMPS)/project
	@echo '== installing the locked packages of the site'
	@$(PIP) $(LOCKED) -r requirements/docs.lock && touch $@

$(STAMPS)/supply: requirements/supply.lock $(STAMPS)/project
	@$(PIP) $(LOCKED) -r requirements/supply.lock && touch $@

# What it needs itself is in requirements/run.lock.
$(STAMPS)/benchmarks: requirements/benchmarks.lock $(STAMPS)/project
	@$(PIP) $(LOCKED) --no-deps -r requirements/benchmarks.lock && touch $@

# ---------------------------------------------------------------- upkeep

papers: setup $(STAMPS)/test
	@$(BIN)/python -m tools.papers

cards: $(STAMPS)/project
	@$(BIN)/python -m schuler_bench.views.start.cards

guide: $(STAMPS)/project
	@$(BIN)/python -m navcore.scenario.guide
	@$(BIN)/python -m navcore.scenario.schema_file
	@$(BIN)/python -m navcore.analysis.network_table
	@$(BIN)/python -m navcore.questions.page
	@$(BIN)/python -m tools.ledger

wheel: $(STAMPS)/project
	@$(BIN)/python -m navcore.warm portable
	@$(PIP) wheel --no-deps --no-index --no-build-isolation --wheel-dir dist .

sbom: $(STAMPS)/supply
	@$(BIN)/python -m tools.supply sbom

# Exit code 1: something is known to be vulnerable; 3: the service cannot be reached, nothing was looked up.
audit: $(STAMPS)/supply
	@$(BIN)/python -m tools.supply audit

languages: setup $(STAMPS)/test
	@$(BIN)/python -m tools.translating

# One resolution for every platform and Python, with hashes and without any address.
UV_COMPILE = $(BIN)/python -m uv pip compile --quiet --universal --python-version 3.11 --fork-strategy fewest \
	--generate-hashes --no-emit-index-url --no-emit-find-links --no-annotate --no-header $(UPGRADE)

lock: $(STAMPS)/python
	@$(PIP) install 'uv>=0.9'
	@$(UV_COMPILE) pyproject.toml --output-file requirements/run.lock
	@$(UV_COMPILE) --group build --constraints requirements/run.lock --output-file requirements/build.lock
	@$(UV_COMPILE) --group test --constraints requirements/run.lock --constraints requirements/build.lock \
	  --output-file requirements/test.lock
	@$(UV_COMPILE) --group docs --constraints requirements/run.lock --constraints requirements/test.lock \
	  --output-file requirements/docs.lock
	@$(UV_COMPILE) --group supply --constraints requirements/run.lock --constraints requirements/test.lock \
	  --output-file requirements/supply.lock
	@$(BIN)/python -c 'import tomllib; \
	  print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]["benchmarks"], sep="\n")' \
	  | $(UV_COMPILE) --no-deps - --output-file requirements/benchmarks.lock

clean:
	rm -rf .venv build dist test-output .hypothesis .pytest_cache .ruff_cache
	find app navcore tests tools -name __pycache__ -type d -prune -exec rm -rf {} +
