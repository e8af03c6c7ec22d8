# The front door. `make help` lists what there is.
.DEFAULT_GOAL := help
MAKEFLAGS += --no-builtin-rules
export PIP_DISABLE_PIP_VERSION_CHECK := 1
unexport PYTHONDONTWRITEBYTECODE # else each of hundreds of processes compiles all that it imports

python := .venv/bin/python
# uv takes a fifth of the time of pip. It reads settings of its own: see docs/install.md.
install := .venv/bin/uv pip install --quiet --python $(python)
# Names of functions are kept for those who count and profile.
editable := $(install) --no-build-isolation --config-settings=install.strip=false --editable '.[pictures,review]'

# What the compiled part of the package is made from, and which packages there are; editing Python needs no new build.
sources := pyproject.toml CMakeLists.txt $(wildcard cmake/* python/ringlet/*/__init__.py) $(shell find src bindings -type f)

# What the review page is made from.
page := tools/web.sh $(wildcard web/*.json web/*.ts web/*.html) $(shell find web/src web/public -type f)

.PHONY: help build demo view test prove blender extension arm bench figures docs gallery lint clean

help: ## list the targets
	@grep -E '^[a-z]+:.*##' Makefile | sed -E 's/:.*## /\t/' | expand -t 10

build: .venv/built .venv/page ## set up .venv and build: gives .venv/bin/ringlet

.venv/prepared: tools/bootstrap.sh pyproject.toml
	@tools/bootstrap.sh
	@echo "Installing what the build needs"
	@$(python) -c 'import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["build-system"]["requires"], sep="\n")' >$@.txt
	@$(python) -m pip install --quiet uv
	@$(install) cmake ninja --requirement $@.txt
	@touch $@

.venv/built: .venv/prepared $(sources)
	@echo "Building Ringlet and installing what it needs"
	@$(editable)
	@touch $@

.venv/page: .venv/prepared $(page)
	@echo "Building the review page"
	@tools/web.sh
	@touch $@

.venv/tooled: .venv/built .venv/page
	@echo "Installing what tests, lints and documents need"
	@$(install) --requirement pyproject.toml --extra dev
	@touch $@

demo: build ## groom, simulate and render the example: writes out/demo
	@.venv/bin/ringlet demo -o out/demo

view: build ## the example's curls in the browser, to be changed
	@.venv/bin/ringlet view examples/child/curls.recipe.toml

test: .venv/tooled ## everything: C++, Python, known answers, lints, documents
	@tools/test.sh

prove: .venv/tooled ## what is too long for a test, before a release: docs/proofs.md
	@OMP_NUM_THREADS=1 $(python) tools/prove.py

blender: ## Blender's Python module in .venv-blender, 374 MB, for the tests that open files with it
	python3.11 -m venv .venv-blender
	.venv-blender/bin/pip install --quiet bpy==5.0.1

extension: build ## the extension for Blender: one zip in dist
	@$(python) tools/blender_extension.py dist

sanitize: .venv/tooled ## the C++ tests with the sanitizers of addresses, undefined behaviour and threads
	@tools/sanitize.sh

wheel: .venv/tooled ## a wheel for this Python and glibc 2.28 in dist, audited, and tried out in an environment of its own
	@tools/wheel.sh

arm: .venv/tooled ## cross-built for Linux ARM64 and run by qemu-user: C++ tests, a wheel in dist, Python tests
	@tools/arm.sh

bench: build ## speed, as JSON
	@for name in groom strands; do .venv/bin/ringlet bench $$name --json; done

figures: .venv/tooled ## measures again what is kept in bench/results and of older sources, by turns with these
	@$(python) bench/record.py

docs: .venv/tooled ## the documents: docs/_build/html/index.html
	@tools/docs.sh

gallery: .venv/tooled ## pictures of docs/gallery.md that are missing or out of date, and the page
	@$(python) docs/gallery.py

lint: .venv/tooled ## formatting, types, static analysis, who may call whom
	@tools/lint.sh

clean: ## remove everything that was built
	rm -rf .venv build dist out docs/_build web/node_modules python/ringlet/viewer/static
