# Each target sets up what it needs, including the virtual environment. Only what has changed is rebuilt.

PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin

.DEFAULT_GOAL := help
.PHONY: help demo test test-rust test-python zoo campaign property-tests soak derivatives dds-peer test-sdist release-check test-aarch64 miri audit \
    lint lint-rust lint-python \
    bench coverage docs docs-check papers

# The jobs that `test` runs side by side are no jobs of cargo's.
unexport MAKEFLAGS MFLAGS

help:  ## list the targets
	@awk -F ':.*## ' '/^[a-z0-9-]+:.*## / { printf "%-14s%s\n", $$1, $$2 }' $(MAKEFILE_LIST)

# The limit is that of the BAS paper. It exceeds the limits of the real arm in four joints; the command says so.
demo: $(VENV)/with-cli,plot  ## a KUKA iiwa 14 follows the BAS paper's circle; results in demo/
	$(BIN)/beetle-ik track iiwa14 --curve circle --center 0.3,0.3,1.0 --diameter 0.2 --duration 30 --dt 0.2 \
	    --start-q 0.6449,0.2037,0.1969,-0.7714,0.2028,0.7179,0.1 --velocity-sinusoid 2,0.004,1 --solver bas --out demo

# Two jobs at a time: compiling keeps one core busy for long. Each line prints its output when it ends.
test:  ## all checks and tests, of Rust and of Python
	$(MAKE) $(MAKEOVERRIDES) --no-print-directory --jobs=2 $(if $(filter output-sync,$(.FEATURES)),--output-sync=line) test-rust test-python

test-rust: lint-rust
	cargo test --locked

# The parts take about the same time: two cores share them with the tests of Rust, whichever ends first.
PARTS := a-d e-l m-p q-z
test-python: lint-python $(addprefix test-python-,$(PARTS))
	$(BIN)/python -m mypy.stubtest beetle_ik._core

test-python-%: $(VENV)/with-test
	$(BIN)/python -m pytest tests/python/test_[$*]*.py

zoo: $(VENV)/with-zoo  ## every robot of the package example-robot-data: loads, stands as in Pinocchio, reaches its targets
	$(BIN)/python -m pytest tests/zoo

# Failing cases and counts are in target/campaign/; `python -m campaign table target/campaign/ledger.csv` makes the table.
campaign: $(VENV)/with-test  ## attacks on every promise: SEED=, and CASES= of each attack or MINUTES= in all (default: 10 minutes)
	PYTHONPATH=tests $(BIN)/python -m campaign run --seed $(or $(SEED),0) --workers $(or $(WORKERS),2) --out target/campaign \
	    $(if $(CASES),--cases $(CASES)) $(if $(MINUTES),--minutes $(MINUTES),$(if $(CASES),,--minutes 10))

property-tests:  ## the drawn tests of the core with cases of their own in every run: SEED=, and CASES= of each (default: 4096)
	PROPTEST_RNG_SEED=$(or $(SEED),$(shell date +%s)) PROPTEST_CASES=$(or $(CASES),4096) cargo test --locked --lib --test core

soak: $(VENV)/with-test  ## hours of load, killed writers, full disks, forks; SOAK="tracker rows" for some of them
	PYTHONPATH=tests $(BIN)/python -m campaign soak $(SOAK) --long

# JAX takes 400 MB, PyTorch up to 6 GB where its wheel brings CUDA.
derivatives: $(VENV)/with-test  ## the tests of interop.jax and interop.torch, with both libraries
	$(BIN)/pip install --quiet --disable-pip-version-check "$$(echo dist/*.whl)[jax,torch]"
	$(BIN)/python -m pytest tests/python/test_door_jax.py tests/python/test_door_torch.py tests/python/test_examples.py

# Its crates are no part of the workspace, nor of its lock.
dds-peer: $(VENV)/with-test  ## `beetle-ik ros` against RustDDS: 1,000 trajectories, restarts, damaged messages
	cargo build --release --manifest-path tests/dds_peer/Cargo.toml --target-dir target/dds_peer
	$(BIN)/python tests/dds_peer/exchange.py target/dds_peer/release/dds_peer

# What pip does where it finds no wheel; then the package of the core, as crates.io would build it.
test-sdist: $(BIN)/maturin  ## the source distribution and the crates build and pass their tests where nothing else is
	rm -rf target/sdist
	$(BIN)/maturin sdist --out target/sdist
	cd target/sdist && tar xzf beetle_ik-*.tar.gz && cd beetle_ik-*/ && $(PYTHON) -m venv .venv \
	    && .venv/bin/pip install --quiet --disable-pip-version-check '.[test]' && .venv/bin/python -m pytest
	cargo package --workspace --locked

# The wheel is built from the unpacked source distribution, against the glibc that docs/stability.md promises: zig brings it.
PORTABLE = $(if $(filter Linux,$(shell uname -s)),--zig --compatibility manylinux_2_28)
release-check: $(BIN)/maturin  ## a dry run of a release: the source distribution builds alone; metadata, tag and licences of the wheel
	$(PYTHON) tools/third_party.py --check
	rm -rf target/release-check
	$(BIN)/pip install --quiet --disable-pip-version-check 'maturin[zig]>=1.10,<2' 'twine>=6'
	$(BIN)/maturin sdist --out target/release-check
	tar xzf target/release-check/beetle_ik-*.tar.gz -C target
	rm -rf target/release-source && mv target/beetle_ik-*/ target/release-source
	. $(BIN)/activate && cd target/release-source && CARGO_TARGET_DIR=$(CURDIR)/target/release-build \
	    maturin build --release $(PORTABLE) --interpreter python --out $(CURDIR)/target/release-check
	$(BIN)/twine check --strict target/release-check/*
	$(PYTHON) tools/check_wheel.py target/release-check

# Debian and Ubuntu: apt install qemu-user gcc-aarch64-linux-gnu; rustup target add aarch64-unknown-linux-gnu.
test-aarch64:  ## the tests of the core on an emulated 64-bit ARM processor
	CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
	    CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER='qemu-aarch64 -L /usr/aarch64-linux-gnu' \
	    cargo test --locked -p ikcore --target aarch64-unknown-linux-gnu

# rustup toolchain install nightly --component miri,rust-src. Miri rounds sines at random, unless told not to; two tests that go
# through millions of angles would take hours.
miri:  ## the unsafe code of `math` under Miri, which finds undefined behaviour
	RUSTFLAGS='-C target-feature=+avx2,+fma' PROPTEST_CASES=2 MIRIFLAGS='-Zmiri-disable-isolation -Zmiri-deterministic-floats' \
	    cargo +nightly miri test --locked -p ikcore --lib --target-dir target/miri math:: -- \
	    --skip agrees_with_the_standard_library --skip single_precision_agrees

# cargo install cargo-deny --locked
audit: $(VENV)/with-test  ## known vulnerabilities, licences and origins of everything that is built in or installed
	cargo deny --locked check
	$(BIN)/pip install --quiet --disable-pip-version-check 'pip-audit>=2.9'
	$(BIN)/pip-audit --skip-editable

lint: lint-rust lint-python  ## formatting, clippy, ruff, types and the docstrings that editors show

lint-rust:
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --locked --quiet

lint-python: $(VENV)/with-test
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/python tools/stub_docstrings.py --check

bench: $(BIN)/maturin  ## criterion benchmarks of the core, then the comparison with other libraries in target/compare/
	cargo bench --locked
	rm -rf target/bench
	$(BIN)/maturin build --release --interpreter $(BIN)/python --out target/bench
	$(PYTHON) -m venv .venv-bench
	echo '*' > .venv-bench/.gitignore
	.venv-bench/bin/pip install --quiet --disable-pip-version-check --force-reinstall --no-deps target/bench/*.whl
	.venv-bench/bin/pip install --quiet --disable-pip-version-check --requirement benches/requirements.txt target/bench/*.whl
	.venv-bench/bin/python benches/compare.py --out target/compare

# `cargo install cargo-tarpaulin --locked` installs the coverage tool for Rust.
coverage: $(VENV)/with-test  ## lines that the tests reach, of Rust and of Python
	PROPTEST_RNG_SEED=1 cargo tarpaulin --locked -p ikcore --engine llvm --skip-clean --target-dir target/coverage --timeout 3600 \
	    --exclude-files 'tests/*' 'benches/*' 'examples/*'
	$(BIN)/pip install --quiet --disable-pip-version-check 'pytest-cov>=6'
	$(BIN)/python -m pytest --cov=beetle_ik --cov-report=term-missing:skip-covered

docs: $(VENV)/with-docs  ## the site in docs/build/html, the Rust pages in target/doc
	RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --locked
	$(BIN)/sphinx-build --fail-on-warning --keep-going --quiet docs docs/build/html

# Needs Chromium or Chrome.
docs-check: docs  ## the site in a browser: blocks that do not fit, searches that find nothing
	$(BIN)/pip install --quiet --disable-pip-version-check 'playwright>=1.50'
	PYTHONPATH=tools $(BIN)/python tools/check_site.py docs/build/html

papers: $(VENV)/with-test  ## the papers run again, reports in target/papers/; the tables and claims that README and site quote
	$(BIN)/beetle-ik reproduce all --out target/papers
	cd docs/papers/tables && for table in */*.csv; do \
	    cp ../../../target/papers/$${table%/*}/tables/$${table#*/} $$table || exit 1; done
	cd docs/papers/claims && for claims in *.csv; do \
	    cp ../../../target/papers/$${claims%.csv}/claims.csv $$claims || exit 1; done

SOURCES := Cargo.toml Cargo.lock pyproject.toml README.md \
    $(shell find crates python -type f -not -name '*.pyc' -not -name '*.so' -not -name '*.pyd')

$(BIN)/maturin: | $(VENV)/python
	$(BIN)/pip install --quiet --disable-pip-version-check 'maturin>=1.10,<2'

$(VENV)/python:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed: make PYTHON=...")'
	$(PYTHON) -m venv $(VENV)
	@touch $@

# The profile `quick` compiles on all cores. The wheel is installed without its dependencies: the extras below install them.
$(VENV)/wheel: $(SOURCES) | $(BIN)/maturin
	rm -rf dist
	$(BIN)/maturin build --profile quick --interpreter $(BIN)/python --out dist
	$(BIN)/pip install --quiet --disable-pip-version-check --force-reinstall --no-deps dist/*.whl
	@touch $@

$(VENV)/with-%: $(VENV)/wheel
	$(BIN)/pip install --quiet --disable-pip-version-check "$$(echo dist/*.whl)[$*]"
	@touch $@

# Pinocchio, the reference for kinematics, is optional: its tests are skipped if there is no wheel.
$(VENV)/with-test: $(VENV)/wheel
	$(BIN)/pip install --quiet --disable-pip-version-check "$$(echo dist/*.whl)[test]"
	$(BIN)/pip install --quiet --disable-pip-version-check --only-binary :all: "$$(echo dist/*.whl)[oracles]" \
	    || echo "no wheel of Pinocchio for this platform: its tests skip"
	@touch $@
