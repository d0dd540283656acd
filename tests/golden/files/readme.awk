# awk -f readme.awk README.md OUTPUT: prints each line that the README shows as output of a command and that OUTPUT lacks or has
# earlier than the line before. Numbers may differ by 2 %: simulations end in other last digits on other processors.

function same(a, b,    x, y, u, v) {
  while (match(a, number)) {
    if (substr(a, 1, RSTART - 1) != substr(b, 1, RSTART - 1)) return 0
    x = substr(a, RSTART, RLENGTH); a = substr(a, RSTART + RLENGTH); b = substr(b, RSTART)
    if (match(b, number) != 1) return 0
    y = substr(b, 1, RLENGTH); b = substr(b, RLENGTH + 1)
    u = x - y; v = 0.02 * x
    if (u > v || -u > v) return 0
  }
  return a == b
}

BEGIN { number = "[0-9]+[.]?[0-9]*" }
FNR == 1 { file++ }
file == 1 && /^```/ { shown = 0 }
file == 1 && shown && NF && !/^[$] / { gsub(/ +/, " "); want[++n] = $0 }
file == 1 && /^[$] / { shown = 1 }
file == 2 { gsub(/ +/, " "); have[++m] = $0 }
END {
  for (i = j = 1; i <= n; i++) {
    for (k = j; k <= m && !same(want[i], have[k]); k++) { }
    if (k > m) print want[i]
    else j = k + 1
  }
}
