#!/bin/sh
# same_answer.sh PROGRAM FIRST SECOND...: compares what builds of bench_answer print, each in the
# directory of its build, with what the first does: run again and with two threads to the bit, dense
# and without FFT, and by the other builds, within 1e-10 of the largest value of its kind in a scene.
most=1e-10
first=$1
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
failed=0

# print NAME COMMAND...: into the file NAME
print() {
    name=$1
    shift
    "$@" >"$out/$name" || { echo "$*: failed" >&2; exit 1; }
}

# compare NAME HOW MOST
compare() {
    awk -F, -v how="$2" -v most="$3" '
        function magnitude(x) { return x < 0 ? -x : x }
        { key = $1 "," $2 "," $3; kind = $1 "," $2 }
        FNR == NR {
            value[key] = $4
            if (magnitude($4) > largest[kind]) largest[kind] = magnitude($4)
            lines++
            next
        }
        !(key in value) || $4 !~ /[0-9]/ { print "missing or not a number: " key; bad = 1; next }
        {
            other++
            off = magnitude($4 - value[key]) / largest[kind]
            if (!(off <= worst)) { worst = off; where = key }
        }
        END {
            if (lines == 0 || lines != other || !(worst <= most)) bad = 1
            if (worst > 0) where = " (" where ")"
            printf "%-34s off by %.1e, %d values%s%s\n", how, worst, other, where, \
                bad ? ": FAILED" : ""
            exit bad
        }' "$out/first" "$out/$1" || failed=1
}

print first "$first"
print other "$first"
compare other "run again" 0
print other "$first" threads
compare other "two threads" 0
print other "$first" dense
compare other "dense solves" $most
print other "$first" blas
compare other "products without FFT" $most
shift
for program; do
    print other "$program"
    compare other "$program" $most
done
exit $failed
