#!/usr/bin/env bash
# Runs each fuzzer of build/fuzz for FUZZ_RUNS inputs, from the kept corpus. Run by the Makefile.
#   scripts/fuzz.sh         run
#   scripts/fuzz.sh --keep  pack anew, into fuzz/corpus/<kind>.tar.gz, what reaches code that the seeds do not reach
set -euo pipefail
cd "$(dirname "$0")/../build/fuzz"

for kind in config path experiment robot; do
  fuzzer=fuzz/${kind}_fuzzer
  seeds=../../fuzz/corpus/$kind
  archive=$seeds.tar.gz
  rm -rf "$kind/kept"
  mkdir -p "$kind/corpus" "$kind/kept"
  tar -xzf "$archive" -C "$kind/kept"

  if [ "${1:-}" = --keep ]; then
    rm -rf "$kind/merged"
    cp -r "$seeds" "$kind/merged"
    echo "fuzz: $kind, merging"
    "$fuzzer" -set_cover_merge=1 -use_counters=0 -artifact_prefix="$kind/" "$kind/merged" "$kind/kept" "$kind/corpus" \
      >"$kind/log.txt" 2>&1
    # The merge leaves out an input that fails.
    if grep -a '^SUMMARY' "$kind/log.txt"; then exit 1; fi
    (cd "$seeds" && ls) | (cd "$kind/merged" && xargs rm)
    # The same files give the same archive, byte for byte.
    (cd "$kind/merged" && LC_ALL=C ls) |
      tar --format=ustar --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=644 -C "$kind/merged" -T - -c |
      gzip -n9 >"$archive"
    continue
  fi

  echo "fuzz: $kind, $FUZZ_RUNS inputs"
  # A robot with many contacts or an experiment with many trials may take a while, but no minute.
  if ! "$fuzzer" -runs="$FUZZ_RUNS" -timeout=60 -rss_limit_mb=4096 -max_len=4096 -use_value_profile=1 \
    -artifact_prefix="$kind/" "$kind/corpus" "$kind/kept" "$seeds" >"$kind/log.txt" 2>&1; then
    tail -30 "$kind/log.txt"
    exit 1
  fi
  grep -a '^Done' "$kind/log.txt"
done
