#!/usr/bin/env bash
# Installs the packages of Debian in a new, minimal Debian 12 in a folder of its own, with apt-get, as
# a user would, runs the program there, builds a project with the library, and removes both again.
#
#   scripts/clean_install.sh [BUILD]     default: build/release, where everything is built
#
# Needs root, mmdebstrap (Debian's package of that name) and a mirror of Debian; a few minutes.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(cd "${1:-$top/build/release}" && pwd)
say() { printf 'clean_install: %s\n' "$*"; }
fail() { printf 'clean_install: error: %s\n' "$*" >&2; exit 1; }

[ "$(id -u)" -eq 0 ] || fail "this needs root, for a new system in a folder"
command -v mmdebstrap >/dev/null || fail "no mmdebstrap here; please install the package mmdebstrap"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
system=$scratch/system

say "packages"
(cd "$scratch" && cpack --config "$build/CPackConfig.cmake" -B "$scratch/packages") >"$scratch/log" \
   || { cat "$scratch/log"; fail "no packages"; }

say "a minimal Debian 12"
mmdebstrap --quiet --variant=minbase bookworm "$system"
# its names are looked up as here
cp -L /etc/resolv.conf "$system/etc/resolv.conf"
mkdir "$system/vcor"
cp "$scratch"/packages/*.deb "$system/vcor"
cp -r "$top/tests/consumer" "$system/vcor"

# inside COMMAND: run it there, with nothing of the environment here
inside() {
   chroot "$system" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
      DEBIAN_FRONTEND=noninteractive sh -euc "cd /vcor; $1"
}
apt="apt-get -q -y -o APT::Install-Recommends=false -o Dpkg::Use-Pty=0"

say "install vcor"
inside "apt-get -q update" >"$scratch/log"
inside "$apt install ./vcor_*.deb" >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail "not installed"; }
say "run vcor"
inside "vcor run /usr/share/doc/vcor/examples/paper/sls.nml"
inside "vcor verify" | tail -n 1
inside "vcor run /usr/share/doc/vcor/examples/sweeps/sls_velocity.nml --quiet; ls *.h5"

say "install libvcor-dev, build a project"
inside "$apt install ./libvcor-dev_*.deb cmake make pkg-config" >"$scratch/log" 2>&1 \
   || { cat "$scratch/log"; fail "not installed"; }
inside "cp /usr/share/doc/vcor/examples/paper/sls.nml .
   gfortran consumer/app/from_case.f90 \$(pkg-config --cflags --libs vcor) -o drop && ./drop
   cmake -S consumer -B build >/dev/null
   cmake --build build >/dev/null && build/from_case && build/from_code"

say "install python3-vcor"
inside "$apt install ./python3-vcor_*.deb" >"$scratch/log" 2>&1 \
   || { cat "$scratch/log"; fail "not installed"; }
inside "python3 -c 'import vcor; print(vcor.read(\"sls.nml\").solve()[\"cor\"])'
   vcor-plot sls_velocity.h5"

say "remove"
inside "apt-get -q -y -o Dpkg::Use-Pty=0 purge vcor libvcor-dev python3-vcor >/dev/null
   if [ -e /usr/bin/vcor ] || [ -e /usr/lib/libvcor.a ]; then exit 1; fi"
say "done"
