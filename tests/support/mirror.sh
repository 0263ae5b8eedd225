# shellcheck shell=sh
# Sourced after tap.sh by tests that debootstrap systems of this machine's release: $release, and $mirror, that of this machine's apt unless
# DUITE_MIRROR names another.
release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
mirror=${DUITE_MIRROR:-$(apt-get indextargets --format '$(CODENAME) $(REPO_URI)' 'Created-By: Packages' | sed -n "s/^$release //p" | head -n 1)}
test -n "$mirror" || skip_all "the sources of apt name no mirror of '$release'"
# $golden: the tests that compare hashes with those of x86-64, gcc and Open MPI.
golden="tests/whole/test_same_hash.sh tests/whole/test_scenes.sh tests/whole/test_garment.sh tests/whole/test_mannequin.sh"
