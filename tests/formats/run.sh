#!/usr/bin/env bash
# tests/formats/run.sh [PROGRAM [NAMES]]: reads the files of table.tsv, or those whose names match the pattern, by name and from
# stdin without a name, and compares; then writes those that other programs wrote in every format that is written and reads that
# back. Prints what is wrong and "N files, N right, 0 wrong".
set -u
export LC_ALL=C
thread=$(realpath "$(command -v "${1:-thread}")")
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
cd "$(dirname "$0")" || exit 1
cp ./*.bin "$scratch" # which glTF files want beside them

edges() { # FRAME [OPTION..]: its edges as CSV
  "$thread" convert -q "$@" -T csv
}

count() { # EDGES: nodes, edges, length, highest z
  awk -F, 'NR == 1 { own = $7 == "length" } NR > 1 {
      a = $1 "," $2 "," $3; b = $4 "," $5 "," $6
      if (!(a in seen)) { seen[a] = 1; nodes++ }
      if (!(b in seen)) { seen[b] = 1; nodes++ }
      length_ += own ? $7 : sqrt(($1 - $4) ^ 2 + ($2 - $5) ^ 2 + ($3 - $6) ^ 2)
      for (i = 3; i <= 6; i += 3) if (NR == 2 && i == 3 || $i > top) top = $i }
    END { printf "%d %d %.9f %.9f\n", nodes, NR - 1, length_, top }' <<<"$1"
}

agrees() { # what was counted, the row
  awk -v got="$1" -v row="$2" 'BEGIN {
    split(got, g, " "); split(row, r, "\t")
    for (i = 1; i <= 4; i++) {
      want = r[i + 1]
      if (want != "-" && (g[i] == "" || (g[i] - want) ^ 2 > (1e-6 * (1 + want)) ^ 2)) exit 1
    } }'
}

refused() { # exit code, what is said of it, FRAME [OPTION..]
  local said code
  said=$(edges "${@:3}" 2>&1)
  code=$?
  [[ $code = "$1" && $said = *"$2"* && $said != *$'\n'* ]] || { echo "$3: exit code $code, $said" && return 1; }
}

files=0 right=0
while IFS= read -r row; do
  case $row in '#'* | '') continue ;; esac
  IFS=$'\t' read -r file nodes code why _ <<<"$row"
  read -ra frame <<<"$file"
  # shellcheck disable=SC2053 # a pattern
  [[ $file = ${2:-*} ]] || continue
  fine=yes
  files=$((files + 1))
  if [ "$nodes" = refused ]; then
    refused "$code" "$why" "${frame[@]}" && right=$((right + 1))
    continue
  fi
  lines=$(edges "${frame[@]}")
  got=$(count "$lines")
  agrees "$got" "$row" || { echo "$file: $got" && fine=; }
  cp "${frame[0]}" "$scratch/nameless"
  case $file in *-nodes.csv | *-edges.csv | *.off) ;; *) # whose names say what they are
    [ "$(edges "$scratch/nameless" "${frame[@]:1}")" = "$lines" ] || { echo "$file: read otherwise without its name" && fine=; } ;;
  esac
  case $file in blender-* | ezdxf-* | networkx* | igraph*) types='json obj csv ply dxf graphml' ;; *) types= ;; esac
  for type in $types; do
    [[ $type = [jcg]* || $lines = *z2$'\n'* ]] || continue # lengths and covers, which the others do not keep
    "$thread" convert -q "${frame[@]}" -o "$scratch/again.$type"
    [ "$(edges "$scratch/again.$type")" = "$lines" ] || { echo "$file: not the same as $type" && fine=; }
  done
  [ -z "$fine" ] || right=$((right + 1))
done <table.tsv
echo "$files files, $right right, $((files - right)) wrong"
[ "$files" -gt 0 ] && [ "$right" -eq "$files" ]
