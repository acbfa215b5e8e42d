#!/usr/bin/env bash
# Installs into a temporary prefix and uses the library from there as a host would: through
# pkg-config, in C and C++, shared and static. Needs gcc, g++, make and pkg-config.
set -euo pipefail
cd "$(dirname "$0")/../.."
here=tests/install
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset DESTDIR PREFIX LIBDIR INCLUDEDIR BINDIR PKGCONFIGDIR

cc="gcc -std=c11 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wstrict-prototypes -Werror"
cxx="g++ -std=c++11 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror"
major=$(sed -n 's/^#define ILSA_VERSION_MAJOR *//p' include/ilsa/version.h)
version=$major.$(sed -n 's/^#define ILSA_VERSION_MINOR *//p' include/ilsa/version.h).$(
    sed -n 's/^#define ILSA_VERSION_PATCH *//p' include/ilsa/version.h)

say() { printf 'install: %s\n' "$*"; }
fail() {
    say "FAILED: $*" >&2
    exit 1
}
files() { (cd "$1" && find . ! -type d | sort); }
build_and_run() { # NAME COMMAND...
    local name=$1
    shift
    "$@" -o "$work/$name"
    LD_LIBRARY_PATH=${library_path:-} "$work/$name" >/dev/null || fail "$name"
    say "$name"
}

make install PREFIX="$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; fail "make install"; }
export PKG_CONFIG_PATH=$work/prefix/lib/pkgconfig
[ "$(pkg-config --modversion ilsa)" = "$version" ] || fail "version of ilsa.pc"
cflags=$(pkg-config --cflags ilsa)
libs=$(pkg-config --libs ilsa)
static=$(pkg-config --static --libs ilsa | sed 's/-lilsa/-l:libilsa.a/')

# shellcheck disable=SC2086
{
    library_path=$work/prefix/lib
    build_and_run shared $cc $cflags $here/consumer.c $libs
    build_and_run shared-c++ $cxx $cflags $here/consumer.cpp $libs
    readelf -d "$work/shared" | grep -q "NEEDED.*\[libilsa\.so\.$major\]" || fail "SONAME"
    library_path=
    build_and_run static $cc $cflags $here/consumer.c $static
    readelf -d "$work/static" | grep -q libilsa && fail "static: needs the shared library"

    # These may run for minutes: built only.
    for source in examples/*.c; do
        [ -e "$source" ] || continue
        $cc -D_POSIX_C_SOURCE=200809L $cflags "$source" -o "$work/example" $libs -lm ||
            fail "$source"
        say "built $source"
    done

    # Each header stands on its own.
    for header in "$work"/prefix/include/ilsa/*.h; do
        name=ilsa/$(basename "$header")
        printf '#include <%s>\n#include <%s>\nextern int end;\n' "$name" "$name" >"$work/one.c"
        cp "$work/one.c" "$work/one.cpp"
        $cc $cflags -fsyntax-only "$work/one.c" || fail "$name in C"
        $cxx $cflags -fsyntax-only "$work/one.cpp" || fail "$name in C++"
    done
    say "headers, one by one"

    # The tree's own ilsa.pc, without LD_LIBRARY_PATH.
    export PKG_CONFIG_PATH=$PWD/lib/pkgconfig
    cflags=$(pkg-config --cflags ilsa)
    libs=$(pkg-config --libs ilsa)
    build_and_run tree $cc $cflags $here/consumer.c $libs
}

# What the shared library shows is what the headers declare.
nm -D --defined-only "$work/prefix/lib/libilsa.so" | awk '{print $3}' | sort >"$work/shown"
printf '#include <ilsa/ilsa.h>\n' | gcc -E -P -Iinclude - | tr '\n' ' ' | tr ';' '\n' |
    sed -n 's/.*visibility("default")[^(]*)) [^(]*[ *]\(ilsa_[a-z0-9_]*\)(.*/\1/p' |
    sort >"$work/declared"
diff "$work/declared" "$work/shown" >"$work/diff" ||
    fail "declared (<) and exported (>) differ:
$(cat "$work/diff")"
say "exports: $(wc -l <"$work/shown") functions"

# A staged install names its final place only, and uninstall removes all of it.
make install DESTDIR="$work/stage" PREFIX=/usr >/dev/null
grep -q "$work" "$work/stage/usr/lib/pkgconfig/ilsa.pc" && fail "DESTDIR in ilsa.pc"
grep -q '^prefix=/usr$' "$work/stage/usr/lib/pkgconfig/ilsa.pc" || fail "prefix of ilsa.pc"
[ "$(files "$work/stage/usr")" = "$(files "$work/prefix")" ] || fail "DESTDIR installs other files"
make uninstall DESTDIR="$work/stage" PREFIX=/usr >/dev/null
make uninstall PREFIX="$work/prefix" >/dev/null
[ -z "$(files "$work/stage")$(files "$work/prefix")" ] || fail "uninstall left files behind"
say "DESTDIR, uninstall"
say "all passed"
