#!/usr/bin/env bash
# What `make install` leaves is complete, also where it was moved afterwards: the library's names, the examples in C and Python with
# nothing but what is installed, documents, man pages and completions. tests/library/run.sh BUILD_FOLDER OUT; closes with "N passed, N failed".
set -u
[ $# -eq 2 ] || { echo "usage: tests/library/run.sh BUILD_FOLDER OUT" >&2; exit 2; }
build=$(realpath "$1")
mkdir -p "$2"
out=$(realpath "$2")
cd "$(dirname "$0")/../.." || exit 2
root=$out/installed
usr=$root/usr
length=1995.248611 # mm, the least length of the dome with 7 x 7 nodes (data/README.md)
passed=0 failed=0
export LC_ALL=C

test_that() { # WORDS COMMAND ..
  local words=$1
  shift
  if "$@" >"$out/said" 2>&1; then passed=$((passed + 1)); return; fi
  failed=$((failed + 1))
  echo "not so: $words"
  sed 's/^/    /' "$out/said"
}

rm -rf "$root" "$out/staged"
make_quietly() { # TARGET: into $out/staged
  "${MAKE:-make}" -s OUT="$(dirname "$build")" BUILD="$(basename "$build")" DESTDIR="$out/staged" PREFIX=/usr "$1"
}
make_quietly install >"$out/install.log" 2>&1 || { cat "$out/install.log"; echo "0 passed, 1 failed"; exit 1; }
cp -R "$out/staged" "$root"
uninstalled() { make_quietly uninstall && ! find "$out/staged" ! -type d | grep .; }
export PKG_CONFIG_PATH=$usr/lib/pkgconfig
examples=$usr/share/doc/thread/examples

only_ours() { [ -z "$(nm -D --defined-only "$usr/lib/libthread.so" | awk '$3 !~ /^thread_/')" ]; }
only_ours_static() { [ -z "$(nm -g --defined-only "$usr/lib/libthread.a" | awk 'NF == 3 && $3 !~ /^thread_/')" ]; }
all_declared() { # every name of the header is in the library, and none else
  diff <(nm -D --defined-only "$usr/lib/libthread.so" | awk '{ print $3 }' | sort) \
    <(grep -o 'thread_[a-z_]*(' "$usr/include/thread.h" | tr -d '(' | sort -u)
}
soname() { readelf -d "$usr/lib/libthread.so" | grep -q 'SONAME.*\[libthread\.so\.0\]'; }
short() { [ "$(wc -l <"$usr/include/thread.h")" -le 220 ]; }
# shellcheck disable=SC2046 # words
c_example() { cc -Wall -Wextra -Werror -std=c99 "$examples/c/dome.c" $(pkg-config --cflags --libs thread) -o "$out/dome"; }
# shellcheck disable=SC2046
c_static() { g++ "$out/dome.o" "$usr/lib/libthread.a" $(pkg-config --static --libs thread | sed 's/-lthread//') -o "$out/dome-static"; }
# shellcheck disable=SC2046
c_object() { cc -c "$examples/c/dome.c" $(pkg-config --cflags thread) -o "$out/dome.o"; }
c_by_cmake() {
  rm -rf "$out/cmake" && cmake -S "$examples/c" -B "$out/cmake" -DCMAKE_PREFIX_PATH="$usr" -DCMAKE_C_FLAGS='-Wall -Werror' && cmake --build "$out/cmake"
}
refused_by_cmake() { # a version that is newer, and one of another soname
  local version
  for version in 0.99 1.0; do
    mkdir -p "$out/cmake-$version" && sed "s/thread 0.1 /thread $version /" "$examples/c/CMakeLists.txt" >"$out/cmake-$version/CMakeLists.txt" || return
    touch "$out/cmake-$version/dome.c"
    ! cmake -S "$out/cmake-$version" -B "$out/cmake-$version" -DCMAKE_PREFIX_PATH="$usr" || return
  done
}
# shellcheck disable=SC2046
cplusplus() { echo '#include <thread.h>
int main() { return thread_version() != THREAD_VERSION; }' | g++ -Wall -Wextra -Werror -x c++ - $(pkg-config --cflags --libs thread) -o "$out/version" && "$out/version"; }
# shellcheck disable=SC2046
page_compiles() { # the program in docs/library.md
  { printf '#include <stdio.h>\n#include <thread.h>\nint main(void)\n{\n'
    awk '/^```/ { inside = $0 == "```c"; next } inside' docs/library.md
    printf 'return 0;\n}\n'; } | cc -Wall -Wextra -std=c99 -x c - $(pkg-config --cflags --libs thread) -o "$out/page"
}
prints_length() { [ "$("$@")" = $length ]; }
package=$(dirname "$(find "$root" -path '*/thread_plan/__init__.py')")
# the package as it was installed, by a Python that knows nothing else of it
python() { PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$(dirname "$package") LIBTHREAD=$usr/lib/libthread.so.0 python3 "$@"; }
python_example() { prints_length python "$examples/python/dome.py" "$out/python.svg"; }
python_package() { python tests/library/package.py; }
same_plans() { python tests/library/plans.py "$usr/bin/thread"; }
same_advice() { # the rows of program and library, for three frames
  local shape
  for shape in 'dome --size 5' 'tube --size 6' 'honeycomb --size 2'; do
    # shellcheck disable=SC2086 # words
    "$usr/bin/thread" make $shape -o "$out/advised.json" && "$usr/bin/thread" advise "$out/advised.json" --json >"$out/advice.json" &&
      python -c '
import json, sys, thread_plan
frame, advice = sys.argv[1:]
said, told = json.load(open(advice)), thread_plan.read(frame).advice()
for row in said["rows"]: del row["command"] # is for people at a terminal
assert said["rows"] == told["rows"] and said["recommended"] == told["recommended"], (said, told)' "$out/advised.json" "$out/advice.json" || return
  done
}
library_words() { python3 tests/library/words.py; }
python_types() { mypy --strict --cache-dir="$out/mypy" python/thread_plan; }
python_wheel() { # one without the library, built twice by the rules of PEP 517, as pip takes it
  local wheel again
  wheel=$(python3 python/build_wheel.py "$out/wheel") && again=$(python3 python/build_wheel.py "$out/wheel-again") && cmp "$wheel" "$again" &&
    rm -rf "$out/unpacked" && python3 -m zipfile -e "$wheel" "$out/unpacked" && diff -r --exclude='*.pyc' "$package" "$out/unpacked/thread_plan"
}
as_drawn() { "$usr/bin/thread" draw "$out/plan.json" -o "$out/program.svg" && cmp "$out/program.svg" "$out/c.svg"; }
same_picture() { cmp "$out/c.svg" "$out/python.svg"; }
has_options() { # the man page of a command names every option that the command knows
  local option missing=
  while IFS=$'\t' read -r option _; do
    grep -qF -e "${option//-/\\-}" "$usr/share/man/man1/thread-$1.1" || missing+=" $option"
  done < <("$usr/bin/thread" complete "$1" -)
  echo "$missing"
  [ -z "$missing" ]
}
is_offered() { # every option in the help of a command is offered by the program, and so by the three shells
  diff <("$usr/bin/thread" "$1" --help | grep -oE '^ +(-[a-zA-Z], +)?--[a-z0-9-]+' | grep -oE -e '--.*' | sort -u) \
    <("$usr/bin/thread" complete "$1" - | cut -f 1 | sort -u)
}
bash_offers_all() { completes "$("$usr/bin/thread" complete plan -- | cut -f 1 | tr '\n' ' ' | sed 's/ $//')" plan --; }
opens() { ! MANPATH=$usr/share/man LC_ALL=C.UTF-8 man --warnings "${1##*.}" "${1%.*}" 2>&1 >/dev/null | grep .; }
is_clean() { ! mandoc -T lint "$1" | grep .; }
linked() { # what documents link to is installed
  local file target missing=
  while IFS=: read -r file target; do
    [ -e "$(dirname "$file")/${target%%#*}" ] || missing+=" $file:$target"
  done < <(grep -roE --include='*.md' '\]\([^)#][^)]*\)|src="[^"]*"' "$usr/share/doc/thread" | grep -v '://' | sed -E 's/\]\((.*)\)$/\1/; s/src="(.*)"$/\1/')
  echo "$missing"
  [ -z "$missing" ]
}
names_pages() { # thread(1) names the page of every command, and nothing that is not installed
  local name missing=
  for name in "$usr"/share/man/man1/thread-*.1; do
    name=$(basename "$name" .1)
    grep -q "^\.BR ${name/-/\\\\-} (1)" "$usr/share/man/man1/thread.1" || missing+=" $name"
  done
  for name in $(sed -n 's|^\.I \(.*\.md\)$|\1|p' "$usr/share/man/man1/thread.1"); do
    [ -e "$usr/share/doc/thread/${name//\\/}" ] || missing+=" $name"
  done
  echo "$missing"
  [ -z "$missing" ]
}
completes() { # WANTED WORDS: bash completes the last of the words so
  local wanted=$1
  shift
  # shellcheck disable=SC2016
  [ "$(PATH=$usr/bin:$PATH bash -c '. "$1"; shift; COMP_WORDS=(thread "$@"); COMP_CWORD=$#; _thread; echo "${COMPREPLY[*]}"' - \
    "$usr/share/bash-completion/completions/thread" "$@" | tr '\n' ' ' | sed 's/ $//')" = "$wanted" ]
}
zsh_offers() { # WANTED WORDS: what the function hands to zsh, less what zsh leaves out since it begins otherwise than the last word
  local wanted=$1 prefix=${*: -1}
  shift
  # shellcheck disable=SC2016
  [ "$(PATH=$usr/bin:$PATH zsh -f -c '
    fpath=("$1" $fpath); shift; autoload -Uz _thread
    _describe() { print -l -- "${(@P)2}" }
    _files() { print files }
    ask() { local -a words; words=("$@"); local CURRENT=$#; _thread }
    ask "$@"' - "$usr/share/zsh/site-functions" "$@" | sed -n "s/^\($prefix[^:]*\).*/\1/p" | tr '\n' ' ' | sed 's/ $//')" = "$wanted" ]
}
fish_offers() { # WANTED LINE
  [ "$(PATH=$usr/bin:$PATH HOME=$out fish --no-config -c 'source $argv[1]; complete -C $argv[2]' "$usr/share/fish/vendor_completions.d/thread.fish" "$2" |
    cut -f 1 | tr '\n' ' ' | sed 's/ $//')" = "$1" ]
}

version=$(sed -n 's/^VERSION := //p' Makefile)
packaged() { # debian/ asks for the libraries that the Makefile asks for, and knows the same names
  local package
  for package in $(sed -n '/^BUILD_PACKAGES/,/[^\\]$/p' Makefile | grep -o '\<[a-z0-9-]*-dev'); do
    grep -q "^Build-Depends:.* $package" debian/control || { echo "$package"; return 1; }
  done
  diff <(sed -n 's/^ \(thread_[a-z_]*\)@.*/\1/p' debian/libthread0.symbols | sort) \
    <(nm -D --defined-only "$usr/lib/libthread.so" | awk '{ print $3 }' | sort)
}
one_version() { # of header, pkg-config, package and citation
  local major minor patch
  IFS=. read -r major minor patch <<<"$version"
  grep -qxF "version = \"$version\"" python/pyproject.toml && grep -q "^#define THREAD_VERSION $((10000 * major + 100 * minor + patch)) " include/thread.h && [ "$(pkg-config --modversion thread)" = "$version" ] &&
    head -n 1 debian/changelog | grep -qF "($version)" && [ "$(date -u -d "$(sed -n 's/^ -- .*>  //p' debian/changelog | head -n 1)" +%F)" = "$(sed -n 's/^DATE := //p' Makefile)" ] && grep -qx "version: $version" CITATION.cff
}

export LD_LIBRARY_PATH=$usr/lib
test_that 'the Debian packages know the same libraries and names' packaged
test_that 'all say one version' one_version
test_that 'the shared library exports thread_* only' only_ours
test_that 'the static library exports thread_* only' only_ours_static
test_that 'the header declares what is exported' all_declared
test_that 'the soname is libthread.so.0' soname
test_that 'the header has at most 220 lines' short
test_that 'the C example compiles with pkg-config alone' c_example
test_that 'the C example prints the least length' prints_length "$out/dome" "$out/c.svg"
if command -v cmake >/dev/null; then
  test_that 'and by CMake alone' c_by_cmake
  test_that 'which prints the same' prints_length "$out/cmake/dome" "$out/cmake.svg"
  test_that 'CMake refuses other versions' refused_by_cmake
fi
test_that 'the C example is compiled' c_object
test_that 'and linked with the static library' c_static
test_that 'the static example prints the least length' env -u LD_LIBRARY_PATH bash -c "[ \"\$('$out/dome-static')\" = $length ]"
test_that 'the header is C++, too' cplusplus
test_that 'what docs/library.md shows compiles' page_compiles
test_that 'texts name members, not options' library_words
test_that 'the Python example prints the least length' python_example
test_that 'C and Python draw the same picture' same_picture
test_that 'the Python package does what it says' python_package
test_that 'program and library plan the same' same_plans
test_that 'program and library advise the same' same_advice
if command -v mypy >/dev/null; then test_that 'the Python package is typed' python_types; fi
test_that 'the wheel has the same files, and the same bytes twice' python_wheel
test_that 'the program plans the dome' bash -c "'$usr/bin/thread' make dome | '$usr/bin/thread' plan - --cords 1 -o '$out/plan.json'"
test_that 'and draws the same picture' as_drawn
for command in $("$usr/bin/thread" complete '' | cut -f 1 | grep -v help); do
  test_that "thread-$command(1) names every option" has_options "$command"
  test_that "every option of thread $command is offered" is_offered "$command"
done
for page in "$usr"/share/man/man[135]/*; do
  if command -v man >/dev/null; then test_that "$(basename "$page") opens without warnings" opens "$(basename "$page")"; fi
  if command -v mandoc >/dev/null; then test_that "$(basename "$page") is clean" is_clean "$page"; fi
done
test_that 'every function has a page' diff <(cd "$usr/share/man/man3" && printf '%s\n' thread_*) <(grep -o 'thread_[a-z_]*(' "$usr/include/thread.h" | sed 's/($/.3/' | sort -u)
test_that 'thread(1) names the other pages, and documents that are installed' names_pages
test_that 'installed documents link to what is installed' linked
test_that 'bash offers every option' bash_offers_all
test_that 'bash completes a command' completes plan pla
test_that 'bash completes an option' completes --objective plan --objec
test_that 'bash completes values' completes 'tortuosity' plan --objective t
test_that 'bash completes values after =' completes 'tube' plan --joint = t
test_that 'bash completes values that the help explains below' completes 'steps steps.csv' draw -T st
test_that 'bash leaves files to itself' completes '' check pl
if command -v zsh >/dev/null; then
  test_that 'zsh reads its completion' zsh -n "$usr/share/zsh/site-functions/_thread"
  test_that 'zsh offers commands' zsh_offers 'check' thread ch
  test_that 'zsh offers values' zsh_offers 'length symmetry tortuosity' thread plan x --objective ''
  test_that 'zsh leaves files to itself' zsh_offers 'files' thread check ''
fi
if command -v fish >/dev/null; then
  test_that 'fish reads its completion' fish -n "$usr/share/fish/vendor_completions.d/thread.fish"
  test_that 'fish offers commands' fish_offers 'check' 'thread ch'
  test_that 'fish offers values' fish_offers 'length symmetry tortuosity' 'thread plan x --objective '
fi

test_that 'uninstalled, nothing is left' uninstalled

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
