#!/usr/bin/env bash
# tests/formats/run.sh [PROGRAM]: reads the files of table.tsv, by name and from stdin without a name, and compares; then writes
# each in every format that is written and reads that back. Prints what is wrong and "N files, N right, 0 wrong".
set -u
export LC_ALL=C
folder=$(dirname "$0")
thread=${1:-thread}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
cp "$folder"/*.bin "$scratch" # which glTF files want beside them

count() { # FRAME: nodes, edges, length, highest z, from the six columns of CSV and from info
  "$thread" convert -q "$1" -T csv | awk -F, 'NR > 1 {
      a = $1 "," $2 "," $3; b = $4 "," $5 "," $6
      if (!(a in seen)) { seen[a] = 1; nodes++ }
      if (!(b in seen)) { seen[b] = 1; nodes++ }
      length_ += NF > 6 ? $7 : sqrt(($1 - $4) ^ 2 + ($2 - $5) ^ 2 + ($3 - $6) ^ 2)
      for (i = 3; i <= 6; i += 3) if (NR == 2 && i == 3 || $i > top) top = $i }
    END { printf "%d %d %.9f %.9f\n", nodes, NR - 1, length_, top }'
}

agrees() { # what was counted, the row
  awk -v got="$1" -v row="$2" 'BEGIN {
    split(got, g, " "); split(row, r, "\t")
    for (i = 1; i <= 4; i++) {
      want = r[i + 1]
      if (want != "-" && (g[i] == "" || (g[i] - want) ^ 2 > (1e-6 * (1 + want)) ^ 2)) exit 1
    } }'
}

files=0 right=0
while IFS= read -r row; do
  case $row in '#'* | '') continue ;; esac
  file=${row%%$'\t'*} fine=yes
  files=$((files + 1))
  got=$(count "$folder/$file")
  agrees "$got" "$row" || { echo "$file: $got" && fine=; }
  cp "$folder/$file" "$scratch/nameless"
  [ "$(count "$scratch/nameless")" = "$got" ] || { echo "$file: read otherwise without its name" && fine=; }
  for type in json obj csv ply dxf graphml; do
    "$thread" convert -q "$folder/$file" -o "$scratch/again.$type"
    case $file$type in ezdxf-all.dxf[^jgc]* | dxf-two-vertex-circle.dxf[^jgc]*) continue ;; esac # curves, whose lengths these do not keep
    [ "$(count "$scratch/again.$type")" = "$got" ] || { echo "$file: not the same as $type" && fine=; }
  done
  [ -z "$fine" ] || right=$((right + 1))
done <"$folder/table.tsv"
echo "$files files, $right right, $((files - right)) wrong"
[ "$files" -gt 0 ] && [ "$right" -eq "$files" ]
