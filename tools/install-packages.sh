#!/bin/sh
# Installs the Debian packages named as arguments that are not installed yet. Nothing missing: does nothing.
set -eu

if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
  echo "install-packages: not a Debian system; make sure that you have what these packages hold: $*" >&2
  exit 0
fi

missing=
for package; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) || status=
  [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0
missing=${missing# }

if [ "$(id -u)" -eq 0 ]; then
  root=
elif command -v sudo >/dev/null 2>&1 && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
  root=sudo
else
  echo "install-packages: these packages are missing, and neither root nor sudo is at hand to install them." >&2
  echo "  Ask your administrator for: apt-get install $missing" >&2
  exit 1
fi

# Another apt may hold the lock for a while, or the network may stumble: three tries.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
try() {
  for pause in 5 20 0; do
    if $root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300 "$@" \
      >"$log" 2>&1 </dev/null; then return 0; fi
    sleep "$pause"
  done
  return 1
}
echo "install-packages: installing $missing (a minute or two)" >&2
if ! try update; then
  tail -n 5 "$log" >&2
  echo "install-packages: the package lists could not be renewed; going on with the present ones" >&2
fi
# shellcheck disable=SC2086 # one word per package
if ! try install --no-install-recommends $missing; then
  cat "$log" >&2
  echo "install-packages: apt-get could not install: $missing" >&2
  exit 1
fi
