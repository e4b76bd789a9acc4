#!/bin/bash
# Installs missing packages of Debian (12 or 13) that plica requires, with root or sudo.
# Usage: tools/install_packages.sh [GROUP...], of: build libraries viewer browser firefox python tests checks tidy
# pictures site napari fuzz slurm. Without a group: all except slurm.
set -euo pipefail

# The one list of packages. docs/developers/dependencies.md explains each library.
declare -A packages=(
  [build]="cmake ninja-build g++"
  # OpenBLAS in its serial variant: one thread, so that results are bitwise identical.
  [libraries]="libeigen3-dev libtomlplusplus-dev libcli11-dev libfmt-dev nlohmann-json3-dev
               libmumps-seq-dev libmetis-dev libopenblas-serial-dev libdeflate-dev libhdf5-dev libvtk9-dev libx11-dev libnlopt-cxx-dev libboost-dev
               libqhull-dev libmuparser-dev"
  # To bundle the report's page. Node 18 or newer from elsewhere does as well.
  [viewer]="nodejs npm"
  # To test that page.
  [browser]="chromium fonts-dejavu-core"
  # To test it in a second browser, ./test --all: on a screen without a device, without which Firefox offers no WebGL.
  [firefox]="firefox-esr fonts-dejavu-core xvfb xauth libgl1-mesa-dri"
  # To build and test the Python package (tools/python_environment.sh).
  [python]="python3-dev python3-venv"
  [tests]="libgtest-dev libbenchmark-dev zlib1g-dev"
  [checks]="clang-format python3 python3-vtk9 python3-pandas python3-matplotlib"
  [tidy]="clang-tidy"
  # What plica render draws with where there is no screen: an X server without one, and OpenGL in software. (xauth: for
  # xvfb-run, by which ParaView's test does so.)
  [pictures]="xvfb xauth libgl1-mesa-dri"
  # To make the site of the documentation (docs/build), whose notebooks draw with PyVista.
  [site]="python3-venv nodejs npm libgl1 libegl1 libgl1-mesa-dri"
  # What the windows of napari need (tests/napari).
  [napari]="libgl1 libegl1 libxkbcommon0"
  # To fuzz the readers, fuzz/run, and for the preset tsan. (Clang with libFuzzer and the sanitizers; its OpenMP with
  # Archer.)
  [fuzz]="clang libclang-rt-dev libomp-dev"
  # A Slurm of one machine, to try job arrays on (tools/slurm_here). Not among the groups that no argument stands for.
  [slurm]="munge slurmctld slurmd slurm-client"
)

groups=("$@")
[ ${#groups[@]} -gt 0 ] || groups=(build libraries viewer browser firefox python tests checks tidy pictures site napari fuzz)

wanted=()
for group in "${groups[@]}"; do
  if [ -z "${packages[$group]:-}" ]; then
    echo "install_packages.sh: no group '$group'; there are: ${!packages[*]}" >&2
    exit 2
  fi
  for name in ${packages[$group]}; do
    case " ${wanted[*]:-} " in *" $name "*) ;; *) wanted+=("$name") ;; esac
  done
done

missing=()
for name in "${wanted[@]}"; do
  case $name in nodejs) command -v node >/dev/null && continue ;; npm) command -v npm >/dev/null && continue ;; esac
  status=$(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null) || status=""
  [ "$status" = installed ] || missing+=("$name")
done

if [ ${#missing[@]} -eq 0 ]; then
  echo "All ${#wanted[@]} packages are there (${groups[*]})."
  exit 0
fi

echo "Installing: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install_packages.sh: needs root or sudo to install: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
# What apt-get says is shown only when it fails.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
install() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "${missing[@]}"
}
if ! install >"$log" 2>&1; then
  tail -n 40 "$log" >&2
  echo "install_packages.sh: apt-get failed (above); needed: ${missing[*]}" >&2
  exit 1
fi
echo "Installed ${#missing[@]} packages and what they need."
