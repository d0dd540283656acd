#!/usr/bin/env bash
# Who may include whom, who may print or exit, include guards, no paths or hosts of one machine.
# Prints "layers: ok", or each violation as file:line: what; then exits 1. `--self-test` proves that it catches each kind.
set -u
export LC_ALL=C

if [ "${1:-}" != --self-test ]; then
  cd "${1:-$(dirname "$0")/..}" || exit 2
fi

# module: the modules whose headers it may include
allowed_modules='graph:graph
lp:lp graph
symmetry:symmetry graph lp
tortuosity:tortuosity graph lp
eval:eval graph lp
diagram:diagram graph
planner:planner graph lp symmetry tortuosity
cli:cli graph lp symmetry tortuosity planner eval diagram'

# foreign and Linux headers: the only file that may include them. "*" also stands for a folder of headers.
owners='igraph.h:graph/framework/igraph.c
jansson.h:graph/io/json_jansson.c
glpk.h:lp/solver/lp_glpk.c
nau*.h:symmetry/group/nauty.c
traces.h:symmetry/group/nauty.c
*bt[A-Z]*.h:eval/joint/bullet.cpp
SuiteSparse*.h:eval/structure/spqr.c
cholmod*.h:eval/structure/spqr.c
cairo*.h:diagram/export/paper.c
librsvg/*.h:diagram/export/paper.c
sys/prctl.h:graph/process/process.c
dlfcn.h:graph/process/lazy.c'

# C++, in the file that shims a C++ library
cpp_headers='new utility cmath cstdlib cstring vector'

# C11 and POSIX
system_headers='assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg
stdatomic stdbool stddef stdint stdio stdlib stdnoreturn string tgmath threads time wchar wctype
dirent fcntl fnmatch getopt glob libgen poll pthread regex strings sys/ioctl sys/mman sys/resource sys/stat sys/time sys/types
sys/wait termios unistd'

# The sources without comments and without what strings say, line by line; #include lines keep their names.
check_sources() { # FILE..
  awk -v modules="$allowed_modules" -v owners="$owners" -v system_headers="$system_headers" -v cpp_headers="$cpp_headers" '
    function bad(what) { print FILENAME ":" FNR ": " what }
    function strip(s,    out, c, two, i, n) { # uses and sets in_comment
      out = ""; n = length(s)
      for (i = 1; i <= n; i++) {
        c = substr(s, i, 1); two = substr(s, i, 2)
        if (in_comment) { if (two == "*/") { in_comment = 0; i++ } }
        else if (two == "/*") { in_comment = 1; i++; out = out " " }
        else if (two == "//") break
        else if (c == "\"" || c == "\047") {
          out = out c
          for (i++; i <= n && substr(s, i, 1) != c; i++) if (substr(s, i, 1) == "\\") i++
          out = out c
        } else out = out c
      }
      return out
    }
    function owner_of(name,    pattern) {
      for (pattern in owner) if (name ~ pattern) return owner[pattern]
      return ""
    }
    function check_include(s,    name, quoted, parts) {
      quoted = s ~ /^[ \t]*#[ \t]*include[ \t]*"/
      if (!match(s, /["<][^">]*[">]/)) { bad("#include without a name"); return }
      name = substr(s, RSTART + 1, RLENGTH - 2)
      if (quoted) {
        split(name, parts, "/")
        if (name !~ /\// || name ~ /\.\./) bad("write \"module/" name "\", not a relative name")
        else if (!((module, parts[1]) in may)) bad(module "/ must not include " parts[1] "/")
      } else if (owner_of(name) != "") {
        if (owner_of(name) != FILENAME) bad("only " owner_of(name) " may include <" name ">")
      } else if (FILENAME ~ /\.cpp$/ && (name in is_cpp)) {
      } else if (!(name in is_system)) bad("<" name "> is neither C11, POSIX nor a library with one owner")
    }
    BEGIN {
      n = split(modules, rows, "\n")
      for (i = 1; i <= n; i++) { split(rows[i], row, ":"); m = split(row[2], list, " "); for (j = 1; j <= m; j++) may[row[1], list[j]] = 1 }
      n = split(owners, rows, "\n")
      for (i = 1; i <= n; i++) { split(rows[i], row, ":"); gsub(/\./, "[.]", row[1]); gsub(/\*/, ".*", row[1]); owner["^" row[1] "$"] = row[2] }
      n = split(system_headers, list, /[ \n]+/)
      for (i = 1; i <= n; i++) is_system[list[i] ".h"] = 1
      n = split(cpp_headers, list, " ")
      for (i = 1; i <= n; i++) is_cpp[list[i]] = 1
    }
    FNR == 1 { module = FILENAME; sub(/\/.*/, "", module); in_comment = 0 }
    {
      was_comment = in_comment
      code = strip($0)
      if (!was_comment && code ~ /^[ \t]*#[ \t]*include/) { check_include($0); next }
      if (module == "cli") next
      if (match(code, /(^|[^A-Za-z0-9_])(printf|vprintf|puts|putchar|perror|exit|_exit|_Exit|quick_exit|abort)[ \t]*\(/)) {
        word = substr(code, RSTART, RLENGTH); gsub(/[^A-Za-z_]/, "", word)
        # a forked child has no other way to end
        if (word != "_exit" || FILENAME != "graph/process/process.c") bad(word "(): only cli/ prints and exits")
      }
      if (code ~ /(^|[^A-Za-z0-9_])(stderr|stdout|STDOUT_FILENO|STDERR_FILENO)([^A-Za-z0-9_]|$)/ && FILENAME != "graph/text.c")
        bad("stdout/stderr: only cli/ and thr_text_write in graph/text.c write there")
    }' "$@"
}

# #ifndef THR_X_H and #define THR_X_H as the first code of every header
check_guards() { # FILE..
  awk '
    function report() { if (last != "" && state != 2) print last ":1: no include guard THR_.._H" }
    FNR == 1 { report(); last = FILENAME; state = 0; name = "" }
    state == 0 && /^#ifndef THR_[A-Z0-9_]+_H$/ { state = 1; name = $2; next }
    state == 1 { state = ($1 == "#define" && $2 == name) ? 2 : 3
      if (name in seen) print FILENAME ":" FNR ": " name " guards " seen[name] " too"
      seen[name] = FILENAME }
    END { report() }' "$@"
}

check_machine() { # every text file except build output and fuzz seeds
  find . \( -name .git -o -name build -o -path ./tests/fuzz/corpus \) -prune -o -type f -print0 |
    xargs -0 grep -HnIE \
      '(^|[^A-Za-z0-9_.<])/(home|root|Users|work|mnt|media)/[A-Za-z0-9_.]|[A-Za-z]:\\Users|(deb\.debian|registry\.npmjs|files\.pythonhosted|static\.crates|proxy\.golang)\.(org|io)' |
    sed -E 's#^\./##; s#^([^:]+:[0-9]+):.*#\1: a path or host of one machine#'
}

check_tree() {
  local -a sources=() headers=()
  mapfile -t sources < <(for m in graph lp symmetry tortuosity planner eval diagram cli; do
    for f in "$m"/*.c "$m"/*.h "$m"/*.cpp "$m"/*/*.c "$m"/*/*.h "$m"/*/*.cpp; do [ -e "$f" ] && echo "$f"; done
  done)
  for f in "${sources[@]}"; do case $f in *.h) headers+=("$f") ;; esac; done
  [ ${#sources[@]} -eq 0 ] || check_sources "${sources[@]}"
  [ ${#headers[@]} -eq 0 ] || check_guards "${headers[@]}"
  check_machine
}

report() {
  local violations
  violations=$(check_tree)
  if [ -n "$violations" ]; then
    printf '%s\n' "$violations" | sort -t: -k1,1 -k2,2n
    return 1
  fi
  echo 'layers: ok'
}

# ---- self-test: each violation in a tree of its own, then things that must pass ----

self_test() {
  local scratch failed=0 n=0
  scratch=$(mktemp -d) || exit 2
  # shellcheck disable=SC2064 # the value of now
  trap "rm -rf '$scratch'" EXIT

  expect() { # FILE:LINE|ok FILE TEXT
    local want=$1 file=$2 text=$3 got
    n=$((n + 1))
    rm -rf "$scratch/tree"
    mkdir -p "$scratch/tree/$(dirname "$file")"
    printf '%b' "$text" >"$scratch/tree/$file"
    got=$(cd "$scratch/tree" && report)
    case $want in
    ok) [ "$got" = 'layers: ok' ] ;;
    *) case $got in "$want: "*) true ;; *) false ;; esac ;;
    esac || { failed=1 && echo "self-test $n: wanted $want for $file, got: $got"; }
  }

  expect graph/a.c:1 graph/a.c '#include "lp/solver/lp.h"\n'
  expect lp/a.c:2 lp/a.c '\n#include "tortuosity/t.h"\n'
  expect tortuosity/a.c:1 tortuosity/a.c '#include "symmetry/s.h"\n'
  expect tortuosity/a.c:1 tortuosity/a.c '#include "planner/plan.h"\n'
  expect diagram/a.c:1 diagram/a.c '#include "lp/solver/lp.h"\n'
  expect eval/a.h:3 eval/a.h '#ifndef THR_A_H\n#define THR_A_H\n# include  "diagram/d.h"\n#endif\n'
  expect graph/a.c:1 graph/a.c '#include "frame.h"\n'
  expect graph/a.c:1 graph/a.c '#include "../lp/lp.h"\n'
  expect graph/a.c:1 graph/a.c '#include <igraph.h>\n'
  expect graph/framework/frame.c:1 graph/framework/frame.c '#include <jansson.h>\n'
  expect cli/main.c:1 cli/main.c '#include <glpk.h>\n'
  expect symmetry/group/group.c:1 symmetry/group/group.c '#include <traces.h>\n'
  expect symmetry/group/group.c:1 symmetry/group/group.c '#include <nauty/nausparse.h>\n'
  expect eval/a.c:1 eval/a.c '#include <SuiteSparseQR_C.h>\n'
  expect eval/a.cpp:1 eval/a.cpp '#include <btBulletDynamicsCommon.h>\n'
  expect eval/a.c:1 eval/a.c '#include <BulletDynamics/btBox.h>\n'
  expect eval/a.c:1 eval/a.c '#include <new>\n'
  expect eval/a.c:1 eval/a.c 'void f(void) { _exit(1); }\n'
  expect lp/a.c:1 lp/a.c '#include <curl/curl.h>\n'
  expect graph/a.c:1 graph/a.c 'int f(void) { return printf("x"); }\n'
  expect lp/a.c:2 lp/a.c '\nvoid f(void) { exit (1); }\n'
  expect lp/a.c:1 lp/a.c 'void f(void) { abort(); }\n'
  expect eval/a.c:1 eval/a.c 'void f(void) { fprintf(stderr, "x"); }\n'
  expect eval/a.c:1 eval/a.c 'void f(void) { fputs("x", stdout); }\n'
  expect eval/a.c:3 eval/a.c '/* one\n two */\nvoid f(void) { char c = \047"\047; puts("x"); }\n'
  expect graph/a.h:1 graph/a.h 'int f(void);\n'
  expect graph/a.h:1 graph/a.h '#ifndef A_H\n#define A_H\n#endif\n'
  expect graph/a.h:1 graph/a.h '#ifndef THR_A_H\n#define THR_B_H\n#endif\n'
  expect docs/a.md:2 docs/a.md "one\nsee /ho""me/someone/thread\n"
  expect tools/a.sh:1 tools/a.sh "curl http://deb.deb""ian.org/x\n"
  expect ok graph/framework/igraph.c '#include <igraph.h>\n#include <stdio.h>\n#include "graph/framework/frame.h"\n'
  expect ok lp/solver/lp_glpk.c '#include "graph/framework/frame.h"\n#include "lp/solver/lp.h"\n#include <glpk.h>\n'
  expect ok symmetry/group/nauty.c '#include "graph/framework/frame.h"\n#include <traces.h>\n'
  expect ok eval/joint/bullet.cpp '#include <BulletDynamics/btBox.h>\n#include <btBulletDynamicsCommon.h>\n#include <new>\n'
  expect graph/a.c:1 graph/a.c '#include <sys/prctl.h>\n'
  expect graph/framework/igraph.c:1 graph/framework/igraph.c '#include <dlfcn.h>\n'
  expect ok graph/process/process.c '#include <sys/prctl.h>\n#include <sys/wait.h>\nvoid f(void) { _exit(1); }\n'
  expect ok graph/text.c 'void f(void) { fwrite("", 1, 0, stdout); }\n'
  expect ok cli/main.c '#include "lp/solver/lp.h"\nint main(void) { printf("%d", 1); exit(0); }\n'
  expect ok graph/a.c '/* printf(1); #include "lp/solver/lp.h"\n#include "lp/solver/lp.h"\n */\nint f(void) { return snprintf(0, 0, "exit(1) stderr"); } // puts(1)\n'
  expect ok graph/a.c 'void thr_exit(int); void f(int at_exit) { thr_exit(at_exit); my_printf(1); }\n'
  expect ok graph/a.h '/* head */\n#ifndef THR_A_H\n#define THR_A_H\n#endif\n'
  expect ok docs/a.md 'cord/wo''rk/length, https://example.org/wo''rk/x, <b>/home/</b>\n'

  [ "$failed" -eq 0 ] && echo "layers: self-test ok, $n trees"
  return "$failed"
}

if [ "${1:-}" = --self-test ]; then self_test; else report; fi
