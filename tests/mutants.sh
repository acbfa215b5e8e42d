#!/bin/sh
# mutants.sh [FIRST..LAST] [SEED]: how many small faults of src/ do the tests find?
#
# Takes the 60 mutations that mutants.awk draws by the seed (1), or those numbered FIRST to LAST of
# them, one after another: builds each in a copy of the tree, runs the tests of the module
# concerned, then all others, the short ones first, and stops at the first that fails. Prints
#
#   number file:line: from -> to: caught by TEST: WHAT | survived
#
# and at the end "N of M caught". A mutation that does not compile is drawn again. Results are kept
# in $MUTANTS (build/mutants)/results, and a mutant that has one for this very tree is not run again:
# a run that was interrupted goes on where it stopped. Runs side by side need a MUTANTS of their own
# each. Status 1 unless nine of ten were caught.
set -eu
cd "$(dirname "$0")/.."

total=60
first=1
last=$total
case ${1-} in
'') ;;
*..*)
    first=${1%..*}
    last=${1#*..}
    ;;
*)
    first=$1
    last=$1
    ;;
esac
seed=${2:-1}
scratch=${MUTANTS:-build/mutants}
tree=$scratch/tree

# A make of its own: not the jobs and the variables of the one that runs this script.
unset MAKEFLAGS MAKELEVEL MFLAGS MAKEOVERRIDES 2>/dev/null || :
in_tree() {
    make -C "$tree" --no-print-directory ${JOBS:+-j$JOBS} WERROR= "$@"
}

# Runs the tests that are named; a mutant that loops or allocates for ever is stopped. The limit is
# one that a test may raise, as tests/test_memory.c does.
check() {
    (
        ulimit -S -v 16000000
        in_tree check SOME_TESTS="$1" TEST_TIMEOUT="$2"
    ) >"$scratch/check.log" 2>&1
}

object_of() {
    echo "$tree/build/release/obj/${1%.c}.o"
}

# The file as it is here again; its object is made anew, whatever the times of the two say.
restore() {
    if [ -f "$scratch/changed" ]; then
        read -r file <"$scratch/changed"
        rm -f "$(object_of "$file")"
        cp -p "$scratch/src/${file#src/}" "$tree/$file"
        rm "$scratch/changed"
    fi
}

# ---- The copy of the tree, built and known to pass ----------------------------------------------
mkdir -p "$tree"
if [ -f "$scratch/changed" ]; then
    read -r file <"$scratch/changed"
    rm -f "$(object_of "$file")" "$scratch/changed"
fi
for part in src include tests bench examples Makefile mk ilsa.pc.in; do
    rm -rf "${tree:?}/$part"
    cp -Rp "$part" "$tree/"
done
rm -rf "${scratch:?}/src"
cp -Rp src "$scratch/" # what is mutated from, should src/ change in the meantime
trap restore EXIT
trap 'exit 130' INT TERM

identity=$(find src include tests bench examples Makefile mk -type f | LC_ALL=C sort |
    xargs cat | cksum | tr ' ' -)
if [ "$(cat "$scratch/passes" 2>/dev/null)" != "$identity" ]; then
    echo "all tests without a mutation"
    in_tree check >"$scratch/check.log" 2>&1 || {
        tail -n 5 "$scratch/check.log" >&2
        exit 2
    }
    echo "$identity" >"$scratch/passes"
fi

# Every test with its seconds, the short ones first.
(cd "$tree/build/release/log" && for status in *.status; do
    read -r _ seconds <"$status"
    echo "$seconds ${status%.status}"
done) | sort -n >"$scratch/tests"

# ---- Which tests first --------------------------------------------------------------------------
# Those named after the file, those that include its header, then all; without a test of either
# kind those of its room.
tests_of() {
    base=$(basename "$1" .c)
    own=$(
        cd "$tree/tests"
        ls "test_$base.c" "test_${base}"_*.c 2>/dev/null || :
        grep -l "[/\"]$base\.h\"" test_*.c 2>/dev/null || :
    )
    case $own$1 in
    test*) ;;
    */api/*) own="test_solver.c test_handles.c" ;;
    */step/* | */front/*) own="test_step.c test_solver.c" ;;
    */tip/*) own="test_tip.c" ;;
    */elastic/*) own="test_elasticity.c" ;;
    */solve/*) own="test_coupled.c" ;;
    */flow/*) own="test_lubrication.c" ;;
    esac
    awk -v own="$own" '
        BEGIN { n = split(own, name, /[ \n]+/); for (k = 1; k <= n; k++) sub(/\.c$/, "", name[k]) }
        { seconds[$2] = $1; all[NR] = $2 }
        END {
            for (k = 1; k <= n; k++)
                if (name[k] in seconds && !done[name[k]]++)
                    print name[k], seconds[name[k]]
            for (k = 1; k <= NR; k++)
                if (!done[all[k]]++)
                    print all[k], seconds[all[k]]
        }' "$scratch/tests"
}

# What the log of a test that failed says: the first test in it that did, or how the program ended.
failure_of() {
    log=$tree/build/release/log/$1
    read -r status _ <"$log.status"
    what=$(sed -n 's/^\[  FAILED  \] \([a-zA-Z_][a-zA-Z_0-9]*\)$/\1/p' "$log.log" | head -n 1)
    case $status in
    124) what="out of time" ;;
    *) what=${what:-status $status} ;;
    esac
    echo "$1: $what"
}

# ---- The mutants --------------------------------------------------------------------------------
tab=$(printf '\t')

# Puts line $1 of the draw into the tree, with what it is in $file and $name.
mutate() {
    sed -n "$1p" "$scratch/draw" >"$scratch/one"
    IFS=$tab read -r file line column width from to <"$scratch/one"
    name="$file:$line: ${from:-nothing} -> ${to:-nothing}"
    echo "$file" >"$scratch/changed"
    awk -v line="$line" -v column="$column" -v width="$width" -v to="$to" '
        NR == line { $0 = substr($0, 1, column - 1) to substr($0, column + width) }
        { print }' "$scratch/src/${file#src/}" >"$tree/$file"
}

# One mutant, by its number: what became of it in $outcome.
judge() {
    draw=$1
    mutate "$draw"
    until in_tree lib/libilsa.a >"$scratch/check.log" 2>&1; do
        echo "$1 $name: does not compile, drawn again"
        restore
        draw=$((draw + total))
        mutate "$draw"
    done
    outcome=survived
    tests_of "$file" >"$scratch/order"
    while read -r test seconds; do
        if ! check "$test" $((20 + 5 * seconds)) </dev/null; then
            outcome="caught by $(failure_of "$test")"
            break
        fi
    done <"$scratch/order"
    restore
}

find src -name '*.c' | LC_ALL=C sort |
    xargs awk -v seed="$seed" -v count=100000 -f tests/mutants.awk >"$scratch/draw"
touch "$scratch/results"
caught=0
number=$first
while [ "$number" -le "$last" ]; do
    key="$identity $seed $number "
    if ! grep "^$key" "$scratch/results" >"$scratch/known"; then
        judge "$number"
        printf '%s%s: %s\n' "$key" "$name" "$outcome" | tee -a "$scratch/results" >"$scratch/known"
    fi
    cut -d ' ' -f 3- "$scratch/known"
    if ! grep -q ': survived$' "$scratch/known"; then
        caught=$((caught + 1))
    fi
    number=$((number + 1))
done
count=$((last - first + 1))
echo "$caught of $count caught"
[ $((10 * caught)) -ge $((9 * count)) ]
