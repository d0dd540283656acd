#!/bin/sh
# SPDX-License-Identifier: MIT
# Every framework with every list of options, as many at a time as there are processors:
#   sweep.sh FOLDER FRAME.. -- OPTIONS..
#   sweep.sh out data/*.json -- '--cords 1' '--cords 4 --ends feet' '--objective tortuosity --time-limit 60'
# FOLDER/results.jsonl has a line for each, in this order. The same command goes on where a killed one was. With GNU parallel, where
# it is installed (PARALLEL="--sshloginfile .." spreads it over machines), else with xargs. On a cluster: slurm.sh.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$1
shift
mkdir -p "$folder"
: >"$folder/cells.part"
frames=
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  frames="$frames$1
"
  shift
done
[ $# -gt 1 ] || { echo "usage: sweep.sh FOLDER FRAME.. -- OPTIONS.." >&2; exit 2; }
shift
printf '%s' "$frames" | while IFS= read -r frame; do
  for options; do printf '%s\t%s\n' "$frame" "$options" >>"$folder/cells.part"; done
done
if [ -e "$folder/cells" ] && ! cmp -s "$folder/cells" "$folder/cells.part"; then
  echo "sweep.sh: $folder holds another sweep" >&2
  exit 2
fi
mv "$folder/cells.part" "$folder/cells"
n=$(wc -l <"$folder/cells")
[ -z "${SWEEP_ONLY_LIST:-}" ] || { echo "$n"; exit 0; }
if command -v parallel >/dev/null; then
  seq "$n" | parallel --will-cite "$here/cell.sh" "$folder" || true
else
  seq "$n" | xargs -P "$(nproc)" -n 1 "$here/cell.sh" "$folder" || true
fi
missing=0
for i in $(seq "$n"); do
  if [ -e "$folder/$i.row" ]; then cat "$folder/$i.row"; else missing=$((missing + 1)); fi
done >"$folder/results.part"
[ "$missing" -eq 0 ] || { echo "sweep.sh: $missing of $n cells are missing; the same command goes on" >&2; exit 1; }
mv "$folder/results.part" "$folder/results.jsonl"
echo "$n cells: $folder/results.jsonl"
