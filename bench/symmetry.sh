#!/usr/bin/env bash
# Time of `thread symmetries` by size of framework and order of group: the whole table, and single rows (the largest group, one
# in the middle, the trivial one), wall time of one run each. "-": not proved within LIMIT seconds. THREAD names the program.
set -eu
cd "$(dirname "$0")/.."
thread=${THREAD:-build/release/thread}
limit=${LIMIT:-20}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

seconds() { # ARGUMENTS OF symmetries..: wall time, "-" if some row is not proved in time
  local start end code=0
  start=$(date +%s%N)
  "$thread" symmetries -q --json --time-limit "$limit" "$@" >"$work/table.json" 2>"$work/why" || code=$?
  end=$(date +%s%N)
  case $code in
  0) awk -v ns=$((end - start)) 'BEGIN { printf "%.3f", ns / 1e9 }' ;;
  5) echo - ;;
  *) cat "$work/why" >&2; exit 1 ;;
  esac
}

orders() { # order of each row of the table, one a line
  sed -n 's/^ {"number": [0-9]*, "order": \([0-9]*\).*/\1/p' "$work/table.json"
}

row() { # NAME FILE ENDS
  local all group classes middle order=() single=() k
  all=$(seconds "$2" --ends "$3")
  mapfile -t order < <(orders)
  classes=${#order[@]}
  group=$(sed -n '1s/.*"edges": \([0-9]*\).*, "order": \([0-9.e+]*\), "node_orbits".*/\1 \2/p' "$work/table.json")
  middle=$(((classes + 1) / 2))
  for k in 1 "$middle" "$classes"; do single+=("${order[$((k - 1))]}" "$(seconds "$2" --ends "$3" --group "$k")"); done
  # shellcheck disable=SC2086
  printf '%-28s %-7s %6s %10s %7d %9s  %6s %8s  %6s %8s  %6s %8s\n' "$1" "$3" $group "$classes" "$all" "${single[@]}"
}

printf '%-28s %-7s %6s %10s %7s %9s  %15s  %15s  %15s\n' framework ends edges group classes 'all (s)' 'largest (s)' 'middle (s)' \
  'trivial (s)'
for shape in 'dome --size 6' 'dome --size 12' 'dome --size 20' 'tube --size 12 --rings 7' 'honeycomb --size 4' 'sphere --size 1' \
  'sphere --size 3' 'geodesic --size 4'; do
  # shellcheck disable=SC2086
  "$thread" make $shape -o "$work/frame.json"
  for ends in closed any; do row "$shape" "$work/frame.json" $ends; done
done
for file in data/jax_fdm/liew_dome.json data/jax_fdm/barrel.obj data/assembly-instances/klein_bottle_trail.json; do
  [ -e "$file" ] && row "$(basename "$file")" "$file" closed
done
