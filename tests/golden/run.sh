#!/usr/bin/env bash
# Golden cases of the command line: tests/golden/run.sh PROGRAM [FILE.case ..]. The format is in tests/README.md.
# Prints a diff for each case that fails and closes with "N passed, N failed". UPDATE=1 rewrites failing cases.
set -u
[ $# -ge 1 ] || { echo "usage: [UPDATE=1] tests/golden/run.sh PROGRAM [FILE.case ..]" >&2; exit 2; }
program=$(realpath "$1")
[ -x "$program" ] || { echo "golden: $1 is not a program" >&2; exit 2; }
shift
files=()
for file; do files+=("$(realpath "$file")"); done
cd "$(dirname "$0")/../.." || exit 2
[ ${#files[@]} -gt 0 ] || for file in tests/golden/*.case; do [ -e "$file" ] && files+=("$file"); done

work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
ln -s "$program" "$work/bin/thread"
export PATH=$work/bin:$PATH LC_ALL=C TERM=dumb XDG_CACHE_HOME=$work/cache
unset COLUMNS NO_COLOR CLICOLOR_FORCE MAKEFLAGS MAKELEVEL
passed=0 failed=0

# Does ACTUAL fit EXPECTED? A line " ..." stands for any lines, "..." inside a line for any characters.
# shellcheck disable=SC2016
fits='
  function line_fits(e, a,    k, n, part, at) {
    if (e == a) return 1
    n = split(e, part, /\.\.\./)
    if (n < 2 || substr(a, 1, length(part[1])) != part[1]) return 0
    a = substr(a, length(part[1]) + 1)
    for (k = 2; k < n; k++) {
      if (!(at = index(a, part[k])) && part[k] != "") return 0
      if (part[k] != "") a = substr(a, at + length(part[k]))
    }
    return length(a) >= length(part[n]) && substr(a, length(a) - length(part[n]) + 1) == part[n]
  }
  FILENAME == ARGV[1] { e[++ne] = $0; next }
  { a[++na] = $0 }
  END {
    row[0] = 1 # row[j]: the first i expected lines fit the first j actual ones
    for (i = 1; i <= ne; i++) {
      before = row[0]; row[0] = before && e[i] == " ..."
      for (j = 1; j <= na; j++) {
        old = row[j]
        row[j] = e[i] == " ..." ? old || row[j - 1] : before && line_fits(e[i], a[j])
        before = old
      }
    }
    exit !row[na + 0]
  }'

# The scratch folder becomes {TMP}, lines that would read as marks get "= " in front, a missing last newline is said.
written() { # FILE MARK
  [ -s "$1" ] || return 0
  sed "s#$tmp#{TMP}#g" "$1" | awk -v mark="$2" '{ print mark ((mark == "" && $0 ~ /^([$!?=] |#| \.\.\.$)/) ? "= " : "") $0 }'
  [ -z "$(tail -c 1 "$1")" ] || echo "$2\\ no newline at the end"
}

run_case() { # compares $work/expected with what $command does; appends the case to $work/new
  printf '%s\n' "${command//\{TMP\}/$tmp}" >"$work/command"
  timeout 300 sh "$work/command" >"$work/out" 2>"$work/err" </dev/null
  local code=$?
  { written "$work/out" ''; written "$work/err" '! '; echo "? $code"; } >"$work/actual"
  grep -q '^? ' "$work/expected" || echo '? 0' >>"$work/expected"
  echo "\$ $command" >>"$work/new"
  if awk "$fits" "$work/expected" "$work/actual"; then
    passed=$((passed + 1))
    cat "$work/expected" >>"$work/new"
    return
  fi
  failed=$((failed + 1))
  echo "$name:$at: \$ $command"
  diff -u --label expected --label actual "$work/expected" "$work/actual" | tail -n +3
  cat "$work/actual" >>"$work/new"
}

run_file() {
  name=${1#"$PWD"/} tmp=$work/tmp
  local line number=0
  command='' at=0
  rm -rf "$tmp"
  mkdir "$tmp"
  : >"$work/new"
  : >"$work/expected"
  # comments and empty lines before a case belong to the file, not to the case before
  local gap=''
  end_case() {
    [ -z "$command" ] || run_case
    command=''
    printf '%s' "$gap" >>"$work/new"
    gap=''
    : >"$work/expected"
  }
  while IFS= read -r line || [ -n "$line" ]; do
    number=$((number + 1))
    case $line in
    '$ '*)
      end_case
      command=${line#'$ '} at=$number
      ;;
    '#'*) gap+=$line$'\n' ;;
    *)
      if [ -n "$command" ] && ! grep -q '^? ' "$work/expected"; then
        printf '%s\n' "$line" >>"$work/expected"
      elif [ -z "$line" ]; then # after the exit code: a gap between cases
        gap+=$'\n'
      else
        echo "$name:$number: text outside a case: $line"
        failed=$((failed + 1))
        gap+=$line$'\n'
      fi
      ;;
    esac
  done <"$1"
  end_case
  if [ -n "${UPDATE:-}" ] && ! cmp -s "$work/new" "$1"; then
    cat "$work/new" >"$1"
    echo "$name: rewritten; read the difference before you commit it"
  fi
}

for file in "${files[@]}"; do run_file "$file"; done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
