# The front door. Needs python3, g++ and make; `make setup` fetches the rest, and the other targets run it.

.DEFAULT_GOAL := help
SHELL := /bin/bash

PRESET ?= release
WERROR ?= OFF
PREFIX ?= /usr/local
JOBS ?= $(shell nproc)
ARGS ?=

BIN := $(CURDIR)/.venv/bin
BUILD := build/$(PRESET)
PIROUETTE := $(BUILD)/pirouette
CMAKE := $(BIN)/cmake
CONFIGURE := $(CMAKE) --preset $(PRESET) --log-level=WARNING -DPIROUETTE_WERROR=$(WERROR) \
    -DPIROUETTE_BENCH=OFF

CPP_FILES = $(shell find src apps tests bench examples -name '*.[ch]pp')
CMAKE_FILES = $(shell find CMakeLists.txt cmake src apps tests bench examples \
    -name CMakeLists.txt -o -name '*.cmake')
PYTHON_FILES = $(shell find python -name '*.py' 2>/dev/null)

export PIP_DISABLE_PIP_VERSION_CHECK := 1

.PHONY: help
help:  ## this list
	@echo 'usage: make TARGET [PRESET=release|dev|asan-ubsan|tidy] [WERROR=ON] [JOBS=N]'
	@awk -F ':.*## *' '/^[a-z-]+:.*##/ {printf "  %-10s %s\n", $$1, $$2}' Makefile

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
	@$(CMAKE) --build $(BUILD) --target pirouette_program

.PHONY: spin
spin: build  ## one spin in simulation; ARGS='--rate 0.7 --terrain slope:10'
	@$(PIROUETTE) spin $(ARGS)

.PHONY: test
test: configure  ## every test; wrong formatting and warnings fail it with WERROR=ON only
	@$(MAKE) --no-print-directory check-format || test $(WERROR) = OFF
	@$(CMAKE) --build $(BUILD)
	@$(BIN)/ctest --test-dir $(BUILD) --parallel $(JOBS) --output-on-failure --progress

.PHONY: check
check: check-format lint  ## formatting and clang-tidy

.PHONY: check-format
check-format: setup
	@echo 'check: formatting'
	@wrong=$$($(BIN)/clang-format --dry-run --Werror $(CPP_FILES) 2>&1 | grep -o '^[^: ]*:' | sort -u); \
	    test -z "$$wrong" || { echo 'not formatted; repair with make format:' $$wrong; exit 1; }
	@$(BIN)/gersemi --check $(CMAKE_FILES)
	@$(if $(PYTHON_FILES),$(BIN)/ruff check --quiet $(PYTHON_FILES))
	@$(if $(PYTHON_FILES),$(BIN)/ruff format --check --quiet $(PYTHON_FILES))

.PHONY: lint
lint: setup .venv/lint.stamp
	@echo 'check: clang-tidy'
	@$(CMAKE) --preset tidy --log-level=WARNING > /dev/null
	@$(CMAKE) --build build/tidy

.venv/lint.stamp: requirements-lint.txt | setup
	@$(BIN)/pip install --quiet --requirement requirements-lint.txt
	@touch $@

.PHONY: format
format: setup  ## format every file in place
	@$(BIN)/clang-format -i $(CPP_FILES)
	@$(BIN)/gersemi --in-place --quiet $(CMAKE_FILES)
	@$(if $(PYTHON_FILES),$(BIN)/ruff format --quiet $(PYTHON_FILES))

.PHONY: config
config: build  ## config/default.toml and docs/parameters.md from src/pirouette/config/config.hpp
	@$(PIROUETTE) config dump > $(BUILD)/default.toml
	@$(PIROUETTE) config doc > $(BUILD)/parameters.md
	@cp $(BUILD)/default.toml config/ && cp $(BUILD)/parameters.md docs/

.PHONY: bench
bench: setup  ## cost of a control tick and its parts
	@$(CONFIGURE) -DPIROUETTE_BENCH=ON > /dev/null
	@$(CMAKE) --build $(BUILD) --target pirouette_bench
	@$(BUILD)/pirouette_bench $(ARGS)

.PHONY: install
install: setup  ## program, libraries and data to PREFIX=/usr/local
	@$(CONFIGURE) -DCMAKE_INSTALL_PREFIX=$(PREFIX) > /dev/null
	@$(CMAKE) --build $(BUILD) --target pirouette_program
	@$(CMAKE) --install $(BUILD) > /dev/null
	@echo 'install: $(PREFIX)'

.PHONY: clean
clean:  ## remove build/; .venv stays
	@rm -rf build
