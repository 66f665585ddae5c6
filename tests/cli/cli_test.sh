#!/bin/bash
# The program as a user meets it: wrong command lines and configurations, interruption, the files of a run.
#   cli_test.sh PROGRAM
# Every wrong input exits with 2, says what is wrong in "error: ..." lines and leaves no file behind.
set -u

program=$(realpath "$1")
source=$(dirname "$(dirname "$(dirname "$(realpath "$0")")")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail() {
  echo "FAILED: $*"
  sed 's/^/    /' stderr
  failures=$((failures + 1))
}

# wrong TEXT ARGUMENTS...: one error line that holds TEXT.
wrong() { wrong_lines 1 "$@"; }

# wrong_lines COUNT TEXT ARGUMENTS...: COUNT error lines, one of which holds TEXT, and nothing else.
wrong_lines() {
  local count=$1 text=$2 before after
  shift 2
  before=$(ls -A . sandbox)
  (cd sandbox && "$program" "$@") > stdout 2> stderr
  local code=$?
  after=$(ls -A . sandbox)
  [ $code -eq 2 ] || fail "exit code $code, not 2: $*"
  [ -s stdout ] && fail "prints to stdout: $*"
  grep -q -F -e "$text" stderr || fail "does not say \"$text\": $*"
  [ "$(grep -c '^error: ' stderr)" -eq "$count" ] || fail "not $count error lines: $*"
  [ "$(grep -c -v '^error: ' stderr)" -eq 0 ] || fail "other lines than errors: $*"
  [ "$before" = "$after" ] || fail "leaves files behind: $*"
}

mkdir sandbox
touch stdout stderr sandbox/file
mkdir sandbox/thesis && echo years > sandbox/thesis/thesis.tex

cat > sandbox/unknown_key.toml <<'TOML'
[gait]
perid = 0.5
TOML
cat > sandbox/wrong_type.toml <<'TOML'
[gait]
period = "half a second"
TOML
cat > sandbox/nan.toml <<'TOML'
[mpc]
weight_position = [2.0, nan, 50.0]
TOML
cat > sandbox/syntax.toml <<'TOML'
[gait
period = 0.5
TOML
cat > sandbox/three_things.toml <<'TOML'
controller = "mti"
[gait]
duty = 2.0
[foot]
model = "cube"
TOML
cat > sandbox/path.toml <<'TOML'
points = [[0, 0], [1, 0]]
speed = "fast"
TOML
echo '<mujoco><worldbody>' > sandbox/broken.xml
echo '<mujoco><worldbody><body><geom size="1"/></body></worldbody></mujoco>' > sandbox/no_legs.xml
echo 'not XML at all' > sandbox/text.xml
printf 'file = "no_legs.xml"\n[legs.FR]\nknee = "sideways"\n' > sandbox/sideways.toml

# Command lines.
wrong 'unknown verb "pirouet"' pirouet
wrong '--bogus' --bogus
wrong '--bogus' spin --bogus
wrong 'extra' spin extra
wrong '--rate' spin --rate
wrong '--rate' spin --rate 1 --rate 2
wrong '--rate: given "fast"' spin --rate fast
wrong '--rate: given nan' spin --rate nan
wrong '--rate: given inf' spin --rate inf
wrong '--rate: given -99' spin --rate -99
wrong '--turns: given 0' spin --turns 0
wrong '--seed: given 1.5' spin --seed 1.5
wrong '--point: given "1"' spin --point 1
wrong '--start-offset: given "a,b"' spin --start-offset a,b
wrong '--start-yaw-deg: given 720' spin --start-yaw-deg 720
wrong '--sensors: given "perfect"' spin --sensors perfect
wrong '--aid: given "10Hz"; allowed: rate in Hz, noise in mm and delay in ms' spin --aid 10Hz
wrong '--aid: given "10Hz:5cm:50ms"' spin --aid 10Hz:5cm:50ms
wrong '--aid: given "9999Hz:5mm:50ms"; plant.sensors.aid_rate' spin --aid 9999Hz:5mm:50ms
wrong '--estimator: given "oracle"' spin --estimator oracle
wrong '--controller: given "mti"' spin --controller mti
wrong '--radius' turn
wrong '--radius: given 100' turn --radius 100
wrong '--radius' turn --radius wide
wrong '--radius: given inf' turn --radius inf
wrong '--radius: missing; or give --speed, --path or --config' turn --rate 0.5
wrong '--speed: given 9' turn --speed 9
wrong '--speed: given -0.2' turn --path figure8 --speed -0.2
wrong '--radius excludes --speed' turn --speed 0.2 --radius 0.5
wrong '--path excludes --radius' turn --path figure8 --radius 0.5
wrong '--rate excludes --path' turn --path figure8 --rate 0.5
wrong '--path excludes --heading-offset-deg' turn --path figure8 --heading-offset-deg 90
wrong '--path: given "figure9"; allowed: figure8, square; did you mean figure8?' turn --path figure9
wrong '--path: given "nowhere.toml": no such file' turn --path nowhere.toml
wrong 'path.toml:2: speed: given "fast"; allowed: 0.01 to 2 m/s' turn --path path.toml
printf '[run]\nrate = 0.7\n' > sandbox/run.toml
printf 'points = [[0, 0], [1, 0], [0, 0]]\n' > sandbox/back.toml
wrong 'back.toml:1: points: the curve turns back on itself' turn --path back.toml
wrong '--heading-offset-deg: needs --radius or --speed' turn --rate 1 --heading-offset-deg 90 --config run.toml
wrong 'run.turns: makes a trial of' spin --rate 1e-16
wrong '--laps: given 0' turn --path figure8 --laps 0
wrong '--path' spin --path figure8
wrong 'check, dump, doc' config
wrong 'back.toml: is no configuration but a path' spin --config back.toml
wrong 'FILE' config check

# Terrain and robot.
wrong '--terrain: "moon"' spin --terrain moon
wrong '--terrain: "slope:95"' spin --terrain slope:95
wrong '--terrain: "stairs:0.03"' spin --terrain stairs:0.03
wrong '--terrain: "slope:10+stairs:0.03x0.2"' spin --terrain slope:10+stairs:0.03x0.2
wrong '--robot: given "centipede"' spin --robot centipede
wrong '--robot: given "nowhere.xml"' spin --robot nowhere.xml
wrong 'broken.xml' spin --robot broken.xml
wrong 'text.xml' spin --robot text.xml
wrong 'no_legs.xml' spin --robot no_legs.xml

wrong 'legs.FR.knee: given "sideways"; allowed: "backward", "forward"' spin --robot sideways.toml
wrong 'no quadruped: no free joint' robot check no_legs.xml
wrong 'broken.xml' robot describe broken.xml
wrong 'check, describe, list' robot

# Parameters.
wrong 'gait.perid: unknown key; did you mean gait.period?' spin --set gait.perid=0.4
wrong 'gait.period: given "long"' spin --set gait.period=long
wrong 'gait.period: given nan' spin --set gait.period=nan
wrong 'gait.duty' spin --set gait.duty=0.95
wrong 'given "gait.period"' spin --set gait.period
wrong 'plant.timestep' spin --set plant.timestep=0.0007
wrong 'nowhere.toml: no such file' spin --config nowhere.toml
wrong 'unknown_key.toml:2: gait.perid' spin --config unknown_key.toml
wrong 'wrong_type.toml:2: gait.period' spin --config wrong_type.toml
wrong 'nan.toml:2: mpc.weight_position' spin --config nan.toml
wrong 'syntax.toml:1' spin --config syntax.toml
wrong 'unknown_key.toml:2: gait.perid' config check unknown_key.toml
wrong_lines 3 'three_things.toml:1: controller' spin --config three_things.toml
wrong_lines 3 'three_things.toml:5: foot.model' config check three_things.toml
wrong_lines 2 '--sensors' spin --sensors perfect --set gait.duty=2

# Experiments.
cat > sandbox/experiment.toml <<'TOML'
[common]
run.turns = 0.02
run.settle_time = 0.1
gait.stand_time = 0.2
[[rows]]
label = "one"
controller = "asc"
TOML
wrong 'experiment.toml: is no configuration but an experiment' config check experiment.toml
sed 's/asc/acs/' sandbox/experiment.toml > sandbox/bad_row.toml
sed 's/turns = 0.02/tunrs = 1/' sandbox/experiment.toml > sandbox/bad_key.toml
sed 's/label = "one"/label = "o\\u001bne"/' sandbox/experiment.toml > sandbox/bad_label.toml
wrong 'bad_label.toml:6: rows.label: given "o\x1bne"; allowed: a text without control characters' \
  sweep bad_label.toml
wrong 'FILE' sweep
wrong 'nowhere.toml: no such file' sweep nowhere.toml
wrong 'bad_row.toml:5: controller: given "acs"' sweep bad_row.toml
wrong 'bad_key.toml:2: run.tunrs' sweep bad_key.toml
wrong '--jobs: given -1' sweep experiment.toml --jobs -1
for shard in 0/2 3/2 2 1/2/3 1/x -1/2 '' 1/100001; do
  wrong "--shard: given \"$shard\"; allowed: I/N" sweep experiment.toml --shard "$shard"
done
wrong '--fresh excludes --shard' sweep experiment.toml --shard 1/2 --fresh
wrong '--shard excludes --merge' sweep experiment.toml --shard 1/2 --merge
wrong '--fresh excludes --resume' sweep experiment.toml --resume --fresh
wrong '--shard' reproduce fig6 --shard 1/2
wrong 'no results of 1 of 1 trials' sweep experiment.toml --merge
cat > sandbox/random.toml <<'TOML'
trials = 100
[common]
run.turns = 0.02
run.settle_time = 0.1
gait.stand_time = 0.2
[random]
run.rate = {uniform = [0.3, 1.2], either_sign = true}
[[rows]]
label = "flat"
controller = "asc"
[[rows]]
label = "slope"
controller = "pirouette"
[rows.random]
plant.terrain = {uniform = [1, 10], text = "slope:{}"}
TOML
wrong 'FILE' montecarlo
wrong 'experiment.toml: trials: missing' montecarlo experiment.toml
wrong '--trials: given 0' montecarlo random.toml --trials 0
wrong '--seeds: given 2 for an experiment that draws its seeds' sweep random.toml --seeds 2
wrong '--seeds' montecarlo random.toml --seeds 2
wrong '--seeds: given 0' sweep experiment.toml --seeds 0
wrong '--turns: given 0' sweep experiment.toml --turns 0
wrong 'file' sweep experiment.toml --out file
wrong 'FIGURE' reproduce
wrong 'given "fig66"' reproduce fig66
wrong '--turns: given 0' reproduce fig6 --turns 0
wrong '--seeds: given 0' reproduce all --seeds 0
wrong '--profile: given "real"' spin --profile real

# MuJoCo's own fatal errors, and robots that would walk on quietly.
xml="$source/robots/mini_cheetah/mini_cheetah.xml"
sed 's#<worldbody>#<size memory="24K"/>\n  <worldbody>#' "$xml" > sandbox/small.xml
wrong 'out of memory' spin --robot small.xml
[ -e sandbox/MUJOCO_LOG.TXT ] && fail 'MuJoCo leaves its log'

# The run folder.
wrong '--out' spin --out ''
wrong 'is a file' spin --out file
wrong '--out' spin --out file/run
wrong '--out' spin --out /proc/pirouette/run
wrong 'with other things in it' spin --out thesis
[ "$(cat sandbox/thesis/thesis.tex)" = years ] || fail 'touched a folder that is no run'

ln -s nowhere sandbox/dangling
wrong 'is a link to nothing' spin --out dangling
wrong 'is a link to nothing' spin --out dangling/run
# What only looks like a run is nobody's to delete.
mkdir -p sandbox/fake/notes && touch sandbox/fake/run.toml sandbox/fake/metrics.json
echo mine > sandbox/fake/notes/a
wrong 'with other things in it' spin --out fake
wrong 'with other things in it' spin --out fake --force
[ "$(cat sandbox/fake/notes/a)" = mine ] || fail 'touched notes'
wrong 'MB left, and the run needs' spin --turns 50000 --set run.trace_rate=500 --out huge

# Signals, once the first line of progress is out: what was measured is kept.
for signal in INT:130 TERM:143 HUP:129; do
  : > stderr
  "$program" spin --turns 1000 --out interrupted > stdout 2> stderr &
  pid=$!
  until [ -s stderr ]; do sleep 0.05; done
  kill -${signal%:*} $pid
  wait $pid
  code=$?
  [ $code -eq ${signal#*:} ] || fail "exit code $code after $signal"
  grep -q '"interrupted": true' interrupted/metrics.json || fail "$signal: not marked as interrupted"
  [ -s interrupted/trace.npy ] || fail "$signal: no trace"
  rm -r interrupted
done

# A killed run leaves its part folder; the next one cleans up.
: > stderr
"$program" spin --turns 1000 --out killed > stdout 2> stderr &
pid=$!
until [ -s stderr ]; do sleep 0.05; done
"$program" spin --out killed > stdout 2> second
[ $? -eq 2 ] && grep -q 'is being written by another process' second || fail 'two runs in one folder'
kill -KILL $pid
wait $pid 2> /dev/null
[ -d .killed.pirouette-part ] || fail 'where is the part folder?'

# Standard output that takes nothing.
"$program" spin --turns 0.05 --set run.settle_time=0.2 --json --out full > /dev/full 2> stderr
[ $? -eq 2 ] && grep -q 'standard output cannot be written' stderr || fail '--json > /dev/full'
[ -e .killed.pirouette-part ] && fail 'left-overs of a killed run stay'
"$program" config doc > /dev/full 2> stderr
[ $? -eq 2 ] || fail 'config doc > /dev/full'

# Less than what was asked for is exit code 1, with one line.
"$program" spin --turns 8 --set run.time_limit=1 --set run.settle_time=0.2 --quiet --out less 2> stderr
[ $? -eq 1 ] && grep -q '^not done: .* of the turns' stderr || fail 'turns that were not done'
for angle in 20 -20; do
  "$program" spin --angle $angle --rate 1 --json --quiet --out angle$angle > stdout 2> stderr ||
    fail "a turn by $angle degrees"
  grep -q '"angle_error_deg": -\?0\.' stdout || fail "more than a degree off $angle"
done
wrong '--angle' spin --angle 90 --turns 2
wrong 'run.rate other than 0' spin --angle 90 --rate 0

# A run, and the same again from what it left.
short='--turns 0.05 --set run.settle_time=0.2'
"$program" spin $short --json > stdout 2> stderr || fail 'a short spin'
[ "$(ls runs/spin-flat-0.7-seed1 | xargs)" = 'files.txt metrics.json robot.xml run.toml terrain.npy trace.npy' ] || fail 'run folder'
cmp -s stdout runs/spin-flat-0.7-seed1/metrics.json || fail '--json prints something else'
grep -q '^100 %' stderr || fail 'no progress on stderr'
"$program" spin --config runs/spin-flat-0.7-seed1/run.toml --out again --quiet > stdout 2> stderr ||
  fail 'a run from run.toml'
[ -s stdout ] || [ -s stderr ] && fail '--quiet is not quiet'
cmp -s runs/spin-flat-0.7-seed1/trace.npy again/trace.npy || fail 'run.toml gives another trace'
"$program" spin $short --seed 2 --out again > stdout 2> stderr
[ $? -eq 2 ] && grep -q 'holds an earlier run' stderr || fail 'replaces a run without --force'
echo mine > again/note
"$program" spin $short --seed 2 --out again --force > stdout 2> stderr || fail 'replacing a run'
[ "$(cat again/note)" = mine ] || fail 'a note beside the run is gone'
grep -q 'Run folder: again' stdout || fail 'the table does not name the run folder'
cmp -s runs/spin-flat-0.7-seed1/trace.npy again/trace.npy && fail 'another seed, the same trace'

# Against the wall clock: 3 s of simulation take 3 s and give the same trace.
timed='--turns 0.05 --set run.settle_time=0.2 --set gait.stand_time=2'
"$program" spin $timed --out simulated --quiet > stdout 2> stderr || fail 'a timed spin'
SECONDS=0
"$program" spin $timed --out paced --realtime --quiet > stdout 2> stderr || fail 'a spin in real time'
[ $SECONDS -ge 2 ] || fail 'not against the wall clock'
grep -q '^Real time: [0-9]* of [0-9]* deadlines missed' stderr || fail 'no missed deadlines told'
cmp -s simulated/trace.npy paced/trace.npy || fail 'another trace in real time'

# A turn along a path, and the same again from what it left.
"$program" turn --path square --laps 0.01 --set run.settle_time=0.2 > stdout 2> stderr ||
  fail 'a short turn'
grep -q 'distance to path' stdout || fail 'the table does not tell the distance to the path'
"$program" turn --config runs/turn-flat-square-seed1/run.toml --out along --quiet > stdout 2> stderr ||
  fail 'a turn from run.toml'
cmp -s runs/turn-flat-square-seed1/trace.npy along/trace.npy || fail 'run.toml gives another turn'

# A robot that cannot stand falls: exit code 1, and the run folder tells.
"$program" spin --set plant.torque_scale=0.1 --out fallen > stdout 2> stderr
code=$?
[ $code -eq 1 ] || fail "exit code $code after a fall, not 1"
grep -q '"fell": true' fallen/metrics.json || fail 'metrics.json does not tell of the fall'

# A sweep, and the same again from what it left.
"$program" sweep sandbox/experiment.toml --jobs 2 --seeds 2 --out swept > stdout 2> stderr ||
  fail 'a short sweep'
cp swept/table.csv first.csv && cp stdout first.md
"$program" sweep sandbox/experiment.toml --jobs 1 --seeds 2 --out swept > stdout 2> stderr ||
  fail 'a sweep that was done'
grep -q '2 of 2 trials were there' stderr || fail 'a finished sweep runs again'
cmp -s swept/table.csv first.csv && cmp -s stdout first.md || fail 'another table'
[ "$(ls swept | xargs)" = \
  'experiment.csv experiment.json experiment.md results.jsonl table.csv traces' ] ||
  fail 'files of a sweep'

[ "$("$program" sweep sandbox/experiment.toml --seeds 3 --out swept --dry-run)" = \
  '2 of 3 trials are finished in swept' ] || fail 'a dry run'

# A broken, an old and a foreign line are told, and their trials run again.
sed -i -e '1s/"fell":0.0/"fell":1.0/' -e '2s/,"check".*/}/' swept/results.jsonl
sed -n '1s/"row":"one"/"row":"two"/p' swept/results.jsonl >> swept/results.jsonl
"$program" sweep sandbox/experiment.toml --seeds 2 --out swept > stdout 2> stderr ||
  fail 'a sweep of a log with broken lines'
for told in '1: is damaged or edited' '2: has no checksum' '3: is damaged or edited'; do
  grep -q "^warning: swept/results.jsonl:$told.*; left out$" stderr || fail "does not tell $told"
done
grep -q '0 of 2 trials' stderr || fail 'believes broken lines'
cmp -s swept/table.csv first.csv && cmp -s stdout first.md || fail 'another table after broken lines'

# A folder is of one experiment.
sed 's/turns = 0.02/turns = 0.03/' sandbox/experiment.toml > sandbox/other.toml
wrong '../swept: holds results of the experiment "experiment"; allowed for "other": a folder of its own, by --out' \
  sweep other.toml --out ../swept
wrong 'holds results of the experiment "experiment"' sweep other.toml --out ../swept --fresh
wrong 'holds results of the experiment "experiment"' sweep other.toml --out ../swept --dry-run
wrong 'holds results of the experiment "experiment"' montecarlo random.toml --out ../swept
wrong 'holds results of the experiment "experiment"' reproduce fig6 --turns 0.02 --out ../swept

# The same in two parts.
"$program" sweep sandbox/experiment.toml --seeds 2 --out parts --shard 2/2 > stdout 2> stderr ||
  fail 'a shard'
[ "$(ls parts | xargs)" = 'results-2of2.jsonl traces' ] || fail 'files of a shard'
wrong 'no results of 1 of 2 trials; shards not finished: 1/2' \
  sweep experiment.toml --seeds 2 --out ../parts --merge
"$program" sweep sandbox/experiment.toml --seeds 2 --out parts --shard 1/2 > stdout 2> stderr ||
  fail 'the other shard'
"$program" sweep sandbox/experiment.toml --seeds 2 --out parts --merge > stdout 2> stderr ||
  fail 'a merge'
cmp -s parts/table.csv first.csv && cmp -s stdout first.md || fail 'another table from shards'

# Random trials, of which the worst is run again as the report says.
"$program" montecarlo sandbox/random.toml --trials 4 --seed 3 --out drawn > stdout 2> stderr ||
  fail 'four random trials'
[ "$(ls drawn | xargs)" = 'random.json random.md results.jsonl table.csv traces' ] ||
  fail 'files of random trials'
cmp -s drawn/table.csv <("$program" montecarlo sandbox/random.toml --trials 4 --seed 4 --out other \
  > stdout 2> stderr && cat other/table.csv) && fail 'another seed, the same trials'
line=$(grep -m 1 '^    pirouette spin' drawn/random.md)
seed=$(sed 's/.*--seed \([0-9]*\).*/\1/' <<< "$line")
eval "\"$program\" ${line#*pirouette } --json" > stdout 2> stderr || fail "replay: $line"
rate=$(sed -n 's/.*"yaw_rate_mean": \([-0-9.e]*\).*/\1/p' stdout)
grep ",$seed," drawn/table.csv | grep -q -F ",$rate," || fail "the replay differs: $line"

# A robot that was described is the robot itself, to the last bit.
"$program" robot list > stdout 2> stderr && grep -q '^go1 ' stdout || fail 'robot list'
"$program" robot check go1 > stdout 2> stderr && grep -q 'It can walk' stdout || fail 'robot check'
"$program" robot describe go1 > go1.toml 2> stderr || fail 'robot describe'
for robot in "$source/robots/go1/go1.xml" go1.toml; do
  "$program" spin --robot "$robot" --angle 20 --out "of-$(basename "$robot")" --quiet > stdout 2> stderr ||
    fail "a spin of $robot"
done
cmp -s of-go1.xml/trace.npy of-go1.toml/trace.npy || fail 'robot describe gives another robot'

# Programs of other packages.
mkdir bin
printf '#!/bin/sh\necho "$#: $2"\nexit 7\n' > bin/pirouette-echo
chmod +x bin/pirouette-echo
PATH=$PWD/bin:$PATH "$program" echo --flag 'two words' > stdout 2> stderr
[ $? -eq 7 ] || fail 'the exit code of pirouette-echo is lost'
[ "$(cat stdout)" = '2: two words' ] || fail 'the arguments of pirouette-echo are lost'

"$program" > stdout 2> stderr && grep -q 'Usage: pirouette' stdout || fail 'no help without a verb'
"$program" --version > stdout 2> stderr && grep -q '^pirouette [0-9]' stdout || fail 'no --version'
for table in doc trace metrics dump; do
  "$program" config $table > stdout 2> stderr && [ -s stdout ] || fail "config $table"
done
"$program" config dump > own.toml && "$program" config check own.toml > stdout 2> stderr ||
  fail 'its own dump is not a valid configuration'

[ $failures -eq 0 ] && echo "all as expected" || echo "$failures failures"
exit $((failures > 0))
