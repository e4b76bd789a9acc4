#!/bin/bash
# Makes build/venv, in which the Python package is built and tested, with Debian's Python. Requires the network the first
# time. Usage: tools/python_environment.sh
set -euo pipefail
cd "$(dirname "$0")/.."
requirements=python/requirements-test.txt stamp=build/venv/installed.txt
if cmp -s "$requirements" "$stamp"; then
  echo "build/venv is there."
  exit 0
fi
echo "Making build/venv with: $(grep -v '^#' "$requirements" | tr '\n' ' ')"
/usr/bin/python3 -m venv --clear build/venv
build/venv/bin/pip install --quiet --disable-pip-version-check --requirement "$requirements"
cp "$requirements" "$stamp"
