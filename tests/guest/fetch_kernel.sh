#!/usr/bin/env bash
# fetch_kernel.sh DIRECTORY: the kernel of the guest, and its modules, from Debian's archive.
#
# Fetches the package that linux-image-amd64 depends on today, keeps of it the kernel and what USB
# needs in DIRECTORY/<name of the package's file>, and prints that folder's name. What is there
# already is not fetched again; where the archive can't be reached, the newest that is there will do.
set -euo pipefail
export LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive

say() { printf 'fetch_kernel.sh: %s\n' "$*" >&2; }

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo --preserve-env=DEBIAN_FRONTEND "$@"; fi
}

versioned() { apt-cache depends linux-image-amd64 2>/dev/null | awk '$1 == "Depends:" { print $2; exit }'; }

# The package's file, as the archive calls it: "linux-image-6.1.0-9-amd64_6.1.27-1_amd64.deb".
file_of() { apt-get download --print-uris "$1" 2>/dev/null | awk 'NR == 1 { print $2 }'; }

fetch() {
    local package=$1 file=$2 to=$3 work
    work=$(mktemp -d "$3.XXXXXX")
    # shellcheck disable=SC2064
    trap "rm -rf '$work'" EXIT
    chmod 755 "$work"
    (cd "$work" && apt-get download -q -o Acquire::Retries=3 -o APT::Sandbox::User=root "$package") >&2
    dpkg-deb --fsys-tarfile "$work"/*.deb | tar -x -C "$work" --wildcards \
        './boot/vmlinuz-*' './lib/modules/*/modules.*' './lib/modules/*/kernel/drivers/usb/*' \
        './lib/modules/*/kernel/fs/configfs/*'
    rm "$work"/*.deb
    [ -n "$(find "$work/boot" -name 'vmlinuz-*')" ] || { say "$file: no kernel in it"; exit 1; }
    mv -T "$work" "$to" 2>/dev/null || [ -d "$to/boot" ]
}

[ $# = 1 ] || { say "usage: fetch_kernel.sh DIRECTORY"; exit 2; }
mkdir -p "$1"
kept=$(find "$1" -mindepth 1 -maxdepth 1 -type d -name '*.deb' -printf '%T@ %p\n' | sort -n | tail -n 1)
package=$(versioned)
file=${package:+$(file_of "$package")}
if [ -z "$file" ] && [ -z "$kept" ]; then
    say "the lists of packages are missing: apt-get update"
    as_root apt-get update -qq -o Acquire::Retries=3 >&2
    package=$(versioned)
    file=$(file_of "$package")
fi
if [ -n "$file" ] && [ ! -d "$1/$file" ]; then
    fetch "$package" "$file" "$1/$file" || { [ -n "$kept" ] || exit 1; file=; }
fi
[ -n "$file" ] || file=$(basename "${kept#* }")
[ -d "$1/$file/boot" ] || { say "no kernel could be had"; exit 1; }
echo "$1/$file"
