scenesdir = $(pkgdatadir)/scenes
dist_scenes_DATA =
EXTRA_DIST += cloth/demo.sh

demo: all
	@srcdir='$(srcdir)' MPIRUN='$(MPIRUN)' VIEW_MISSING='$(VIEW_MISSING)' $(SHELL) $(srcdir)/cloth/demo.sh
.PHONY: demo
