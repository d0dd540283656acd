#!/usr/bin/env bash
# Builds the libraries that thread stands on, to be linked with it, from Debian's own sources: GLPK, igraph, nauty, Bullet, and the
# small version of GMP. Usage: targets/libraries.sh wasm|linux|shared|windows FOLDER: with Emscripten, with gcc for this machine's
# processor (shared: to be part of a shared library, without GMP), or with MinGW; or targets/libraries.sh --fetch FOLDER: the sources only. What is there already is not built again, as long
# as it was built by the same compiler and this same file (FOLDER/TARGET/built-by): FOLDER/TARGET/lib/*.a and, of those headers that
# differ from the ones that Debian installs, FOLDER/TARGET/include.
#
# The sources come through apt from wherever this system gets its packages (deb-src beside its deb; nothing of the system is
# changed); their versions are pinned here and their bytes by targets/sources.sha256.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
target=${1:?which target: wasm, linux, shared or windows?}
folder=${2:?which folder?}
case $target in
wasm) cc=emcc cxx=em++ ar=emar ;;
linux | shared) cc=gcc cxx=g++ ar=ar ;;
windows) cc=x86_64-w64-mingw32-gcc-posix cxx=x86_64-w64-mingw32-g++-posix ar=x86_64-w64-mingw32-ar ;;
--fetch) ;;
*) echo "targets/libraries.sh: $target is none of wasm, linux, shared, windows" >&2 && exit 2 ;;
esac
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
built=$folder/$target
export LC_ALL=C
packages='glpk=5.0-1 igraph=0.10.2+ds-2 nauty=2.8.6+ds-2 bullet=3.24+dfsg-2 gmp=2:6.2.1+dfsg1-1.1'
flags='-O2 -ffp-contract=off -ffunction-sections -fdata-sections -w' # the linker drops what nothing calls, and what that calls
if [ "$target" = shared ]; then flags+=' -fPIC -fvisibility=hidden'; fi

# ---- sources ----

say() { echo "targets/libraries.sh: $*" >&2; }

source_lists() { # this system's package lists, asked for sources
  sed 's/^Types:.*/Types: deb-src/' /etc/apt/sources.list.d/*.sources >"$folder/apt/all.sources" 2>/dev/null || rm -f "$folder/apt/all.sources"
  sed -n 's/^deb /deb-src /p' /etc/apt/sources.list /etc/apt/sources.list.d/*.list >"$folder/apt/all.list" 2>/dev/null || true
  [ -s "$folder/apt/all.list" ] || rm -f "$folder/apt/all.list"
}

fetch() {
  mkdir -p "$folder/apt/lists/partial" "$folder/apt/archives/partial" "$folder/source"
  source_lists
  cat >"$folder/apt.conf" <<END
Dir::Etc::sourcelist "/dev/null";
Dir::Etc::sourceparts "$folder/apt";
Dir::State::lists "$folder/apt/lists";
Dir::Cache "$folder/apt";
APT::Sandbox::User "root";
Acquire::Retries "3";
END
  (
    cd "$folder/source"
    export APT_CONFIG=$folder/apt.conf
    { apt-get -q update && apt-get -q source --download-only $packages; } >"$folder/apt.log" 2>&1 || {
      tail -n 5 "$folder/apt.log" >&2
      say 'the sources could not be fetched: are these versions still in the lists of this system?'
      exit 1
    }
    sha256sum --quiet --check "$here/sources.sha256" || { say 'a source is not what it was when this was written'; exit 1; }
    for archive in *.orig.tar.*z; do tar -xf "$archive"; done
  )
}

# ---- compiling ----

compile() { # LIBRARY FLAGS.. < the files, named from the top of the source: an archive of them
  local library=$1
  shift
  local objects=$built/objects/$library
  rm -rf "$objects"
  mkdir -p "$objects" "$built/lib" "$built/include"
  # shellcheck disable=SC2016
  CC=$cc CXX=$cxx FLAGS="$flags $*" OBJECTS=$objects xargs -P "$(nproc)" -I{} sh -c '
    name=$OBJECTS/$(echo "{}" | tr / _).o
    case {} in *.c) set -- $CC ;; *) set -- $CXX -std=c++17 ;; esac
    "$@" $FLAGS -c "{}" -o "$name" || exit 255'
  rm -f "$built/lib/$library.a"
  "$ar" rcs "$built/lib/$library.part" "$objects"/*.o
  mv "$built/lib/$library.part" "$built/lib/$library.a"
}

wanted() { # LIBRARY: is it still to be built?
  [ ! -e "$built/lib/$1.a" ] || return 1
  say "building $1 for $target"
}

glpk() {
  cd "$folder/source/glpk-5.0"
  local part includes=
  for part in amd api bflib colamd draft env intopt minisat misc mpl npp proxy simplex zlib; do includes+=" -Isrc/$part"; done
  local options=(-DTLS=_Thread_local -fwrapv) # its own whole numbers rely on sums that wrap
  if [ "$target" = wasm ]; then options=(-fwrapv); fi
  if [ "$target" = linux ]; then options+=(-DHAVE_GMP); fi
  if [ "$target" = windows ]; then options+=(-D__WOE__); fi
  # shellcheck disable=SC2086
  find src -name '*.c' ! -name main.c | sort | compile glpk -Isrc $includes "${options[@]}"
  mkdir -p "$built/include/zlib" # which it brings along, with names of its own
  cp src/glpk.h "$built/include"
  cp src/zlib/zlib.h src/zlib/zconf.h "$built/include/zlib"
}

# The headers are Debian's, but for the sizes of this processor; in wasm there is no thread-local storage. No instructions that some
# processors have not.
nauty() {
  local header=$built/include/nauty/nauty.h
  mkdir -p "$built/include/nauty"
  cp /usr/include/nauty/*.h "$built/include/nauty"
  sed 's/^\(#define HAVE_HW[A-Z]*\) 1/\1 0/' /usr/include/*/nauty/nauty.h >"$header"
  if [ "$target" = wasm ]; then
    sed -i -e 's/^\(#define SIZEOF_LONG\) 8/\1 4/' -e 's/^\(#define SIZEOF_POINTER\) 8/\1 4/' \
      -e 's/^\(#define SIZEOF_INT128[_T]*\) 16/\1 0/' -e '/^#define USE_TLS/d' -e 's/^\(#define TLS_SUPPORTED\) 1/\1 0/' \
      -e 's/^\(#define TLS_ATTR\) .*/\1/' "$header"
  elif [ "$target" = windows ]; then
    sed -i -e 's/^\(#define SIZEOF_LONG\) 8/\1 4/' -e 's/^\(#define DEFAULT_WORDSIZE\) 0/\1 64/' "$header"
  fi
  cd "$folder/source/nauty2_8_6"
  printf '%s.c\n' nauty nautil naugraph nausparse schreier naurng traces |
    compile nauty -DAVOID_SYS_WAIT_H -I"$built/include" -I"$built/include/nauty"
}

# Without GLPK, LAPACK, libxml2 and what reads files: what thread calls needs none of them. An integer has 64 bits, as in Debian.
igraph() {
  cd "$folder/source/igraph-0.10.2+ds"
  mkdir -p "$built/include/mini-gmp"
  cp "$folder"/source/gmp-*/mini-gmp/mini-gmp.[ch] "$built/include/mini-gmp"
  cat >"$built/include/mini-gmp/config.h" <<END
#include "igraph_config.h"
#define HAVE_STRCASECMP 1
#define HAVE_STRNCASECMP 1
#define HAVE_STRDUP 1
#define HAVE_STRNDUP 1
#define HAVE_BUILTIN_OVERFLOW 1
#define HAVE___UINT128_T 1
#define INTERNAL_GMP 1
#define IGRAPH_F77_SAVE static
#define IGRAPH_THREAD_LOCAL $([ "$target" = wasm ] || echo _Thread_local)
END
  # what nothing calls, but MinGW's linker looks for
  printf 'int igraph_arpack_%s(void) { return 1; }\n' rssolve rnsolve options_get_default >"$built/include/mini-gmp/unused.c"
  {
    ls src/version.c src/core/*.c src/graph/*.c src/internal/*.c src/math/*.c src/random/*.c src/flow/*.c src/isomorphism/*.c* \
      src/isomorphism/bliss/*.cc src/layout/kamada_kawai.c src/layout/layout_random.c src/layout/circular.c \
      src/connectivity/*.c src/constructors/*.c src/paths/*.c src/properties/*.c src/operators/*.c src/misc/*.c \
      vendor/pcg/*.c vendor/cs/*.c
    echo "$built/include/mini-gmp/mini-gmp.c"
    if [ "$target" = windows ]; then echo "$built/include/mini-gmp/unused.c"; fi
  } | grep -v -e glpk_support -e power_law_fit | compile igraph -I/usr/include/igraph -Isrc -Ivendor -Iinclude \
    -I"$built/include" -I"$built/include/mini-gmp" -DIGRAPH_STATIC
}

bullet() {
  cd "$folder/source/bullet3-3.24/src"
  find LinearMath BulletCollision BulletDynamics -name '*.cpp' | sort |
    compile bullet -I. -DBT_USE_DOUBLE_PRECISION -fno-exceptions -fno-rtti
}

if [ ! -e "$folder/source/fetched" ]; then
  fetch
  touch "$folder/source/fetched"
fi
[ "$target" != --fetch ] || exit 0
by=$({ cat "$here/libraries.sh" "$here/sources.sha256" && "$cc" --version; } | sha256sum)
if [ "$(cat "$built/built-by" 2>/dev/null)" != "$by" ]; then
  rm -rf "$built"
  mkdir -p "$built"
  echo "$by" >"$built/built-by"
fi
for library in glpk nauty igraph bullet; do
  if wanted "$library"; then ("$library"); fi
done
