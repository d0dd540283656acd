#!/usr/bin/env bash
# Runs a part of the tests and closes with the line "N passed, N failed": tests/run.sh test|fast|rest|all|fuzz, started by `make
# test`, test-fast, test-rest, test-all and fuzz, which set MAKE, OUT (where things are built), FUZZ_SECONDS, VIEWER_PACKAGES and
# ONLY (run the jobs whose name contains this word). tests/README.md says what is in each.
set -u
cd "$(dirname "$0")/.." || exit 1
export LC_ALL=C OUT=${OUT:-build} FUZZ_SECONDS=${FUZZ_SECONDS:-60} MAKE=${MAKE:-make} CLANG_FORMAT=${CLANG_FORMAT:-clang-format}
export RESULTS=$OUT/results

# First what needs nothing built, so that there is something to see at once; then what takes long, the longest first, so that no
# processor is left without work at the end. `make test-fast` does without those that take long.
at_once='layers layers-self-test format viewer/page'
longest='release/memory property/test_cover property/test_pull_limit release/watchdog golden/figures property/test_circuits
property/test_shortest second/plans viewer/browser golden/eval unit/test_planner unit/test_memory unit/test_advice
property/test_decomposition property/test_reference property/test_cross fuzz/fuzz_plan property/test_few_edges golden/turning
property/test_distinct golden/plan golden/second golden/cords golden/schedules golden/threads golden/convert golden/compare
golden/draw golden/usage unit/test_standing unit/test_symmetry unit/test_sheets unit/test_tied_symmetry
property/test_evenly unit/test_svg_page unit/test_joint unit/test_hubs unit/test_rigidity unit/test_eval
property/test_length_options property/test_anneal property/test_walk_proof property/test_turning property/test_order
property/test_cross_known golden/meant golden/symmetries unit/test_postman unit/test_drag unit/test_frontier_chart
unit/test_threads unit/test_tortuosity'

# Laws with many examples: `make test` runs an eighth of them, `make test-rest` the others, and that eighth under sanitizers.
sweeps() {
  grep -lE 'share_of|ADD_EXAMPLES|ADD_LARGE' tests/property/*.c | sed 's#^tests/#release/#; s#\.c$##'
}

# ---- one job: tests/run.sh job NAME. Writes "passed failed skipped" to $RESULTS/NAME.count and prints a line to file 7 (make has 3 and 4). ----

count_check() { # sums Check's closing lines; a program that ends badly after them fails once more
  awk -v code="$2" '
    /^[0-9]+%: Checks: [0-9]+, Failures: [0-9]+, Errors: [0-9]+$/ {
      split($0, n, /[^0-9]+/); checks += n[2]; bad += n[3] + n[4] }
    END { passed = checks - bad; if ((code != 0 && bad == 0) || checks == 0) bad++; print passed + 0, bad + 0, 0 }' "$1"
}

count_lines() { # the closing line of tests/golden/run.sh, tests/second/compare.py, tests/viewer/run.sh, tests/memory/run.sh, the watchdog, ..
  awk -v code="$2" '
    /^[0-9]+ passed, [0-9]+ failed$/ { passed = $1; failed = $3; seen = 1 }
    END { if (!seen || (code != 0 && failed == 0)) failed++; print passed + 0, failed + 0, 0 }' "$1"
}

# New inputs go below $OUT, the seeds of the tree are only read. FUZZ_RUNS is how many inputs are tried; 0: FUZZ_SECONDS, going on
# from what was found before.
fuzz() { # NAME LOG
  local target=${1#fuzz/fuzz_} found limit most
  local -a more=()
  found=$OUT/fuzz/found/$target
  limit="-runs=$FUZZ_RUNS -seed=1" most=1800
  if [ "$FUZZ_RUNS" = 0 ]; then limit=-max_total_time=$FUZZ_SECONDS most=$((FUZZ_SECONDS * 3 + 120)); else rm -rf "$found"; fi
  mkdir -p "$found" "$OUT/fuzz/failures"
  [ -f "tests/fuzz/$target.dict" ] && more+=("-dict=tests/fuzz/$target.dict")
  [ -d "tests/fuzz/corpus/$target" ] && more+=("tests/fuzz/corpus/$target")
  # shellcheck disable=SC2086 # two words
  timeout "$most" "$OUT/fuzz/tests/$1" $limit -timeout=120 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$OUT/fuzz/failures/$target-" "$found" "${more[@]}" >"$2" 2>&1
}

format() { # LOG
  env -u MAKEFLAGS -u MAKELEVEL "$MAKE" -s format-check >"$1.all" 2>&1
  local code=$?
  sed -n 's/^\([^:]*\):.*code should be clang-formatted.*/\1/p' "$1.all" | sort | uniq -c >"$1"
  if [ -s "$1" ]; then echo 'lines to change, by file; "make format" does it' >>"$1"; else cat "$1.all" >"$1"; fi
  return $code
}

# A program of tests runs one of so many of its examples; -8: what 8 leaves out.
share() { # NAME
  case ${TIER-}/$1 in
  fast/* | rest/asan/unit/*) echo 10 ;;
  test/release/property/* | rest/asan/property/*) echo 8 ;;
  rest/release/property/test_circuits) echo 1 ;;
  rest/release/property/*) echo -8 ;;
  *) echo 1 ;;
  esac
}

viewer_page() {
  tools/npm-packages.sh viewer "$OUT/viewer" || { echo '1 skipped' && return 77; }
  viewer/build.sh "$OUT/viewer" | cmp - diagram/export/viewer_page.html && return
  echo 'diagram/export/viewer_page.html is not what viewer/ gives; "make viewer" builds it'
  return 1
}

run() { # NAME LOG: runs the job; its exit code, 77 = skipped
  local name=$1 build=${1%%/*} rest=${1#*/} log=$2
  case $name in
  # shellcheck disable=SC2086 # one word per package
  viewer/* | schema | web) flock "$RESULTS/packages" tools/install-packages.sh ${VIEWER_PACKAGES:-} >>"$log" 2>&1 ;;
  slicers) flock "$RESULTS/packages" tools/install-packages.sh admesh libxml2-utils openscad prusa-slicer unzip >>"$log" 2>&1 ;;
  esac
  export THREAD_TEST_SHARE CK_TIMEOUT_MULTIPLIER=10
  THREAD_TEST_SHARE=$(share "$name")
  [ "$build" = asan ] && CK_TIMEOUT_MULTIPLIER=30
  case $name in
  layers) tests/layers.sh ;;
  layers-self-test) tests/layers.sh --self-test ;;
  documents) tools/source_tour.py --check && tests/documents.py "$OUT/release/thread" ;;
  format) format "$log" && return ;;
  */golden/*) tests/golden/run.sh "$OUT/$build/thread" "tests/$rest" ;;
  release/memory) nice tests/memory/run.sh "$OUT/release/thread" "$OUT/release/tests/memory/fail_malloc.so" "$OUT/memory" "$MEMORY_SAMPLES" ;;
  release/watchdog) timeout 1800 "$OUT/release/watchdog" "$OUT/release/thread" "$OUT/watchdog" ;;
  release/* | asan/*) timeout 3600 "$OUT/$build/tests/$rest" </dev/null ;;
  second/plans) timeout 1800 tests/second/compare.py "$OUT/release/thread" ;;
  schema) tests/schema/run.sh "$OUT/release/thread" "$OUT/schema-test" ;;
  second/json) tests/second/read_json.py "$OUT/release/tests/second/dump_json" ;;
  viewer/page) viewer_page ;;
  bench/smallest) bench/run.py "$OUT/release/thread" --smallest ;;
  library/install) tests/library/run.sh "$OUT/release" "$OUT/library-test" ;;
  formats/mutants) tests/formats/mutants.py "$OUT/release/thread" --each "$MUTANTS" ;;
  slicers) tests/kit/run.sh "$OUT/release/thread" ;;
  film) tests/film.py "$OUT/release/tests/unit/test_film" "$OUT/film-test" ;;
  readme) tests/readme/run.sh "$OUT/release/thread" ;;
  tutorial) tools/make_docs.py "$OUT/release/thread" --check ;;
  examples) tests/examples/run.sh "$OUT/release/thread" ;;
  web) tests/web.sh "$OUT/release/thread" "$OUT/web" "$OUT/web-test" ;;
  static) tests/targets.sh static "$OUT/release/thread" "$OUT/static/thread" ;;
  release) tests/release.sh "$OUT" ;;
  windows) tests/targets.sh windows "$OUT/release/thread" "$OUT/windows/thread.exe" ;;
  exchange) tests/exchange.sh "$OUT/release/thread" ;;
  viewer/browser) tests/viewer/run.sh "$OUT/release/thread" "$OUT/viewer-test" ;;
  fuzz/*) fuzz "$name" "$log" ;;
  esac >>"$log" 2>&1
}

job() { # NAME
  local name=$1 code=0 note='' spent counts passed failed skipped
  local log=$RESULTS/${name//\//_}.log TIMEFORMAT='%1R s, %1U + %1S CPU s'
  : >"$log"
  spent=$( { time run "$name" "$log" 7>&-; } 2>&1) || code=$?
  case $name in
  */golden/* | */memory | */watchdog | second/* | schema | viewer/browser | library/* | readme | slicers | film | examples | exchange | web | static | windows | release | formats/*) counts=$(count_lines "$log" "$code") ;;
  asan/* | release/*) counts=$(count_check "$log" "$code") ;;
  *) if [ "$code" -eq 0 ]; then counts='1 0 0'; else counts='0 1 0'; fi ;;
  esac
  [ $code -eq 77 ] && [ "${CI:-}" != true ] && counts="0 0 $(sed -n 's/^\([0-9]*\) skipped$/\1/p' "$log")"
  case $name in fuzz/*) note=$(sed -n 's/^stat::number_of_executed_units: *\(.*\)/, \1 runs/p' "$log") ;; esac
  read -r passed failed skipped <<<"$counts"
  { # one write at a time, so that lines of parallel jobs do not mix
    flock 9
    if [ "$failed" -gt 0 ]; then
      printf 'FAIL  %-44s %4d, %d FAILED (exit code %d)\n' "$name" "$passed" "$failed" "$code"
      head -c 100000 "$log" | sed 's/^/      | /'
    elif [ "$skipped" -gt 0 ]; then
      printf 'skip  %-44s %4d  (npm, its network or a browser is missing)\n' "$name" "$skipped"
    else
      printf 'ok    %-44s %4d  (%s%s)\n' "$name" "$passed" "$spent" "$note"
    fi
    echo "$spent $name" >>"$RESULTS/times"
  } 9>"$RESULTS/lock" >&7
  echo "$counts" >"$RESULTS/${name//\//_}.count"
}

if [ "${1:-}" = job ]; then
  { true >&7; } 2>/dev/null || exec 7>&1
  job "$2"
  exit 0
fi

# ---- which jobs ----

export TIER=${1:-test} MEMORY_SAMPLES=40 MUTANTS=50 FUZZ_RUNS=100000
# Golden cases that take minutes under sanitizers, and whose planning and evaluation other tests run under them.
slow='asan/kit.case asan/figures.case asan/eval.case asan/cords.case asan/turning.case asan/threads.case asan/convert.case asan/plan.case asan/compare.case asan/schedules.case asan/rise.case'
# What a change needs within minutes, and what `make test` leaves to `make test-rest`: no tenth of these says anything.
builds=release tree='layers layers-self-test documents format bench/smallest library/install readme tutorial examples formats/mutants'
programs='second/json second/plans schema viewer/page viewer/browser' fuzz='' whole='' left=''
rest='release/memory release/watchdog release/golden/figures.case release/property/test_circuits'
case $TIER in
test) left=$rest ;;
fast) tree='layers documents format' programs='' ;;
rest) builds=asan tree='' programs='' fuzz=yes whole="$rest slicers film $(sweeps)" MEMORY_SAMPLES=16 ;;
all) builds='release asan' slow=asan/figures.case whole='release/watchdog release/memory slicers film exchange web static windows release' fuzz=yes MUTANTS=2000 FUZZ_RUNS=1000000 ;;
fuzz) builds='' tree='' programs='' fuzz=yes FUZZ_RUNS=0 ;;
*) echo "tests/run.sh: $TIER is none of test, fast, rest, all and fuzz" >&2 && exit 2 ;;
esac

list() { # every job of the tier
  local build case
  printf '%s\n' $tree $whole $programs
  for build in $builds; do
    "$MAKE" -s list-tests | sed "s#^#$build/#"
    for case in tests/golden/*.case; do
      [[ " $slow " == *" $build/${case##*/} "* ]] || echo "$build/${case#tests/}"
    done
  done
  [ -z "$fuzz" ] || "$MAKE" -s list-fuzz
}

order() {
  awk -v first="$at_once" -v longest="$longest" -v tier="$TIER" '
    BEGIN {
      n = split(first " " longest, name)
      for (i = 1; i <= n; i++) rank[name[i]] = i - n - 1
      if (tier == "fast") long = -split(longest, name)
    }
    {
      short = $1
      sub(/^(release|asan)\//, "", short)
      sub(/\.case$/, "", short)
      place = $1 in rank ? rank[$1] : rank[short] + 0
      if (place >= 0 || place < long) print place, $1
    }' | sort -s -k1,1n | cut -d' ' -f2
}

mapfile -t queue < <(list | sort -u | grep -vxF "${left// /$'\n'}" | grep -F -e "${ONLY:-}" | order)
if [ ${#queue[@]} = 0 ]; then
  echo "no job of this part has \"${ONLY:-}\" in its name: see make test-rest and make test-all"
  echo '0 passed, 0 failed'
  exit 1
fi

# ---- running them: make builds what each job needs, and runs it; what the compilers say goes into a file ----

export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1
rm -rf "$RESULTS"
mkdir -p "$RESULTS"
exec 7>&1
export JOBS_release='' JOBS_asan='' JOBS_fuzz=''
for name in "${queue[@]}"; do
  case $name in
  asan/*) JOBS_asan+=" run/$name" ;;
  fuzz/*) JOBS_fuzz+=" run/$name" ;;
  *) JOBS_release+=" run/$name" ;;
  esac
done
jobs=("-j$(nproc)")
case ${MAKEFLAGS:-} in *-j*) jobs=() ;; esac
"$MAKE" --no-print-directory -k -O "${jobs[@]}" ${JOBS_release:+suite-release} ${JOBS_asan:+suite-asan} ${JOBS_fuzz:+suite-fuzz} \
  >"$RESULTS/build.log" 2>&1

# A job without a count was killed, or what it needs was not built.
bad=
for name in "${queue[@]}"; do
  file=$RESULTS/${name//\//_}
  [ -e "$file.count" ] && continue
  bad=yes
  if [ -e "$file.log" ]; then echo "FAIL  $name: killed"; else echo "FAIL  $name: does not build"; fi
  echo '0 1 0' >"$file.count"
done
[ -z "$bad" ] || grep -vE '^  (CC|CXX|AS|AR|LINK) ' "$RESULTS/build.log" | sed 's/^/      | /'
if [ ${#queue[@]} -gt 10 ] && [ -e "$RESULTS/times" ]; then
  awk '{ sum += $3 + $5 } END { printf "%d s of processors; the jobs that took most:\n", sum }' "$RESULTS/times"
  awk '{ printf "%8.1f s  %s\n", $3 + $5, $NF }' "$RESULTS/times" | sort -rn | head -n 10
fi
cat "$RESULTS"/*.count | awk '
  { passed += $1; failed += $2; skipped += $3 }
  END {
    if (skipped) printf "%d skipped: npm, its network or a browser is missing\n", skipped
    printf "%d passed, %d failed\n", passed, failed
    exit failed > 0 || passed == 0 }'
