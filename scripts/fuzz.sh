#!/usr/bin/env bash
# Runs each fuzzer of build/fuzz for FUZZ_RUNS inputs, from the kept corpus. Run by the Makefile.
set -euo pipefail
cd "$(dirname "$0")/.."

for kind in config path experiment robot; do
  found=build/fuzz/$kind
  mkdir -p "$found/corpus"
  echo "fuzz: $kind, $FUZZ_RUNS inputs"
  # A robot with many contacts or an experiment with many trials may take a while, but no minute.
  if ! build/fuzz/fuzz/${kind}_fuzzer -runs="$FUZZ_RUNS" -timeout=60 -rss_limit_mb=4096 -max_len=4096 -use_value_profile=1 \
    -artifact_prefix="$found/" "$found/corpus" "fuzz/corpus/$kind" >"$found/log.txt" 2>&1; then
    tail -30 "$found/log.txt"
    exit 1
  fi
  grep -a '^Done' "$found/log.txt"
done
