#!/bin/sh
# Counts the loads that wait for a store (benches/src/bin/blocked.rs) in some rows of the workloads, and compares them
# with benches/blocked.txt, as benches/instructions.sh does with instructions. A row fails if it has more than the table
# says, or fewer, by over 3 % and over one for each ten of its 500 queries.
#
#   benches/blocked.sh                 compare
#   benches/blocked.sh --write         write the table anew, after a change that was meant
#   benches/blocked.sh ROW...          print these rows of `instructions`
set -eu
cd "$(dirname "$0")/.."
table=benches/blocked.txt
# A trace takes seconds for each million instructions, inputs included.
rows="ray_cast/ball linear_cast/cuboid-cuboid intersect/cuboid-cuboid"

if ! command -v valgrind >/dev/null; then
    echo "blocked: valgrind is not installed, nothing was compared"
    exit 0
fi
compiler=$(rustc --version)
case ${1-} in
"") if ! grep -qxF "# $compiler" "$table"; then
        echo "blocked: the table was made with $(sed -n '1s/^# //p' "$table"), not with $compiler; nothing was compared"
        exit 0
    fi ;;
--write) ;;
*) rows=$* ;;
esac

program() {
    cargo build --quiet --profile bench -p benches --bin "$1" --message-format=json-render-diagnostics |
        sed -n 's/.*"executable":"\([^"]*\)".*/\1/p'
}
traced=$(program instructions)
count=$(program blocked)
[ -n "$traced" ] && [ -n "$count" ] || exit 1
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT

# valgrind puts a program at the same addresses each time.
addresses=$(valgrind -q --tool=none "$traced" --addresses)
echo "# $compiler" >"$scratch/table"
for row in $rows; do
    # shellcheck disable=SC2086 # two addresses
    counted=$(valgrind -q --tool=lackey --trace-mem=yes "$traced" "$row" 2>&1 >/dev/null | "$count" $addresses)
    echo "$row $counted" | tee -a "$scratch/table"
done

case ${1-} in
--write) cp "$scratch/table" "$table" ;;
"") awk 'NR == FNR { if ($1 != "#") before[$1] = $2; next }
         $1 == "#" { next }
         {
             is_new = !($1 in before); change = $2 - before[$1]; size = change < 0 ? -change : change
             if (is_new || size > 50 && size > 0.03 * before[$1]) {
                 printf "blocked: %s had %d, and has %d%s\n", $1, before[$1], $2, change < 0 ? ": run with --write" : ""
                 failed = 1
             }
         }
         END { exit failed }' "$table" "$scratch/table" ;;
esac
