#!/usr/bin/env bash
# Runs the whole suite and closes with the line "N passed, N failed". Started by `make test`, which sets
# MAKE, OUT (where things are built), FUZZ_SECONDS, VIEWER_PACKAGES and ONLY (run the jobs whose name contains this word).
# `tests/run.sh fuzz` (make fuzz): the fuzz targets only, keeping what they find. tests/README.md tells more.
set -u
cd "$(dirname "$0")/.." || exit 1
export LC_ALL=C OUT=${OUT:-build} FUZZ_SECONDS=${FUZZ_SECONDS:-10} FUZZ_SEED=${FUZZ_SEED:-1}
export MAKE=${MAKE:-make} CLANG_FORMAT=${CLANG_FORMAT:-clang-format}
ONLY=${ONLY:-}
export RESULTS=$OUT/results
jobs=()
case ${MAKEFLAGS:-} in *-j*) ;; *) jobs=("-j$(nproc)") ;; esac

# ---- one job: tests/run.sh --job NAME. Writes "passed failed" to $RESULTS/NAME.count and prints one line. ----

count_check() { # sums Check's closing lines; a program that ends badly after them fails once more
  awk -v code="$2" '
    /^[0-9]+%: Checks: [0-9]+, Failures: [0-9]+, Errors: [0-9]+$/ {
      split($0, n, /[^0-9]+/); checks += n[2]; bad += n[3] + n[4] }
    END { passed = checks - bad; if ((code != 0 && bad == 0) || checks == 0) bad++; print passed + 0, bad + 0 }' "$1"
}

count_golden() { # the closing line of tests/golden/run.sh, tests/second/compare.py, tests/viewer/run.sh, tests/memory/run.sh and the watchdog
  awk -v code="$2" '
    /^[0-9]+ passed, [0-9]+ failed$/ { passed = $1; failed = $3; seen = 1 }
    END { if (!seen || (code != 0 && failed == 0)) failed++; print passed + 0, failed + 0 }' "$1"
}

fuzz() { # NAME LOG: new inputs go below $OUT, the seeds of the tree are only read
  local target=${1#fuzz/} seeds found dictionary
  local -a more=()
  target=${target#fuzz_}
  seeds=tests/fuzz/corpus/$target
  found=$OUT/fuzz/found/$target
  dictionary=tests/fuzz/$target.dict
  [ "$FUZZ_SEED" = 0 ] || rm -rf "$found"
  mkdir -p "$found" "$OUT/fuzz/failures"
  [ -f "$dictionary" ] && more+=("-dict=$dictionary")
  [ -d "$seeds" ] && more+=("$seeds")
  timeout $((FUZZ_SECONDS * 3 + 120)) "$OUT/fuzz/tests/$1" -max_total_time="$FUZZ_SECONDS" -seed="$FUZZ_SEED" -timeout=20 \
    -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="$OUT/fuzz/failures/$target-" \
    "$found" "${more[@]}" >"$2" 2>&1
}

job() {
  local name=$1 build=${1%%/*} rest=${1#*/} code=0 note='' start end counts passed failed
  local log=$RESULTS/${name//\//_}.log
  start=$(date +%s%N)
  case $name in
  layers) tests/layers.sh >"$log" 2>&1 || code=$? ;;
  layers-self-test) tests/layers.sh --self-test >"$log" 2>&1 || code=$? ;;
  format)
    "$MAKE" -s format-check >"$log.all" 2>&1 || code=$?
    sed -n 's/^\([^:]*\):.*code should be clang-formatted.*/\1/p' "$log.all" | sort | uniq -c >"$log"
    if [ -s "$log" ]; then echo 'lines to change, by file; "make format" does it' >>"$log"; else cat "$log.all" >"$log"; fi
    ;;
  asan/* | release/*)
    export CK_TIMEOUT_MULTIPLIER=3
    [ "$build" = release ] || CK_TIMEOUT_MULTIPLIER=10
    case $rest in
    golden/*) tests/golden/run.sh "$OUT/$build/thread" "tests/$rest" >"$log" 2>&1 || code=$? ;;
    memory)
      nice tests/memory/run.sh "$OUT/$build/thread" "$OUT/$build/tests/memory/fail_malloc.so" "$OUT/memory" >"$log" 2>&1 || code=$? ;;
    watchdog) timeout 900 "$OUT/$build/watchdog" "$OUT/$build/thread" "$OUT/watchdog" >"$log" 2>&1 || code=$? ;;
    *) timeout 900 "$OUT/$build/tests/$rest" >"$log" 2>&1 </dev/null || code=$? ;;
    esac
    ;;
  second/plans) timeout 900 tests/second/compare.py "$OUT/release/thread" >"$log" 2>&1 || code=$? ;;
  viewer/page) viewer/build.sh "$OUT/viewer" 2>"$log" | cmp - diagram/export/viewer_page.html >>"$log" 2>&1 ||
    { code=1 && echo 'diagram/export/viewer_page.html is not what viewer/ gives; "make viewer" builds it' >>"$log"; } ;;
  viewer/browser) tests/viewer/run.sh "$OUT/release/thread" "$OUT/viewer-test" >"$log" 2>&1 || code=$? ;;
  fuzz/*)
    fuzz "$name" "$log" || code=$?
    note=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    note=${note:+, $note runs}
    ;;
  esac
  end=$(date +%s%N)
  case $name in
  */golden/* | */memory | */watchdog | second/plans | viewer/browser) counts=$(count_golden "$log" "$code") ;;
  asan/* | release/*) counts=$(count_check "$log" "$code") ;;
  *) if [ "$code" -eq 0 ]; then counts='1 0'; else counts='0 1'; fi ;;
  esac
  echo "$counts" >"$RESULTS/${name//\//_}.count"
  passed=${counts% *} failed=${counts#* }
  { # one write at a time, so that lines of parallel jobs do not mix
    flock 9
    if [ "$failed" -eq 0 ]; then
      printf 'ok    %-44s %4d  (%d.%d s%s)\n' "$name" "$passed" $(((end - start) / 1000000000)) $(((end - start) / 100000000 % 10)) "$note"
    else
      printf 'FAIL  %-44s %4d, %d FAILED (exit code %d)\n' "$name" "$passed" "$failed" "$code"
      head -c 100000 "$log" | sed 's/^/      | /'
    fi
  } 9>"$RESULTS/lock"
}

if [ "${1:-}" = --job ]; then
  job "$2"
  exit 0
fi

# ---- the whole suite ----

only_fuzz=
[ "${1:-}" = fuzz ] && only_fuzz=yes
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1
rm -rf "$RESULTS"
mkdir -p "$RESULTS"

give_up() { # NAME: a job that cannot run
  echo "FAIL  $1: does not build"
  echo '0 1' >"$RESULTS/${1//\//_}.count"
}

build() { # BUILD GOAL..: true if everything was made
  local build=$1
  shift
  if "$MAKE" --no-print-directory -k "${jobs[@]}" BUILD="$build" "$@" >"$RESULTS/build-$build.txt" 2>&1; then
    ! grep -q 'warning:' "$RESULTS/build-$build.txt" || sed 's/^/      | /' "$RESULTS/build-$build.txt"
    return 0
  fi
  echo "FAIL  build $build"
  sed 's/^/      | /' "$RESULTS/build-$build.txt"
  return 1
}

made() { "$MAKE" -s BUILD="$1" "$2" >/dev/null 2>&1; } # is this file there and up to date?

wanted() { case $1 in *"$ONLY"*) true ;; *) false ;; esac }

queue=()
if [ -z "$only_fuzz" ]; then
  for name in layers layers-self-test format; do wanted "$name" && queue+=("$name"); done
fi

# longest first: fuzz targets, then the sanitizer build
mapfile -t fuzzers < <("$MAKE" -s list-fuzz | sort)
mapfile -t programs < <("$MAKE" -s list-tests | sort)
goals=() names=()
for target in "${fuzzers[@]}"; do
  [ -n "$target" ] && wanted "$target" && goals+=("$OUT/fuzz/tests/$target") && names+=("$target")
done
if [ ${#goals[@]} -gt 0 ]; then
  all=yes
  build fuzz "${goals[@]}" || all=
  for target in "${names[@]}"; do
    if [ -n "$all" ] || made fuzz "$OUT/fuzz/tests/$target"; then queue+=("$target"); else give_up "$target"; fi
  done
fi

[ -n "$only_fuzz" ] || for variant in asan release; do
  goals=() names=() cases=()
  for program in "${programs[@]}"; do
    [ -n "$program" ] && wanted "$variant/$program" && goals+=("$OUT/$variant/tests/$program") && names+=("$program")
  done
  for case in tests/golden/*.case; do
    [ -e "$case" ] && wanted "$variant/${case#tests/}" && cases+=("${case#tests/}")
  done
  watchdog= # of the program that users have: sanitizers take time and memory of their own
  memory=   # the same
  [ "$variant" = release ] && wanted release/watchdog && watchdog=$OUT/release/watchdog && goals+=("$watchdog")
  [ "$variant" = release ] && wanted release/memory && memory=$OUT/release/tests/memory/fail_malloc.so && goals+=("$memory")
  [ -n "$ONLY" ] && [ ${#goals[@]} -eq 0 ] && [ ${#cases[@]} -eq 0 ] && continue
  all=yes
  build "$variant" all "${goals[@]}" || all=
  for program in "${names[@]}"; do
    if [ -n "$all" ] || made "$variant" "$OUT/$variant/tests/$program"; then queue+=("$variant/$program"); else give_up "$variant/$program"; fi
  done
  if [ -n "$memory" ]; then
    if [ -n "$all" ] || { made release "$memory" && made release "$OUT/release/thread"; }; then queue+=(release/memory); else give_up release/memory; fi
  fi
  if [ -n "$watchdog" ]; then
    if [ -n "$all" ] || { made release "$watchdog" && made release "$OUT/release/thread"; }; then queue+=(release/watchdog); else give_up release/watchdog; fi
  fi
  [ ${#cases[@]} -eq 0 ] && continue
  if [ -n "$all" ] || made "$variant" "$OUT/$variant/thread"; then
    for case in "${cases[@]}"; do queue+=("$variant/$case"); done
  else
    give_up "$variant/golden"
  fi
done

if [ -z "$only_fuzz" ] && wanted second/plans; then
  if made release all || build release all; then queue+=(second/plans); else give_up second/plans; fi
fi

# The viewer last: it needs npm and a browser.
if [ -z "$only_fuzz" ]; then
  names=()
  for name in viewer/page viewer/browser; do wanted "$name" && names+=("$name"); done
  # shellcheck disable=SC2086 # one word per package
  if [ ${#names[@]} -eq 0 ]; then
    :
  elif tools/install-packages.sh ${VIEWER_PACKAGES:-} && build release all; then
    queue+=("${names[@]}")
  else
    give_up viewer
  fi
fi

[ ${#queue[@]} -eq 0 ] || printf '%s\n' "${queue[@]}" | xargs -P "$(nproc)" -I{} tests/run.sh --job {}

# A job that was queued but left no count was killed: it failed.
for name in "${queue[@]}"; do
  [ -e "$RESULTS/${name//\//_}.count" ] || { echo "FAIL  $name: killed" && echo '0 1' >"$RESULTS/${name//\//_}.count"; }
done
cat "$RESULTS"/*.count 2>/dev/null | awk '
  { passed += $1; failed += $2 }
  END { printf "%d passed, %d failed\n", passed, failed; exit failed > 0 || passed == 0 }'
