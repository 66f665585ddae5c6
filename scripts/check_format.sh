#!/usr/bin/env bash
# Names every file that is not formatted, or formats it with --fix. Run by the Makefile.
set -euo pipefail
cd "$(dirname "$0")/.."
bin=.venv/bin

sources() { find src apps tests bench fuzz examples python -type f \( "$@" \) 2>/dev/null | sort || true; }
mapfile -t cpp < <(sources -name '*.cpp' -o -name '*.hpp')
mapfile -t cmake < <(ls CMakeLists.txt cmake/*.cmake && sources -name CMakeLists.txt -o -name '*.cmake')
mapfile -t python < <(sources -name '*.py')

if [ "${1:-}" = --fix ]; then
  $bin/clang-format -i "${cpp[@]}"
  $bin/gersemi --quiet --in-place "${cmake[@]}"
  [ ${#python[@]} = 0 ] || $bin/ruff format --quiet "${python[@]}"
  exit
fi

unformatted=$(
  { $bin/clang-format --dry-run --Werror "${cpp[@]}" 2>&1 || true; } | sed -n 's/:[0-9]*:[0-9]*: error:.*//p' | uniq
  { $bin/gersemi --check "${cmake[@]}" 2>&1 || true; } | sed -n "s|^$PWD/||; s/ would be reformatted//p"
  [ ${#python[@]} = 0 ] || { $bin/ruff format --check "${python[@]}" 2>&1 || true; } | sed -n 's/^Would reformat: //p'
)
if [ -n "$unformatted" ]; then
  echo 'not formatted; `make format` repairs:'
  echo "$unformatted" | sed 's/^/  /'
  exit 1
fi
[ ${#python[@]} = 0 ] || $bin/ruff check --quiet "${python[@]}"
