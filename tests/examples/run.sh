#!/usr/bin/env bash
# The examples that run in other programs, and sweeps: tests/examples/run.sh PROGRAM, with the shared library beside it; closes with
# "N passed, N failed". The other examples of libthread are run by tests/library/run.sh.
set -u
[ $# -eq 1 ] || { echo "usage: tests/examples/run.sh PROGRAM" >&2; exit 2; }
program=$(realpath "$1")
cd "$(dirname "$0")/../.." || exit 2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
ln -s "$program" "$work/bin/thread"
export PATH=$work/bin:$PATH LC_ALL=C
LIBTHREAD=$(find "$(dirname "$program")" -maxdepth 1 -name 'libthread.so.*' | head -n 1)
export LIBTHREAD
passed=0 failed=0
holds() { # WORDS COMMAND ..
  if "${@:2}" >"$work/said" 2>&1; then passed=$((passed + 1)); return; fi
  failed=$((failed + 1))
  echo "not so: $1"
  sed 's/^/    /' "$work/said"
}
count_rows() { [ "$(wc -l <"$work/$1/results.jsonl")" -eq "$2" ] && python3 -c 'import json, sys; [json.loads(l) for l in sys.stdin]' <"$work/$1/results.jsonl"; }

read -r a _ b _ < <(python3 tests/examples/hosts.py "$program" | tee "$work/hosts" | tail -n 1)
passed=$((passed + ${a:-0})) failed=$((failed + ${b:-1}))
grep -v passed "$work/hosts"

# A sweep: four frameworks (one is none) x two lists of options; then the same, killed on the way.
for size in 3 4 5; do thread make dome --size $size -o "$work/dome $size.json"; done
frames=("$work"/dome\ *.json "$work/none.obj")
options=('--cords 1' '--cords 2 --ends feet --capacity 2')
sweep() { examples/sweep/sweep.sh "$work/$1" "${frames[@]}" -- "${options[@]}"; }
stop_soon() { # after its third cell
  setsid examples/sweep/sweep.sh "$work/killed" "${frames[@]}" -- "${options[@]}" >/dev/null 2>&1 &
  local sweeping=$!
  for _ in $(seq 600); do
    [ "$(find "$work/killed" -name '*.row' 2>/dev/null | wc -l)" -ge 3 ] && break
    sleep 0.01
  done
  kill -KILL -- -$sweeping 2>/dev/null
  wait $sweeping 2>/dev/null
  [ "$(find "$work/killed" -name '*.row' | wc -l)" -ge 3 ]
}
goes_on() { # what was done is not done again
  local first before
  first=$(find "$work/killed" -name '*.row' | sort | head -n 1)
  before=$(stat -c %Y.%i "$first")
  sweep killed && [ "$(stat -c %Y.%i "$first")" = "$before" ]
}
holds 'a sweep runs' sweep whole
holds 'it has a row for every cell' count_rows whole 8
holds 'and says what it could not read' grep -q 'none.obj.*"code": 3, "plan": null' "$work/whole/results.jsonl"
holds 'a sweep is killed' stop_soon
holds 'it goes on' goes_on
holds 'with the same results' cmp "$work/whole/results.jsonl" "$work/killed/results.jsonl"
holds 'another sweep does not take its folder' bash -c "! examples/sweep/sweep.sh '$work/whole' '$work/none.obj' -- --balance"
# As Slurm runs a task.
cp -r examples/sweep "$work/submitted"
SWEEP_ONLY_LIST=1 sweep array >/dev/null
for task in 1 2 3 4 5 6 7 8; do
  holds "array task $task" env SLURM_SUBMIT_DIR="$work/submitted" SLURM_ARRAY_TASK_ID=$task sh examples/sweep/slurm.sh "$work/array"
done
holds 'an array is collected' sweep array
holds 'with the same results' cmp "$work/whole/results.jsonl" "$work/array/results.jsonl"

if command -v blender >/dev/null; then
  thread make dome -o "$work/dome.obj"
  holds 'the add-on runs in Blender' blender -b --factory-startup --python-exit-code 1 --python tests/examples/in_blender.py -- "$work/dome.obj"
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
