#!/usr/bin/env bash
# Who may include whom, who may print or exit, what the checker reaches, names of files, circles of files, includes of what is used,
# include guards, no paths or hosts of one machine.
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
kit:kit diagram graph
planner:planner graph lp symmetry tortuosity
include:include
lib:lib include graph lp symmetry tortuosity planner eval diagram kit
cli:cli lib include graph lp symmetry tortuosity planner eval diagram kit
targets:targets cli graph eval diagram
web:web targets cli graph eval diagram'

# The checker reaches, also through other headers, only headers of these folders: nothing that makes plans.
checker=graph/check
checker_reaches='graph graph/framework graph/plan graph/check graph/io/json.h graph/io/json.h'

# At most so many files of a folder may include each other in a circle (x.c and x.h are one file).
longest_circle=3

# foreign and Linux headers: the only file that may include them. "*" also stands for a folder of headers.
owners='igraph.h:graph/framework/igraph.c
charconv:graph/number.cpp
glpk.h:lp/solver/lp_glpk.c
nau*.h:symmetry/group/nauty.c
traces.h:symmetry/group/nauty.c
*bt[A-Z]*.h:eval/joint/bullet.cpp
SuiteSparse*.h:eval/structure/spqr.c
cholmod*.h:eval/structure/spqr.c
fontconfig*.h:diagram/export/font_find.c
zlib.h:diagram/export/deflate.c
sys/prctl.h:graph/process/process.c
dlfcn.h:graph/process/lazy.c
emscripten.h:web/host.c
windows.h:targets/windows/os.c
io.h:targets/windows/os.c
process.h:targets/windows/os.c'

# C++, in the file that shims a C++ library
cpp_headers='new utility cerrno cfloat cmath cstdio cstdlib cstring vector version'

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

# What the quoted includes of all files say together: the checker's reach, names of files, circles.
check_structure() { # FILE..
  awk -v checker="$checker" -v reaches="$checker_reaches" -v longest="$longest_circle" '
    function folder_of(file) { return file ~ /\// ? substr(file, 1, match(file, /\/[^\/]*$/) - 1) : "" }
    function stem_of(file) { sub(/\.[a-z]+$/, "", file); return file }
    function base_of(file) { sub(/.*\//, "", file); return file }
    function reach(from, file,    i, list, n) { # everything that the file includes, and what that includes
      n = split(includes[file], list, " ")
      for (i = 1; i <= n; i++) {
        if ((from, list[i]) in seen) continue
        seen[from, list[i]] = 1
        if (!(folder_of(list[i]) in may_reach) && !(list[i] in may_reach))
          print from ":1: the checker must not reach " list[i] (file == from ? "" : ", as by " file)
        else reach(from, list[i])
      }
    }
    function walk(from, stem,    i, list, n) { # all stems of the folder that lead on from this one
      n = split(leads[stem], list, " ")
      for (i = 1; i <= n; i++) if (!((from, list[i]) in to)) { to[from, list[i]] = 1; walk(from, list[i]) }
    }
    FNR == 1 { file[++n_files] = FILENAME }
    /^[ \t]*#[ \t]*include[ \t]*"/ {
      name = $0; sub(/^[^"]*"/, "", name); sub(/".*/, "", name)
      includes[FILENAME] = includes[FILENAME] " " name
      if (folder_of(name) == folder_of(FILENAME) && stem_of(name) != stem_of(FILENAME))
        leads[stem_of(FILENAME)] = leads[stem_of(FILENAME)] " " stem_of(name)
    }
    END {
      n = split(reaches, list, " ")
      for (i = 1; i <= n; i++) may_reach[list[i]] = 1
      for (i = 1; i <= n_files; i++) {
        if (folder_of(file[i]) == checker) reach(file[i], file[i])
        base = base_of(stem_of(file[i])); stem = stem_of(file[i])
        if (stem in known) continue
        known[stem] = 1; stems[++n_stems] = stem
        # a header and its code may stand in two folders
        if (base in first && base != "main" && !index(includes[stem ".c"] " ", " " first[base] ".h ") &&
            !index(includes[first[base] ".c"] " ", " " stem ".h "))
          print file[i] ":1: " first[base] " has the same name"
        if (!(base in first)) first[base] = stem
      }
      for (i = 1; i <= n_stems; i++) walk(stems[i], stems[i])
      for (i = 1; i <= n_stems; i++) {
        if (stems[i] in told || !((stems[i], stems[i]) in to)) continue
        circle = base_of(stems[i]); size = 1
        for (k = i + 1; k <= n_stems; k++)
          if (((stems[i], stems[k]) in to) && ((stems[k], stems[i]) in to)) { circle = circle " " base_of(stems[k]); size++; told[stems[k]] = 1 }
        if (size > longest) print stems[i] ".c:1: a circle of " size " files: " circle
      }
    }' "$@"
}

# Whoever names a function or type of the house includes the header that declares it, or leaves that to a header of its own folder;
# tests to the headers of tests/ that they include.
check_uses() { # FILE..
  awk '
    function strip(s,    out, c, two, i, n) { # uses and sets in_comment; also strings go
      out = ""; n = length(s)
      for (i = 1; i <= n; i++) {
        c = substr(s, i, 1); two = substr(s, i, 2)
        if (in_comment) { if (two == "*/") { in_comment = 0; i++ } }
        else if (two == "/*") { in_comment = 1; i++; out = out " " }
        else if (two == "//") break
        else if (c == "\"" || c == "\047") { for (i++; i <= n && substr(s, i, 1) != c; i++) if (substr(s, i, 1) == "\\") i++ }
        else out = out c
      }
      return out
    }
    function declare(name) { if (name ~ /^thr_/ && !index(where[name] " ", " " FILENAME " ")) where[name] = where[name] " " FILENAME }
    function statement(s,    name) { # a statement of a header outside all braces, its {..} as {}
      if (s ~ /^[ ]*typedef/) {
        if (match(s, /\([ ]*\*[ ]*thr_[a-z0-9_]+/)) { name = substr(s, RSTART, RLENGTH); sub(/^[( *]*/, "", name) }
        else { name = s; sub(/[ ]*$/, "", name); sub(/.*[^a-z0-9_]/, "", name) }
        declare(name)
      } else if (match(s, /thr_[a-z0-9_]+[ ]*\(/)) { name = substr(s, RSTART, RLENGTH); sub(/[ ]*\($/, "", name); declare(name) }
      if (match(s, /struct thr_[a-z0-9_]+[ ]*{/)) { name = substr(s, RSTART + 7, RLENGTH - 7); sub(/[ ]*{$/, "", name); declare(name) }
    }
    function feed(line,    i, c) {
      for (i = 1; i <= length(line); i++) {
        c = substr(line, i, 1)
        if (c == "{") { if (depth++ == 0) held = held "{" }
        else if (c == "}") { if (--depth == 0 && held !~ /typedef|struct|enum|=/) { statement(held); held = "" } }
        else if (depth == 0 && c == ";") { statement(held); held = "" }
        else if (depth == 0) held = held c
      }
      if (depth == 0) held = held " "
    }
    function folder_of(file) { sub(/\/[^\/]*$/, "", file); return file }
    function included(file, header,    i, n, list) { # also by headers of its folder, in tests/ by headers of tests
      if (index(includes[file] " ", " " header " ")) return 1
      n = split(includes[file], list, " ")
      for (i = 1; i <= n; i++)
        if ((folder_of(list[i]) == folder_of(file) || (file ~ /^tests\// && list[i] ~ /^tests\//)) && included(list[i], header)) return 1
      return 0
    }
    FNR == 1 { in_comment = 0; depth = 0; held = "" }
    /^[ \t]*#/ {
      if (!in_comment && $0 ~ /include[ \t]*"/) { name = $0; sub(/^[^"]*"/, "", name); sub(/".*/, "", name); includes[FILENAME] = includes[FILENAME] " " name }
      next
    }
    {
      line = strip($0)
      if (FILENAME ~ /\.h$/) feed(line)
      while (match(line, /[A-Za-z0-9_]+/)) {
        word = substr(line, RSTART, RLENGTH); line = substr(line, RSTART + RLENGTH)
        if (word ~ /^thr_/ && !((FILENAME, word) in used)) { used[FILENAME, word] = FNR; uses[FILENAME] = uses[FILENAME] " " word }
      }
    }
    END {
      for (file in uses) {
        n = split(uses[file], names, " ")
        for (i = 1; i <= n; i++) {
          m = split(where[names[i]], header, " "); good = m == 0
          for (k = 1; k <= m; k++)
            good = good || header[k] == file || included(file, header[k])
          if (!good && !((file, header[1]) in told)) {
            told[file, header[1]] = 1
            print file ":" used[file, names[i]] ": include \"" header[1] "\" for " names[i]
          }
        }
      }
    }' "$@"
}

# #ifndef THR_X_H and #define THR_X_H as the first code of every header
check_guards() { # FILE..
  awk '
    function report() { if (last != "" && state != 2) print last ":1: no include guard THR_.._H" }
    FNR == 1 { report(); last = FILENAME; state = 0; name = "" }
    state == 0 && (/^#ifndef THR_[A-Z0-9_]+_H$/ || (FILENAME ~ /^include\// && /^#ifndef [A-Z]+_H$/)) { state = 1; name = $2; next }
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
  local -a sources=() headers=() tests=()
  mapfile -t sources < <(for m in graph lp symmetry tortuosity planner eval diagram include lib cli targets web; do
    for f in "$m"/*.c "$m"/*.h "$m"/*.cpp "$m"/*/*.c "$m"/*/*.h "$m"/*/*.cpp; do [ -e "$f" ] && echo "$f"; done
  done)
  mapfile -t tests < <(for f in tests/*.c tests/*.h tests/*/*.c tests/*/*.h bench/*.c; do [ -e "$f" ] && echo "$f"; done)
  for f in "${sources[@]}" "${tests[@]}"; do case $f in *.h) headers+=("$f") ;; esac; done
  if [ ${#sources[@]} -gt 0 ]; then
    check_sources "${sources[@]}"
    check_structure "${sources[@]}"
    check_uses "${sources[@]}" "${tests[@]}"
  fi
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

  expect() { # FILE:LINE|ok FILE TEXT [FILE TEXT ..]
    local want=$1 file=$2 got
    n=$((n + 1))
    rm -rf "$scratch/tree"
    for (( ; $# > 2; )); do
      mkdir -p "$scratch/tree/$(dirname "$2")"
      printf '%b' "$3" >"$scratch/tree/$2"
      shift 2
    done
    got=$(cd "$scratch/tree" && report)
    case $want in
    ok) [ "$got" = 'layers: ok' ] ;;
    *) case $got in "$want: "*) true ;; *) false ;; esac ;;
    esac || { failed=1 && echo "self-test $n: wanted $want for $file, got: $got"; }
  }

  expect graph/a.c:1 graph/a.c '#include "lp/solver/solver.h"\n'
  expect lp/a.c:2 lp/a.c '\n#include "tortuosity/t.h"\n'
  expect tortuosity/a.c:1 tortuosity/a.c '#include "symmetry/s.h"\n'
  expect tortuosity/a.c:1 tortuosity/a.c '#include "planner/make_plan.h"\n'
  expect diagram/a.c:1 diagram/a.c '#include "lp/solver/solver.h"\n'
  expect eval/a.h:3 eval/a.h '#ifndef THR_A_H\n#define THR_A_H\n# include  "diagram/d.h"\n#endif\n'
  expect graph/a.c:1 graph/a.c '#include "frame.h"\n'
  expect graph/a.c:1 graph/a.c '#include "../lp/lp.h"\n'
  expect graph/a.c:1 graph/a.c '#include <igraph.h>\n'
  expect graph/framework/frame.cpp:1 graph/framework/frame.cpp '#include <charconv>\n'
  expect cli/main.c:1 cli/main.c '#include <glpk.h>\n'
  expect symmetry/group/group.c:1 symmetry/group/group.c '#include <traces.h>\n'
  expect symmetry/group/group.c:1 symmetry/group/group.c '#include <nauty/nausparse.h>\n'
  expect eval/a.c:1 eval/a.c '#include <SuiteSparseQR_C.h>\n'
  expect eval/a.cpp:1 eval/a.cpp '#include <btBulletDynamicsCommon.h>\n'
  expect eval/a.c:1 eval/a.c '#include <BulletDynamics/btBox.h>\n'
  expect eval/a.c:1 eval/a.c '#include <new>\n'
  expect eval/a.c:1 eval/a.c 'void f(void) { _exit(1); }\n'
  expect lp/a.c:1 lp/a.c '#include <curl/curl.h>\n'
  expect web/a.c:1 web/a.c '#include <emscripten.h>\n'
  expect targets/a.c:1 targets/a.c '#include <windows.h>\n'
  expect cli/a.c:1 cli/a.c '#include "targets/host.h"\n'
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
  local guard='#ifndef THR_A_H\n#define THR_A_H\n' other='#ifndef THR_B_H\n#define THR_B_H\n'
  expect graph/check/a.c:1 graph/check/a.c '#include "graph/threading/t.h"\n'
  expect graph/check/a.c:1 graph/check/a.c '#include "graph/io/read.h"\n'
  expect graph/check/a.c:1 graph/check/a.c '#include "graph/plan/b.h"\n' graph/plan/b.h "$other"'#include "graph/process/p.h"\n#endif\n'
  expect ok graph/check/a.c '#include "graph/plan/b.h"\n#include "graph/io/json.h"\n' graph/plan/b.h "$other"'#include "graph/status.h"\n#endif\n'
  expect ok graph/plan/a.c '#include "graph/threading/t.h"\n'
  expect lp/tjoin/a.c:1 graph/plan/a.c '\n' lp/tjoin/a.c '\n'
  expect ok graph/plan/a.h "$guard#endif\n" graph/check/a.c '#include "graph/plan/a.h"\n' cli/main.c '\n' eval/main.c '\n'
  expect lp/a.c:1 lp/a.c '#include "lp/b.h"\n' lp/b.c '#include "lp/c.h"\n' lp/c.c '#include "lp/d.h"\n' lp/d.c '#include "lp/a.h"\n'
  expect ok lp/a.c '#include "lp/b.h"\n' lp/b.c '#include "lp/c.h"\n' lp/c.c '#include "lp/a.h"\n#include "lp/d.h"\n' lp/d.c '\n'
  expect ok lp/a.c '#include "lp/b.h"\n' lp/b.c '#include "lp/c.h"\n' lp/c.c '#include "lp/d.h"\n' lp/d.c '#include "graph/a.h"\n'
  expect lp/b.c:2 lp/a.h "$guard"'int thr_a(int);\n#endif\n' lp/b.c '\nint f(void) { return thr_a(1); }\n'
  expect lp/b.c:1 lp/a.h "$guard"'typedef struct {\n  int x;\n} thr_a;\n#endif\n' lp/b.c 'thr_a *f(void);\n'
  expect lp/b.c:1 lp/a.h "$guard"'typedef struct thr_a thr_a;\n#endif\n' lp/b.c 'thr_a *f(void);\n'
  expect lp/b.c:1 lp/a.h "$guard"'typedef int (*thr_a)(int);\n#endif\n' lp/b.c 'thr_a f;\n'
  expect lp/c.c:2 lp/a.h "$guard"'static inline int thr_a(int x)\n{\n  return x;\n}\nint thr_b(void);\n#endif\n' lp/c.c '\nint x = thr_b();\n'
  expect lp/c.c:2 lp/a.h "$guard"'int thr_a;\n#endif\n' lp/b.h "$other"'#include "lp/a.h"\nvoid thr_b(void);\n#endif\n' lp/d.h '#ifndef THR_D_H\n#define THR_D_H\nint thr_d(void);\n#endif\n' lp/c.c '#include "lp/b.h"\nint x = thr_d();\n'
  expect ok lp/a.h "$guard"'int thr_a(int);\n#endif\n' lp/b.h "$other"'#include "lp/a.h"\n#endif\n' lp/b.c '#include "lp/b.h"\nint x = thr_a(1); /* thr_c */\n'
  expect tests/unit/b.c:2 lp/a.h "$guard"'int thr_a(int);\n#endif\n' tests/unit/b.c '\nint x = thr_a(1);\n'
  expect bench/b.c:1 lp/a.h "$guard"'typedef struct thr_a thr_a;\n#endif\n' bench/b.c 'thr_a *x;\n'
  expect ok lp/a.h "$guard"'int thr_a(int);\n#endif\n' tests/b.h "$other"'#include "lp/a.h"\n#endif\n' tests/c.h '#ifndef THR_C_H\n#define THR_C_H\n#include "tests/b.h"\n#endif\n' tests/unit/b.c '#include "tests/c.h"\nint x = thr_a(1);\n'
  expect ok graph/framework/igraph.c '#include <igraph.h>\n#include <stdio.h>\n#include "graph/framework/frame.h"\n'
  expect ok lp/solver/lp_glpk.c '#include "graph/framework/frame.h"\n#include "lp/solver/solver.h"\n#include <glpk.h>\n'
  expect ok symmetry/group/nauty.c '#include "graph/framework/frame.h"\n#include <traces.h>\n'
  expect ok eval/joint/bullet.cpp '#include <BulletDynamics/btBox.h>\n#include <btBulletDynamicsCommon.h>\n#include <new>\n'
  expect graph/a.c:1 graph/a.c '#include <sys/prctl.h>\n'
  expect graph/framework/igraph.c:1 graph/framework/igraph.c '#include <dlfcn.h>\n'
  expect ok graph/process/process.c '#include <sys/prctl.h>\n#include <sys/wait.h>\nvoid f(void) { _exit(1); }\n'
  expect ok graph/text.c 'void f(void) { fwrite("", 1, 0, stdout); }\n'
  expect ok cli/main.c '#include "lp/solver/solver.h"\nint main(void) { printf("%d", 1); exit(0); }\n'
  expect ok graph/a.c '/* printf(1); #include "lp/solver/solver.h"\n#include "lp/solver/solver.h"\n */\nint f(void) { return snprintf(0, 0, "exit(1) stderr"); } // puts(1)\n'
  expect ok graph/a.c 'void thr_exit(int); void f(int at_exit) { thr_exit(at_exit); my_printf(1); }\n'
  expect ok graph/a.h '/* head */\n#ifndef THR_A_H\n#define THR_A_H\n#endif\n'
  expect ok docs/a.md 'cord/wo''rk/length, https://example.org/wo''rk/x, <b>/home/</b>\n'

  [ "$failed" -eq 0 ] && echo "layers: self-test ok, $n trees"
  return "$failed"
}

if [ "${1:-}" = --self-test ]; then self_test; else report; fi
