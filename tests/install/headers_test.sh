#!/usr/bin/env bash
# Installs the build and checks every header there: it compiles alone, with Eigen and nothing else, without a warning;
# it brings in nothing of MuJoCo, toml++ or nlohmann's JSON.
#   headers_test.sh CMAKE BUILD_DIR WORK_DIR COMPILER EIGEN_INCLUDE_DIR JOBS
set -euo pipefail

cmake=$1 build=$2 work=$3 compiler=$4 eigen=$5 jobs=$6
include=$work/prefix/include
rm -rf "$work"
"$cmake" --install "$build" --prefix "$work/prefix" >/dev/null

check() {
  local uses=$work/${1//\//_}.d found
  # Twice, as two of a program's own headers may do.
  if ! printf '#include "%s"\n#include "%s"\n' "$1" "$1" |
    "$compiler" -x c++ -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Werror \
      -I "$include" -isystem "$eigen" -MD -MF "$uses" - >"$uses.log" 2>&1; then
    echo "FAILED: $1 does not compile alone"
    head -20 "$uses.log"
    return 1
  fi
  found=$(grep -oE '[^ ]*/(mujoco|toml\+\+|nlohmann)/[^ ]*' "$uses" | head -1 || true)
  [ -z "$found" ] || { echo "FAILED: $1 brings in $found"; return 1; }
}
export -f check
export work include compiler eigen

mapfile -t headers < <(cd "$include" && find pirouette -name '*.hpp' | sort)
[ ${#headers[@]} -gt 0 ] || { echo "FAILED: no header is installed"; exit 1; }
printf '%s\0' "${headers[@]}" | xargs -0 -P "$jobs" -I {} bash -c 'check {}'
echo "${#headers[@]} headers"
