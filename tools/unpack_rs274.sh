#!/usr/bin/env bash
# Unpacks rs274, the interpreter of LinuxCNC, and the libraries that it loads, from Debian's packages into a folder.
#
#     tools/unpack_rs274.sh FOLDER
# Installed as a whole, linuxcnc-uspace brings a desktop and systemd with it (123 packages).

set -euo pipefail

folder=$1
packages=$(mktemp -d)
trap 'rm -rf "$packages"' EXIT
chmod a+rx "$packages"

# The version of boost in the name differs between releases of Debian.
boost() { apt-cache depends linuxcnc-uspace 2>/dev/null | sed -nE 's/.*Depends: (libboost-python[0-9.]+)$/\1/p'; }

if [ -z "$(boost)" ]; then
    [ "$(id -u)" -eq 0 ] && as_root=() || as_root=(sudo)
    "${as_root[@]}" apt-get update -q
fi
for package in linuxcnc-uspace $(boost) libedit2 libbsd0 libmd0; do
    (cd "$packages" && apt-get download -q "$package" 2>&1) | grep -v "unsandboxed" || true
    archive=$(echo "$packages/$package"_*.deb)
    [ -e "$archive" ] || exit 1
    mkdir "$packages/$package"
    dpkg-deb -x "$archive" "$packages/$package"
done

rm -rf "$folder"
mkdir -p "$folder"
find "$packages"/*/ -path '*/usr/lib/lib*.so*' -o -path '*/usr/lib/*-linux-gnu/lib*.so*' |
    xargs cp -P --target-directory="$folder"
cp "$packages/linuxcnc-uspace/usr/bin/rs274" "$folder"
if LD_LIBRARY_PATH=$folder ldd "$folder/rs274" | grep "not found"; then
    rm "$folder/rs274"
    exit 1
fi
