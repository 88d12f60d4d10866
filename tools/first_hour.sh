#!/bin/sh
# The first hour with Passo: from a bare Debian to a part of G-code that is seen in the browser.
#
#     sh tools/first_hour.sh REPOSITORY FOLDER
#
# Clones a repository into FOLDER, which must not exist, and does there what README and tutorial show; needs root or
# sudo for Debian packages that are missing. In a container:
#
#     docker run --rm -v "$PWD:/passo:ro" debian:12 sh /passo/tools/first_hour.sh /passo /tmp/passo
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

.venv/bin/python -m benchmarks.hour "$((ended - began))" "$megabytes"
