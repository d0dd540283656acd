#!/bin/sh
# SPDX-License-Identifier: MIT
# One cell of a sweep: cell.sh FOLDER N plans line N of FOLDER/cells (framework, tab, options) and leaves FOLDER/N.json, the plan,
# and FOLDER/N.row, one JSON line with what `thread plan --json` says and its exit code. A cell that is there is done: a sweep that
# was killed goes on where it was. The row comes last and whole, so that what is there is complete.
set -u
folder=$1 n=$2
[ -e "$folder/$n.row" ] && exit 0
tab=$(printf '\t')
line=$(sed -n "${n}p" "$folder/cells")
frame=${line%%"$tab"*} options=${line#*"$tab"}
# shellcheck disable=SC2086 # options are words
summary=$(thread plan "$frame" $options -j 1 --json -o "$folder/$n.json" 2>"$folder/$n.messages")
code=$?
case $code in 0 | 2 | 3 | 4 | 5) ;; *) exit $code ;; esac # killed, or a fault: not done
# Files by their names, as the folder may be moved; and no plan where there is none.
summary=$(printf '%s' "$summary" | sed "s|\"$folder/|\"|g")
case $code in 0 | 5) ;; *) summary=null ;; esac
quoted() { printf '%s' "$1" | sed 's/[\\"]/\\&/g'; }
printf '{"cell": %d, "frame": "%s", "options": "%s", "code": %d, "plan": %s}\n' "$n" "$(quoted "$frame")" "$(quoted "$options")" \
  $code "${summary:-null}" >"$folder/$n.part" && mv "$folder/$n.part" "$folder/$n.row"
