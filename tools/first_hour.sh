#!/bin/sh
# The first hour with Passo: from a bare Debian to a part of G-code that is seen in the browser.
#
#     sh tools/first_hour.sh REPOSITORY FOLDER
#
# Clones a repository into FOLDER, which must not exist, and does there what README and tutorial show; needs root or
# sudo for Debian packages that are missing. In a container:
#
#     docker run --rm -v "$PWD:/passo:ro" -v "$PWD/build:/out" debian:12 \
#         sh -c 'sh /passo/tools/first_hour.sh /passo /tmp/passo && cp /tmp/passo/build/first_hour/* /out'
#
# or in a folder that `debootstrap --variant=minbase bookworm FOLDER` made, with chroot. Then
# `python -m benchmarks.first_hour --hour build/hour.json` puts what it measured into docs/first_hour.md.
set -eu

as_root=
[ "$(id -u)" -eq 0 ] || as_root=sudo
if ! command -v git >/dev/null || ! command -v make >/dev/null; then
    $as_root apt-get update -q
    $as_root apt-get install -y -q --no-install-recommends git make ca-certificates
fi
git -c safe.directory='*' clone -q "$1" "$2"
cd "$2"

began=$(date +%s)
make demo
ended=$(date +%s)
megabytes=$(du -sm . | cut -f1)

times >times.txt # of this shell, then of its children: 1m2.345s 0m6.789s
processor=$(tail -n 1 times.txt | tr 'ms' '  ' | awk '{ printf "%.0f", 60 * ($1 + $3) + $2 + $4 }')
rm times.txt

.venv/bin/python -m benchmarks.hour "$((ended - began))" "$processor" "$megabytes"
