# How others install duite: each file says in its first lines how it is used. configure makes the modulefile.
EXTRA_DIST += contrib/apptainer.def contrib/debian/control contrib/debian/copyright contrib/debian/duite-cloth.install contrib/debian/duite-tools.install \
	contrib/debian/libduite-dev.examples contrib/debian/libduite-dev.install contrib/debian/libduite1.install contrib/debian/not-installed contrib/debian/rules \
	contrib/spack/packages/duite/package.py contrib/spack/repo.yaml

# Debian packages of the distribution, in deb/. Their one change is this version, of the day of NEWS. Debian's file of the copyright has all
# of COPYING. make check says of the tree what tests of a package would.
DEB_TREE = deb/$(distdir)
deb: dist
	rm -rf deb && mkdir deb && tar -xzf $(distdir).tar.gz -C deb && cp -R $(DEB_TREE)/contrib/debian $(DEB_TREE)
	sed 's/^$$/./; s/^/ /' $(DEB_TREE)/COPYING >> $(DEB_TREE)/debian/copyright
	printf '%s\n' '$(PACKAGE) ($(PACKAGE_VERSION)) unstable; urgency=medium' '' '  * Packages of this version.' '' \
		" -- `sed -n 's/^Maintainer: //p' $(DEB_TREE)/debian/control`  `date -R -r $(DEB_TREE)/NEWS`" > $(DEB_TREE)/debian/changelog
	cd $(DEB_TREE) && DEB_BUILD_OPTIONS=$${DEB_BUILD_OPTIONS-nocheck} dpkg-buildpackage -b -us -uc
	rm -rf $(DEB_TREE)
clean-local:
	rm -rf deb
.PHONY: deb

if CLOTH
blenderdir = $(pkgdatadir)/blender
dist_blender_DATA = contrib/blender/duite_cloth.py
endif
