#!/bin/sh
# On arm64 duite has the bits of x86-64. A cross compiler builds this tree against Debian's packages for arm64, which debootstrap fetches from
# this machine's mirror (DUITE_MIRROR names another), and QEMU runs unit tests, and runs that are held against the tables of hashes, on one rank and on
# several.
. "${srcdir:-.}/tests/support/tap.sh"
for tool in aarch64-linux-gnu-gcc qemu-aarch64-static debootstrap dpkg-deb apt-get; do
    command -v $tool > "$scratch/output" || skip_all "$tool is missing (packages gcc-aarch64-linux-gnu, qemu-user-static, debootstrap, dpkg, apt)"
done
test "$(id -u)" = 0 || skip_all "only root may call debootstrap"
. "$srcdir/tests/support/mirror.sh"
root=$scratch/arm64
build=$scratch/build
make=${MAKE:-make}
unset MAKEFLAGS MFLAGS MAKELEVEL
plan_later

system() { # unpacked, not configured: no program of it runs; links lead to its own files
    debootstrap --foreign --arch=arm64 --variant=minbase \
        --include=libopenmpi-dev,libmetis-dev,libhwloc-dev,libxxhash-dev,uthash-dev,libyaml-dev,check,libgmp-dev "$release" "$root" "$mirror" || return
    for package in "$root"/var/cache/apt/archives/*.deb; do
        dpkg-deb --fsys-tarfile "$package" | tar -x --keep-directory-symlink -C "$root" || return
    done
    find "$root/usr/lib" -lname '/*' | while read -r link; do ln -sfn "$root$(readlink "$link")" "$link" || return; done
}

build() {
    lib=$root/usr/lib/aarch64-linux-gnu
    "$make" -s distdir distdir="$scratch/tree" && mkdir "$build" && cd "$build" &&
        "$scratch/tree/configure" --quiet --host=aarch64-linux-gnu CC="aarch64-linux-gnu-gcc --sysroot=$root" \
            MPI_CFLAGS="-I$lib/openmpi/include" MPI_LIBS="-L$lib/openmpi/lib -lmpi" MPIRUN="${MPIRUN:-mpirun}" \
            PKG_CONFIG_SYSROOT_DIR="$root" PKG_CONFIG_LIBDIR="$lib/pkgconfig:$root/usr/share/pkgconfig" &&
        "$make" -j2 && "$make" -j2 check-programs
}

emulate() { # a script of its age takes the place of each program, and runs it
    find "$build" -type f -perm -u+x ! -path '*/.libs/*' | while read -r program; do
        test "$(head -c 4 "$program" | tail -c 3)" = ELF || continue
        mv "$program" "$program.arm64" && printf '#!/bin/sh\nexec qemu-aarch64-static -L %s %s.arm64 "$@"\n' "$root" "$program" > "$program" &&
            chmod +x "$program" && touch -r "$program.arm64" "$program" || return
    done
}

check() { # LIST: variables of the Makefile, or names
    "$make" check-TESTS check_PROGRAMS= TEST_JOBS=2 TESTS="$1"
}

ok "Debian's packages for arm64" system
ok "the cross compiler builds duite" build
ok "a script for each program" emulate
cd "$build" || exit 99
ok "unit tests" check '$(ASAN_ALL)'
ok "golden hashes" check "$golden"
