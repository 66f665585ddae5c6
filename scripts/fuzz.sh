#!/usr/bin/env bash
# Runs each fuzzer of build/fuzz for FUZZ_RUNS inputs, from the kept corpus. Run by the Makefile.
#   scripts/fuzz.sh         run
#   scripts/fuzz.sh --keep  pack what reaches code that the seeds do not reach into fuzz/corpus/<kind>.tar.gz
set -euo pipefail
cd "$(dirname "$0")/.."

for kind in config path experiment robot; do
  fuzzer=build/fuzz/fuzz/${kind}_fuzzer
  seeds=fuzz/corpus/$kind
  found=build/fuzz/$kind
  rm -rf "$found/kept"
  mkdir -p "$found/corpus" "$found/kept"
  tar -xzf "$seeds.tar.gz" -C "$found/kept"

  if [ "${1:-}" = --keep ]; then
    rm -rf "$found/merged"
    cp -r "$seeds" "$found/merged"
    echo "fuzz: $kind, merging"
    "$fuzzer" -set_cover_merge=1 -use_counters=0 "$found/merged" "$found/kept" "$found/corpus" >"$found/log.txt" 2>&1
    (cd "$seeds" && printf '%s\0' *) | (cd "$found/merged" && xargs -0 rm)
    # The same inputs give the same archive, byte for byte.
    (cd "$found/merged" && LC_ALL=C ls) |
      tar --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=644 -C "$found/merged" -T - --format=ustar -c |
      gzip -n9 >"$seeds.tar.gz"
    continue
  fi

  echo "fuzz: $kind, $FUZZ_RUNS inputs"
  # A robot with many contacts or an experiment with many trials may take a while, but no minute.
  if ! "$fuzzer" -runs="$FUZZ_RUNS" -timeout=60 -rss_limit_mb=4096 -max_len=4096 -use_value_profile=1 \
    -artifact_prefix="$found/" "$found/corpus" "$found/kept" "$seeds" >"$found/log.txt" 2>&1; then
    tail -30 "$found/log.txt"
    exit 1
  fi
  grep -a '^Done' "$found/log.txt"
done
