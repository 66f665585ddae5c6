#!/usr/bin/env bash
# Installs the Debian or Ubuntu packages that the wheels do not carry, or those that are named as
# arguments, if any is missing. Without the right to install, prints the line to run and fails.
set -euo pipefail

packages=(
  libtomlplusplus-dev
  libcli11-dev
  nlohmann-json3-dev
  libgtest-dev
  libbenchmark-dev
)
# A Python without ensurepip cannot make an environment.
python3 -c 'import ensurepip' 2>/dev/null || packages+=(python3-venv)
# Its headers, for the compiled part of the Python package.
python3 -c 'import os, sysconfig as s; os.stat(s.get_path("include") + "/Python.h")' 2>/dev/null ||
  packages+=(python3-dev)
[ $# = 0 ] || packages=("$@")

if ! command -v dpkg-query >/dev/null; then
  echo "setup: not a Debian system; install the equivalents of: ${packages[*]}"
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

if [ "$(id -u)" = 0 ]; then
  as_root=()
elif sudo --non-interactive true 2>/dev/null; then
  as_root=(sudo --non-interactive)
else
  echo "setup: system packages are missing; run this, then make again:" >&2
  echo "  sudo apt-get update && sudo apt-get install -y --no-install-recommends ${missing[*]}" >&2
  exit 1
fi

echo "setup: system packages ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
