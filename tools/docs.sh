#!/bin/bash
# Builds the documents; a warning (a dead link, an unknown name) is an error.
set -eu
export OMP_NUM_THREADS=1 # what is drawn is small, and drawn side by side
cd "$(dirname "$0")/.."
.venv/bin/sphinx-build -q -W --keep-going -j auto docs docs/_build/html
echo "docs/_build/html/index.html"
