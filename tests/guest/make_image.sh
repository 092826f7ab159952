#!/usr/bin/env bash
# make_image.sh KERNEL OUTPUT FILE...: the guest's root as a compressed cpio archive.
#
# KERNEL is a folder from fetch_kernel.sh. Programs go to /bin with the libraries they are linked to,
# other files to /; /init and /scenarios are among them. The kernel's drivers and what those need are
# in /lib/modules, where modprobe finds them.
set -euo pipefail
export LC_ALL=C.UTF-8

drivers=(xhci-pci cdc-acm ch341 ftdi_sio cp210x pl2303 vhci-hcd dummy_hcd usb_f_acm g_serial usbmon)

kernel=$1 output=$(realpath "$2")
shift 2
root=$(mktemp -d "$output.XXXXXX")
trap 'rm -rf "$root"' EXIT
chmod 755 "$root"
mkdir -p "$root"/{bin,sbin,proc,sys,dev,tmp,run}

cp /bin/busybox "$root/bin/"
for name in $(/bin/busybox --list | grep -vx busybox); do ln -s busybox "$root/bin/$name"; done
ln -s /bin/busybox "$root/sbin/modprobe" # where the kernel looks for it

version=$(basename "$kernel"/lib/modules/*)
modules=$kernel/lib/modules/$version
dependencies=$(/bin/busybox depmod -n -b "$kernel" "$version")
mkdir -p "$root/lib/modules/$version"
cp "$modules"/modules.{builtin,order} "$root/lib/modules/$version/"
for name in "${drivers[@]}"; do
    files=$(grep -E "^[^:]*/$name\.ko[^:]*:" <<<"$dependencies" | tr -d :) || {
        echo "make_image.sh: $kernel has no module $name" >&2
        exit 1
    }
    (cd "$modules" && cp --parents $files "$root/lib/modules/$version/")
done
find "$root/lib/modules" -name '*.ko.xz' -exec xz -d {} +
/bin/busybox depmod -b "$root" "$version"

for file in "$@"; do
    if [ "$(head -c 4 "$file")" = $'\x7fELF' ]; then
        cp "$file" "$root/bin/"
        for library in $(ldd "$file" | grep -o '/[^ )]*'); do
            mkdir -p "$root$(dirname "$library")"
            cp -Ln "$library" "$root$library"
        done
    else
        cp "$file" "$root/"
    fi
done
(cd "$root" && find . | LC_ALL=C sort | cpio -o -H newc --quiet | gzip -1) >"$output"
