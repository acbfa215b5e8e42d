#!/usr/bin/env bash
# Runs README's two commands as a new user would: on a minimal Debian 12 that has git and
# certificates and nothing else of ours, without make and without a compiler. Needs root,
# debootstrap and 1.5 GB under ROOT. Not part of .ci/run.
#
#   ROOT=/tmp/ilsa-fresh   where the system is made; removed at the end unless KEEP=1
#   REPO=(this tree)       what is cloned into it
#   MIRROR=                a Debian mirror; by default the sources that this machine uses
#   AS=root                root: without sudo; user: an ordinary user with sudo
set -euo pipefail
ROOT=${ROOT:-/tmp/ilsa-fresh}
REPO=${REPO:-$(cd "$(dirname "$0")/../.." && pwd)}
MIRROR=${MIRROR:-}
AS=${AS:-root}
KEEP=${KEEP:-0}

fail() {
    printf 'fresh: %s\n' "$*" >&2
    exit 1
}
[ "$(id -u)" = 0 ] || fail "run it as root"
command -v debootstrap >/dev/null || fail "debootstrap is missing"
[ ! -e "$ROOT" ] || fail "$ROOT is there already"

cleanup() {
    if mountpoint -q "$ROOT/proc"; then umount "$ROOT/proc"; fi
    if [ "$KEEP" != 1 ]; then rm -rf --one-file-system "$ROOT"; fi
}
trap cleanup EXIT

step() {
    local start=$SECONDS
    printf '\n#### %s\n' "$*"
    "$@"
    printf '#### %d s\n' $((SECONDS - start))
}
inside() { # USER COMMAND
    chroot "$ROOT" su - "$1" -c "$2"
}

# Lines of sources.list: the mirror's, or what apt reads here from Debian.
sources() {
    if [ -n "$MIRROR" ]; then
        echo "deb $MIRROR bookworm main"
    else
        # shellcheck disable=SC2016
        apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' \
            'Created-By: Packages' 'Origin: Debian' | sort -u
    fi
}
[ -n "$(sources)" ] || fail "no Debian sources here (apt-get update?): give MIRROR"
mirror=$(sources | awk '$3 == "bookworm" { print $2; exit }')

step debootstrap --variant=minbase --include=ca-certificates,git bookworm "$ROOT" "$mirror"
sources >"$ROOT/etc/apt/sources.list"
apt-config dump | grep '^Acquire::' >"$ROOT/etc/apt/apt.conf.d/90acquire" || true
cp -L /etc/resolv.conf /etc/hosts "$ROOT/etc/"
mount -t proc proc "$ROOT/proc"

user=root
if [ "$AS" = user ]; then
    user=engineer
    inside root "apt-get update -q && apt-get install -q -y --no-install-recommends sudo"
    inside root "rm -rf /var/lib/apt/lists/*"
    inside root "useradd -m -s /bin/bash $user"
    echo "$user ALL=(ALL) NOPASSWD: ALL" >"$ROOT/etc/sudoers.d/$user"
fi
inside "$user" "! command -v make gcc cc" || fail "the system is not bare"

git clone -q --no-local "$REPO" "$ROOT/tmp/libilsa"
home=$(inside "$user" pwd)
mv "$ROOT/tmp/libilsa" "$ROOT$home/libilsa"
inside root "chown -R $user: $home/libilsa"

command_under() { # COMMENT
    awk -v comment="$1" 'index($0, comment) { getline; sub(/^ */, ""); print; exit }' "$REPO/README.md"
}
for comment in "# grow the paper's three-layer fracture" "# pass the tests"; do
    command=$(command_under "$comment")
    [ -n "$command" ] || fail "README.md has no command under '$comment'"
    step inside "$user" "cd libilsa; $command"
done
inside "$user" "ls -l libilsa/out/demo"
printf '\nfresh: both commands passed as %s\n' "$AS"
