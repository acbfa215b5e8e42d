#!/bin/sh
# rooms.sh [draw]: do the rooms of src/ keep their order?
#
# A room is a folder of src/. Its files include from their own room and from rooms above it in the
# list below. An include of src/ is quoted and names "room/file"; ilsa/ is included in <>. The
# definition of struct ilsa_solver, step/solver.h, is for api/ and step/ alone.
#
# Prints the arrows between rooms, how many includes each stands for, then the faults, one a line.
# Status 1 if there is one, or if the picture, docs/figures/rooms.svg, shows other arrows. draw: draws
# the picture instead. Tests and bench programs that look inside the solver are counted, no more.
set -eu
cd "$(dirname "$0")/.."
picture=docs/figures/rooms.svg

# Name, and what is in it: from above to below.
rooms='base|fields, grid, memory, threads, errors
model|what the host says
tip|the asymptote; cells that the front crosses
elastic|pressure from width
flow|lubrication, leak-off, contact
solve|widths and pressures of a step
front|survey cells, march, tip cells
step|one step, from trial to acceptance
api|the calls of a host'

includes() { # FILE...: the lines "file:line:what" of their quoted includes
    grep -nH '^[ 	]*#[ 	]*include[ 	]*"' "$@" /dev/null |
        sed 's/^\([^:]*:[0-9]*\):[^"]*"\([^"]*\)".*/\1:\2/' || :
}

# Lines "arrow FROM TO COUNT" in the order of rooms, and "fault TEXT".
arrows() {
    {
        printf '%s\n' "$rooms" | sed 's/|.*//; s/^/room:/'
        find src -type f ! -name '*.[ch]' ! -name '*.def' -exec printf 'stray:%s\n' {} +
        find src -type f \( -name '*.[ch]' -o -name '*.def' \) | sort >"$work/files"
        sed 's/^/file:/' "$work/files"
        # shellcheck disable=SC2046
        includes $(cat "$work/files") | sed 's/^/include:/'
    } | awk -F: '
        function fault(text) { faults[++fault_count] = text }
        function room_of(path, parts) { return split(path, parts, "/") == 2 ? parts[1] : "" }
        $1 == "room" { place[$2] = ++rooms; name[rooms] = $2 }
        $1 == "stray" { fault($2 ": neither source, header nor table") }
        $1 == "file" {
            file = $2
            sub(/^src\//, "", file)
            there[file] = 1
            if (!(room_of(file) in place)) fault($2 ": not in a room of tests/rooms.sh")
        }
        $1 == "include" {
            file = $2
            sub(/^src\//, "", file)
            from = room_of(file)
            to = room_of($4)
            where = $2 ":" $3 ": \"" $4 "\""
            if (!(from in place)) next
            if (!(to in place) || !($4 in there)) { fault(where " is no room/file of src/"); next }
            count[from, to]++
            if ($4 == "step/solver.h" && from != "api" && from != "step")
                fault(where ": the solver is for api and step alone")
            else if (place[to] > place[from])
                fault(where ": " to " is below " from)
        }
        END {
            for (i = 1; i <= rooms; i++)
                for (j = 1; j <= rooms; j++)
                    if (i != j && count[name[i], name[j]])
                        print "arrow", name[i], name[j], count[name[i], name[j]]
            for (k = 1; k <= fault_count; k++) print "fault", faults[k]
        }'
}

table() {
    printf '%s\n' "$rooms" | sed 's/|.*//; s/^/room /' | cat - "$work/arrows" | awk '
        $1 == "room" { name[++rooms] = $2 }
        $1 == "arrow" { count[$2, $3] = $4 }
        END {
            printf "%-10s", "includes"
            for (j = 1; j <= rooms; j++) printf "%8s", name[j]
            for (i = 1; i <= rooms; i++) {
                printf "\n%-10s", name[i]
                for (j = 1; j <= rooms; j++)
                    printf "%8s", i == j ? "-" : count[name[i], name[j]] ? count[name[i], name[j]] : ""
            }
            printf "\n"
        }'
}

# Rooms from above to below; arrows to rooms above on the right, a room's own colour each; arrows to
# rooms below, which there should be none of, red on the left.
svg() {
    printf '%s\n' "$rooms" | sed 's/^/room|/' | cat - "$work/arrows" | awk -F'|' '
        BEGIN {
            width = 300; height = 44; gap = 18; left = 60; top = 20
            split("#888888 #1b7837 #8c510a #01665e #b35806 #762a83 #2166ac #b2182b #333333", colour, " ")
        }
        $1 == "room" { place[$2] = ++rooms; name[rooms] = $2; words[rooms] = $3; next }
        { split($0, word, " ") }
        word[1] == "arrow" { from[++arrows] = place[word[2]]; to[arrows] = place[word[3]] }
        function middle(room) { return top + (room - 1) * (height + gap) + height / 2 }
        function arc(a, b, k, side, x0, y0, x1, y1, reach, ink) {
            side = b < a ? 1 : -1
            ink = side > 0 ? colour[a] : "#ff0000"
            x0 = x1 = side > 0 ? left + width : left
            # Arrows leave above the middle of a room and arrive below it, so ordered that those of
            # one room, and those to one, do not cross.
            y0 = middle(a) - side * (2 + 18 * (b - 1) / rooms)
            y1 = middle(b) + side * (2 + 20 * (rooms - a) / rooms)
            reach = side > 0 ? x0 + 24 + 27 * (a - b) : x0 - 12 - 6 * (b - a)
            printf "<path d=\"M%g %gC%g %g %g %g %g %g\" stroke=\"%s\" marker-end=\"url(#%s)\"/>\n", \
                x0, y0, reach, y0, reach, y1, x1 + side * 7, y1, ink, "end" (side > 0 ? a : 0)
        }
        END {
            printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"590\" height=\"%d\"", \
                2 * top + rooms * (height + gap) - gap
            print " font-family=\"sans-serif\" font-size=\"13\">"
            print "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>"
            colour[0] = "#ff0000"
            print "<defs>"
            for (i = 0; i <= rooms; i++)
                printf "<marker id=\"end%d\" viewBox=\"0 0 8 8\" refX=\"1\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"%s\"/></marker>\n", i, colour[i]
            print "</defs>"
            print "<g fill=\"none\" stroke-width=\"1.4\">"
            for (k = 1; k <= arrows; k++) arc(from[k], to[k])
            print "</g>"
            for (i = 1; i <= rooms; i++) {
                y = top + (i - 1) * (height + gap)
                printf "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" rx=\"5\" fill=\"#f7f7f7\" stroke=\"%s\" stroke-width=\"1.6\"/>\n", left, y, width, height, colour[i]
                printf "<text x=\"%d\" y=\"%d\" font-weight=\"bold\">%s</text>\n", left + 12, y + 18, name[i]
                printf "<text x=\"%d\" y=\"%d\" fill=\"#444444\">%s</text>\n", left + 12, y + 35, words[i]
            }
            print "</svg>"
        }'
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
arrows >"$work/arrows"
svg >"$work/picture"
if [ "${1-}" = draw ]; then
    cp "$work/picture" "$picture"
    exit
fi

table
cmp -s "$work/picture" "$picture" || echo "fault $picture shows other arrows: make rooms-figure" >>"$work/arrows"
inside=$(includes tests/*.[ch] tests/*/*.[ch] bench/*.[ch] | grep -c ':step/solver\.h$' || :)
echo "tests and bench programs that look inside the solver: $inside"
sed -n 's/^fault /FAULT /p' "$work/arrows"
! grep -q '^fault' "$work/arrows"
