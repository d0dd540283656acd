#!/bin/sh
# Prints flags that define the names by which the run-time linker knows libraries, as a program linked with them would have them:
#   tools/library-names.sh CC z spqr -- -lz -lspqr   prints   -DTHR_LIBRARY_Z='"libz.so.1"' ..
set -eu
cc=$1 names=
shift
while [ "$1" != -- ]; do
  names="$names $1"
  shift
done
shift
probe=$(mktemp)
trap 'rm -f "$probe"' EXIT
# shellcheck disable=SC2086 # the compiler may be two words
$cc -shared -nostdlib -o "$probe" -Wl,--no-as-needed "$@"
for name in $names; do
  found=$(readelf -d "$probe" | sed -n "s/.*(NEEDED).*\[\(lib$name\.so[^]]*\)\].*/\1/p")
  [ -n "$found" ] || { echo "thread: no shared library lib$name" >&2; exit 1; }
  echo "-DTHR_LIBRARY_$(echo "$name" | tr a-z- A-Z_)='\"$found\"'"
done
