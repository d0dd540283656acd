#!/usr/bin/env bash
# CPU time of certified minimum T-joins (whole: shrinking, searches, matching, pricing, moats), in one table; where LEMON is installed
# (liblemon-dev) beside its perfect matching on the same instances, with the ratios: on the candidate pairs against our matching of the
# same pairs, on the port gadget against the whole. LENGTH must agree. THREAD names the program, whose library is used; SIZES the
# numbers of edges; LEMON_SECONDS limits each run of LEMON.
set -eu
cd "$(dirname "$0")/.."
library=$(dirname "${THREAD:-build/release/thread}")/libthread.a
sizes=${SIZES:-1000 10000 100000}
families=${FAMILIES:-grid geodesic honeycomb honeycomb-equal planar}
seconds=${LEMON_SECONDS:-60}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# shellcheck disable=SC2046
"${CC:-cc}" -std=c11 -O2 -D_DEFAULT_SOURCE -I. -c -o "$work/matching.o" bench/matching.c
# shellcheck disable=SC2046
"${CXX:-c++}" -o "$work/matching" "$work/matching.o" "$library" $(pkg-config --libs igraph nauty bullet-float64) -lglpk -lm
lemon=
if "${CXX:-c++}" -std=c++17 -O2 -w -o "$work/lemon" bench/lemon.cpp -llemon 2>/dev/null; then lemon=$work/lemon; fi

printf '%-16s %8s %8s %9s %9s %6s %8s %16s' family edges odd 'whole (s)' 'match (s)' rounds MB length
if [ -n "$lemon" ]; then printf ' %10s %6s %10s %6s' 'L pairs' ratio 'L ports' ratio; fi
echo
for edges in $sizes; do
  for family in $families; do
    line=$("$work/matching" "$family" "$edges" "$work")
    printf '%s' "$line"
    if [ -n "$lemon" ]; then
      pairs=$(timeout "$seconds" "$lemon" pairs "$work/pairs" || echo - -)
      ports=$(timeout "$seconds" "$lemon" ports "$work/graph" || echo - -)
      awk -v line="$line" -v pairs="$pairs" -v ports="$ports" '
        function show(text, own,    part) {
          split(text, part, " ")
          if (part[1] == "-") printf " %10s %6s", ">limit", "-"
          else if (part[1] < 0.0005 || own < 0.00005) printf " %10s %6s", part[1], "-" # too short to be measured
          else printf " %10s %6.1f", part[1], part[1] / own
          return part[2]
        }
        BEGIN {
          split(line, own, " ")
          show(pairs, own[5])
          if (show(ports, own[4]) + 0 != own[8] + 0 && ports !~ /^-/) printf " LENGTHS DIFFER"
        }'
    fi
    echo
  done
done
