#!/bin/sh
# tools/release.sh VERSION OUT: puts what `make static windows web wheel deb` have left below OUT into one folder, OUT/thread-VERSION,
# with a README and SHA256SUMS. The same files give the same bytes; all have the time SOURCE_DATE_EPOCH.
# tools/release.sh --ready LIBRARIES: before half an hour of building, is there what all of these need? The sources of the libraries
# and npm's packages are fetched into LIBRARIES; one line says what is missing.
set -eu
if [ "$1" = --ready ]; then
  top=$(dirname "$0")/..
  refuse() { echo "make release: $1" >&2 && exit 1; }
  missing=
  for tool in git gcc g++ x86_64-w64-mingw32-gcc-posix x86_64-w64-mingw32-g++-posix emcc node npm python3 dh dpkg-buildpackage lintian; do
    command -v "$tool" >/dev/null || missing="$missing $tool"
  done
  [ -z "$missing" ] || refuse "missing:$missing"
  changed=$(git -C "$top" status --porcelain) || refuse 'the source is packed from git, and this is no clone'
  # shellcheck disable=SC2086 # on one line
  [ -z "$changed" ] || refuse "the source that is handed on would be without what is not committed: $(echo $changed)"
  "$top/targets/libraries.sh" --fetch "$2" || refuse 'the sources of the libraries are missing (above)'
  "$top/tools/npm-packages.sh" "$top/web/rhino" "$2/rhino3dm" || refuse 'rhino3dm, which npm fetches, is missing (above)'
  exit 0
fi
version=$1 out=$(cd "$2" && pwd)
folder=$out/thread-$version
: "${SOURCE_DATE_EPOCH:?}"
rm -rf "$folder"
mkdir -p "$folder"
cp "$out/static/thread" "$folder/thread-linux-$(uname -m)"
cp "$out/windows/thread.exe" "$out/web/thread.html" "$out/web/thread-3dm.js" "$out/thread-$version.tar.gz" "$folder"
cp "$out"/wheel/*.whl "$folder"
find "$out/deb" -maxdepth 1 -name '*.deb' ! -name '*-dbgsym_*' -exec cp {} "$folder" \;
(cd "$out/web/npm" && npm pack --silent --pack-destination "$folder" >/dev/null)

cat >"$folder/README.txt" <<END
thread $version: plans how cord is threaded through bead structures, proves it, draws it.

Which file is for me?

You want to try it, on any computer or telephone:     thread.html          open it in a browser; no network is needed
  .. and you have Rhino's files:                      thread-3dm.js        put it beside thread.html, which then reads 3dm
You work on Windows, in a terminal:                   thread.exe           run it as it is: thread.exe make dome
You work on Linux, and want one file:                 thread-linux-$(uname -m)  chmod +x it; install a font (DejaVu) for PDFs
You have Debian 12:                                   *.deb                apt install ./NAME_$version*.deb, of these names:
  the program                                           thread
  the page, below /usr/share/thread                     thread-plan-html
  the library, and what programs in C need              libthread0, libthread-dev
  the package for Python                                python3-thread-plan, with libthread0
You write Python, on Linux:                           *.whl                pip install ./thread_plan-$version-*.whl
You write JavaScript, or have node and nothing else:  *.tgz                npm install ./thread-plan-$version.tgz; npx thread-plan
You build it yourself, or read how it works:          thread-$version.tar.gz  make demo; make test

Are they whole?  sha256sum --check SHA256SUMS
What now?        thread help; thread make dome | thread plan - -o dome.json --draw dome
END
chmod 644 "$folder"/*
chmod 755 "$folder"/thread-linux-*
(cd "$folder" && sha256sum -- * >../SHA256SUMS && mv ../SHA256SUMS .)
find "$folder" -exec touch --no-dereference --date="@$SOURCE_DATE_EPOCH" {} +
ls -l "$folder"
