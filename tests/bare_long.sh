#!/bin/sh
# README's two commands on a bare Debian of this machine's release, which debootstrap fetches from this machine's mirror (DUITE_MIRROR names
# another) with nothing but what every Debian has; on one with MPICH alone the build, a program of the tutorial, the tests of the runtime and
# golden hashes; on a third libduite and its tools alone, without the packages of the cloth; and on a fourth the Debian packages that the first
# has made come and go. An hour on two cores, 3 GB each. It tests a clone: the last commit.
. "${srcdir:-.}/tests/support/tap.sh"
test "$(id -u)" = 0 || skip_all "only root may enter another system"
for tool in debootstrap unshare git apt-get; do
    command -v $tool > "$scratch/output" || skip_all "$tool is missing (packages debootstrap, util-linux, git, apt)"
done
why=$(unshare --mount --pid --fork true 2>&1) || skip_all "no namespaces here: $why"
git -C "$srcdir" rev-parse --git-dir > "$scratch/output" 2>&1 || skip_all "no sources of git"
. "$srcdir/tests/support/mirror.sh"
plan_later
DUITE_TIMEOUT=7200

# enter SYSTEM COMMAND: as root in its folder of the clone; all that it started ends with it, and all that is mounted.
# shellcheck disable=SC2016 # for the shell inside
enter() {
    limited unshare --mount --pid --fork --kill-child sh -c '
        mount -t proc proc "$1/proc" && mount -t tmpfs tmpfs "$1/dev/shm" && mount -t devpts -o newinstance,ptmxmode=0666 devpts "$1/dev/pts" || exit
        mount -t sysfs -o ro sysfs "$1/sys" || echo "without /sys"
        exec chroot "$1" /usr/bin/env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
            http_proxy="$http_proxy" https_proxy="$https_proxy" sh -c "cd /root/duite && $2"
        ' enter "$scratch/$1" "$2" > "$scratch/said" 2>&1 && status=0 || status=$?
    grep '^FAIL\|^ERROR' "$scratch/said"
    tail -n 60 "$scratch/said"
    return $status
}
system() {
    debootstrap --variant=minbase "$release" "$scratch/one" "$mirror" > "$scratch/said" 2>&1 || { tail -n 20 "$scratch/said" && return 1; }
    echo "127.0.0.1 localhost" > "$scratch/one/etc/hosts" && git clone -q "$srcdir" "$scratch/one/root/duite" && cp -a "$scratch/one" "$scratch/mpich" &&
        cp -a "$scratch/one" "$scratch/alone" && cp -a "$scratch/one" "$scratch/packages"
}
command_of_readme() { grep -qxF "$1" "$srcdir/README.md" && enter one "$1"; }
pictures() { test -s "$scratch/one/root/duite/demo/sheet-008.png" && test -s "$scratch/one/root/duite/demo/dressing.png"; }

only_mpich() {
    enter mpich "apt-get update -qq && apt-get install -qq --no-install-recommends libmpich-dev mpich && ./bootstrap && make && make install" &&
        ! ls "$scratch"/mpich/usr/lib/*/libmpi.so.40 && grep -qx 'mpi=MPICH' "$scratch/mpich/usr/local/lib/pkgconfig/duite.pc"
}
first() {
    cp "$srcdir/tests/examples/dot.c" "$scratch/mpich/root/dot.c" &&
        enter mpich 'cd /root && cc dot.c -o dot $(pkg-config --cflags --libs duite) && ldd dot | grep libmpi && { ./dot; mpirun -n 2 ./dot; mpirun -n 3 ./dot; }' &&
        test "$(grep -c '^dot: [0-9]*$' "$scratch/said")" = 3
}
runtime() { enter mpich 'make check TESTS="$(make -s --eval='\''print-list:;@echo $(filter tests/runtime/%,$(TESTS))'\'' print-list)"'; }
hashes() { enter mpich "make check TESTS='$golden'"; }
without_cloth() {
    enter alone './bootstrap --disable-cloth && make check' || return
    enter alone 'dpkg-query -W libyaml-dev libhdf5-dev libzmq3-dev libepoxy-dev' # the names of those that are there
    ! grep -v '^dpkg-query: no packages found' "$scratch/said"
}
packages() {
    enter one 'apt-get install -qq --no-install-recommends build-essential debhelper libassimp-dev libhdf5-dev libopen-trace-format2-dev lintian && make deb && lintian --allow-root --fail-on error,warning deb/*.changes'
}
install_packages() {
    mv "$scratch/one/root/duite/deb" "$scratch/packages/root" && rm "$scratch"/packages/root/deb/*-dbgsym_*.deb &&
        enter packages 'apt-get update -qq && apt-get install -qq --no-install-recommends gcc libc6-dev make cmake pkg-config ../deb/*.deb && sh tests/installed.sh &&
            cd / && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n 2 duite-cloth sheet.yaml --end 0.002'
}
remove_packages() { # nothing of them is left
    enter packages 'apt-get purge -qq libduite1 libduite-dev duite-tools duite-cloth' || return
    find "$scratch/packages" -path "$scratch/packages/root" -prune -o -name '*duite*' -print > "$scratch/left"
    cat "$scratch/left"
    test ! -s "$scratch/left"
}

ok "a bare $release" system
ok "README: ./bootstrap && make demo" command_of_readme './bootstrap && make demo'
ok "pictures of it" pictures
ok "README: ./bootstrap && make check" command_of_readme './bootstrap && make check'
ok "Debian packages, of which lintian warns of nothing" packages
ok "Debian packages on a bare system: the first program, and two ranks of cloth" install_packages
ok "Debian packages: removed" remove_packages
ok "MPICH alone: build" only_mpich
ok "MPICH alone: the first program on 1, 2 and 3 ranks" first
ok "MPICH alone: the tests of the runtime" runtime
ok "MPICH alone: the hashes of Open MPI" hashes
ok "without the cloth: make check, and none of its packages" without_cloth
