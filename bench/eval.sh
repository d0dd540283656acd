#!/usr/bin/env bash
# Time of `thread eval` by each method beside the closed form's on the same plan, one run, one table. joint: with an empty cache
# of measured joints and with a full one. THREAD names the program. A row takes up to a minute.
set -eu
cd "$(dirname "$0")/.."
thread=${THREAD:-build/release/thread}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

seconds() { # COMMAND..: user + system time
  local TIMEFORMAT='%U %S'
  { time "$@" >/dev/null; } 2>&1 | awk 'END { printf "%.3f", $1 + $2 }'
}

row() { # NAME PLAN
  local passes capstan cold warm limit
  passes=$(sed -n 's/.*"passes": \([0-9]*\).*/\1/p' "$2" | head -n 1)
  rm -rf "$work/cache"
  capstan=$(seconds "$thread" eval "$2")
  cold=$(seconds "$thread" eval "$2" --method joint --cache "$work/cache")
  warm=$(seconds "$thread" eval "$2" --method joint --cache "$work/cache")
  limit=$(seconds "$thread" eval "$2" --method structure --no-dynamics)
  awk -v n="$1" -v p="$passes" -v c="$capstan" -v cold="$cold" -v warm="$warm" -v limit="$limit" \
    'BEGIN { printf "%-20s %7d %9s %9s %9s %9.1f %9s\n", n, p, c, cold, warm, cold / (warm > 0.001 ? warm : 0.001), limit }'
}

printf '%-20s %7s %9s %9s %9s %9s %9s\n' framework passes 'capstan s' 'cold s' 'warm s' 'cold/warm' 'limit s'
for size in 7 14 20 23; do
  "$thread" make dome --size $size -o "$work/frame.json"
  "$thread" plan "$work/frame.json" -q -o "$work/plan.json"
  row "dome $size x $size" "$work/plan.json"
done
"$thread" plan data/assembly-instances/fandisk.json -q -o "$work/plan.json"
row fandisk "$work/plan.json"
