#!/usr/bin/env bash
# Installs the prerequisites of the other make targets: Debian packages, .venv, Python packages.
#
#     tools/setup.sh [SET...]
# A SET is an optional set of Python packages in requirements-SET.txt (dev, yosys, ...); or `firmware`:
# Debian's compiler for the STM32; or `browser`: Debian's headless Chromium and Firefox, and axe, where npm is; or
# `vhdl`: Debian's GHDL; or `gcode`: rs274, the interpreter of Debian's LinuxCNC; or `linuxcnc`: all of it (120 packages); or `fuzz`: Debian's clang with
# libFuzzer; or `cncjs`: the controller of that sender, where npm is. The set `web` has Pyodide as well, where npm is, and `site` Debian's Doxygen.
# Safe to run again at any time: it installs only what is missing.
# PYTHON selects the interpreter for the environment (default: python3).

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

root=$(pwd -P)
python=${PYTHON:-python3}
stamp=.venv/.setup-stamp

step() { printf '== %s\n' "$*"; }
fail() {
    printf '\nSetup stopped: %s\n' "$1" >&2
    shift
    [ $# -eq 0 ] || printf '  %s\n' "$@" >&2
    exit 1
}

# Prevents concurrent runs from corrupting .venv.
exec 9<tools/setup.sh
flock 9

# --- What is missing -----------------------------------------------------------------------------

# A command that shows that a Debian package is installed. Verilator's driver needs the full Perl, which has
# pod2usage, and the compiler as c++.
tools="iverilog:iverilog c++:g++ make:make pod2usage:perl git:git"

# Headers for Verilator's FST writer.
headers="lz4.h:liblz4-dev zlib.h:zlib1g-dev"

python_sets=()
rs274=""
npm_sets=()
fuzz=""
for name in "$@"; do
    if [ "$name" = firmware ]; then
        tools+=" arm-none-eabi-gcc:gcc-arm-none-eabi"
        headers+=" newlib/newlib.h:libnewlib-arm-none-eabi"
    elif [ "$name" = browser ]; then
        tools+=" chromium-headless-shell:chromium-headless-shell firefox-esr:firefox-esr"
        npm_sets+=(axe)
    elif [ "$name" = vhdl ]; then
        tools+=" ghdl:ghdl"
    elif [ "$name" = linuxcnc ]; then
        tools+=" linuxcnc:linuxcnc-uspace"
        headers+=" linuxcnc/hal.h:linuxcnc-uspace-dev"
    elif [ "$name" = fuzz ]; then
        fuzz=yes
    elif [ "$name" = gcode ]; then
        rs274=.venv/rs274
    elif [ "$name" = cncjs ]; then
        npm_sets+=(cncjs)
    else
        python_sets+=("$name")
        [ "$name" != web ] || npm_sets+=(pyodide)
        [ "$name" != site ] || tools+=" doxygen:doxygen"
    fi
done

missing_tools() {
    local tool header
    for header in $headers; do
        [ -e "/usr/include/${header%%:*}" ] || echo "${header##*:}"
    done
    for tool in $tools; do
        command -v "${tool%%:*}" >/dev/null || echo "${tool##*:}"
    done
    [ -z "$fuzz" ] || fuzzer_is_there || echo clang libclang-rt-dev
}

fuzzer_is_there() {
    echo 'int LLVMFuzzerTestOneInput(void) { return 0; }' | clang -fsanitize=fuzzer -x c - -o /dev/null 2>/dev/null
}

# Packages missing for the interpreter: venv needs ensurepip; cffi needs the headers; cocotb loads Python into the
# simulator and needs the shared library, which Debian packages separately.
missing_python_parts() {
    if ! command -v "$python" >/dev/null; then
        echo python3 python3-venv python3-dev
        return
    fi
    "$python" - <<'PYTHON'
import ctypes, importlib.util, os, sysconfig
if not importlib.util.find_spec("ensurepip"):
    print("python3-venv")
try:
    ctypes.CDLL(sysconfig.get_config_var("INSTSONAME"))
    if not os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h")):
        print("python3-dev")
except OSError:
    print("python3-dev")
PYTHON
}

# The absolute path is part of the key because a .venv does not survive being moved.
key=$(cat requirements.txt pyproject.toml VERSION tools/setup.sh - <<<"$root" | sha256sum)

venv_is_current() {
    [ -f "$stamp" ] && [ "$(<"$stamp")" = "$key" ] && .venv/bin/python -c 'import pip' 2>/dev/null
}

# A file of requirements and those that it includes.
with_included() { printf '%s\n' "$1" $(sed -n 's/^-r //p' "$1"); }

# The same for a set, which may include another one with a line "-r FILE".
set_key() { cat $(with_included "requirements-$1.txt") - <<<"$key" | sha256sum; }

set_is_current() {
    [ -f "$stamp-$1" ] && [ "$(<"$stamp-$1")" = "$(set_key "$1")" ]
}

missing_sets() {
    local name
    for name in "$@"; do
        [ -f "requirements-$name.txt" ] || fail "there is no set '$name'; these are there:" \
            $(ls requirements-*.txt | sed 's/requirements-\(.*\)\.txt/\1/')
        set_is_current "$name" || echo "$name"
    done
}

rs274_is_there() { [ -z "$rs274" ] || [ -x "$rs274/rs274" ]; }

# What a set of npm is for has its package.json.
npm_folder() { [ -d "tools/$1" ] && echo "tools/$1" || echo "tests/$1"; }

# Without npm there is nothing to install with: its tests say so. The lock file is the key.
missing_npm_sets() {
    local name
    command -v npm >/dev/null || return 0
    for name in "${npm_sets[@]}"; do
        cmp -s "$(npm_folder "$name")/package-lock.json" ".venv/$name/installed.json" || echo "$name"
    done
}

sets=$(missing_sets "${python_sets[@]}")
missing=$(missing_tools)
if [ -z "$missing" ] && [ -z "$sets" ] && venv_is_current && rs274_is_there && [ -z "$(missing_npm_sets)" ]; then
    step "Setup is complete."
    exit 0
fi

case $root in
    *[[:space:]]*) fail "the path of this folder contains a space:" "$root" \
        "Verilator's makefiles cannot work there. Move the folder and run 'make setup' again." ;;
esac

# --- Debian packages -----------------------------------------------------------------------------

install_packages() {
    local as_root=() install=(apt-get install -y --no-install-recommends "$@")
    local by_hand="apt-get update && ${install[*]}"

    if ! command -v apt-get >/dev/null; then
        fail "these Debian packages are needed, but there is no apt-get here: $*" \
            "Install what your system has in their place, then run 'make setup' again."
    fi
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            fail "these Debian packages are missing: $*" \
                "An administrator has to run:" "" "    $by_hand" "" "Then run 'make setup' again."
        fi
        as_root=(sudo)
    fi

    step "Installing Debian packages: $*"
    as_root+=(env DEBIAN_FRONTEND=noninteractive)
    "${as_root[@]}" apt-get update -q || step "The package lists could not be refreshed; trying without."
    "${as_root[@]}" "${install[@]}" -q || fail "apt-get could not install: $*" \
        "Check that the Debian mirror can be reached, or have an administrator run:" "" \
        "    $by_hand" "" "Then run 'make setup' again."
}

missing=$(echo $missing $(missing_python_parts))
if [ -n "$missing" ]; then
    # Unquoted on purpose: one argument per package.
    install_packages $missing
    missing=$(echo $(missing_python_parts))
    [ -z "$missing" ] || fail "$(command -v "$python") still lacks what these packages give: $missing" \
        "It is probably not Debian's own Python. Choose that one with:" "" \
        "    PYTHON=/usr/bin/python3 make setup"
fi

# --- Python environment --------------------------------------------------------------------------

"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
    fail "Python 3.11 or newer is needed; $(command -v "$python") is $("$python" -V)." \
        "Choose another one with PYTHON=... make setup."

# The scripts of a .venv contain its path, so the path that pip reports reveals broken and moved ones.
if [[ $(.venv/bin/pip --version 2>/dev/null) != *" $root/.venv/"* ]]; then
    step "Creating .venv with $("$python" -V)"
    rm -rf .venv
    "$python" -m venv .venv || fail "$python could not create .venv." \
        "On Debian, the package python3-venv has to be there."
fi

# Prints what pip is doing: a line for each package.
show_progress() {
    local line number=0
    while read -r line; do
        case $line in
            "Collecting "*) number=$((number + 1)) && line="${number}${1:+ of $1}: ${line#Collecting }" ;;
            "Installing collected"*) line="unpacking $number packages" ;;
            *) continue ;;
        esac
        printf '   [%3d s] %s\n' "$SECONDS" "${line%% (from*}"
    done
}

# The number of packages, unless it is unknown, and the arguments of pip. The files name all packages with their
# versions, so there is nothing to resolve; Python compiles what is imported.
pip_install() {
    local packages=$1
    shift
    PYTHONUNBUFFERED=1 .venv/bin/python -m pip install --no-input --disable-pip-version-check \
        --progress-bar off --no-deps --no-compile "$@" | show_progress "$packages" ||
        fail "pip could not install the Python packages; its message is above." \
            "Check the network and pip's own configuration (.venv/bin/pip config list), then run" \
            "'make setup' again. It continues where it stopped."
}

files=()
venv_is_current || files+=(requirements.txt)
for name in $sets; do
    files+=("requirements-$name.txt")
done

if [ ${#files[@]} -gt 0 ]; then
    step "Installing the Python packages of ${files[*]} (up to four minutes the first time)"
    included=$(for file in "${files[@]}"; do with_included "$file"; done | sort -u)
    pip_install "$(cat $included | grep -c '==')" $(printf -- '-r %s ' "${files[@]}")
fi

if ! venv_is_current; then
    step "Installing passo in editable mode"
    pip_install "" --no-build-isolation -e .

    echo "$key" >"$stamp"
fi

# Programs that a set, or one that it includes, names in a line "# warm-up: PROGRAM": they are WebAssembly and are
# compiled on their first run, which must not be interrupted.
warm_ups() {
    local name
    for name in $sets; do
        sed -n 's/^# warm-up: //p' $(with_included "requirements-$name.txt")
    done
}

for program in $(warm_ups | sort -u); do
    step "Preparing $program (1 to 3 minutes the first time)"
    ".venv/bin/$program" -V >/dev/null || fail "$program does not run; its message is above."
done

for name in $sets; do
    set_key "$name" >"$stamp-$name"
done

if ! rs274_is_there; then
    step "Unpacking rs274 from Debian's linuxcnc-uspace (22 MB)"
    tools/unpack_rs274.sh "$rs274" || fail "rs274 cannot be had: Debian's linuxcnc-uspace, and what it needs, is missing." \
        "Check that the Debian mirror can be reached, then run 'make setup' again."
fi

for name in $(missing_npm_sets); do
    step "Installing $name with npm"
    mkdir -p ".venv/$name"
    from=$(npm_folder "$name")
    cp "$from/package.json" "$from/package-lock.json" ".venv/$name"
    npm ci --prefix ".venv/$name" --ignore-scripts --no-audit --no-fund --silent || fail "npm could not install $name." \
        "Check the network and npm's own configuration (npm config list), then run 'make setup' again."
    cp "$from/package-lock.json" ".venv/$name/installed.json"
done

step "Setup is complete."
