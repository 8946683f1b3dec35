# Everything that is done with this repository. `make test` is what CI runs.
#
#   make demo    virtual environment, build, run the main example, say where the report lies: one to three minutes
#   make test    lint and all tests
#   make test-deep   the random tests with many more cases; then random cases for MINUTES (60): machine files,
#                formulas, tables, plans, machines and their laws
#   make wheel-test  the wheel, installed outside the clone: commands of README and documentation as printed
#   make lint    formatting, clippy, ruff, types
#   make bench   the product against what a user would use instead
#   make docs    the documentation as pages in site/
#   make fmu     the library of FMUs, beside the core: seconds after `make build`; tests and wheel make it too

SHELL := /bin/bash
VENV := .venv
# Windows, with make and bash of MSYS2, has programs of a virtual environment elsewhere.
SCRIPTS := $(if $(filter Windows_NT,$(OS)),Scripts,bin)
BIN := $(VENV)/$(SCRIPTS)
PYTHON ?= python3
# macOS has no nproc.
CORES := $(shell nproc 2> /dev/null || sysctl -n hw.ncpu)
# The compiled module lands in the package's folder; this file says when it was built.
BUILT := $(VENV)/built
INSTALLED := $(VENV)/installed
# Modules are compiled when they are first imported: most of them never are.
PIP := $(BIN)/python -m pip install -q --no-compile --disable-pip-version-check -c constraints.txt
TOOLS := $(VENV)/tools
# The library of FMUs lies in the package under its platform's name in FMI 3.0.
FMU := $(VENV)/fmu
RUST := $(shell find crates -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock

# Some environments forbid compiled files of Python: every process of the tests would compile all modules anew.
unexport PYTHONDONTWRITEBYTECODE
export VIRTUAL_ENV := $(CURDIR)/$(VENV)
export PATH := $(CURDIR)/$(BIN):$(PATH)

PRINTED := tests/cli/test_printed_commands.py

.PHONY: demo build fmu test test-deep lint rust-test python-test studio-test wheel-test bench docs clean

# What README's commands need besides the package.
EXTRAS := studio studies report

demo: build
	$(BIN)/linkwright run machines/roller_two_carts.toml --out out/roller_two_carts
	@echo
	@echo "The report: $(CURDIR)/out/roller_two_carts/report.html"
	@echo "For the commands of README: source $(BIN)/activate"

# Compiling waits for the processor and pip for the network: side by side.
build:
	@$(MAKE) --no-print-directory -j2 $(INSTALLED)

$(BIN)/python:
	@echo "Creating a virtual environment in $(VENV)."
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or later is needed")'
	@$(PYTHON) -m venv $(VENV)

# What builds the package, at a pinned version.
$(VENV)/needs: constraints.txt | $(BIN)/python
	@$(PIP) 'maturin>=1.9,<2'
	@touch $@

$(BUILT): $(VENV)/needs $(RUST)
	@echo "Compiling the core: about a minute on two fast cores, two or three on slow ones."
	@PIP_CONSTRAINT=$(CURDIR)/constraints.txt $(BIN)/maturin develop --release --locked --skip-install
	@touch $@

fmu: $(FMU)

# All crates below it are those of the module, which is built before.
$(FMU): $(BUILT)
	@cargo build --release --locked -q -p linkwright-fmu
	@PYTHONPATH=python $(BIN)/python -m linkwright.fmi.library target/release
	@touch $@

# What the package and the extras need.
$(VENV)/packages: constraints.txt pyproject.toml | $(VENV)/needs
	@echo "Installing what the package needs, with its extras $(EXTRAS)."
	@$(BIN)/python -c 'import sys, tomllib; p = tomllib.load(open("pyproject.toml", "rb"))["project"]; print(*p["dependencies"], *(each for extra in sys.argv[1:] for each in p["optional-dependencies"][extra]), sep="\n")' $(EXTRAS) > $@.txt
	@$(PIP) -r $@.txt
	@touch $@

$(INSTALLED): $(BUILT) $(VENV)/packages
	@$(PIP) --no-deps --no-build-isolation -e .
	@touch $@

# What tests and lint need besides.
$(TOOLS): $(INSTALLED)
	$(PIP) -e '.[dev]' --no-build-isolation
	touch $@

# Two at a time: one waits for a compiler or for the network while the other computes. The make of macOS, 3.81, mixes
# what they print.
SYNC := $(if $(filter output-sync,$(.FEATURES)),--output-sync=target)

test:
	$(MAKE) --no-print-directory -j2 $(SYNC) lint rust-test python-test studio-test wheel-test

lint: $(TOOLS)
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- -D warnings
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	# Without a name an encoding is that of the system, on Windows a code page.
	$(BIN)/ruff check -q --preview --select PLW1514 python
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest linkwright._core --ignore-disjoint-bases

# With both packages named, the kernels are those that the module was built from: nothing long is compiled twice.
rust-test: $(BUILT)
	cargo test --release --workspace --features pyo3/extension-module --locked
	@test "$$(uname)" != Linux || $(BIN)/python benches/code_size.py

python-test: $(TOOLS) $(FMU)
	$(BIN)/python -m pytest -n $(CORES) --dist worksteal --ignore=$(PRINTED)

# The module is built already, so that the wheel is only packed. Its environment borrows the dependencies alone.
WHEEL := $(CURDIR)/$(VENV)/wheel
wheel-test: $(TOOLS) $(FMU)
	rm -rf $(WHEEL)
	PIP_CONSTRAINT=$(CURDIR)/constraints.txt $(BIN)/maturin build --release --locked -q -o $(WHEEL)/dist
	$(PYTHON) -m venv --without-pip $(WHEEL)/env
	$(BIN)/python -m pip --python $(WHEEL)/env/$(SCRIPTS)/python install -q --disable-pip-version-check --no-deps $(WHEEL)/dist/*.whl
	$(WHEEL)/env/$(SCRIPTS)/python -c 'import sys, sysconfig; print(sys.argv[1], file=open(sysconfig.get_path("purelib") + "/borrowed.pth", "w"))' \
	  "$$($(BIN)/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')"
	cd $(WHEEL) && LINKWRIGHT_WHEEL=1 env/$(SCRIPTS)/python -m pytest -n 2 -p no:cacheprovider $(CURDIR)/$(PRINTED)

# The studio's page: types, pieces, and the whole of it in a browser. Node serves these tests alone; the page needs none.
CHROMIUM ?= $(or $(shell command -v chromium),/usr/bin/chromium)

studio-test: $(TOOLS)
	@command -v node npm > /dev/null || { echo "The tests of the studio need Node.js 20 or newer with npm (https://nodejs.org); the studio itself needs none."; exit 1; }
	@test -x "$(CHROMIUM)" || { apt-get update -qq && apt-get install -qq -y chromium; } > /dev/null || { echo "The tests of the studio need Chromium: apt-get install chromium, or make test CHROMIUM=/path/to/it."; exit 1; }
	npm ci --silent --no-audit --no-fund
	node tests/studio/vendor.mjs --check
	node_modules/.bin/tsc -p tests/studio/tsconfig.json
	node --test tests/studio/client/
	CHROMIUM="$(CHROMIUM)" node --test tests/studio/browser/

MINUTES ?= 60

test-deep: $(TOOLS) $(FMU)
	LINKWRIGHT_DEEP=1 $(BIN)/python -m pytest -n $(CORES) --dist worksteal -m "deep or hypothesis"
	$(BIN)/python tests/fuzz/deep.py --minutes $(MINUTES) --jobs $(CORES)

bench: $(TOOLS)
	$(PIP) -e '.[bench]' --no-build-isolation
	$(BIN)/python benches/run.py

docs: $(TOOLS)
	$(PIP) -e '.[docs]' --no-build-isolation
	$(BIN)/mkdocs build --strict
	cargo doc --no-deps --workspace --exclude linkwright-py --exclude linkwright-border --locked

clean:
	rm -rf $(VENV) target out site python/linkwright/*.so python/linkwright/*.pyd python/linkwright/_fmu.*
