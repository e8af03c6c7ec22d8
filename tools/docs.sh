#!/bin/bash
# Builds the documents; a warning (a dead link, an unknown name) is an error.
set -eu
cd "$(dirname "$0")/.."
.venv/bin/sphinx-build -q -W --keep-going -j auto docs docs/_build/html
echo "docs/_build/html/index.html"
