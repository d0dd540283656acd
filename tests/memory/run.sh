#!/usr/bin/env bash
# Every command with allocations that fail, its libraries' and its child processes' included:
#   tests/memory/run.sh PROGRAM fail_malloc.so FOLDER [SAMPLES [WORD]]
# Allocations are told apart by the stack of calls that leads to them. Of each command (that has this word) so many stacks are
# tried (0: all), evenly spread: the first allocation of each fails, by itself and then with all that come after it. Allowed are
# the exit codes 0, 3, 4, 5 and 70, with a message if it is not 0. What was written is whole: the same bytes as without failures,
# or a plan that `thread check` accepts, or a PDF with the same pages and fonts; with exit code 0 nothing is missing. And real plans are
# checked in 40 MB of address space. One line per failure, with the words that repeat it, then "N passed, N failed".
set -u
export LC_ALL=C
program=$(realpath "$1") library=$(realpath "$2") folder=$3 samples=${4:-40} word=${5:-}
data=$PWD/data passed=0 failed=0
rm -rf "$folder"
mkdir -p "$folder/inputs"
cd "$folder" || exit 1
folder=$PWD
export XDG_CACHE_HOME=$folder/cache

# The exit code is the command's; $folder/record is as fail_malloc.c says.
try() { # FOLDER SETTINGS.. -- COMMAND..: in a fresh folder with the inputs
  local here=$1 settings=()
  shift
  while [ "$1" != -- ]; do settings+=("$1") && shift; done
  shift
  rm -rf "$here"
  mkdir "$here"
  ln -s "$folder"/inputs/* "$here"
  : >"$folder/record"
  (cd "$here" && exec timeout -s KILL 600 env FAIL_FILE="$folder/record" "${settings[@]}" LD_PRELOAD="$library" "$program" "$@") \
    >"$here.out" 2>"$here.err" </dev/null
}

number() { # PLACE: the number that is there in the record
  od -An -td8 -j $((8 * $1)) -N 8 "$folder/record" | tr -d ' '
}

# The allocation that is meant is looked for near where it was; everywhere if things came in another order.
try_stack() { # STACK AT ON COMMAND..
  local stack=$1 at=$2 on=$3 code
  shift 3
  try run FAIL_STACK="$stack" FAIL_FROM=$((at > 500 ? at - 500 : 0)) $on -- "$@"
  code=$?
  [ "$(number 1)" = 0 ] || return $code
  try run FAIL_STACK="$stack" $on -- "$@"
}

# fontconfig may leave a word out, or set it in another place, when a single allocation of theirs fails, and say nothing.
pages_and_fonts() { # FILE
  pdfinfo "$1" 2>&1 | grep -E '^Pages|Error'
  pdffonts "$1" 2>&1 | sed '1,2d; s/^[A-Z]*+//' | awk '{ print $1, $2 }'
}

is_whole() { # FILE
  cmp -s "run/$1" "whole/$1" && return
  case $1 in
  *.json) "$program" check -q "run/$1" >check.out 2>&1 ;;
  *.pdf) [ "$(tail -c 6 "run/$1")" = '%%EOF' ] && cmp -s <(pages_and_fonts "run/$1") <(pages_and_fonts "whole/$1") ;;
  *) false ;;
  esac
}

# Empty, or what is wrong with the files of a run that ended with exit code $1.
judge() { # CODE
  local file
  case $1 in
  0) ;;
  3 | 4 | 5 | 70) grep -q '^thread: ' run.err || { echo "exit code $1 without a message" && return; } ;;
  *) echo "exit code $1" && return ;;
  esac
  find run -name '.thread-*' | grep . && return
  while read -r file; do
    if [ ! -e "run/$file" ]; then
      [ "$1" != 0 ] || { echo "no $file" && return; }
    elif ! is_whole "$file"; then
      echo "half of $file or other bytes" && return
    fi
  done < <(cd whole && find . -type f)
}

command_fails() { # COMMAND..
  local code n allocations step i at on wrong before=$failed unmet=0 stacks=()
  case $* in *"$word"*) ;; *) return ;; esac
  try whole -- "$@"
  code=$?
  [ $code = 0 ] || { echo "thread $*: exit code $code without failures: $(cat whole.err)" && failed=$((failed + 1)) && return; }
  allocations=$(number 0)
  n=$(number 2)
  [ "${n:-0}" -gt 0 ] || { echo "thread $*: no allocation was recorded: is $library loaded?" && failed=$((failed + 1)) && return; }
  readarray -t stacks < <(od -An -v -tx8 -w16 -j 24 -N $((16 * n)) "$folder/record")
  step=$((samples > 0 && n > samples ? n / samples : 1))
  for ((i = 0, at = 0; at < n; i++, at += step)); do
    read -r stack place <<<"${stacks[step > 1 ? (at + (i * 7919) % step) % n : at]}"
    for on in '' FAIL_ON=1; do
      try_stack "$stack" $((16#$place)) "$on" "$@"
      wrong=$(judge $?)
      if [ "$(number 1)" = 0 ]; then
        unmet=$((unmet + 1))
      elif [ -z "$wrong" ]; then
        passed=$((passed + 1))
      else
        failed=$((failed + 1))
        echo "thread $*: FAIL_STACK=$stack $on: $wrong: $(head -c 300 run.err | tr '\n' ' ')"
      fi
    done
  done
  echo "thread $*: $allocations allocations, $n stacks, $i tried, $((failed - before)) failed, $unmet not met again"
}

"$program" make dome --size 3 -o inputs/frame.json && "$program" plan inputs/frame.json --ends feet -q -o inputs/plan.json &&
  "$program" plan inputs/frame.json --ends any -q -o inputs/any.json && "$program" eval inputs/plan.json >/dev/null &&
  "$program" eval inputs/plan.json --method joint >/dev/null 2>&1 || exit 1

fits_into_40_mb() { # PLAN
  if (ulimit -v 40000 && exec "$program" check -q "$1"); then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "thread check $1 in 40 MB: exit code $?"
  fi
}

"$program" plan "$data/jax_fdm/liew_dome.json" --cords 1 -q -o liew.json && "$program" plan "$data/jax_fdm/barrel.obj" --cords 1 -q -o barrel.json || exit 1
for plan in "$data"/dome7-*.json liew.json barrel.json; do fits_into_40_mb "$plan"; done

command_fails make dome --size 3 -o new.json
command_fails info frame.json
command_fails plan frame.json --ends feet -o new.json
command_fails plan frame.json --ends feet --cords 2 --balance -o new.json
command_fails plan frame.json --crossings forbid --cords 2 -o new.json
command_fails plan frame.json --ends feet --tune engine=lp -o new.json
command_fails plan frame.json --ends feet --objective tortuosity -o new.json
command_fails plan frame.json --ends feet --objective symmetry -o new.json
command_fails plan frame.json --ends feet --joint tube -o new.json
command_fails symmetries frame.json --ends feet
command_fails advise frame.json --time-limit 0
command_fails check plan.json
command_fails eval plan.json --method joint --plot tension.svg
command_fails eval plan.json --method structure --tune time-step=10 --tune iterations=0.1
command_fails eval plan.json --method structure --taut --load B2=1 --load-pulls 5 --schedule "all: pull both 9" -o new.json
command_fails compare plan.json any.json --method all
command_fails draw plan.json -o overview.svg
command_fails draw plan.json -T pdf -o sheets.pdf
command_fails draw plan.json -T html -o viewer.html
command_fails draw plan.json -T cords.csv -o cords.csv

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
