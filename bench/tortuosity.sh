#!/usr/bin/env bash
# Turning of one closed cord by each way of finding it, divided by the bound that `--objective tortuosity` proves, and
# exp(mu * turning), mu = 0.2, beside that of its plan, as a power of ten. The tours are the classical ones, with the cheapest
# pairing of every bead kept or ignored. One run, one table. bench/tortuosity.sh [FRAME..]: these frameworks besides the made ones.
# THREAD names the program, LIMIT the time for each framework (20 s).
set -euo pipefail
thread=$(readlink -f "${THREAD:-$(dirname "$0")/../build/release/thread}")
limit=${LIMIT:-20}
work=$(mktemp -d)
touch "$work/errors"
trap 'cat "$work/errors" >&2; rm -rf "$work"' EXIT

plan() { # FRAME OPTION..: a plan that is not proved is one, too
  local frame=$1
  shift
  "$thread" plan "$frame" -q --ends closed --time-limit "$limit" "$@" -o "$work/plan.json" 2>"$work/errors" || [ $? -eq 5 ]
}

run() { # FRAME OPTION..: makes $work/plan.json; user + system time
  local TIMEFORMAT='%U %S' frame=$1
  shift
  { time plan "$frame" "$@"; } 2>&1 | awk 'END { printf "%.2f", $1 + $2 }'
}

turning() { # of all cords, rad
  sed -n 's/^  "turning": \([0-9][-+.e0-9]*\),.*/\1/p' "$work/plan.json"
}

bound() { # that the plan's proof gives, rad
  sed -n 's/^  "turning": {.*"lower_bound": \([-+.e0-9]*\),.*/\1/p' "$work/plan.json"
}

line() { # NAME WAY SECONDS TURNING BOUND LEAST
  awk -v name="$1" -v way="$2" -v s="$3" -v turning="$4" -v bound="$5" -v least="$6" \
    'BEGIN { degree = atan2(0, -1) / 180
             printf "%-28s %-20s %11.0f %9.4f %11.1f %8s\n", name, way, turning / degree, turning / bound,
                    0.2 * (turning > least ? turning - least : 0) / log(10), s }'
}

rows() { # NAME FRAME
  local seconds turning bound least options
  seconds=$(run "$2" --objective tortuosity)
  least=$(turning)
  bound=$(bound)
  line "$1" least "$seconds" "$least" "$bound" "$least"
  for options in 'tortuosity --tour fleury' 'tortuosity --tour fleury --pairings ignore' 'tortuosity --tour hierholzer' \
    'tortuosity --tour hierholzer --pairings ignore' length; do
    # shellcheck disable=SC2086
    seconds=$(run "$2" --objective $options)
    turning=$(turning)
    line '' "$(echo "$options" | sed 's/.*--tour //; s/ --pairings/,/')" "$seconds" "$turning" "$bound" "$least"
  done
}

printf '%-28s %-20s %11s %9s %11s %8s\n' framework way 'turning deg' '/ bound' 'capstan 10^' 'CPU s'
for shape in 'dome --size 6' 'dome --size 14' 'dome --size 20' 'geodesic --size 3' 'geodesic --size 4' 'sphere --size 3' \
  'tube --size 24 --rings 15' 'honeycomb --size 6'; do
  # shellcheck disable=SC2086
  "$thread" make $shape -o "$work/frame.json"
  rows "$shape" "$work/frame.json"
done
for frame in "$@"; do rows "$(basename "$frame")" "$frame"; done
