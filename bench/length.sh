#!/usr/bin/env bash
# Time of `thread plan --objective length` beside that of `thread check` on its result, best of three, one run, one table.
# The ratio says how much finding and proving costs against verifying. THREAD names the program.
set -eu
cd "$(dirname "$0")/.."
thread=${THREAD:-build/release/thread}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

seconds() { # COMMAND..: best of three wall times
  local best='' i start end
  for i in 1 2 3; do
    start=$(date +%s%N)
    "$@" >/dev/null
    end=$(date +%s%N)
    if [ -z "$best" ] || [ $((end - start)) -lt "$best" ]; then best=$((end - start)); fi
  done
  awk -v ns="$best" 'BEGIN { printf "%.3f", ns / 1e9 }'
}

row() { # NAME FILE ENDS
  local plan check
  plan=$(seconds "$thread" plan "$2" -q --ends "$3" -o "$work/plan.json")
  check=$(seconds "$thread" check "$work/plan.json")
  "$thread" info "$2" -q --json | sed 's/.*"edges": \([0-9]*\).*"odd_nodes": \([0-9]*\).*/\1 \2/' |
    awk -v name="$1" -v ends="$3" -v plan="$plan" -v check="$check" \
      '{ printf "%-28s %-7s %7d %6d %9s %9s %8.1f\n", name, ends, $1, $2, plan, check, plan / check }'
}

printf '%-28s %-7s %7s %6s %9s %9s %8s\n' framework ends edges odd 'plan (s)' 'check (s)' ratio
for file in data/jax_fdm/liew_dome.json data/assembly-instances/fandisk.json; do
  for ends in closed any; do row "$(basename "$file")" "$file" $ends; done
done
for shape in 'dome --size 30' 'dome --size 70' 'geodesic --size 12' 'sphere --size 18' 'tube --size 48 --rings 40' \
  'honeycomb --size 12' 'honeycomb --size 25'; do
  # shellcheck disable=SC2086
  "$thread" make $shape -o "$work/frame.json"
  for ends in closed any; do row "$shape" "$work/frame.json" $ends; done
done
