# shellcheck shell=sh
# Sourced after tap.sh by tests that debootstrap systems of this machine's release: $release, and $mirror, that of this machine's apt unless
# DUITE_MIRROR names another.
release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
mirror=${DUITE_MIRROR:-$(apt-get indextargets --format '$(CODENAME) $(REPO_URI)' 'Created-By: Packages' | sed -n "s/^$release //p" | head -n 1)}
test -n "$mirror" || skip_all "the sources of apt name no mirror of '$release'"
