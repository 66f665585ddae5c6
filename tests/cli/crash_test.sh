#!/bin/bash
# A sweep that is killed again and again, at random moments, ends with the same files as one that is left alone;
# nothing half-written is ever seen.
#   crash_test.sh PROGRAM
set -u

program=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
RANDOM=1
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

cat > experiment.toml <<'TOML'
seeds = [1, 2, 3, 4]
[common]
run.turns = 0.05
run.settle_time = 0.1
gait.stand_time = 0.2
[[rows]]
label = "one"
controller = "asc"
[[axes]]
key = "plant.friction"
values = [0.6, 0.8, 1.0]
[trace]
plant.friction = [0.6, 1.0]
TOML

run() { exec "$program" sweep experiment.toml --jobs 2 "$@"; }

# whole_files FOLDER: what readers may look at is as in the sweep that was left alone, or not there.
whole_files() {
  local file
  for file in "$1"/traces/*.npy "$1"/table.csv "$1"/experiment.*; do
    [ ! -e "$file" ] || cmp -s "$file" "alone/${file#"$1"/}" || fail "half-written: $file"
  done
}

# kill_until_done FOLDER OPTIONS...: starts the sweep and kills it at a random moment, until it ends by itself.
# Where that came after fewer than three kills, once more with moments half as late: machines differ in speed.
kill_until_done() {
  local folder=$1 longest=200 kills=0
  [ ! -e "$folder" ] || cp -r "$folder" before
  while kill_and_resume "$@" && [ $kills -lt 3 ] && [ $longest -gt 5 ]; do
    rm -rf "$folder"
    [ ! -e before ] || cp -r before "$folder"
    longest=$((longest / 2))
  done
  rm -rf before
  [ $kills -ge 3 ] || fail "only $kills kills in $folder"
  echo "$folder: killed $kills times within $longest ms or more"
}

kill_and_resume() {
  local folder=$1 code=137
  shift
  kills=0
  while [ $code -eq 137 ]; do
    # ms; grows, so that a slow machine comes to an end.
    local wait=$((RANDOM % (longest + longest * kills / 2)))
    (run --out "$folder" "$@") > /dev/null 2> stderr &
    local pid=$!
    (sleep "$((wait / 1000)).$(printf %03d $((wait % 1000)))"; kill -KILL $pid 2> /dev/null) &
    wait $pid 2> /dev/null
    code=$?
    [ $code -eq 137 ] && kills=$((kills + 1))
    whole_files "$folder"
  done
  [ $code -eq 0 ] || { fail "exit code $code: $(cat stderr)"; return 1; }
}

(run --out alone) > /dev/null 2> stderr || fail "the sweep that is left alone: $(cat stderr)"
[ "$(find alone/traces -name '*.npy' | wc -l)" -eq 2 ] || fail 'two traces are to be kept'

kill_until_done killed --resume
diff -r --exclude='*.jsonl' alone killed || fail 'other files after kills'

kill_until_done shards --shard 1/2
kill_until_done shards --shard 2/2
(run --out shards --merge) > /dev/null 2> stderr || fail "merge: $(cat stderr)"
diff -r --exclude='*.jsonl' alone shards || fail 'other files from shards'

[ $failures -eq 0 ] && echo "all as expected" || echo "$failures failures"
exit $((failures > 0))
