#!/bin/sh
# Counts the instructions of some rows of the workloads under callgrind and compares them with benches/instructions.txt:
# a row that takes over 3 % more or less fails. Counts do not depend on the load of the machine, but they do on the
# compiler, so the table names the one it was made with.
#
#   benches/instructions.sh            compare
#   benches/instructions.sh --write    write the table anew, after a change that was meant
set -eu
cd "$(dirname "$0")/.."
table=benches/instructions.txt

if ! command -v valgrind >/dev/null; then
    echo "instructions: valgrind is not installed, nothing was compared"
    exit 0
fi

compiler=$(rustc --version)
if [ "${1-}" != --write ] && ! grep -qxF "# $compiler" "$table"; then
    echo "instructions: the table was made with $(sed -n '1s/^# //p' "$table"), not with $compiler; nothing was compared"
    exit 0
fi

program=$(cargo build --quiet --profile bench -p benches --bin instructions \
    --message-format=json-render-diagnostics | sed -n 's/.*"executable":"\([^"]*\)".*/\1/p')
[ -n "$program" ] || exit 1
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT

echo "# $compiler" >"$scratch/table"
for row in $("$program"); do
    if ! valgrind --tool=callgrind --callgrind-out-file="$scratch/out" --toggle-collect='*counted*' \
        "$program" "$row" >"$scratch/log" 2>&1; then
        cat "$scratch/log" >&2
        exit 1
    fi
    echo "$row $(sed -n 's/^summary: //p' "$scratch/out")" >>"$scratch/table"
done

if [ "${1-}" = --write ]; then
    cp "$scratch/table" "$table"
    cat "$table"
    exit 0
fi

awk 'NR == FNR { if ($1 != "#") before[$1] = $2; next }
     $1 == "#" { next }
     {
         change = before[$1] ? 100 * ($2 - before[$1]) / before[$1] : 100
         verdict = change > 3 ? "MORE" : change < -3 ? "LESS: run with --write" : "same"
         printf "%-38s %12d %12d %+7.1f %%  %s\n", $1, before[$1], $2, change, verdict
         if (verdict != "same") failed = 1
     }
     END { exit failed }' "$table" "$scratch/table"
