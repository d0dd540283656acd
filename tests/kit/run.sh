#!/usr/bin/env bash
# tests/kit/run.sh [PROGRAM]: what other programs find in the kits that PROGRAM (build/release/thread) writes. A square pyramid as
# five pieces and as eight tubes: unzip and xmllint read the package, admesh and prusa-slicer find nothing to repair, prusa-slicer
# slices it, openscad makes pieces of about the same volume. Installs nothing: what is missing (Debian: admesh, libxml2-utils,
# openscad, prusa-slicer, unzip) is skipped, which it says. Closes with "N passed, N failed".
set -u
export LC_ALL=C
program=$(realpath "${1:-build/release/thread}") passed=0 failed=0 skipped=0
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

holds() { # WHAT COMMAND..: the command ends well, if there is such a program
  if ! command -v "$2" >/dev/null; then
    skipped=$((skipped + 1))
    echo "skipped, there is no $2: $1"
  elif "${@:2}" >"$work/log" 2>&1; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAIL $1"
    tail -20 "$work/log" | sed 's/^/  /'
  fi
}
have() { command -v "$1" >/dev/null; }
volume() { admesh "$1" | sed -n 's/.*Volume *: *//p'; }

same_counts() { # FOLDER: as many triangles in the package as in all STL files, as many items as rows
  local model in_package in_stl
  model=$(unzip -p "$1/kit.3mf" 3D/3dmodel.model)
  in_package=$(grep -c '<triangle ' <<<"$model")
  in_stl=$(for f in "$1"/*.stl; do od -An -tu4 -j80 -N4 "$f"; done | awk '{ n += $1 } END { print n }')
  echo "$in_package triangles in the package, $in_stl in files"
  [ "$in_package" = "$in_stl" ] && [ "$(grep -c '<item ' <<<"$model")" = $(($(wc -l <"$1/kit.csv") - 1)) ]
}
well_formed() { unzip -p "$1/kit.3mf" 3D/3dmodel.model | xmllint --noout -; }
nothing_repaired() { # STL
  admesh "$1" >"$work/admesh" || return 1
  cat "$work/admesh"
  awk '/disconnected|Degenerate|fixed  |removed|added|reversed|Backwards/ { sub(/.*: */, ""); if ($1 + $2) bad = 1 }
    /Number of parts/ { parts = $5 } END { exit bad || parts != 1 }' "$work/admesh"
}
all_manifold() { # FOLDER PIECES
  prusa-slicer --info "$1/kit.3mf" >"$work/info" || return 1
  cat "$work/info"
  [ "$(grep -c 'manifold = yes' "$work/info")" = "$2" ] && ! grep -qiE 'repair|manifold = no' "$work/info"
}
slices() { # FOLDER: in the places that the package has
  prusa-slicer --dont-arrange --export-gcode -o "$1/kit.gcode" "$1/kit.3mf" >"$work/sliced" 2>&1 || { cat "$work/sliced" && return 1; }
  cat "$work/sliced"
  ! grep -qi repaired "$work/sliced" && grep -q '^G1 .*E' "$1/kit.gcode"
}
as_in_openscad() { # FOLDER KIND: within a twentieth; feet, whose fillets it has not, within a fifth
  openscad -D "show=\"$2\"" -o "$work/scad.stl" "$1/kit.scad" && ! grep -qi warning "$work/log" || return 1
  awk -v a="$(volume "$1/$2"-print-*.stl)" -v b="$(volume "$work/scad.stl")" -v part="$3" \
    'BEGIN { print a, b; exit !(a > 0 && (a - b) ^ 2 < (part * a) ^ 2) }'
}

printf '%s\n' 'v 0 0 0' 'v 40 0 0' 'v 40 40 0' 'v 0 40 0' 'v 20 20 30' \
  'l 1 2' 'l 2 3' 'l 3 4' 'l 4 1' 'l 1 5' 'l 2 5' 'l 3 5' 'l 4 5' >pyramid.obj
for joint in solid tube; do
  pieces=$([ $joint = solid ] && echo 5 || echo 8)
  holds "a plan, $joint" "$program" plan -q pyramid.obj --units mm --joint $joint -o $joint.json
  holds "a kit, $joint" "$program" kit -q $joint.json --names none --no-picture --stl --scad -o $joint
  cp $joint/kit.3mf first.3mf
  holds "the same kit again, $joint" "$program" kit -q $joint.json --names none --no-picture --stl --scad -o $joint
  holds "the same bytes, $joint" cmp first.3mf $joint/kit.3mf
  holds "$joint/kit.3mf unzips" unzip -tq $joint/kit.3mf
  have xmllint && holds "$joint/kit.3mf is XML" well_formed $joint
  have unzip && holds "$joint/kit.3mf has what the other files have" same_counts $joint
  if have admesh; then
    for f in $joint/*.stl; do holds "admesh: $f" nothing_repaired "$f"; done
  fi
  if have prusa-slicer; then
    holds "prusa-slicer: $joint/kit.3mf is manifold" all_manifold $joint $pieces
    holds "prusa-slicer slices $joint/kit.3mf" slices $joint
  fi
  if have openscad && have admesh; then
    kind=$(basename "$(find $joint -name '*.stl' | sort | tail -1)") kind=${kind%-print-*}
    holds "openscad: $joint $kind" as_in_openscad $joint "$kind" $([ $joint = solid ] && echo 0.2 || echo 0.05)
  fi
done
for tool in xmllint unzip admesh prusa-slicer openscad; do
  have $tool || { skipped=$((skipped + 1)) && echo "skipped, there is no $tool"; }
done
[ $skipped = 0 ] || echo "$skipped skipped"
echo "$passed passed, $failed failed"
[ $failed = 0 ]
